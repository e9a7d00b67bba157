// Bands of the figures of a rig: closed forms of what stated uncertainties of the inputs make.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/refusal.h"
#include "server/simulation/rig_evaluation.h"
#include "tests/service/uncertain_fluids.h"

namespace tribodyn::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Fluid and surface of the test's requests.
struct RigInputs {
  v1::Lubricant fluid = exact_seed<v1::Lubricant>("lubricants/paper-fluid-1");
  v1::Surface surface = exact_seed<v1::Surface>("surfaces/run-in");
};

void state_uncertainty(v1::Surface& surface, const std::string& field, double uncertainty) {
  for (v1::ParameterProvenance& entry : *surface.mutable_provenance()) {
    if (entry.field() == field) return entry.set_standard_uncertainty(uncertainty);
  }
  ADD_FAILURE() << field;
}

v1::EvaluateRigRequest banded_request(int draws) {
  v1::EvaluateRigRequest out;
  out.set_lubricant("lubricants/a");
  out.set_radius_x_metres(0.0127);
  out.set_draws(draws);
  out.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  return out;
}

void add_row(v1::EvaluateRigRequest& request, double load, double speed, double percent,
             double celsius = 40) {
  v1::RigCondition& row = *request.add_conditions();
  row.set_load_newtons(load);
  row.set_entrainment_speed_metres_per_second(speed);
  row.set_slide_roll_ratio_percent(percent);
  row.set_supply_temperature_celsius(celsius);
}

v1::EvaluateRigResponse run_banded(
    const v1::EvaluateRigRequest& request, const RigInputs& inputs,
    const std::function<bool()>& is_over = [] { return false; }) {
  Fluids fluids;
  fluids.add("lubricants/a", inputs.fluid);
  fluids.add("surfaces/a", inputs.surface);
  Violations violations;
  const auto evaluation = read_rig(request, fluids.lookup(), violations);
  if (!evaluation) throw std::runtime_error(violations.front().description);
  return evaluate_rig(request, *evaluation, is_over);
}

const v1::UncertainRigFigure& band_of(const v1::EvaluateRigResponse& answer,
                                      const std::string& figure) {
  for (const v1::UncertainRigFigure& each : answer.uncertainties()) {
    if (each.figure() == figure) return each;
  }
  throw std::runtime_error("no uncertainty of " + figure);
}

std::vector<std::string> moved_figures(const v1::EvaluateRigResponse& answer) {
  std::vector<std::string> out;
  for (const v1::UncertainRigFigure& each : answer.uncertainties()) out.push_back(each.figure());
  return out;
}

/// The standard deviation of the logarithm of an input with a relative uncertainty.
double logarithmic(double relative_uncertainty) {
  return std::sqrt(std::log1p(relative_uncertainty * relative_uncertainty));
}

constexpr double kNormal = 1.959964;  // 97.5 % of the standard normal distribution lie below

TEST(RigUncertainty, OfALimitedFilmIsThatOfItsLimit) {
  RigInputs inputs;
  const double slope = inputs.fluid.limiting_shear_stress_coefficient();
  inputs.fluid.set_vogel_viscosity_prefactor_pascal_seconds(
      1e4 * inputs.fluid.vogel_viscosity_prefactor_pascal_seconds());  // even the edge is limited
  set_uncertainty(inputs.fluid, "limiting_shear_stress_coefficient", 0.05 * slope);
  v1::EvaluateRigRequest request = banded_request(999);
  request.mutable_model_options()->set_isothermal(true);
  for (const double load : {38.0, 154.0}) add_row(request, load, 2, 200);
  const v1::EvaluateRigResponse out = run_banded(request, inputs);
  EXPECT_THAT(moved_figures(out), ElementsAre("traction_coefficient"));
  const v1::UncertainRigFigure& band = band_of(out, "traction_coefficient");
  const double deviation = logarithmic(0.05);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(out.limiting_stress_area_share(i), 1);
    const double rest = inputs.fluid.limiting_shear_stress_at_zero_pressure_pascals() /
                        out.mean_pressure_pascals(i);
    EXPECT_NEAR(out.traction_coefficient(i), slope + rest, 1e-12);
    const double expected = slope * std::sqrt(1 + 0.05 * 0.05) * 0.05;  // of a log-normal variable
    EXPECT_NEAR(band.standard_uncertainty(i) / expected, 1, 2e-3);
    EXPECT_NEAR(band.interval_minimum(i), slope * std::exp(-kNormal * deviation) + rest,
                2e-3 * expected);
    EXPECT_NEAR(band.interval_maximum(i), slope * std::exp(kNormal * deviation) + rest,
                2e-3 * expected);
  }
  EXPECT_THAT(out.refused_draws(), ElementsAre(0, 0));
}

