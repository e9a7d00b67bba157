#include "core/gear/blank_geometry.h"

#include <cmath>
#include <numbers>
#include <string>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2;

std::string wrong_angle(const std::string& name, double value, double low) {
  if (value > low && value < kRightAngle) return "";
  constexpr double kDegrees = 180 / std::numbers::pi;
  return " " + name + " is " + number_text(value * kDegrees) + " degrees; it must lie between " +
         std::to_string(static_cast<int>(std::lround(low * kDegrees))) + " and 90.";
}

std::string wrong_with(const std::string& name, const BlankMember& member) {
  std::string wrong;
  if (member.teeth < 1) {
    wrong += " " + name + ".teeth is " + std::to_string(member.teeth) + "; it must be at least 1.";
  }
  wrong += wrong_angle(name + ".pitch_angle", member.pitch_angle, 0);
  wrong += wrong_angle(name + ".face_angle", member.face_angle, 0);
  wrong += wrong_angle(name + ".spiral_angle", member.spiral_angle, -kRightAngle);
  if (!std::isfinite(member.face_apex) || !std::isfinite(member.pitch_apex)) {
    wrong += " " + name + ": an apex position is not finite.";
  }
  return wrong;
}

void refuse_impossible(const HypoidBlank& blank) {
  std::string wrong = wrong_with("pinion", blank.pinion) + wrong_with("gear", blank.gear);
  if (!(blank.offset > 0 && std::isfinite(blank.offset))) {
    wrong += " offset is " + number_text(blank.offset) + " m; it must be above 0 m.";
  }
  if (!(blank.pinion.spiral_angle > blank.gear.spiral_angle)) {
    wrong += " pinion.spiral_angle must be above gear.spiral_angle.";
  }
  if (!wrong.empty())
    throw Refusal("BLANK_IMPOSSIBLE", "These blanks make no hypoid pair." + wrong);
}

// Distance from the mean point to the face cone, perpendicular to the pitch cone.
double mean_addendum(const BlankMember& member, double cone_distance) {
  const double inclination = member.face_angle - member.pitch_angle;
  const double apex_distance = member.face_apex - member.pitch_apex;
  return (cone_distance * std::sin(inclination) + apex_distance * std::sin(member.face_angle)) /
         std::cos(inclination);
}

double cosine_of_shaft_angle(double pinion_pitch_angle, double gear_pitch_angle,
                             double offset_angle) {
  return std::cos(pinion_pitch_angle) * std::cos(gear_pitch_angle) * std::cos(offset_angle) -
         std::sin(pinion_pitch_angle) * std::sin(gear_pitch_angle);
}

}  // namespace

ShaftPlacement shaft_placement(double pinion_cone_distance, double gear_cone_distance,
                               double pinion_pitch_angle, double gear_pitch_angle,
                               double offset_angle) {
  const double shaft_angle =
      std::acos(cosine_of_shaft_angle(pinion_pitch_angle, gear_pitch_angle, offset_angle));
  const double offset =
      std::sin(offset_angle) *
      (pinion_cone_distance * std::sin(pinion_pitch_angle) * std::cos(gear_pitch_angle) +
       gear_cone_distance * std::sin(gear_pitch_angle) * std::cos(pinion_pitch_angle)) /
      std::sin(shaft_angle);
  return {shaft_angle, offset};
}

HypoidGeometry hypoid_geometry(const HypoidBlank& blank) {
  refuse_impossible(blank);
  const double dp = blank.pinion.pitch_angle;
  const double dg = blank.gear.pitch_angle;
  const double bp = blank.pinion.spiral_angle;
  const double bg = blank.gear.spiral_angle;

  HypoidGeometry g;
  g.offset_angle = bp - bg;

  // The offset is homogeneous of degree one in the cone distances.
  const double gear_radius_ratio =
      std::cos(bp) / std::cos(bg) * blank.gear.teeth / blank.pinion.teeth;
  const ShaftPlacement unit =
      shaft_placement(1 / std::sin(dp), gear_radius_ratio / std::sin(dg), dp, dg, g.offset_angle);
  g.shaft_angle = unit.shaft_angle;
  g.pinion.mean_radius = blank.offset / unit.offset;
  g.gear.mean_radius = gear_radius_ratio * g.pinion.mean_radius;
  const double ap = g.pinion.mean_radius / std::sin(dp);
  const double ag = g.gear.mean_radius / std::sin(dg);
  g.pinion.mean_cone_distance = ap;
  g.gear.mean_cone_distance = ag;

  // Feet of the common perpendicular on the two axes, measured from the apexes.
  const double cos_shaft = cosine_of_shaft_angle(dp, dg, g.offset_angle);
  const double along_pinion = std::cos(dp) * (ap - ag * std::cos(g.offset_angle));
  const double along_gear = std::cos(dg) * (ap * std::cos(g.offset_angle) - ag);
  const double sin2_shaft = 1 - cos_shaft * cos_shaft;
  g.pinion.pitch_apex = (along_pinion - cos_shaft * along_gear) / sin2_shaft;
  g.gear.pitch_apex = (cos_shaft * along_pinion - along_gear) / sin2_shaft;

  g.pinion.addendum = mean_addendum(blank.pinion, ap);
  g.gear.addendum = mean_addendum(blank.gear, ag);
  g.working_depth = g.pinion.addendum + g.gear.addendum;
  if (!(g.working_depth > 0)) {
    throw Refusal("BLANK_IMPOSSIBLE", "These blanks make no hypoid pair. The working depth is " +
                                          number_text(g.working_depth) +
                                          " m; face and pitch apexes must leave it above 0 m.");
  }
  g.mean_normal_module = 2 * g.gear.mean_radius * std::cos(bg) / blank.gear.teeth;
  g.mean_point_sliding = g.pinion.mean_radius * std::sin(g.offset_angle) / std::cos(bg);

  const double tan_limit = -std::tan(dp) * std::tan(dg) / std::cos(g.offset_angle) *
                           (ap * std::sin(bp) - ag * std::sin(bg)) /
                           (ap * std::tan(dp) + ag * std::tan(dg));
  g.limit_pressure_angle = std::atan(tan_limit);
  g.limit_curvature_radius =
      (std::tan(bp) - std::tan(bg)) /
      (std::cos(g.limit_pressure_angle) *
       (1 / (ap * std::cos(bp)) - 1 / (ag * std::cos(bg)) -
        tan_limit * (std::tan(bp) / (ap * std::tan(dp)) + std::tan(bg) / (ag * std::tan(dg)))));
  return g;
}

}  // namespace tribodyn
