#include "core/gear/blank_geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/refusal.h"
#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

BlankMember member(const nlohmann::json& blank, const std::string& suffix) {
  const auto angle = [&](const std::string& name) {
    return blank.at(name + suffix + "_deg").get<double>() * kDegree;
  };
  return {blank.at("N" + suffix),
          angle("pitch_angle"),
          angle("face_angle"),
          angle("spiral_angle"),
          blank.at("pitch_apex" + suffix),
          blank.at("face_apex" + suffix)};
}

HypoidBlank reference_blank() {
  const nlohmann::json blank = load_reference("reference_gear_set.json").at("blank_geometry");
  return {member(blank, "_p"), member(blank, "_g"), blank.at("offset")};
}

TEST(HypoidGeometry, MatchesTheReferenceGearSet) {
  const nlohmann::json expected = load_reference("reference_gear_set.json").at("derived_geometry");
  const HypoidGeometry g = hypoid_geometry(reference_blank());
  const auto compare = [&](const std::string& name, double value) {
    EXPECT_NEAR(value / expected.at(name).get<double>(), 1, 1e-13) << name;
  };
  compare("mean_cone_distance_p", g.pinion.mean_cone_distance);
  compare("mean_cone_distance_g", g.gear.mean_cone_distance);
  compare("mean_radius_p", g.pinion.mean_radius);
  compare("mean_radius_g", g.gear.mean_radius);
  compare("offset_angle_pitch_plane_deg", g.offset_angle / kDegree);
  compare("mean_normal_module", g.mean_normal_module);
  compare("addendum_p", g.pinion.addendum);
  compare("addendum_g", g.gear.addendum);
  compare("working_depth", g.working_depth);
  compare("limit_pressure_angle_deg", g.limit_pressure_angle / kDegree);
  compare("limit_curvature_radius", g.limit_curvature_radius);
}

TEST(HypoidGeometry, ClosesOnTheBlankThatItCameFrom) {
  const HypoidBlank blank = reference_blank();
  const HypoidGeometry g = hypoid_geometry(blank);
  EXPECT_NEAR(g.shaft_angle / kDegree, 90, 0.0015);
  // Apexes were not used: they come back to the micrometres that the drawing is printed with.
  EXPECT_NEAR(g.pinion.pitch_apex, blank.pinion.pitch_apex, 4e-6);
  EXPECT_NEAR(g.gear.pitch_apex, blank.gear.pitch_apex, 4e-6);
  // Standard proportions of a uniform-depth set: depth factor 2, profile shift 0.5.
  EXPECT_NEAR(g.working_depth / g.mean_normal_module, 2, 0.001);
  EXPECT_NEAR(g.pinion.addendum / g.mean_normal_module, 1.5, 0.001);
  EXPECT_NEAR(g.gear.addendum / g.mean_normal_module, 0.5, 0.001);
}

// The pair set up in space, pitch plane z = 0 and mean point at the origin.
struct PairInSpace {
  Vector3d pinion_apex, pinion_axis, gear_apex, gear_axis, tooth_trace;
  PairInSpace(const HypoidBlank& blank, const HypoidGeometry& g) {
    const double e = g.offset_angle;
    const Vector3d generatrix(std::cos(e), -std::sin(e), 0);
    pinion_apex = -g.pinion.mean_cone_distance * generatrix;
    pinion_axis = std::cos(blank.pinion.pitch_angle) * generatrix +
                  std::sin(blank.pinion.pitch_angle) * Vector3d::UnitZ();
    gear_apex = -g.gear.mean_cone_distance * Vector3d::UnitX();
    gear_axis = std::cos(blank.gear.pitch_angle) * Vector3d::UnitX() -
                std::sin(blank.gear.pitch_angle) * Vector3d::UnitZ();
    tooth_trace = {std::cos(blank.gear.spiral_angle), std::sin(blank.gear.spiral_angle), 0};
  }
};

