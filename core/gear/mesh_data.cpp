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
  }
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

MeshFunctions MeshData::functions(double theta_p, double theta_g) const {
  const double cos_p = std::cos(theta_p), sin_p = std::sin(theta_p);
  const double cos_g = std::cos(theta_g), sin_g = std::sin(theta_g);
  MeshFunctions f{pinion_radius_, gear_radius_, 0, stiffness_, 0, error_, 0};
  double cp = cos_p, sp = sin_p, cg = cos_g, sg = sin_g;
  for (std::size_t n = 0; n < harmonics_.size(); ++n) {
    const Harmonic& h = harmonics_[n];
    const double order = static_cast<double>(n + 1);
    const double order_p = order * pinion_teeth_, order_g = order * gear_teeth_;
    f.pinion_contact_radius += h.radius_p_sin * sp + h.radius_p_cos * cp;
    f.gear_contact_radius += h.radius_g_sin * sg + h.radius_g_cos * cg;
    f.radius_integral += (h.radius_p_cos * sp - h.radius_p_sin * cp) / order_p -
                         (h.radius_g_cos * sg - h.radius_g_sin * cg) / order_g;
    f.mesh_stiffness += h.stiffness_sin * sp + h.stiffness_cos * cp;
    f.mesh_stiffness_slope += order_p * (h.stiffness_sin * cp - h.stiffness_cos * sp);
    f.static_transmission_error += h.error_sin * sp + h.error_cos * cp;
    f.static_transmission_error_slope += order_p * (h.error_sin * cp - h.error_cos * sp);
    const double next_cp = cp * cos_p - sp * sin_p, next_cg = cg * cos_g - sg * sin_g;
    sp = sp * cos_p + cp * sin_p;
    sg = sg * cos_g + cg * sin_g;
    cp = next_cp;
    cg = next_cg;
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
