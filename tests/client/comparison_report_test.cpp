// Uncertainty, comparison and sensitivities as the command line shows them.
#include "client/cpp/report/comparison_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/report/comparison_plot.h"
#include "client/cpp/report/curve_plot.h"
#include "client/cpp/report/curve_report.h"
#include "client/cpp/report/explanation_plot.h"
#include "client/cpp/report/explanation_report.h"
#include "client/cpp/report/report_page.h"
#include "client/cpp/report/sensitivity_report.h"
#include "client/cpp/text/csv.h"
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
            "1.18 %, +/- 0.82; solver error 0.00042 %");
  EXPECT_EQ(with_errors(sample_figure(53.91, 16.8, 0.04), "W"),
            "54 W, +/- 33; solver error 0.040 W");
  EXPECT_EQ(with_errors(sample_figure(1.1783, 0, 0.00042), "%"),
            "1.17830 %, uncertainty not stated; solver error 0.00042 %");
  v1::UncertainFigure asymmetric = sample_figure(1.1783, 0.4199, 0.00042);
  asymmetric.set_interval_maximum(3);
  EXPECT_EQ(with_errors(asymmetric, "%"), "1.18 %, 0.36 to 3.00; solver error 0.00042 %");
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
    lubricant.set_uncertainty_stated(true);
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

TEST(ComparisonReport, OfTwoLubricantsHasDifferenceProbabilityAndShares) {
  const std::string text = in_one_line(comparison_report(
      sample_request(), sample_comparison(v1::ComparedDifference::CANNOT_BE_TOLD_APART)));
  for (const char* part : {"-0.20 ", "-0.49 to 0.09", " 91 %",
                           "pressure viscosity coefficient of b@2 96 %", "relaxation time"}) {
    EXPECT_TRUE(has_text(text, part)) << part << " in " << text;
  }
}

TEST(ComparisonReport, DiffersForEachVerdict) {
  std::set<std::string> texts;
  for (const auto verdict :
       {v1::ComparedDifference::LOWER, v1::ComparedDifference::HIGHER,
        v1::ComparedDifference::CANNOT_BE_TOLD_APART, v1::ComparedDifference::WITHHELD,
        v1::ComparedDifference::UNCERTAINTY_NOT_STATED}) {
    texts.insert(comparison_report(sample_request(), sample_comparison(verdict)));
  }
  EXPECT_EQ(texts.size(), 5U);
}

