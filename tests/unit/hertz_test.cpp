#include "core/contact/hertz.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/refusal.h"
#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

constexpr double kFlat = std::numeric_limits<double>::infinity();
constexpr double kModulus = 2.3e11;

EllipseAxes exact_axes(EffectiveRadii radii, double modulus, double load) {
  const HertzFit fit = exact_ellipticity(radii.x, radii.y);
  return ellipse_axes(unit_load_ellipse(fit, radii.x, radii.y, modulus, {}), load);
}

// The pair of bodies of a case in published_checks.json, in any of its notations.
EffectiveRadii radii_of(const nlohmann::json& in) {
  if (in.contains("groove_radius_m")) {
    return effective_radii(in.at("ball_radius_m"), in.at("ball_radius_m"), in.at("race_radius_m"),
                           in.at("groove_radius_m"));
  }
  if (in.contains("radii_1_m")) {
    return effective_radii(in.at("radii_1_m")[0], in.at("radii_1_m")[1], in.at("radii_2_m")[0],
                           in.at("radii_2_m")[1]);
  }
  if (in.contains("radii_m")) {
    return effective_radii(in.at("radii_m")[0], in.at("radii_m")[1], kFlat, kFlat);
  }
  if (in.contains("radius_1_m")) {
    return effective_radii(in.at("radius_1_m"), in.at("radius_1_m"), in.at("radius_2_m"),
                           in.at("radius_2_m"));
  }
  return effective_radii(in.at("radius_m"), in.at("radius_m"), kFlat, kFlat);
}

double quantity(const std::string& name, const EllipseAxes& axes) {
  if (name == "p_max_pa") return axes.maximum_pressure;
  if (name == "p_mean_pa") return 2.0 / 3 * axes.maximum_pressure;
  if (name == "semi_major_m" || name == "radius_of_contact_m") return axes.semi_major;
  if (name == "semi_minor_m") return axes.semi_minor;
  throw std::runtime_error("published_checks.json holds an unknown quantity " + name);
}

void compare(const nlohmann::json& expected, double tolerance,
             const std::vector<EllipseAxes>& axes) {
  for (const auto& [name, values] : expected.items()) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double value = values.is_array() ? values[i].get<double>() : values.get<double>();
      EXPECT_NEAR(quantity(name, axes[i]) / value, 1, tolerance) << name;
    }
  }
}

TEST(ExactHertz, MatchesPublishedContacts) {
  const nlohmann::json cases = load_reference("published_checks.json").at("hertz");
  ASSERT_GE(cases.size(), 7u);
  for (const nlohmann::json& contact : cases) {
    SCOPED_TRACE(contact.at("name").get<std::string>());
    const nlohmann::json& in = contact.at("inputs");
    const std::vector<double> loads = in.contains("loads_n")
                                          ? in.at("loads_n").get<std::vector<double>>()
                                          : std::vector<double>{in.at("load_n")};
    std::vector<EllipseAxes> axes;
    for (const double load : loads) {
      axes.push_back(exact_axes(radii_of(in), reduced_modulus(in.at("E_pa"), in.at("nu")), load));
    }
    compare(contact.at("expected"), contact.at("relative_tolerance"), axes);
    if (contact.contains("printed")) {
      compare(contact.at("printed"), contact.at("printed_tolerance"), axes);
    }
  }
}

TEST(Hertz, MatchesWorkedContacts) {
  int exact = 0;
  const nlohmann::json contacts = load_reference("worked_points.json").at("contacts");
  for (const nlohmann::json& contact : contacts) {
    const nlohmann::json& in = contact.at("input");
    const nlohmann::json& out = contact.at("expected");
    if (out.at("status") != "ok" || in.at("hertz_load") != "EHL") continue;
    SCOPED_TRACE(contact.at("name").get<std::string>());
    const double rx = in.at("Rx"), ry = in.at("Ry");
    const bool is_exact = in.at("hertz") == "exact";
    const HertzFit fit = is_exact ? exact_ellipticity(rx, ry) : simplified_ellipticity(rx, ry, {});
    const double modulus = reduced_modulus(in.at("steel").at("E"), in.at("steel").at("nu"));
    const EllipseAxes axes =
        ellipse_axes(unit_load_ellipse(fit, rx, ry, modulus, {}), out.at("W_EHL").get<double>());
    EXPECT_NEAR(axes.semi_major / out.at("a_c").get<double>(), 1, 1e-14);
    EXPECT_NEAR(axes.semi_minor / out.at("b_c").get<double>(), 1, 1e-14);
    EXPECT_NEAR(axes.maximum_pressure / out.at("p_max").get<double>(), 1, 1e-14);
    exact += is_exact;
  }
  EXPECT_GE(exact, 1);
}

