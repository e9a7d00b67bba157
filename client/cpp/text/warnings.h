#pragma once

#include <string>
#include <utility>
#include <vector>

#include "client/cpp/text/table.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns the meaning of a warning code in a few words, e.g. "cold inlet, do not rank oils here"
/// for COLD_INLET. For an unknown code returns the code in words, e.g. "new code" for NEW_CODE.
std::string warning_words(const std::string& code);

/// Whether a warning states that a law is used outside the range in which it was measured or
/// checked; true for an unknown code. The other warnings describe how the figure was computed
/// (PERIOD, QUASI_STATIC, ...).
bool is_outside_range(const std::string& code);

/// Whether fluids must not be ranked by figures that have this warning.
bool forbids_ranking(const std::string& code);

/// One warning of curves and the speeds at which at least one curve has it.
struct CurveWarning {
  std::string code;
  int speeds = 0;                  ///< number of results that have it
  double first_speed = 0;          ///< first speed in the order of the curve [km/h]
  std::string first_message;       ///< message at that speed
  std::string speeds_text;         ///< "20 to 45 and 60 km/h", "all speeds"
  std::vector<std::string> names;  ///< lubricants that have it; empty: all
  std::string mark;                ///< "a", "b", ...: letter of the strip in the plot
  /// The same speeds as ranges [km/h], each half way to its neighbours.
  std::vector<std::pair<double, double>> bands;
};

/// Returns every warning of the curves: those outside a range first, then by code.
std::vector<CurveWarning> curve_warnings(const std::vector<v1::Simulation>& simulations);

/// Returns the ranges of speed [km/h] in which `holds` is true for a result of some simulation,
/// ascending and without overlap. Each range reaches half way to the neighbouring speeds.
template <class Holds>
std::vector<std::pair<double, double>> speed_bands(const std::vector<v1::Simulation>& simulations,
                                                   const Holds& holds);

/// Joins ranges that touch or overlap.
std::vector<std::pair<double, double>> merged_bands(std::vector<std::pair<double, double>> spans);

/// Adds the warnings of one point or one curve below headings: plain words first, the code last.
void add_warnings(const v1::Simulation& simulation, Sheet& sheet);

template <class Holds>
std::vector<std::pair<double, double>> speed_bands(const std::vector<v1::Simulation>& simulations,
                                                   const Holds& holds) {
  std::vector<std::pair<double, double>> spans;
  for (const v1::Simulation& simulation : simulations) {
    const auto& points = simulation.result().points();
    for (int i = 0; i < points.size(); ++i) {
      if (!points[i].has_result() || !holds(points[i].result())) continue;
      const double speed = points[i].speed_kilometres_per_hour();
      const double before = i > 0 ? points[i - 1].speed_kilometres_per_hour() : speed;
      const double after =
          i + 1 < points.size() ? points[i + 1].speed_kilometres_per_hour() : speed;
      spans.emplace_back((before + speed) / 2, (speed + after) / 2);
    }
  }
  return merged_bands(std::move(spans));
}

}  // namespace tribodyn::client