TEST(ComparisonReport, AWithheldVerdictHasItsReasonAndNoProbability) {
  v1::ComparePointsResponse response = sample_comparison(v1::ComparedDifference::WITHHELD);
  response.set_not_included("Tooth contact only");
  v1::ComparedLubricant& b = *response.mutable_lubricants(1);
  for (v1::ComparedDifference* each : {b.mutable_mean_difference(), b.mutable_differences(0)}) {
    each->set_lower_probability(std::nan(""));
  }
  v1::RangeWarning& warning = *b.mutable_points(0)->add_warnings();
  warning.set_code("VISCOSITY_RANGE");
  warning.set_summary("no oil");
  warning.set_message("1e7 Pa s");
  warning.set_level(v1::WARNING_LEVEL_WITHHOLDS_VERDICT);
  const std::string text = in_one_line(comparison_report(sample_request(), response));
  for (const char* part :
       {"withheld: no oil", "Tooth contact only", "b@2 at 60 km/h: 1e7 Pa s. [VISCOSITY_RANGE]"}) {
    EXPECT_TRUE(has_text(text, part)) << part << " in " << text;
  }
  EXPECT_FALSE(has_text(text, "nan"));
  EXPECT_FALSE(has_text(text, "91 %"));
  const std::vector<CsvLine> lines = read_csv(comparison_csv(sample_request(), response));
  const auto column = [&lines](const std::string& name) {
    const auto& header = lines.front().cells;
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  EXPECT_EQ(lines.at(2).cells.at(column("warnings")), "VISCOSITY_RANGE");
  EXPECT_EQ(lines.at(2).cells.at(column("difference.verdict")), "WITHHELD");
  EXPECT_EQ(lines.at(1).cells.at(column("warnings")), "");
  const std::string svg = comparison_plot(sample_request(), response);
  EXPECT_TRUE(has_text(svg, "[VISCOSITY_RANGE]"));
  EXPECT_TRUE(has_text(svg, "url(#hatch"));
}

TEST(ComparisonReport, DoesNotCallAnUnstatedUncertaintyZero) {
  v1::ComparePointsResponse response =
      sample_comparison(v1::ComparedDifference::UNCERTAINTY_NOT_STATED);
  response.mutable_lubricants(1)->set_uncertainty_stated(false);
  *response.mutable_lubricants(1)->mutable_points(0)->mutable_inefficiency_energy_mean_percent() =
      sample_figure(1.2, 0, 0.001);
  const std::string text = in_one_line(comparison_report(sample_request(), response));
  EXPECT_TRUE(has_text(text, " 1.2000 not stated 0.0010 ")) << text;
}

/// Three lubricants at two speeds and two sump temperatures. "near" cannot be told apart from
/// "good", the best, if `is_tie`; "bad" loses more.
struct SampleRanking {
  v1::ComparePointsRequest request;
  v1::ComparePointsResponse response;

  explicit SampleRanking(bool is_tie, const std::vector<double>& sumps = {80}) {
    for (const char* name : {"bad", "near", "good"}) {
      request.add_lubricants(std::string("lubricants/") + name);
    }
    for (const double sump : sumps) {
      for (const double speed : {120, 40}) {
        v1::PointCondition& condition = *request.add_conditions();
        condition.set_speed_kilometres_per_hour(speed);
        condition.set_sump_temperature_celsius(sump);
        request.add_condition_weights(speed == 40 ? 3 : 1);
      }
    }
    response.set_draws(199);
    response.set_model_version("model-x");
    const auto nearly =
        is_tie ? v1::ComparedDifference::CANNOT_BE_TOLD_APART : v1::ComparedDifference::HIGHER;
    add("lubricants/bad@1", 2.0, 0.0, v1::ComparedDifference::HIGHER);
    add("lubricants/near@2", 1.1, 0.4, nearly);
    add("lubricants/good@3", 1.0, 0.6, v1::ComparedDifference::VERDICT_UNSPECIFIED);
  }

 private:
  void add(const char* revision, double mean, double probability,
           v1::ComparedDifference::Verdict against_best) {
    v1::ComparedLubricant& out = *response.add_lubricants();
    out.set_lubricant_revision(revision);
    out.set_uncertainty_stated(true);
    out.set_best_probability(probability);
    *out.mutable_mean_inefficiency_percent() = sample_figure(mean, 0.1, 0.001);
    v1::ComparedDifference difference;
    difference.set_verdict(against_best);
    *difference.mutable_difference_percent() = sample_figure(mean - 1, 0.1, 0.002);
    v1::InputShare& share = *difference.add_shares();
    share.set_input("lubricant.pressure_viscosity_coefficient_per_pascal");
    share.set_variance_share(0.96);
    v1::DecidingInput& deciding = *difference.add_deciding_inputs();
    deciding.set_input("lubricant.pressure_viscosity_coefficient_per_pascal");
    deciding.set_standard_uncertainty(4e-10);
    deciding.set_factor(0.2);
    if (mean > 1) *out.mutable_mean_difference_from_best() = difference;
    const bool is_first = response.lubricants_size() == 1;
    if (!is_first) *out.mutable_mean_difference() = difference;
    for (int k = 0; k < request.conditions_size(); ++k) {
      *out.add_points()->mutable_inefficiency_energy_mean_percent() =
          sample_figure(mean + 0.1 * k, 0.1, 0.001);
      if (!is_first) *out.add_differences() = difference;
    }
  }
};

TEST(ComparisonReport, RanksThreeLubricantsLeastLossFirst) {
  const SampleRanking sample(false);
  const std::string table = comparison_report(sample.request, sample.response);
  const auto row = [&table](const char* name) { return table.find(std::string(name) + "@"); };
  EXPECT_LT(row("good"), row("near"));
  EXPECT_LT(row("near"), row("bad"));
  const std::string text = in_one_line(table);
  EXPECT_TRUE(has_text(text, "1 good@3 1.00 0.20 60 % ")) << text;
  EXPECT_TRUE(has_text(text, "3 bad@1 2.00 0.20 0 % 1.00 0.80 to 1.20 ")) << text;
}

TEST(ComparisonReport, PutsALubricantWhoseVerdictIsWithheldLast) {
  SampleRanking sample(false);
  v1::ComparedLubricant& good = *sample.response.mutable_lubricants(2);
  good.set_best_probability(std::nan(""));
  *good.mutable_mean_difference_from_best() =
      sample.response.lubricants(1).mean_difference_from_best();
  good.mutable_mean_difference_from_best()->set_verdict(v1::ComparedDifference::WITHHELD);
  sample.response.mutable_lubricants(1)->clear_mean_difference_from_best();
  v1::RangeWarning& warning = *good.mutable_points(1)->add_warnings();
  warning.set_code("THICK_FILM");
  warning.set_summary("too thick");
  warning.set_level(v1::WARNING_LEVEL_WITHHOLDS_VERDICT);
  const std::string text = in_one_line(comparison_report(sample.request, sample.response));
  EXPECT_TRUE(has_text(text, " 1 near@2 ")) << text;
  EXPECT_TRUE(has_text(text, " 3 good@3 1.00 0.20 - ")) << text;
  EXPECT_TRUE(has_text(text, "withheld: too thick"));
}

TEST(ComparisonReport, RanksARefusedLubricantLastWithTheReason) {
  SampleRanking sample(false);
  v1::ComparedLubricant& bad = *sample.response.mutable_lubricants(0);
  bad.clear_mean_inefficiency_percent();
  bad.mutable_mean_difference_from_best()->Clear();
  for (v1::ComparedPoint& point : *bad.mutable_points()) {
    point.Clear();
    point.set_refusal_reason("BELOW_POUR_POINT");
    point.set_refusal_message("too cold");
  }
  for (int i = 1; i < 3; ++i) {
    sample.response.mutable_lubricants(i)->mutable_mean_difference()->Clear();
  }
  const std::string text = in_one_line(comparison_report(sample.request, sample.response));
  EXPECT_TRUE(has_text(text, " - bad@1 - - - no figure: too cold (at ")) << text;
  EXPECT_TRUE(has_text(text, "No difference of near@2 and bad@1: no figure of bad@1: too cold"))
      << text;
}

TEST(ComparisonReport, ShowsNoProbabilityOfOneLubricantAlone) {
  SampleRanking sample(false);
  for (int i = 0; i < 2; ++i) {
    sample.response.mutable_lubricants(i)->set_best_probability(std::nan(""));
  }
  sample.response.mutable_lubricants(2)->set_best_probability(1);
  const std::string text = in_one_line(comparison_report(sample.request, sample.response));
  EXPECT_TRUE(has_text(text, "1 good@3 1.00 0.20 - ")) << text;
  EXPECT_FALSE(has_text(text, "probability that it is the best")) << text;
}

TEST(ComparisonReport, SaysWhatToMeasureIfTheBestIsNotSure) {
  const auto advice = [](bool is_tie) {
    const SampleRanking sample(is_tie);
    return has_text(in_one_line(comparison_report(sample.request, sample.response)),
                    "near@2 from good@3: pressure viscosity coefficient of both with a "
                    "standard uncertainty of 0.4 1/GPa (now 2)");
  };
  EXPECT_TRUE(advice(true));
  EXPECT_FALSE(advice(false));
}

TEST(ComparisonReport, NamesTheNextCommandsForEachSumpTemperature) {
  const SampleRanking sample(true, {40, 90});
  const std::string text = comparison_report(sample.request, sample.response);
  for (const char* command :
       {"tribodyn explain good@3 near@2 --speed 120,40 --weights 1,3 --sump 40\n",
        "tribodyn explain good@3 bad@1 --speed 120,40 --weights 1,3 --sump 90\n",
        "tribodyn report bad near good --sump 40 --html report-40.html\n",
        "tribodyn report bad near good --sump 90 --html report-90.html\n"}) {
    EXPECT_TRUE(has_text(text, command)) << text;
  }
}

TEST(ComparisonPlot, HasALineForEachLubricantAndDifferencesFromTheFirst) {
  const SampleRanking sample(true);
  const std::string svg = comparison_plot(sample.request, sample.response);
  for (const char* part : {">bad@1<", ">near@2<", ">good@3<", "199", "model-x"}) {
    EXPECT_TRUE(has_text(svg, part)) << part;
  }
  const auto count = [](const std::string& text, const std::string& part) {
    int out = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
      ++out;
    }
    return out;
  };
  EXPECT_EQ(count(svg, "fill-opacity=\"0.13\""), 5) << "bands of three lubricants, two differences";
  v1::ComparePointsResponse one = sample.response;
  one.mutable_lubricants()->DeleteSubrange(1, 2);
  EXPECT_EQ(count(comparison_plot(sample.request, one), "fill-opacity=\"0.13\""), 1);
  const SampleRanking sumps(true, {40, 90});
  const std::string both = comparison_plot(sumps.request, sumps.response);
  EXPECT_EQ(count(both, "fill-opacity=\"0.13\""), 10);
  EXPECT_TRUE(has_text(both, ">good@3, 90 C<"));
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

/// A curve over 60, 70 and 80 km/h: at 70 without sensitivities.
v1::Simulation differentiated_curve() {
  v1::Simulation out;
  out.mutable_inefficiency_curve()->set_sensitivities(true);
  for (const double speed : {60.0, 70.0, 80.0}) {
    v1::CurvePoint& point = *out.mutable_result()->add_points();
    point.set_speed_kilometres_per_hour(speed);
    v1::PointResult& result = *point.mutable_result();
    if (speed == 70) {
      v1::RangeWarning& warning = *result.add_warnings();
      warning.set_code("NO_SENSITIVITIES");
      warning.set_message("it is marched");
      continue;
    }
    v1::PointSensitivities& sensitivities = *result.mutable_sensitivities();
    sensitivities.add_figures("inefficiency_energy_mean_percent");
    sensitivities.add_values(1.2);
    for (const auto& [name, elasticity] :
         {std::pair("lubricant.small", 1e-3 * speed), std::pair("wheel_torque", -1e-2 * speed)}) {
      v1::ParameterSensitivity& parameter = *sensitivities.add_parameters();
      parameter.set_parameter(name);
      parameter.add_derivatives(7);
      parameter.add_elasticities(elasticity);
    }
  }
  return out;
}

TEST(CurveSensitivityReport, HasTheElasticitiesBySpeedLargestFirstAndWhySpeedsHaveNone) {
  const std::string text = curve_sensitivity_report(differentiated_curve().result());
  EXPECT_TRUE(has_text(text, "70 km/h: "));
  EXPECT_TRUE(has_text(text, "it is marched"));
  EXPECT_TRUE(has_text(text, "wheel torque")) << text;
  EXPECT_TRUE(has_text(text, "-0.8000")) << text;
  EXPECT_TRUE(has_text(text, "0.0600")) << text;
  EXPECT_LT(text.find("wheel torque"), text.find("lubricant small"));
  EXPECT_TRUE(has_text(curve_report(differentiated_curve(), {}), "-0.8000"));
}

TEST(CurveSensitivityReport, CsvHasAColumnForEachFigureAndParameter) {
  const std::vector<CsvLine> lines = read_csv(points_csv({differentiated_curve()}));
  ASSERT_EQ(lines.size(), 4U);
  const auto& header = lines.front().cells;
  const auto column = std::find(header.begin(), header.end(),
                                "elasticity.inefficiency_energy_mean_percent.wheel_torque");
  ASSERT_NE(column, header.end());
  const auto at = static_cast<std::size_t>(column - header.begin());
  EXPECT_EQ(lines[1].cells[at], "-0.6");
  EXPECT_EQ(lines[2].cells[at], "");
  EXPECT_EQ(lines[3].cells[at], "-0.8");
  EXPECT_EQ(lines[3].cells[at - 1], "7");
}

TEST(SensitivityReport, SaysWhyThereAreNone) {
  v1::PointResult result;
  v1::RangeWarning& warning = *result.add_warnings();
  warning.set_code("NO_SENSITIVITIES");
  warning.set_message("the flanks part");
  EXPECT_TRUE(has_text(sensitivity_report(result), "the flanks part"));
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
  const std::string text = curve_report(curve, {}, &uncertainty);
  EXPECT_TRUE(has_text(text, "+/- 0.73"));
  EXPECT_TRUE(has_text(text, "Measure it."));
  EXPECT_FALSE(has_text(curve_report(curve, {}), "+/- 0.73"));
}

TEST(CurvePlot, DrawsUncertaintiesAsBands) {
  v1::Simulation curve = sample_curve("1", 1);
  curve.set_name("simulations/1");
  const std::string with = curve_plot({curve}, {}, {{"simulations/1", sample_uncertainty(curve)}});
  EXPECT_TRUE(has_text(with, "fill-opacity=\"0.13\""));
  EXPECT_FALSE(has_text(curve_plot({curve}, {}), "fill-opacity=\"0.13\""));
}

v1::DrawnFigure drawn_figure(double value, double uncertainty) {
  v1::DrawnFigure out;
  out.set_value(value);
  out.set_standard_uncertainty(uncertainty);
  out.set_interval_minimum(value - 2 * uncertainty);
  out.set_interval_maximum(value + 2 * uncertainty);
  out.set_solver_error(0.0001);
  return out;
}

/// Of two lubricants that differ by 0.3 in viscosity and by -0.1 in pressure response.
v1::DifferenceExplanation sample_explanation() {
  v1::DifferenceExplanation out;
  *out.mutable_inefficiency_percent() = drawn_figure(1, 0.1);
  *out.mutable_other_inefficiency_percent() = drawn_figure(1.2, 0.1);
  *out.mutable_inefficiency_difference_percent() = drawn_figure(0.2, 0.02);
  *out.mutable_mesh_loss_power_difference_watts() = drawn_figure(40, 4);
  for (int group = 1; group <= 6; ++group) {
    v1::DifferenceCause& cause = *out.add_causes();
    cause.set_group(static_cast<v1::ParameterGroup>(group));
    cause.set_is_equal(group > 2);
    const double share = group == 1 ? 0.3 : group == 2 ? -0.1 : 0;
    *cause.mutable_inefficiency_percent()->mutable_shapley_value() =
        drawn_figure(share, group > 2 ? 0 : 0.015);
    cause.mutable_inefficiency_percent()->set_first_effect(0.9 * share);
    cause.mutable_inefficiency_percent()->set_last_effect(1.1 * share);
  }
  v1::CauseInteraction& interaction = *out.add_interactions();
  interaction.set_group(v1::PARAMETER_GROUP_VISCOSITY);
  interaction.set_other_group(v1::PARAMETER_GROUP_PRESSURE_RESPONSE);
  interaction.set_inefficiency_percent(-0.05);
  return out;
}

struct SampleExplanation {
  v1::ExplainPointsRequest request;
  v1::ExplainPointsResponse response;

  SampleExplanation() {
    response.set_draws(99);
    response.set_lubricant_revision("lubricants/a@1");
    response.set_other_lubricant_revision("lubricants/b@2");
    response.set_model_version("model-x");
    for (const double speed : {40, 80}) {
      request.add_conditions()->set_speed_kilometres_per_hour(speed);
      *response.add_points() = sample_explanation();
    }
    response.mutable_points(1)->set_contact_loss_combinations(12);
    *response.mutable_mean() = sample_explanation();
  }
};

TEST(ExplanationReport, ListsTheSharesLargestFirstWithTheirSum) {
  const SampleExplanation sample;
  const std::string text = explanation_report(sample.request, sample.response);
  const std::string table = text.substr(text.find("group of parameters"));
  EXPECT_LT(table.find("viscosity and its temperature law"), table.find("pressure response"));
  EXPECT_TRUE(
      has_text(in_one_line(text), "a@1 1.000 (0.800 to 1.200) %, b@2 1.200 (1.000 to 1.400) %"))
      << text;
  for (const char* part : {"0.200 ", "+0.300", "-0.100"}) EXPECT_TRUE(has_text(text, part)) << part;
  EXPECT_TRUE(has_text(text, "0.270 to 0.330")) << text;
  EXPECT_TRUE(has_text(text, "-0.050")) << "the interaction";
  EXPECT_TRUE(has_text(text, "80 km/h (12 of 64")) << text;
}

TEST(ExplanationReport, SaysWhyThereAreNoShares) {
  SampleExplanation sample;
  sample.response.mutable_mean()->Clear();
  sample.response.mutable_mean()->set_refusal_reason("NO_FILM");
  sample.response.mutable_mean()->set_refusal_message("the film vanishes");
  const std::string text = explanation_report(sample.request, sample.response);
  EXPECT_TRUE(has_text(text, "the film vanishes [NO_FILM]")) << text;
}

TEST(ExplanationReport, CsvHasARowForEachGroupAtEachConditionAndInTheMean) {
  const SampleExplanation sample;
  const std::string csv = explanation_csv(sample.request, sample.response);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 6);
  EXPECT_TRUE(has_text(csv, "lubricants/a@1,lubricants/b@2,mean,")) << csv;
}