TEST(ExactEllipticity, IsExactForACircle) {
  for (const double radius : {1e-6, 0.0127, 1.0, 1e4}) {
    const HertzFit fit = exact_ellipticity(radius, radius);
    EXPECT_EQ(fit.ellipticity, 1);
    EXPECT_EQ(fit.second_integral, std::numbers::pi / 2);
  }
  // a^3 = 3 W R/(4 E*) with R = R_x = R_y and E* = E'/2
  const EllipseAxes axes = exact_axes({0.01, 0.01}, kModulus, 100);
  EXPECT_NEAR(axes.semi_major, std::cbrt(3 * 100 * 0.01 / (2 * kModulus)), 1e-18);
  EXPECT_NEAR(axes.semi_minor, axes.semi_major, 1e-18);
}

// K and E of the parameter m = 1 - q by arithmetic-geometric means, in extended precision.
std::pair<long double, long double> complete_elliptic_integrals(long double q) {
  long double a = 1, b = std::sqrt(q);
  long double sum = (1 - q) / 2;
  for (long double power = 1; std::abs(a - b) > 1e-18L * a; power *= 2) {
    const long double half_difference = (a - b) / 2;
    sum += power * half_difference * half_difference;
    const long double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  const long double first = std::numbers::pi_v<long double> / (2 * a);
  return {first, first * (1 - sum)};
}

TEST(ExactEllipticity, SatisfiesHertzRelation) {
  for (double ratio = 1.01; ratio < 1.1e6; ratio *= 1.37) {
    const HertzFit fit = exact_ellipticity(0.01, 0.01 * ratio);
    const long double k = fit.ellipticity;
    const auto [first, second] = complete_elliptic_integrals(1 / (k * k));
    EXPECT_NEAR(static_cast<double>(fit.second_integral / second), 1, 3e-15) << ratio;
    // r is steeper in k than linear: its relative error is up to twice that of k
    const long double back = (k * k * second - first) / (first - second);
    EXPECT_NEAR(static_cast<double>(back / static_cast<long double>(ratio)), 1, 6e-15) << ratio;
  }
}

TEST(ExactEllipticity, HasTheNearlyCircularLimit) {
  // k = r^(2/3) (1 + O((r - 1)^2))
  for (double excess = 1e-15; excess < 1e-3; excess *= 3) {
    const double ratio = 1 + excess;
    const HertzFit fit = exact_ellipticity(1, ratio);
    EXPECT_NEAR(fit.ellipticity - 1, std::expm1(2.0 / 3 * std::log(ratio)),
                excess * excess + 1e-15);
    EXPECT_GE(fit.ellipticity, 1);
  }
}

TEST(ExactEllipticity, HasTheLineContactLimit) {
  // q = 1/k^2 -> 0: K -> ln 4k, E -> 1, so r -> k^2/(ln(4k) - 1)
  for (double ratio = 1e4; ratio <= 1e6; ratio *= 10) {
    const HertzFit fit = exact_ellipticity(1e-3, 1e-3 * ratio);
    const double k = fit.ellipticity;
    EXPECT_NEAR(k * k / (std::log(4 * k) - 1) / ratio, 1, 10 * std::log(k) / (k * k));
    EXPECT_NEAR(fit.second_integral, 1, std::log(4 * k) / (k * k));
  }
}

TEST(ExactEllipticity, RisesSteadilyAsTheRatioGrows) {
  double last_k = 1;
  double last_e = std::numbers::pi / 2;
  for (double ratio = 1.0001; ratio < 1e12; ratio *= 1.01) {
    const HertzFit fit = exact_ellipticity(1, ratio);
    EXPECT_GT(fit.ellipticity, last_k) << ratio;
    EXPECT_LT(fit.ellipticity / last_k, 1.0101) << ratio;
    EXPECT_LE(fit.second_integral, last_e) << ratio;
    EXPECT_GE(fit.second_integral, 1) << ratio;
    last_k = fit.ellipticity;
    last_e = fit.second_integral;
  }
}

TEST(Ellipticity, IsIndependentOfWhichRadiusIsNamedX) {
  for (const double ratio : {1.0, 1.3, 20.0, 1e6}) {
    const HertzFit exact = exact_ellipticity(0.01, 0.01 * ratio);
    const HertzFit swapped = exact_ellipticity(0.01 * ratio, 0.01);
    EXPECT_EQ(exact.ellipticity, swapped.ellipticity);
    EXPECT_EQ(exact.second_integral, swapped.second_integral);
    const HertzFit simplified = simplified_ellipticity(0.01, 0.01 * ratio, {});
    EXPECT_EQ(simplified.ellipticity, simplified_ellipticity(0.01 * ratio, 0.01, {}).ellipticity);
  }
}

TEST(ExactEllipticity, IsNotANumberForImpossibleRadii) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [rx, ry] : std::vector<std::pair<double, double>>{{0, 1},
                                                                     {1, 0},
                                                                     {0, 0},
                                                                     {-1, 1},
                                                                     {1, -1},
                                                                     {-1, -1},
                                                                     {nan, 1},
                                                                     {1, nan},
                                                                     {kFlat, 1},
                                                                     {kFlat, kFlat}}) {
    EXPECT_TRUE(std::isnan(exact_ellipticity(rx, ry).ellipticity)) << rx << " " << ry;
    EXPECT_TRUE(std::isnan(exact_ellipticity(rx, ry).second_integral)) << rx << " " << ry;
  }
}

