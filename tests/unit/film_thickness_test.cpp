#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "tests/support/central_film.h"
#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

constexpr FilmConditions kTypical{0.019, 0.055, 0.04, 1.42e-8, 5.1, 2.26e11};
constexpr double kLoad = 2000;

FilmConditions with(double FilmConditions::*member, double factor) {
  FilmConditions conditions = kTypical;
  conditions.*member *= factor;
  return conditions;
}

// ln h(factor)/h(1) over ln(factor)
double exponent(double FilmConditions::*member) {
  constexpr double kFactor = 3;
  return std::log(central_film(with(member, kFactor), kLoad) / central_film(kTypical, kLoad)) /
         std::log(kFactor);
}

double entrainment_radius(double radius_x, double radius_y, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return 1 / laws::curvature_along_entrainment(c * c, s * s, 1 / radius_x, 1 / radius_y);
}

double side_leakage_radius(double radius_x, double radius_y, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return 1 / laws::curvature_across_entrainment(c * c, s * s, 1 / radius_x, 1 / radius_y);
}

TEST(CentralFilm, MatchesWorkedContacts) {
  int compared = 0;
  const nlohmann::json contacts = load_reference("worked_points.json").at("contacts");
  for (const nlohmann::json& contact : contacts) {
    const nlohmann::json& out = contact.at("expected");
    if (out.at("status") != "ok" || out.at("theta").is_null()) continue;
    SCOPED_TRACE(contact.at("name").get<std::string>());
    const double rx = contact.at("input").at("Rx");
    const double ry = contact.at("input").at("Ry");
    const double theta = out.at("theta");
    const FilmConditions conditions{entrainment_radius(rx, ry, theta),
                                    side_leakage_radius(rx, ry, theta),
                                    out.at("eta_in"),
                                    out.at("alpha_in"),
                                    out.at("U_eff"),
                                    out.at("E_prime")};
    EXPECT_NEAR(conditions.entrainment_radius / out.at("R_e").get<double>(), 1, 1e-14);
    EXPECT_NEAR(conditions.side_leakage_radius / out.at("R_s").get<double>(), 1, 1e-14);
    const double expected = out.at("h_cen");
    EXPECT_NEAR(central_film(conditions, out.at("W_EHL")), expected, 1e-13 * expected);
    ++compared;
  }
  EXPECT_GE(compared, 10);
}

TEST(CentralFilm, HasTheExponentsOfEq12) {
  EXPECT_NEAR(exponent(&FilmConditions::entrainment_speed), 0.68, 1e-14);
  EXPECT_NEAR(exponent(&FilmConditions::viscosity), 0.68, 1e-14);
  EXPECT_NEAR(exponent(&FilmConditions::pressure_viscosity_coefficient), 0.49, 1e-14);
  EXPECT_NEAR(exponent(&FilmConditions::reduced_modulus), 0.49 + 0.073 - 0.68, 1e-13);
  const double by_load = central_film(kTypical, 3 * kLoad) / central_film(kTypical, kLoad);
  EXPECT_NEAR(std::log(by_load) / std::log(3), -0.073, 1e-14);
}

TEST(CentralFilm, IsIndependentOfTheSystemOfUnits) {
  // Lengths in units of 1/length_unit m, and so on: h must scale as a length.
  const double length = 7.3, mass = 0.19, time = 41;
  const double pressure = mass / (length * time * time);
  const double force = mass * length / (time * time);
  const FilmConditions scaled{kTypical.entrainment_radius * length,
                              kTypical.side_leakage_radius * length,
                              kTypical.viscosity * pressure * time,
                              kTypical.pressure_viscosity_coefficient / pressure,
                              kTypical.entrainment_speed * length / time,
                              kTypical.reduced_modulus * pressure};
  const double film = central_film(kTypical, kLoad);
  EXPECT_NEAR(central_film(scaled, kLoad * force) / (film * length), 1, 1e-14);
}