TEST(RigUncertainty, OfAFilmIsThatOfTheViscosityToThePower068) {
  RigInputs inputs;
  const double prefactor = inputs.fluid.vogel_viscosity_prefactor_pascal_seconds();
  set_uncertainty(inputs.fluid, "vogel_viscosity_prefactor_pascal_seconds", 0.1 * prefactor);
  // At the temperature of alpha* the viscosity does not move alpha*.
  const double celsius = inputs.fluid.pressure_viscosity_temperature_kelvin() - 273.15;
  v1::EvaluateRigRequest request = banded_request(999);
  for (const double speed : {0.03, 0.3, 3.0}) add_row(request, 20, speed, 0, celsius);
  const v1::EvaluateRigResponse out = run_banded(request, inputs);
  for (const char* figure : {"central_film_thickness_metres", "minimum_film_thickness_metres"}) {
    SCOPED_TRACE(figure);
    const auto* column = out.GetDescriptor()->FindFieldByName(figure);
    const v1::UncertainRigFigure& band = band_of(out, figure);
    const double deviation = 0.68 * logarithmic(0.1);
    for (int i = 0; i < 3; ++i) {
      const double film = out.GetReflection()->GetRepeatedDouble(out, column, i);
      EXPECT_NEAR(band.standard_uncertainty(i) / film / deviation, 1, 5e-3);
      EXPECT_NEAR(std::log(band.interval_minimum(i) / film) / deviation, -kNormal, 3e-3);
      EXPECT_NEAR(std::log(band.interval_maximum(i) / film) / deviation, kNormal, 3e-3);
    }
  }
}

TEST(RigUncertainty, HasTheSameDrawsInAllRowsAndCalls) {
  RigInputs inputs;
  set_uncertainty(inputs.fluid, "vogel_viscosity_prefactor_pascal_seconds",
                  0.1 * inputs.fluid.vogel_viscosity_prefactor_pascal_seconds());
  set_uncertainty(inputs.fluid, "relaxation_time_seconds",
                  0.3 * inputs.fluid.relaxation_time_seconds());
  v1::EvaluateRigRequest request = banded_request(19);  // so few that other draws would show
  for (const double celsius : {80.0, 40.0, 80.0}) {
    for (const double speed : {0.03, 0.1, 3.0}) add_row(request, 20, speed, 10, celsius);
  }
  const v1::EvaluateRigResponse out = run_banded(request, inputs);
  const v1::UncertainRigFigure& film = band_of(out, "central_film_thickness_metres");
  const v1::UncertainRigFigure& traction = band_of(out, "traction_coefficient");
  // Films at one temperature are proportional to each other, draw by draw.
  const double ratio = film.interval_maximum(0) / out.central_film_thickness_metres(0);
  EXPECT_GT(ratio, 1.05);
  for (int i = 1; i < 3; ++i) {
    EXPECT_NEAR(film.interval_maximum(i) / out.central_film_thickness_metres(i) / ratio, 1, 1e-12);
  }
  for (int i = 0; i < 9; ++i) {
    SCOPED_TRACE(i);
    v1::EvaluateRigRequest alone = banded_request(19);
    *alone.add_conditions() = request.conditions(i);
    const v1::EvaluateRigResponse one = run_banded(alone, inputs);
    EXPECT_EQ(band_of(one, "traction_coefficient").standard_uncertainty(0),
              traction.standard_uncertainty(i));
    EXPECT_EQ(band_of(one, "traction_coefficient").interval_maximum(0),
              traction.interval_maximum(i));
  }
}

