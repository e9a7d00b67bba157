// Figures with drawn inputs: what follows from the draws at other conditions.
#include "server/simulation/drawn_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/service/uncertain_fluids.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

/// Speeds of a curve [km/h].
std::vector<double> speeds_between(double first, double last, double step) {
  std::vector<double> out;
  for (double speed = first; speed <= last; speed += step) out.push_back(speed);
  return out;
}

v1::ComparePointsRequest curve_request(const std::vector<double>& speeds,
                                       const std::vector<std::string>& lubricants) {
  auto out = request_at(speeds, lubricants);
  out.set_draws(99);
  out.mutable_model_options()->set_closed_load_sharing(false);
  return out;
}

int least_solved_draws(const v1::ComparedLubricant& lubricant) {
  int out = lubricant.points(0).solved_draws();
  for (const auto& point : lubricant.points()) out = std::min(out, point.solved_draws());
  return out;
}

/// Expects both ends of the interval, and the standard uncertainty, within a tenth of the standard
/// uncertainty and the errors by the solver.
void expect_close(const v1::UncertainFigure& figure, const v1::UncertainFigure& expected) {
  EXPECT_EQ(figure.value(), expected.value());
  const double allowed = 0.1 * expected.standard_uncertainty() + 2 * expected.solver_error();
  EXPECT_NEAR(figure.interval_minimum(), expected.interval_minimum(), allowed);
  EXPECT_NEAR(figure.interval_maximum(), expected.interval_maximum(), allowed);
  EXPECT_NEAR(figure.standard_uncertainty(), expected.standard_uncertainty(), 0.6 * allowed);
  EXPECT_NEAR(figure.linear_standard_uncertainty(), expected.linear_standard_uncertainty(),
              0.6 * allowed);
}

/// Expects of a curve what each of its speeds has in a request of its own.
void expect_as_alone(const std::vector<double>& speeds, const Fluids& fluids,
                     const v1::ComparePointsResponse& curve,
                     const std::vector<std::string>& lubricants) {
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    SCOPED_TRACE(std::to_string(speeds[k]) + " km/h");
    const int at = static_cast<int>(k);
    const auto alone = compare(curve_request({speeds[k]}, lubricants), fluids);
    for (int i = 0; i < alone.lubricants_size(); ++i) {
      SCOPED_TRACE(lubricants[static_cast<std::size_t>(i)]);
      const v1::ComparedPoint& expected = alone.lubricants(i).points(0);
      const v1::ComparedPoint& point = curve.lubricants(i).points(at);
      EXPECT_EQ(expected.solved_draws(), 99);
      expect_close(point.inefficiency_energy_mean_percent(),
                   expected.inefficiency_energy_mean_percent());
      expect_close(point.pinion_torque_newton_metres(), expected.pinion_torque_newton_metres());
      expect_close(point.dynamic_transmission_error_maximum_metres(),
                   expected.dynamic_transmission_error_maximum_metres());
      EXPECT_EQ(point.shares(0).input(), expected.shares(0).input());
      EXPECT_NEAR(point.shares(0).variance_share(), expected.shares(0).variance_share(), 0.03);
      if (i > 0) {
        expect_close(curve.lubricants(i).differences(at).difference_percent(),
                     alone.lubricants(i).differences(0).difference_percent());
      }
    }
  }
}

TEST(DrawnFigures, OfACurveTakeAThirdOfThePointsAndHaveTheIntervalsThatEachSpeedHasAlone) {
  const std::vector<double> speeds = speeds_between(20, 140, kUnderSanitizer ? 15 : 5);
  std::mt19937_64 random(3);
  std::vector<v1::Lubricant> lubricants = {data_sheet(103, 15.1), data_sheet(30, 5.8),
                                           fluid_with_alpha()};
  while (lubricants.size() < 7) lubricants.push_back(measured_fluid(random).measured);
  for (const v1::Lubricant& lubricant : lubricants) {
    Fluids fluids;
    fluids.add("lubricants/oil", lubricant);
    const auto curve = compare(curve_request(speeds, {"lubricants/oil"}), fluids);
    int solved = 0;
    for (const auto& point : curve.lubricants(0).points()) solved += point.solved_draws();
    const int most = curve.lubricants(0).points_size() * 99 / (kUnderSanitizer ? 1 : 3);
    EXPECT_LT(solved, most);
    EXPECT_EQ(least_solved_draws(curve.lubricants(0)), 12);
    expect_as_alone(speeds, fluids, curve, {"lubricants/oil"});
    if (kUnderSanitizer) break;
  }
}

TEST(DrawnFigures, OfLubricantsWhoseErrorsAreCommonHaveTheirDifference) {
  const std::vector<double> speeds = speeds_between(30, 130, 10);
  Fluids fluids;
  fluids.add("lubricants/a", data_sheet(103, 15.1));
  fluids.add("lubricants/b", data_sheet(95, 14.4));
  const std::vector<std::string> both = {"lubricants/a", "lubricants/b"};
  auto request = curve_request(speeds, both);
  request.set_estimate_correlation(1);
  const auto curve = compare(request, fluids);
  EXPECT_LT(least_solved_draws(curve.lubricants(1)), 99);
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    SCOPED_TRACE(std::to_string(speeds[k]) + " km/h");
    auto one = curve_request({speeds[k]}, both);
    one.set_estimate_correlation(1);
    const auto alone = compare(one, fluids);
    const auto& figure = curve.lubricants(1).differences(static_cast<int>(k));
    const auto& expected = alone.lubricants(1).differences(0);
    expect_close(figure.difference_percent(), expected.difference_percent());
    EXPECT_NEAR(figure.lower_probability(), expected.lower_probability(), 0.05);
    const auto& own = alone.lubricants(1).points(0).inefficiency_energy_mean_percent();
    EXPECT_LT(expected.difference_percent().standard_uncertainty(),
              0.5 * own.standard_uncertainty());
  }
}

TEST(DrawnFigures, AreAllSolvedWhereSomeDrawsLoseContactAndOthersDoNot) {
  Fluids fluids;
  fluids.add("lubricants/oil", data_sheet(103, 15.1));
  const std::vector<double> speeds = speeds_between(70, 86, kUnderSanitizer ? 2 : 1);
  const auto curve = compare(curve_request(speeds, {"lubricants/oil"}), fluids);
  expect_as_alone(speeds, fluids, curve, {"lubricants/oil"});
}

TEST(DrawnFigures, OfFewConditionsAreAllSolved) {
  Fluids fluids;
  fluids.add("lubricants/oil", fluid_with_alpha());
  const auto out = compare(curve_request({40, 60, 80, 100}, {"lubricants/oil"}), fluids);
  EXPECT_EQ(least_solved_draws(out.lubricants(0)), 99);
}

}  // namespace
}  // namespace tribodyn::server