TEST(HypoidGeometry, MatchesThePairSetUpInSpace) {
  HypoidBlank blank = reference_blank();
  for (const double shaft_shift : {0.0, 4.0, -9.0}) {  // also shaft angles away from 90 degrees
    blank.gear.pitch_angle = (59.653 + shaft_shift) * kDegree;
    blank.gear.face_angle = blank.gear.pitch_angle;
    const HypoidGeometry g = hypoid_geometry(blank);
    const PairInSpace pair(blank, g);
    EXPECT_NEAR(std::acos(pair.pinion_axis.dot(pair.gear_axis)), g.shaft_angle, 1e-14);
    const Vector3d common = pair.pinion_axis.cross(pair.gear_axis).normalized();
    EXPECT_NEAR((pair.pinion_apex - pair.gear_apex).dot(common), blank.offset, 1e-16);
    // The crossing points lie opposite each other along the common perpendicular.
    const Vector3d on_pinion = pair.pinion_apex + g.pinion.pitch_apex * pair.pinion_axis;
    const Vector3d on_gear = pair.gear_apex + g.gear.pitch_apex * pair.gear_axis;
    EXPECT_NEAR((on_pinion - on_gear - blank.offset * common).norm(), 0, 1e-16);
    // Mean radii are distances of the mean point from the axes.
    EXPECT_NEAR(pair.pinion_apex.cross(pair.pinion_axis).norm(), g.pinion.mean_radius, 1e-16);
    EXPECT_NEAR(pair.gear_apex.cross(pair.gear_axis).norm(), g.gear.mean_radius, 1e-16);
    // With the ratio of the tooth numbers, sliding lies along the tooth trace.
    const double ratio = static_cast<double>(blank.pinion.teeth) / blank.gear.teeth;
    const Vector3d sliding = pair.pinion_axis.cross(-pair.pinion_apex) -
                             ratio * (-pair.gear_axis).cross(-pair.gear_apex);
    EXPECT_NEAR(sliding.cross(pair.tooth_trace).norm(), 0, 1e-16);
    EXPECT_NEAR(sliding.norm(), g.mean_point_sliding, 1e-16);
  }
}

TEST(HypoidGeometry, PutsTheTipOnTheFaceCone) {
  // A face cone that is not parallel to the pitch cone: the tip must lie on it.
  HypoidBlank blank = reference_blank();
  blank.pinion.face_angle += 3 * kDegree;
  const HypoidGeometry g = hypoid_geometry(blank);
  const double d = blank.pinion.pitch_angle;
  const double a = g.pinion.mean_cone_distance;
  const double axial = a * std::cos(d) - g.pinion.addendum * std::sin(d);
  const double radial = a * std::sin(d) + g.pinion.addendum * std::cos(d);
  const double from_face_apex = axial + blank.pinion.face_apex - blank.pinion.pitch_apex;
  EXPECT_NEAR(std::atan2(radial, from_face_apex), blank.pinion.face_angle, 1e-15);
}

TEST(HypoidGeometry, ScalesWithTheOffset) {
  HypoidBlank blank = reference_blank();
  const HypoidGeometry one = hypoid_geometry(blank);
  constexpr double kScale = 3.7;
  blank.offset *= kScale;
  for (BlankMember* member : {&blank.pinion, &blank.gear}) {
    member->pitch_apex *= kScale;
    member->face_apex *= kScale;
  }
  const HypoidGeometry scaled = hypoid_geometry(blank);
  EXPECT_NEAR(scaled.pinion.mean_cone_distance / one.pinion.mean_cone_distance, kScale, 1e-14);
  EXPECT_NEAR(scaled.gear.pitch_apex / one.gear.pitch_apex, kScale, 1e-13);
  EXPECT_NEAR(scaled.working_depth / one.working_depth, kScale, 1e-13);
  EXPECT_NEAR(scaled.limit_curvature_radius / one.limit_curvature_radius, kScale, 1e-13);
  EXPECT_NEAR(scaled.limit_pressure_angle, one.limit_pressure_angle, 1e-15);
  EXPECT_NEAR(scaled.shaft_angle, one.shaft_angle, 1e-15);
}