TEST(RigUncertainty, CountsTheSpecimensToo) {
  RigInputs inputs;
  const double zeta = inputs.surface.asperity_friction_coefficient();
  state_uncertainty(inputs.surface, "asperity_friction_coefficient", 0.05 * zeta);
  v1::EvaluateRigRequest request = banded_request(199);
  request.set_surface("surfaces/a");
  request.mutable_model_options()->set_isothermal(true);
  add_row(request, 38, 0.1, 10);
  const v1::EvaluateRigResponse out = run_banded(request, inputs);
  EXPECT_THAT(moved_figures(out), ElementsAre("traction_coefficient", "boundary_friction_share"));
  EXPECT_THAT(out.inputs_without_uncertainty(),
              testing::IsSupersetOf({std::string("lubricant.relaxation_time_seconds"),
                                     std::string("surface.composite_rms_height_metres")}));
  RigInputs moved = inputs;
  moved.surface.set_asperity_friction_coefficient(1.05 * zeta);
  const double change =
      run_banded(request, moved).traction_coefficient(0) - out.traction_coefficient(0);
  EXPECT_NEAR(band_of(out, "traction_coefficient").standard_uncertainty(0) / change, 1, 0.01);
}

TEST(RigUncertainty, AHeightOfTheRequestIsExact) {
  RigInputs inputs;
  state_uncertainty(inputs.surface, "composite_rms_height_metres", 1e-7);
  v1::EvaluateRigRequest request = banded_request(19);
  request.set_surface("surfaces/a");
  add_row(request, 38, 0.1, 10);
  EXPECT_THAT(moved_figures(run_banded(request, inputs)), testing::Contains("film_ratio"));
  request.set_composite_rms_height_metres(2e-8);
  const v1::EvaluateRigResponse out = run_banded(request, inputs);
  EXPECT_THAT(moved_figures(out), ElementsAre());
  EXPECT_THAT(out.inputs_without_uncertainty(), testing::Contains("composite_rms_height_metres"));
  EXPECT_THAT(out.inputs_without_uncertainty(),
              testing::Not(testing::Contains("surface.composite_rms_height_metres")));
}

TEST(RigUncertainty, LeavesTheFiguresAsTheyAreAndIsAbsentUnlessRequested) {
  RigInputs inputs;
  set_uncertainty(inputs.fluid, "relaxation_time_seconds",
                  0.3 * inputs.fluid.relaxation_time_seconds());
  v1::EvaluateRigRequest request = banded_request(0);
  for (const double percent : {0.0, 5.0, 50.0}) add_row(request, 38, 2, percent);
  const v1::EvaluateRigResponse plain = run_banded(request, inputs);
  EXPECT_EQ(plain.uncertainties_size(), 0);
  EXPECT_EQ(plain.refused_draws_size(), 0);
  EXPECT_EQ(plain.inputs_without_uncertainty_size(), 0);
  request.set_draws(19);
  v1::EvaluateRigResponse out = run_banded(request, inputs);
  EXPECT_EQ(band_of(out, "traction_coefficient").standard_uncertainty(0), 0);  // without sliding
  EXPECT_GT(band_of(out, "traction_coefficient").standard_uncertainty(1), 0);
  out.clear_uncertainties();
  out.clear_refused_draws();
  out.clear_inputs_without_uncertainty();
  EXPECT_EQ(out.SerializeAsString(), plain.SerializeAsString());

  const v1::EvaluateRigResponse exact = run_banded(request, RigInputs());
  EXPECT_EQ(exact.uncertainties_size(), 0);
  EXPECT_THAT(exact.refused_draws(), ElementsAre(0, 0, 0));
  EXPECT_THAT(exact.inputs_without_uncertainty(),
              testing::Contains("lubricant.relaxation_time_seconds"));
}