TEST(SimplifiedEllipticity, StaysNearTheExactSolution) {
  double worst_k = 0, worst_e = 0, worst_p = 0;
  for (double ratio = 1; ratio <= 100; ratio *= 1.01) {
    const HertzFit exact = exact_ellipticity(1, ratio);
    const HertzFit simplified = simplified_ellipticity(1, ratio, {});
    const double p_exact = unit_load_ellipse(exact, 1, ratio, kModulus, {}).maximum_pressure;
    const double p = unit_load_ellipse(simplified, 1, ratio, kModulus, {}).maximum_pressure;
    worst_k = std::max(worst_k, std::abs(simplified.ellipticity / exact.ellipticity - 1));
    worst_e = std::max(worst_e, std::abs(simplified.second_integral / exact.second_integral - 1));
    worst_p = std::max(worst_p, std::abs(p / p_exact - 1));
  }
  EXPECT_LT(worst_k, 0.064);
  EXPECT_LT(worst_e, 0.017);
  EXPECT_LT(worst_p, 0.0221);
}

TEST(SimplifiedEllipticity, ShowsTheMisprintsItIsKeptToShow) {
  AsPublished printed;
  printed.eq20_semi_major = true;
  printed.eq22_inverted_ratio = true;
  const auto pressure = [](double ratio, const AsPublished& form) {
    const HertzFit fit = simplified_ellipticity(1, ratio, form);
    return unit_load_ellipse(fit, 1, ratio, kModulus, form).maximum_pressure;
  };
  EXPECT_DOUBLE_EQ(simplified_ellipticity(1.0, 20.0, printed).second_integral,
                   1.0003 + 0.5968 * 20);
  // Eq 20 alone: a_c too long by eps^(1/3).
  AsPublished eq20;
  eq20.eq20_semi_major = true;
  const HertzFit fit = simplified_ellipticity(1.0, 5.0, {});
  EXPECT_NEAR(unit_load_ellipse(fit, 1, 5, kModulus, eq20).semi_major /
                  unit_load_ellipse(fit, 1, 5, kModulus, {}).semi_major,
              std::cbrt(fit.second_integral), 1e-15);
  AsPublished eq22;
  eq22.eq22_inverted_ratio = true;
  EXPECT_NEAR(pressure(2, eq22) / pressure(2, {}), 0.70, 0.01);
  EXPECT_NEAR(pressure(33, eq22) / pressure(33, {}), 0.13, 0.01);
  EXPECT_NEAR(pressure(2, printed) / pressure(2, {}), 0.54, 0.01);
  EXPECT_NEAR(pressure(33, printed) / pressure(33, {}), 0.05, 0.01);
}