TEST(ShaftPlacement, MatchesIso23509Samples) {
  const nlohmann::json cases =
      load_reference("published_checks.json").at("hypoid_geometry").at("cases");
  ASSERT_EQ(cases.size(), 3u);
  for (const nlohmann::json& sample : cases) {
    const double cone_p = sample.at("Rm1"), cone_g = sample.at("Rm2");  // mm
    const double pitch_p = sample.contains("dm1")
                               ? std::asin(sample.at("dm1").get<double>() / (2 * cone_p))
                               : sample.at("delta1_deg").get<double>() * kDegree;
    const double pitch_g = sample.contains("dm2")
                               ? std::asin(sample.at("dm2").get<double>() / (2 * cone_g))
                               : sample.at("delta2_deg").get<double>() * kDegree;
    const ShaftPlacement placement = shaft_placement(cone_p * 1e-3, cone_g * 1e-3, pitch_p, pitch_g,
                                                     sample.at("zeta_mp").get<double>() * kDegree);
    const nlohmann::json& tolerance = sample.at("tolerance");
    EXPECT_NEAR(placement.shaft_angle / kDegree, sample.at("shaft_angle_deg").get<double>(),
                tolerance.at("shaft_angle_deg").get<double>());
    EXPECT_NEAR(placement.offset * 1e3, sample.at("offset_mm").get<double>(),
                tolerance.at("offset_mm").get<double>());
  }
}

TEST(ShaftPlacement, IsABevelPairWithoutOffsetAngle) {
  const ShaftPlacement placement = shaft_placement(0.08, 0.08, 0.4, 0.9, 0);
  EXPECT_NEAR(placement.shaft_angle, 1.3, 1e-15);
  EXPECT_EQ(placement.offset, 0);
}

TEST(ShaftPlacement, ReturnsToTheBlank) {
  const HypoidBlank blank = reference_blank();
  const HypoidGeometry g = hypoid_geometry(blank);
  const ShaftPlacement placement =
      shaft_placement(g.pinion.mean_cone_distance, g.gear.mean_cone_distance,
                      blank.pinion.pitch_angle, blank.gear.pitch_angle, g.offset_angle);
  EXPECT_NEAR(placement.offset, blank.offset, 1e-16);
  EXPECT_EQ(placement.shaft_angle, g.shaft_angle);
}

std::string sentence(const HypoidBlank& blank) {
  try {
    hypoid_geometry(blank);
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.reason(), "BLANK_IMPOSSIBLE");
    return refusal.what();
  }
  return "";
}

TEST(HypoidGeometry, RefusesAnImpossibleBlank) {
  const auto with = [](auto change) {
    HypoidBlank blank = reference_blank();
    change(blank);
    return sentence(blank);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(with([](HypoidBlank&) {}), "");
  EXPECT_NE(with([](HypoidBlank& b) { b.pinion.teeth = 0; }), "");
  EXPECT_NE(with([](HypoidBlank& b) { b.gear.pitch_angle = 0; }), "");
  EXPECT_NE(with([](HypoidBlank& b) { b.gear.face_angle = 2; }), "");
  EXPECT_NE(with([&](HypoidBlank& b) { b.pinion.spiral_angle = nan; }), "");
  EXPECT_NE(with([](HypoidBlank& b) { b.pinion.spiral_angle = b.gear.spiral_angle; }), "");
  EXPECT_NE(with([](HypoidBlank& b) { b.offset = 0; }), "");
  EXPECT_NE(with([&](HypoidBlank& b) { b.offset = nan; }), "");
  EXPECT_NE(with([&](HypoidBlank& b) { b.gear.face_apex = nan; }), "");
  EXPECT_NE(with([](HypoidBlank& b) { b.pinion.face_apex = -0.1; }), "");
}

TEST(HypoidGeometry, NamesEveryFault) {
  HypoidBlank blank = reference_blank();
  blank.pinion.teeth = -3;
  blank.gear.spiral_angle = 95 * kDegree;
  blank.offset = -0.01;
  const std::string text = sentence(blank);
  EXPECT_NE(text.find("pinion.teeth is -3"), std::string::npos) << text;
  EXPECT_NE(text.find("gear.spiral_angle is 95 degrees"), std::string::npos) << text;
  EXPECT_NE(text.find("offset is -0.01 m"), std::string::npos) << text;
}

}  // namespace
}  // namespace tribodyn
