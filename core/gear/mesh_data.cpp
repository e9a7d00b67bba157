#include "core/gear/mesh_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/gear/flank_motion-inl.h"

namespace tribodyn {
namespace {

double coefficient(const std::vector<double>& list, std::size_t i) {
  return i < list.size() ? list[i] : 0;
}

constexpr double kManyTurns = 1e6;                  // [rad] beyond, an angle has lost its digits
constexpr std::size_t kMostExpandedHarmonics = 64;  // beyond, the expansions take too long to make

}  // namespace

FlankMotion flank_motion(const FlankKinematics& flank, double pinion_speed, double gear_speed) {
  FlankMotion out;
  HWY_NAMESPACE::set_flank_motion(flank, pinion_speed, gear_speed, false, out);
  return out;
}

MeshData::MeshData(const GearSet& set)
    : pinion_teeth_(set.pinion_teeth),
      gear_teeth_(set.gear_teeth),
      intervals_(static_cast<int>(set.tables.load_share[0].size()) - 1),
      pinion_radius_(set.series.pinion_contact_radius.mean),
      // Not the tabulated mean: x winds up unless this ratio is exact.
      gear_radius_(pinion_radius_ * set.gear_teeth / set.pinion_teeth),
      stiffness_(set.series.mesh_stiffness.mean),
      error_(set.series.static_transmission_error.mean) {
  const MeshSeries& s = set.series;
  const std::size_t count =
      std::max({s.pinion_contact_radius.sine.size(), s.gear_contact_radius.sine.size(),
                s.mesh_stiffness.sine.size(), s.static_transmission_error.sine.size()});
  for (std::size_t i = 0; i < count; ++i) {
    harmonics_.push_back(
        {coefficient(s.pinion_contact_radius.sine, i),
         coefficient(s.pinion_contact_radius.cosine, i), coefficient(s.gear_contact_radius.sine, i),
         coefficient(s.gear_contact_radius.cosine, i), coefficient(s.mesh_stiffness.sine, i),
         coefficient(s.mesh_stiffness.cosine, i), coefficient(s.static_transmission_error.sine, i),
         coefficient(s.static_transmission_error.cosine, i), 0, 0});
    Harmonic& h = harmonics_.back();
    h.pinion_order = static_cast<double>(i + 1) * pinion_teeth_;
    h.gear_order = static_cast<double>(i + 1) * gear_teeth_;
    const double pinion_radius = std::hypot(h.radius_p_sin, h.radius_p_cos);
    const double gear_radius = std::hypot(h.radius_g_sin, h.radius_g_cos);
    orders_.push_back({std::hypot(h.error_sin, h.error_cos) + pinion_radius / h.pinion_order +
                           gear_radius / h.gear_order,
                       std::hypot(h.stiffness_sin, h.stiffness_cos) / stiffness_,
                       pinion_radius / pinion_radius_ + gear_radius / gear_radius_});
  }
  if (count <= kMostExpandedHarmonics) expand();
  const ToothContactTables& t = set.tables;
  samples_.resize(intervals_ + 1);
  for (int j = 0; j <= intervals_; ++j) {
    double sum = 0;
    for (int k = 0; k < kFlankPairs; ++k) {
      FlankKinematics& flank = samples_[j][k];
      for (const FlankColumn& column : kFlankColumns) flank.*column.value = (t.*column.table)[k][j];
      flank.load_share = std::max(0.0, flank.load_share);
      sum += flank.load_share;
    }
    for (FlankKinematics& flank : samples_[j]) flank.load_share /= sum;
  }
}

void MeshData::expand() {
  const auto highest = static_cast<double>(std::max<std::size_t>(1, harmonics_.size()));
  reach_ = MeshExpansion::kReach / highest;
  std::size_t count = 8;
  while (0.6 * reach_ * static_cast<double>(count) < std::numbers::pi) count *= 2;
  expansions_.resize(count);
  std::vector<double> cosine(count), sine(count);  // of even angles
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    cosine[i] = std::cos(angle);
    sine[i] = std::sin(angle);
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t n = 0; n < harmonics_.size(); ++n) {
      const std::size_t at = (n + 1) * i % count;
      add(harmonics_[n], static_cast<double>(n + 1), cosine[at], sine[at], expansions_[i]);
    }
  }
}

