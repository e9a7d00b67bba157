#include "core/gear/mesh_data.h"

#include <algorithm>
#include <cmath>

namespace tribodyn {
namespace {

double coefficient(const std::vector<double>& list, std::size_t i) {
  return i < list.size() ? list[i] : 0;
}

constexpr double FlankKinematics::*kColumns[] = {&FlankKinematics::load_share,
                                                 &FlankKinematics::radius_x,
                                                 &FlankKinematics::radius_y,
                                                 &FlankKinematics::pinion_velocity_x,
                                                 &FlankKinematics::pinion_velocity_y,
                                                 &FlankKinematics::gear_velocity_x,
                                                 &FlankKinematics::gear_velocity_y,
                                                 &FlankKinematics::contact_point_velocity_x,
                                                 &FlankKinematics::contact_point_velocity_y,
                                                 &FlankKinematics::pinion_friction_arm,
                                                 &FlankKinematics::gear_friction_arm};

struct Turn {
  double cosine, sine;
};

/// The gear lags behind by the winding of the mesh alone: mostly some milliradians.
Turn small_turn(double angle) {
  if (std::abs(angle) > 0.05) return {std::cos(angle), std::sin(angle)};
  const double square = angle * angle;
  // The next terms are below 1e-18.
  return {1 - square / 2 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56))),
          angle * (1 - square / 6 * (1 - square / 20 * (1 - square / 42 * (1 - square / 72))))};
}

}  // namespace

FlankMotion flank_motion(const FlankKinematics& k, double pinion_speed, double gear_speed) {
  FlankMotion m{};
  m.pinion_x = k.pinion_velocity_x * pinion_speed;
  m.pinion_y = k.pinion_velocity_y * pinion_speed;
  m.gear_x = k.gear_velocity_x * gear_speed;
  m.gear_y = k.gear_velocity_y * gear_speed;
  const double slide_x = m.pinion_x - m.gear_x, slide_y = m.pinion_y - m.gear_y;
  m.sliding_speed = std::sqrt(slide_x * slide_x + slide_y * slide_y);
  if (m.sliding_speed > 0) {
    const double unit_x = slide_x / m.sliding_speed, unit_y = slide_y / m.sliding_speed;
    m.pinion_friction_arm = -(unit_x * k.pinion_velocity_x + unit_y * k.pinion_velocity_y);
    m.gear_friction_arm = unit_x * k.gear_velocity_x + unit_y * k.gear_velocity_y;
  }
  return m;
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
         coefficient(s.static_transmission_error.cosine, i)});
    Harmonic& h = harmonics_.back();
    const double order = static_cast<double>(i + 1) * gear_teeth_;
    h.radius_g_sin_per_order = h.radius_g_sin / order;
    h.radius_g_cos_per_order = h.radius_g_cos / order;
  }
  gear_harmonics_ = s.gear_contact_radius.sine.size();
  // The first term left out is below 3e-15 of the ripple.
  longest_expanded_lag_ = 0.1 / static_cast<double>(std::max<std::size_t>(1, gear_harmonics_));
  const ToothContactTables& t = set.tables;
  samples_.resize(intervals_ + 1);
  for (int j = 0; j <= intervals_; ++j) {
    double sum = 0;
    for (int k = 0; k < kFlankPairs; ++k) {
      samples_[j][k] = {std::max(0.0, t.load_share[k][j]),
                        t.radius_x[k][j],
                        t.radius_y[k][j],
                        t.pinion_velocity_x[k][j],
                        t.pinion_velocity_y[k][j],
                        t.gear_velocity_x[k][j],
                        t.gear_velocity_y[k][j],
                        t.contact_point_velocity_x[k][j],
                        t.contact_point_velocity_y[k][j],
                        t.pinion_friction_arm[k][j],
                        t.gear_friction_arm[k][j]};
      sum += samples_[j][k].load_share;
    }
    for (FlankKinematics& flank : samples_[j]) flank.load_share /= sum;
  }
}

MeshPhase MeshData::at_phase(double theta_p) const {
  MeshPhase at{std::cos(theta_p),
               std::sin(theta_p),
               {pinion_radius_, gear_radius_, 0, stiffness_, 0, error_, 0},
               nullptr};
  MeshFunctions& f = at.pinion;
  double c = at.cosine, s = at.sine;
  for (std::size_t n = 0; n < harmonics_.size(); ++n) {
    const Harmonic& h = harmonics_[n];
    const double order = static_cast<double>(n + 1) * pinion_teeth_;
    f.pinion_contact_radius += h.radius_p_sin * s + h.radius_p_cos * c;
    f.radius_integral += (h.radius_p_cos * s - h.radius_p_sin * c) / order;
    f.mesh_stiffness += h.stiffness_sin * s + h.stiffness_cos * c;
    f.mesh_stiffness_slope += order * (h.stiffness_sin * c - h.stiffness_cos * s);
    f.static_transmission_error += h.error_sin * s + h.error_cos * c;
    f.static_transmission_error_slope += order * (h.error_sin * c - h.error_cos * s);
    const double next = c * at.cosine - s * at.sine;
    s = s * at.cosine + c * at.sine;
    c = next;
  }
  return at;
}

GearRadiusExpansion MeshData::expand_gear_radius(double theta) const {
  GearRadiusExpansion out{};
  for (std::size_t n = 0; n < gear_harmonics_; ++n) {
    const Harmonic& h = harmonics_[n];
    const double order = static_cast<double>(n + 1);
    const double c = std::cos(order * theta), s = std::sin(order * theta);
    out.integral -= h.radius_g_cos_per_order * s - h.radius_g_sin_per_order * c;
    double value = h.radius_g_sin * s + h.radius_g_cos * c;
    double slope = order * (h.radius_g_sin * c - h.radius_g_cos * s);
    double factor = 1;
    for (int k = 0; k < GearRadiusExpansion::kTerms; k += 2) {
      out.ripple[k] += value * factor;
      factor /= k + 1;
      if (k + 1 < GearRadiusExpansion::kTerms) out.ripple[k + 1] += slope * factor;
      factor /= k + 2;
      value *= -order * order;
      slope *= -order * order;
    }
  }
  for (int k = 0; k < GearRadiusExpansion::kTerms; ++k) {
    out.ripple_integral[k] = out.ripple[k] / (gear_teeth_ * (k + 1.0));
  }
  return out;
}

MeshFunctions MeshData::sum_of_series(const MeshPhase& at, double lag) const {
  MeshFunctions f = at.pinion;
  const Turn turn = small_turn(lag);
  const double cosine = at.cosine * turn.cosine + at.sine * turn.sine;
  const double sine = at.sine * turn.cosine - at.cosine * turn.sine;
  double c = cosine, s = sine;
  for (std::size_t n = 0; n < gear_harmonics_; ++n) {
    const Harmonic& h = harmonics_[n];
    f.gear_contact_radius += h.radius_g_sin * s + h.radius_g_cos * c;
    f.radius_integral -= h.radius_g_cos_per_order * s - h.radius_g_sin_per_order * c;
    const double next = c * cosine - s * sine;
    s = s * cosine + c * sine;
    c = next;
  }
  return f;
}

void MeshData::flanks(int interval, double phase,
                      std::array<FlankKinematics, kFlankPairs>& out) const {
  const double t = phase * intervals_ - interval;
  const auto& left = samples_[interval];
  const auto& right = samples_[interval + 1];
  for (int k = 0; k < kFlankPairs; ++k) {
    for (const auto column : kColumns) {
      out[k].*column = left[k].*column + t * (right[k].*column - left[k].*column);
    }
  }
}

}  // namespace tribodyn