TEST(CentralFilm, HasItsSideLeakageLimits) {
  // R_s/R_e -> infinity: a line contact without side leakage.
  const double line = central_film(with(&FilmConditions::side_leakage_radius, 1e9), kLoad);
  const double typical = central_film(kTypical, kLoad);
  const double ratio = kTypical.side_leakage_radius / kTypical.entrainment_radius;
  EXPECT_NEAR(typical / line, 1 - std::exp(-1.23 * std::pow(ratio, 2.0 / 3)), 1e-14);
  // R_s/R_e -> 0: the film falls with the power 2/3 of it.
  const double thin = central_film(with(&FilmConditions::side_leakage_radius, 1e-12), kLoad);
  EXPECT_NEAR(thin / line, 1.23 * std::pow(ratio * 1e-12, 2.0 / 3), 1e-7 * thin / line);
}

TEST(CentralFilm, IsZeroWithoutEntrainment) {
  EXPECT_EQ(central_film(with(&FilmConditions::entrainment_speed, 0), kLoad), 0);
}

TEST(CentralFilm, ScalesFromUnitLoadToAnyLoad) {
  const double unit_load_film = central_film(kTypical, 1.0);
  for (const double load : {1e-12, 1e-3, 1.0, 30.0, 2000.0, 1e6}) {
    const double film = central_film(kTypical, load);
    EXPECT_NEAR(unit_load_film * laws::film_thinning(std::log(load)) / film, 1, 1e-14);
  }
}

double inlet_heating(double loading, double slide_roll_ratio, double pressure_over_modulus) {
  const double speed2 = 9;  // [m2/s2]
  return laws::inlet_heating_factor(std::log(loading / speed2), std::log(speed2),
                                    std::log(speed2 * slide_roll_ratio * slide_roll_ratio),
                                    pressure_over_modulus, 1.0);
}

TEST(InletHeating, IsTheRegressionOfGuptaInTheSlideRollRatio) {
  for (const double loading : {0.01, 1.0, 20.0}) {
    for (const double slide : {0.0, 0.1, 2.0}) {
      const double expected =
          (1 - 13.2 * 0.004 * std::pow(loading, 0.42)) /
          (1 + 0.213 * (1 + 2.23 * std::pow(slide, 0.83)) * std::pow(loading, 0.64));
      EXPECT_NEAR(inlet_heating(loading, slide, 0.004) / expected, 1, 1e-14);
    }
  }
}

TEST(InletHeating, ThinsTheFilmAndNeverTakesItAll) {
  EXPECT_NEAR(inlet_heating(1e-30, 1, 0.006), 1, 1e-12);
  double before = 1;
  for (double loading = 1e-3; loading < 1e6; loading *= 2) {
    const double factor = inlet_heating(loading, 0.5, 0.006);
    EXPECT_GT(factor, 0);
    EXPECT_LT(factor, before);
    before = factor;
  }
}

TEST(EffectiveRadiusAlongAnAngle, SatisfiesItsIdentities) {
  const double rx = 0.02, ry = 1.1;
  for (double theta = -4; theta < 4; theta += 0.01) {
    const double along = entrainment_radius(rx, ry, theta);
    const double across = side_leakage_radius(rx, ry, theta);
    EXPECT_NEAR((1 / along + 1 / across) / (1 / rx + 1 / ry), 1, 1e-14);
    EXPECT_GE(along, rx * (1 - 1e-15));
    EXPECT_LE(along, ry * (1 + 1e-15));
    EXPECT_NEAR(entrainment_radius(rx, ry, theta + std::numbers::pi) / along, 1, 1e-12);
    EXPECT_NEAR(entrainment_radius(ry, rx, theta), across, 1e-15 * across);
  }
  EXPECT_NEAR(entrainment_radius(rx, ry, 0) / rx, 1, 1e-15);
  EXPECT_NEAR(entrainment_radius(rx, ry, std::numbers::pi / 2) / ry, 1, 1e-14);
}

}  // namespace
}  // namespace tribodyn
