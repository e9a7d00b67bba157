#include "core/vehicle/drive_cycle.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/refusal.h"

namespace tribodyn {
namespace {

/// Ends of the operations of a part of the NEDC.
struct Operation {
  double end;    // [s]
  double speed;  // [km/h]
};

constexpr double kMostPieces = 1e6;           // eleven days of pieces of 1 s
constexpr double kMetresPerSecond = 1 / 3.6;  // of 1 km/h

constexpr Operation kUrban[] = {{0, 0},    {11, 0},   {15, 15},  {23, 15},  {25, 10},  {28, 0},
                                {49, 0},   {54, 15},  {56, 15},  {61, 32},  {85, 32},  {93, 10},
                                {96, 0},   {117, 0},  {122, 15}, {124, 15}, {133, 35}, {135, 35},
                                {143, 50}, {155, 50}, {163, 35}, {176, 35}, {178, 35}, {185, 10},
                                {188, 0},  {195, 0}};
constexpr Operation kExtraUrban[] = {
    {0, 0},     {20, 0},    {25, 15},  {27, 15},  {36, 35},  {38, 35},  {46, 50},   {48, 50},
    {61, 70},   {111, 70},  {119, 50}, {188, 50}, {201, 70}, {251, 70}, {286, 100}, {316, 100},
    {336, 120}, {346, 120}, {362, 80}, {370, 50}, {380, 0},  {400, 0}};

[[noreturn]] void refuse(std::size_t place, const std::string& why) {
  throw Refusal("PARAMETER_OUT_OF_RANGE",
                "place " + std::to_string(place + 1) + " of the cycle: " + why);
}

}  // namespace

std::vector<CyclePiece> pieces_of(const DriveCycle& cycle, double longest) {
  const auto& places = cycle.places;
  if (places.size() < 2) throw Refusal("PARAMETER_OUT_OF_RANGE", "a cycle has two places or more");
  std::vector<CyclePiece> out;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const CyclePlace& to = places[i];
    if (!std::isfinite(to.time) || !std::isfinite(to.speed) || !std::isfinite(to.ascent_angle) ||
        !std::isfinite(to.sump_temperature)) {
      refuse(i, "a number is not finite");
    }
    if (to.speed < 0) refuse(i, "the speed is negative");
    if (i == 0) continue;
    const CyclePlace& from = places[i - 1];
    const double duration = to.time - from.time;
    if (!(duration > 0)) refuse(i, "the time does not rise");
    if (duration / longest > kMostPieces - static_cast<double>(out.size())) {
      refuse(i, "the cycle is longer than 1000000 pieces");
    }
    const int parts = std::max(1, static_cast<int>(std::ceil(duration / longest - 1e-9)));
    const double step = duration / parts;
    const double change = (to.speed - from.speed) / parts;
    const double warming = (to.sump_temperature - from.sump_temperature) / parts;
    for (int k = 0; k < parts; ++k) {
      out.push_back({from.time + k * step, step, from.speed + (k + 0.5) * change,
                     (to.speed - from.speed) / duration, from.ascent_angle,
                     from.sump_temperature + (k + 0.5) * warming});
    }
  }
  return out;
}

DriveCycle nedc() {
  DriveCycle out{"NEDC", {{0, 0}}};
  double start = 0;
  const auto append = [&](const auto& part) {
    for (const Operation& each : part) {
      if (each.end > 0) out.places.push_back({start + each.end, each.speed * kMetresPerSecond});
    }
    start += std::prev(std::end(part))->end;
  };
  for (int i = 0; i < 4; ++i) append(kUrban);
  append(kExtraUrban);
  return out;
}

}  // namespace tribodyn