TEST(Ellipse, CarriesItsLoad) {
  // The volume under the semi-ellipsoid of pressure is the load.
  for (const double load : {1e-6, 3.0, 2000.0, 1e6}) {
    for (const double ratio : {1.0, 20.0, 1e4}) {
      const EllipseAxes axes = exact_axes({0.01, 0.01 * ratio}, kModulus, load);
      EXPECT_NEAR(2.0 / 3 * std::numbers::pi * axes.semi_major * axes.semi_minor *
                      axes.maximum_pressure / load,
                  1, 1e-14);
      EXPECT_NEAR(
          axes.semi_major / axes.semi_minor / exact_ellipticity(0.01, 0.01 * ratio).ellipticity, 1,
          1e-14);
    }
  }
}

TEST(Ellipse, ScalesWithSizeLoadAndModulus) {
  // Twice the size and four times the load: the same pressure, twice the axes.
  const EllipseAxes one = exact_axes({0.01, 0.3}, kModulus, 100);
  const EllipseAxes two = exact_axes({0.02, 0.6}, kModulus, 400);
  EXPECT_NEAR(two.maximum_pressure / one.maximum_pressure, 1, 1e-14);
  EXPECT_NEAR(two.semi_major / one.semi_major, 2, 1e-14);
  // Pressure goes with E'^(2/3), axes with E'^(-1/3).
  const EllipseAxes stiff = exact_axes({0.01, 0.3}, 8 * kModulus, 100);
  EXPECT_NEAR(stiff.maximum_pressure / one.maximum_pressure, 4, 1e-14);
  EXPECT_NEAR(stiff.semi_minor / one.semi_minor, 0.5, 1e-14);
}

TEST(Ellipse, IsZeroWithoutLoad) {
  const EllipseAxes axes = exact_axes({0.01, 0.3}, kModulus, 0);
  EXPECT_EQ(axes.semi_major, 0);
  EXPECT_EQ(axes.semi_minor, 0);
  EXPECT_EQ(axes.maximum_pressure, 0);
}

TEST(EffectiveRadii, AddCurvatures) {
  const EffectiveRadii radii = effective_radii(0.01, 0.01, -0.02, kFlat);
  EXPECT_DOUBLE_EQ(radii.x, 0.02);
  EXPECT_DOUBLE_EQ(radii.y, 0.01);
  const EffectiveRadii swapped = effective_radii(-0.02, kFlat, 0.01, 0.01);
  EXPECT_EQ(radii.x, swapped.x);
  EXPECT_EQ(radii.y, swapped.y);
}

std::string reason(double r1x, double r1y, double r2x, double r2y) {
  try {
    effective_radii(r1x, r1y, r2x, r2y);
  } catch (const Refusal& refusal) {
    return refusal.reason();
  }
  return "none";
}

TEST(EffectiveRadii, RefuseBodiesWithoutAPointContact) {
  EXPECT_EQ(reason(0.01, 0.01, -0.01, 0.01), "CONTACT_NOT_A_POINT");
  EXPECT_EQ(reason(0.01, 0.01, 0.01, -0.009), "CONTACT_NOT_A_POINT");
  EXPECT_EQ(reason(0.01, kFlat, 0.01, kFlat), "CONTACT_NOT_A_POINT");
  EXPECT_EQ(reason(0.0, 0.01, 0.01, 0.01), "RADIUS_NOT_A_RADIUS");
  EXPECT_EQ(reason(0.01, 0.01, 0.01, std::nan("")), "RADIUS_NOT_A_RADIUS");
  EXPECT_EQ(reason(0.01, 0.01, kFlat, kFlat), "none");
}

}  // namespace
}  // namespace tribodyn
