// Uncertainty, comparison and sensitivities as the command line shows them.
#include "client/cpp/report/comparison_report.h"

#include <gtest/gtest.h>

#include <string>

#include "client/cpp/plot/curve_plot.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/sensitivity_report.h"
#include "tests/client/sample_simulations.h"

namespace tribodyn::client {
namespace {

bool has_text(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

v1::UncertainFigure sample_figure(double value, double uncertainty, double solver_error) {
  v1::UncertainFigure out;
  out.set_value(value);
  out.set_standard_uncertainty(uncertainty);
  out.set_linear_standard_uncertainty(1.02 * uncertainty);
  out.set_interval_minimum(value - 1.96 * uncertainty);
  out.set_interval_maximum(value + 1.96 * uncertainty);
  out.set_solver_error(solver_error);
  return out;
}

TEST(ComparisonReport, AFigureHasTheErrorsOfInputsAndSolverApart) {
  EXPECT_EQ(with_errors(sample_figure(1.1783, 0.4199, 0.00042), "%"),
            "1.18 % +/- 0.42 (inputs) +/- 0.0004 (solver)");
  EXPECT_EQ(with_errors(sample_figure(53.91, 16.8, 0.04), "W"),
            "54 W +/- 17 (inputs) +/- 0.04 (solver)");
  EXPECT_EQ(with_errors(sample_figure(1.1783, 0, 0.00042), "%"),
            "1.17830 % +/- 0 (inputs) +/- 0.0004 (solver)");
}

v1::ComparePointsRequest sample_request() {
  v1::ComparePointsRequest out;
  out.add_conditions()->set_speed_kilometres_per_hour(60);
  return out;
}

v1::ComparePointsResponse sample_comparison(v1::ComparedDifference::Verdict verdict) {
  v1::ComparePointsResponse out;
  out.set_draws(199);
  out.set_estimate_correlation(0.5);
  for (const char* name : {"lubricants/a@1", "lubricants/b@2"}) {
    v1::ComparedLubricant& lubricant = *out.add_lubricants();
    lubricant.set_lubricant_revision(name);
    *lubricant.add_points()->mutable_inefficiency_energy_mean_percent() =
        sample_figure(1.2, 0.1, 0.001);
  }
  v1::ComparedLubricant& b = *out.mutable_lubricants(1);
  b.add_inputs_without_uncertainty("lubricant.relaxation_time_seconds");
  v1::ComparedDifference& difference = *b.mutable_mean_difference();
  difference.set_verdict(verdict);
  *difference.mutable_difference_percent() = sample_figure(-0.2, 0.15, 0.002);
  difference.set_lower_probability(0.91);
  v1::InputShare& share = *difference.add_shares();
  share.set_input("lubricant.pressure_viscosity_coefficient_per_pascal");
  share.set_lubricant_revision("lubricants/b@2");
  share.set_variance_share(0.96);
  *b.add_differences() = difference;
  return out;
}

/// The text with every run of blanks and line feeds as one blank.
std::string in_one_line(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\n';
    if (!is_blank || (!out.empty() && out.back() != ' ')) out += is_blank ? ' ' : c;
  }
  return out;
}

TEST(ComparisonReport, SaysThatTwoLubricantsCannotBeToldApartAndWhatToMeasure) {
  const std::string text = in_one_line(comparison_report(
      sample_request(), sample_comparison(v1::ComparedDifference::CANNOT_BE_TOLD_APART)));
  EXPECT_TRUE(has_text(text,
                       "these two cannot be told apart: b@2 less a@1 is -0.20 percentage "
                       "points (95 %: -0.49 to 0.09)."));
  EXPECT_TRUE(has_text(text, "Probability that b@2 loses less: 91 %."));
  EXPECT_TRUE(has_text(text, "pressure viscosity coefficient of b@2 96 %"));
  EXPECT_TRUE(has_text(text, "measure first: pressure viscosity coefficient of b@2."));
  EXPECT_TRUE(has_text(text,
                       "Taken as exact, because no uncertainty is stated, of b@2: "
                       "relaxation time."));
}

TEST(ComparisonReport, SaysWhichLubricantLosesLess) {
  const auto text = [](v1::ComparedDifference::Verdict verdict) {
    return in_one_line(comparison_report(sample_request(), sample_comparison(verdict)));
  };
  EXPECT_TRUE(has_text(text(v1::ComparedDifference::LOWER), "b@2 loses less than a@1"));
  EXPECT_TRUE(has_text(text(v1::ComparedDifference::HIGHER), "b@2 loses more than a@1"));
}

TEST(SensitivityReport, SortsParametersBySizeAndDrawsBarsToBothSides) {
  v1::PointResult result;
  v1::PointSensitivities& sensitivities = *result.mutable_sensitivities();
  sensitivities.add_figures("inefficiency_energy_mean_percent");
  sensitivities.add_values(1.2);
  const auto add = [&](const char* name, double elasticity) {
    v1::ParameterSensitivity& parameter = *sensitivities.add_parameters();
    parameter.set_parameter(name);
    parameter.add_derivatives(1);
    parameter.add_elasticities(elasticity);
  };
  add("lubricant.small", 0.1);
  add("lubricant.large_and_negative", -2);
  const std::string text = sensitivity_report(result);
  EXPECT_LT(text.find("lubricant large and negative"), text.find("lubricant small"));
  EXPECT_TRUE(has_text(text, "############|"));
  EXPECT_TRUE(has_text(text, "|#\n"));
}

TEST(SensitivityReport, SaysWhyThereAreNone) {
  v1::PointResult result;
  v1::RangeWarning& warning = *result.add_warnings();
  warning.set_code("NO_SENSITIVITIES");
  warning.set_message("the flanks part");
  EXPECT_TRUE(has_text(sensitivity_report(result), "There are none: the flanks part."));
}

CurveUncertainty sample_uncertainty(const v1::Simulation& curve) {
  CurveUncertainty out;
  for (const v1::CurvePoint& point : curve.result().points()) {
    out.figures[point.speed_kilometres_per_hour()] =
        sample_figure(point.result().inefficiency_energy_mean_percent(), 0.37, 0.001);
  }
  out.remark = "Measure it.";
  return out;
}

TEST(CurveReport, ShowsTheUncertaintyOfTheInputsBesideTheSolversError) {
  const v1::Simulation curve = sample_curve("1", 1);
  const CurveUncertainty uncertainty = sample_uncertainty(curve);
  const std::string text = curve_report(curve, false, &uncertainty);
  EXPECT_TRUE(has_text(text, "+/- 0.37"));
  EXPECT_TRUE(has_text(text, "Measure it."));
  EXPECT_FALSE(has_text(curve_report(curve, false), "+/- 0.37"));
}

TEST(CurvePlot, DrawsUncertaintiesAsBandsAndExplainsThem) {
  v1::Simulation curve = sample_curve("1", 1);
  curve.set_name("simulations/1");
  const std::string with = curve_plot({curve}, {}, {{"simulations/1", sample_uncertainty(curve)}});
  EXPECT_TRUE(has_text(with, "fill-opacity=\"0.13\""));
  EXPECT_TRUE(has_text(with, "Bands: 95 % intervals"));
  EXPECT_FALSE(has_text(curve_plot({curve}, {}), "Bands: 95 % intervals"));
}

}  // namespace
}  // namespace tribodyn::client