TEST(ExplanationPlot, HasABarForEachGroupAndAStackForEachSpeed) {
  const SampleExplanation sample;
  const std::string svg = explanation_plot(sample.request, sample.response);
  for (const char* part : {"boundary film", ">0.3<", ">-0.1<", ">80<", " 99 ", "model-x"}) {
    EXPECT_TRUE(has_text(svg, part)) << part;
  }
}

TEST(ReportPage, NeedsNoOtherFileAndEscapesWhatOthersWrote) {
  const SampleExplanation sample;
  ReportContents contents;
  contents.curves = {sample_curve("a<script>", 1), sample_curve("b", 1.1)};
  contents.comparison_request = sample_request();
  contents.comparison = sample_comparison(v1::ComparedDifference::LOWER);
  contents.explanations = {{sample.request, sample.response}};
  contents.command = "tribodyn report a b";
  const std::string page = report_page(contents);
  EXPECT_FALSE(has_text(page, "<script")) << "a name reached the page as it is";
  EXPECT_TRUE(has_text(page, "&lt;script"));
  for (const char* reference : {"src=", "href=", "@import"}) {
    EXPECT_FALSE(has_text(page, reference)) << reference;
  }
  for (const char* part : {"default-src 'none'", "tribodyn report a b", "abc123"}) {
    EXPECT_TRUE(has_text(page, part)) << part;
  }
  EXPECT_EQ(page.find("id=\"clip1\""), std::string::npos) << "ids of two pictures may be equal";
}

}  // namespace
}  // namespace tribodyn::client