void MeshData::add(const Harmonic& h, double order, double c, double s, MeshExpansion& to) {
  using E = MeshExpansion;
  // Each function, and its derivative by its angle over the order.
  std::array<double, E::kFunctions> value{}, turned{};
  const auto set = [&](E::Function function, double sine, double cosine) {
    value[function] = sine * s + cosine * c;
    turned[function] = sine * c - cosine * s;
  };
  set(E::kPinionRadius, h.radius_p_sin, h.radius_p_cos);
  set(E::kPinionIntegral, h.radius_p_cos / h.pinion_order, -h.radius_p_sin / h.pinion_order);
  set(E::kStiffness, h.stiffness_sin, h.stiffness_cos);
  set(E::kStiffnessSlope, -h.pinion_order * h.stiffness_cos, h.pinion_order * h.stiffness_sin);
  set(E::kError, h.error_sin, h.error_cos);
  set(E::kErrorSlope, -h.pinion_order * h.error_cos, h.pinion_order * h.error_sin);
  set(E::kGearRadius, h.radius_g_sin, h.radius_g_cos);
  set(E::kGearIntegral, -h.radius_g_cos / h.gear_order, h.radius_g_sin / h.gear_order);
  double factor = 1;  // order^k / k!
  for (int k = 0; k < E::kTerms; ++k) {
    const auto& derivative = k % 2 == 0 ? value : turned;
    const double signed_factor = k % 4 < 2 ? factor : -factor;
    for (int f = 0; f < E::kFunctions; ++f) to.term[k][f] += signed_factor * derivative[f];
    factor *= order / (k + 1);
  }
}

const MeshExpansion* MeshData::nearest_expansion(double theta, double& offset) const {
  if (expansions_.empty() || !(std::abs(theta) < kManyTurns)) return nullptr;
  const auto count = static_cast<long>(expansions_.size());
  const double spacing = 2 * std::numbers::pi / static_cast<double>(count);
  const long nearest = std::lround(theta / spacing);
  offset = theta - static_cast<double>(nearest) * spacing;
  return &expansions_[static_cast<std::size_t>(nearest & (count - 1))];
}

MeshPhase MeshData::at_phase(double theta_p) const {
  MeshPhase at{theta_p, {pinion_radius_, gear_radius_, 0, stiffness_, 0, error_, 0}, nullptr, 0};
  MeshFunctions& f = at.pinion;
  at.expansion = nearest_expansion(theta_p, at.offset);
  if (at.expansion != nullptr) {
    const auto ripple = at.expansion->at<MeshExpansion::kPinionRadius, 6>(at.offset);
    f.pinion_contact_radius += ripple[MeshExpansion::kPinionRadius];
    f.radius_integral += ripple[MeshExpansion::kPinionIntegral];
    f.mesh_stiffness += ripple[MeshExpansion::kStiffness];
    f.mesh_stiffness_slope += ripple[MeshExpansion::kStiffnessSlope];
    f.static_transmission_error += ripple[MeshExpansion::kError];
    f.static_transmission_error_slope += ripple[MeshExpansion::kErrorSlope];
    return at;
  }
  const double cosine = std::cos(theta_p), sine = std::sin(theta_p);
  double c = cosine, s = sine;
  for (const Harmonic& h : harmonics_) {
    f.pinion_contact_radius += h.radius_p_sin * s + h.radius_p_cos * c;  // (eq 9)
    f.radius_integral += (h.radius_p_cos * s - h.radius_p_sin * c) / h.pinion_order;
    f.mesh_stiffness += h.stiffness_sin * s + h.stiffness_cos * c;  // (eq 10)
    f.mesh_stiffness_slope += h.pinion_order * (h.stiffness_sin * c - h.stiffness_cos * s);
    f.static_transmission_error += h.error_sin * s + h.error_cos * c;  // (eq 11)
    f.static_transmission_error_slope += h.pinion_order * (h.error_sin * c - h.error_cos * s);
    const double next = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = next;
  }
  return at;
}

std::array<double, 2> MeshData::gear_functions(const MeshPhase& phase, double lag) const {
  const double theta = phase.theta - lag;
  double offset = 0;
  if (const MeshExpansion* expansion = nearest_expansion(theta, offset)) {
    return expansion->at<MeshExpansion::kGearRadius, 2>(offset);
  }
  const double cosine = std::cos(theta), sine = std::sin(theta);
  double c = cosine, s = sine, ripple = 0, integral = 0;
  for (const Harmonic& h : harmonics_) {
    ripple += h.radius_g_sin * s + h.radius_g_cos * c;  // (eq 8)
    integral -= (h.radius_g_cos * s - h.radius_g_sin * c) / h.gear_order;
    const double next = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = next;
  }
  return {ripple, integral};
}

void MeshData::flanks(int interval, double phase,
                      std::array<FlankKinematics, kFlankPairs>& out) const {
  const double t = phase * intervals_ - interval;
  const auto& left = samples_[interval];
  const auto& right = samples_[interval + 1];
  for (int k = 0; k < kFlankPairs; ++k) {
    for (const FlankColumn& column : kFlankColumns) {
      const double from = left[k].*column.value;
      out[k].*column.value = from + t * (right[k].*column.value - from);
    }
  }
}

}  // namespace tribodyn