TEST(RigUncertainty, IsNoNumberWhereTheModelRefusesMoreThanATwentiethOfTheDraws) {
  RigInputs inputs;
  inputs.fluid.set_vogel_reference_temperature_kelvin(230);
  set_uncertainty(inputs.fluid, "vogel_reference_temperature_kelvin", 5);
  v1::EvaluateRigRequest request = banded_request(199);
  for (const double celsius : {2.0, 60.0, -50.0}) add_row(request, 38, 2, 10, celsius);
  const v1::EvaluateRigResponse out = run_banded(request, inputs);
  EXPECT_EQ(out.refusal_numbers(0), 0);
  EXPECT_GT(out.refused_draws(0), 199 / 20);
  EXPECT_EQ(out.refused_draws(1), 0);
  EXPECT_NE(out.refusal_numbers(2), 0) << "-50 C is below 230 K";
  EXPECT_EQ(out.refused_draws(2), 0);
  const v1::UncertainRigFigure& band = band_of(out, "traction_coefficient");
  EXPECT_TRUE(std::isnan(band.standard_uncertainty(0)));
  EXPECT_TRUE(std::isnan(band.interval_maximum(0)));
  EXPECT_GT(band.standard_uncertainty(1), 0);
  EXPECT_TRUE(std::isnan(band.interval_minimum(2)));
}

TEST(RigUncertainty, RefusesMoreContactsThanAMethodComputesAtOnce) {
  const auto wrong = [](const v1::EvaluateRigRequest& request) {
    Violations violations;
    read_rig(request, seed_lookup(), violations);
    std::string out;
    for (const Violation& each : violations) out += each.field + ": " + each.description + "\n";
    return out;
  };
  v1::EvaluateRigRequest request = banded_request(1999);
  request.set_lubricant("lubricants/paper-fluid-1");
  while (request.conditions_size() < 501) add_row(request, 38, 2, 10);
  EXPECT_EQ(wrong(request),
            "draws: 1999 draws of 501 rows are 1002000 contacts; allowed: at most 1000000, rows "
            "times (draws + 1): take at most 1995 draws, or send fewer rows at once\n");
  request.mutable_conditions()->RemoveLast();
  EXPECT_EQ(wrong(request), "");
  request.set_draws(200);
  while (request.conditions_size() < 5000) add_row(request, 38, 2, 10);
  EXPECT_THAT(wrong(request), HasSubstr("take at most 199 draws"));
  request.set_draws(199);
  EXPECT_EQ(wrong(request), "");
  request.set_draws(18);
  EXPECT_THAT(wrong(request), HasSubstr("draws = 18; allowed: 19 to 1999"));

  request.clear_conditions();
  request.set_draws(1999);
  v1::RigGrid& grid = *request.mutable_grid();
  grid.add_supply_temperatures_celsius(40);
  grid.add_entrainment_speeds_metres_per_second(2);
  for (int i = 0; i < 30; ++i) {
    grid.add_loads_newtons(1 + i);
    grid.add_slide_roll_ratios_percent(i);
  }
  EXPECT_THAT(wrong(request), HasSubstr("1999 draws of 900 rows are 1800000 contacts"));
}

TEST(RigUncertainty, StopsSoonAfterItsCallIsOver) {
  RigInputs inputs;
  set_uncertainty(inputs.fluid, "relaxation_time_seconds",
                  0.3 * inputs.fluid.relaxation_time_seconds());
  v1::EvaluateRigRequest request = banded_request(1999);
  for (const double celsius : {40.0, 60.0}) {
    for (int i = 0; i < 100; ++i) add_row(request, 38, 2, i, celsius);
  }
  for (const int allowed : {200, 250, 50'000}) {
    int calls = 0;
    EXPECT_THROW(run_banded(request, inputs, [&] { return ++calls > allowed; }), Cancelled);
    EXPECT_EQ(calls, allowed + 1);
  }
}

}  // namespace
}  // namespace tribodyn::server
