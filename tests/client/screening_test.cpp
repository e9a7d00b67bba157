// Tests of tables of candidates, of their campaigns, of their ranking and of the file of their
// points.
#include "client/cpp/report/screening.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "client/cpp/failure.h"
#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/report/screening_decisions.h"
#include "client/cpp/report/screening_plot.h"
#include "client/cpp/report/screening_report.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/csv.h"

namespace tribodyn::client {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

CandidateBase base_of_tests() {
  CandidateBase base;
  base.lubricant.set_pressure_viscosity_coefficient_per_pascal(2e-8);
  base.lubricant.set_relaxation_time_seconds(4e-7);
  base.surface.set_asperity_friction_coefficient(0.09);
  return base;
}

CandidateTable candidates(const std::string& text, const std::vector<std::string>& carried = {}) {
  return read_candidates(text, "c.csv", base_of_tests(), carried);
}

std::string candidates_error(const std::string& text,
                             const std::vector<std::string>& carried = {}) {
  try {
    candidates(text, carried);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.exit_code(), kExitUsage);
    return failure.what();
  }
  return "";
}

TEST(Candidates, OverrideParametersOfLubricantAndSurfaceInTheirUnits) {
  const CandidateTable table = candidates(
      "candidate,Pressure-Viscosity (1/GPa),asperity friction coefficient,relaxation time,cost\n"
      "a,18,0.08,500ns,12\n"
      "b,,0.1,,9\n");
  EXPECT_THAT(table.names, ElementsAre("a", "b"));
  ASSERT_EQ(table.parameters.size(), 3U);
  EXPECT_EQ(table.parameters[0].path(), "lubricant.pressure_viscosity_coefficient_per_pascal");
  EXPECT_THAT(table.parameters[0].values, ElementsAre(DoubleNear(18e-9, 1e-20), 2e-8));
  EXPECT_EQ(table.parameters[1].path(), "lubricant.asperity_friction_coefficient");
  EXPECT_THAT(table.parameters[1].values, ElementsAre(0.08, 0.1));
  EXPECT_THAT(table.parameters[2].values, ElementsAre(DoubleNear(5e-7, 1e-18), 4e-7));
  EXPECT_THAT(table.is_carried, ElementsAre(false, false, false, true));
  EXPECT_TRUE(table.lubricants.empty());
}

TEST(Candidates, MayDifferInParametersOfThePressureViscosityLaw) {
  CandidateBase base = base_of_tests();
  base.lubricant.mutable_improved_yasutomi()->set_glass_temperature_rise_kelvin(210);
  const std::string text = "candidate,glass temperature rise [K]\na,220\nb,\n";
  const CandidateTable table = read_candidates(text, "c.csv", base, {});
  ASSERT_EQ(table.parameters.size(), 1U);
  EXPECT_EQ(table.parameters[0].path(),
            "lubricant.improved_yasutomi.glass_temperature_rise_kelvin");
  EXPECT_THAT(table.parameters[0].values, ElementsAre(220, 210));
  EXPECT_THAT(candidates_error(text), HasSubstr("glass temperature rise"));
}

TEST(Candidates, HaveTheBoundaryFrictionOfTheLubricantUnlessTheSurfaceIsNamed) {
  CandidateBase base = base_of_tests();
  const CandidateTable table = candidates(
      "asperity_friction_coefficient,surface.asperity_friction_coefficient\n0.1,\n,0.2\n");
  ASSERT_EQ(table.parameters.size(), 2U);
  EXPECT_EQ(table.parameters[0].path(), "lubricant.asperity_friction_coefficient");
  EXPECT_THAT(table.parameters[0].values, ElementsAre(0.1, 0.2));
  EXPECT_EQ(table.parameters[1].path(), "surface.asperity_friction_coefficient");
  EXPECT_EQ(table.parameters[1].header(), "surface.asperity_friction_coefficient");
  EXPECT_THAT(table.parameters[1].values, ElementsAre(0.09, 0.2));
  std::string wrong;
  EXPECT_EQ(find_candidate_parameter("asperity-friction-coefficient", wrong),
            table.parameters[0].field);
  EXPECT_EQ(find_candidate_parameter("surface.asperity-friction-coefficient", wrong),
            table.parameters[1].field);
  base.lubricant.add_asperity_friction_by_temperature()->set_asperity_friction_coefficient(0.3);
  EXPECT_TRUE(std::isnan(base_value(base, *table.parameters[0].field)));
}

TEST(Candidates, HaveNoNumbersOfALubricantThatAreNoParameters) {
  const std::string text = "name,relaxation_time_seconds,pour_point (C)\na,1e-7,-30\n";
  EXPECT_THAT(candidates_error(text),
              AllOf(HasSubstr("column 'pour_point (C)'"), HasSubstr("--lubricants")));
  EXPECT_EQ(candidates(text, {"pour_point (C)"}).parameters.size(), 1U);
  EXPECT_THAT(candidates_error("name,asperity_friction_by_temperature\na,0.1\n"),
              AllOf(HasSubstr("JSON"), HasSubstr("--asperity-friction-by-temperature")));
}

TEST(Candidates, WithoutNamesHaveTheNumbersOfTheirRows) {
  EXPECT_THAT(candidates("relaxation_time_seconds\n1e-7\n2e-7\n").names, ElementsAre("1", "2"));
  EXPECT_THAT(candidates_error("id,relaxation_time_seconds\na,1e-7\na,2e-7\n"),
              HasSubstr("row 3: "));
}

TEST(Candidates, MayHaveDecimalCommasAndARowOfUnits) {
  const CandidateTable table =
      candidates("name;pressure-viscosity;treat rate\n;1/GPa;\nA;18,5;0,5\nB;19,5;1\n");
  EXPECT_THAT(table.parameters.at(0).values,
              ElementsAre(DoubleNear(18.5e-9, 1e-20), DoubleNear(19.5e-9, 1e-20)));
  EXPECT_THAT(table.note, HasSubstr("2 cells"));
  EXPECT_EQ(table.cells[0][1], "0.5");
}

TEST(Candidates, RefuseAMisspeltParameterUnlessItIsCarried) {
  const std::string text = "relaxtion_time_seconds,pressure-viscosity (1/GPa)\n1e-7,20\n";
  EXPECT_THAT(candidates_error(text), HasSubstr("relaxation_time_seconds"));
  EXPECT_THAT(candidates(text, {"relaxtion_time_seconds"}).is_carried, ElementsAre(true, false));
  EXPECT_THAT(candidates_error("relaxation_time_seconds\n1e-7\n", {"cost"}),
              HasSubstr("--carry 'cost'"));
}

TEST(Candidates, ReportOneWrongCellOfEachColumn) {
  const std::string error =
      candidates_error("pressure-viscosity,relaxation time (s)\n17.1,1e-7\n17.2,x\n17.3,1e-7\n");
  EXPECT_THAT(error, HasSubstr("row 2 column pressure-viscosity: '17.1'"));
  EXPECT_THAT(error, HasSubstr("(2 more"));
  EXPECT_THAT(error, HasSubstr("row 3 column relaxation time (s): 'x'"));
  EXPECT_THAT(candidates_error("relaxation time (kg)\n1\n"), HasSubstr("kg"));
  for (const char* text : {"name,cost\na,3\n", "relaxation_time_seconds\n", ""}) {
    EXPECT_THAT(candidates_error(text), HasSubstr("c.csv"));
  }
}

TEST(Candidates, WithMeasurementsAreLubricantsForTheServer) {
  const CandidateTable table = candidates(
      "name,kv40,kv100,asperity_friction_coefficient\n"
      "a,73.3,8.86,0.1\n");
  ASSERT_EQ(table.lubricants.size(), 1U);
  EXPECT_EQ(table.lubricants[0]
                .measurements()
                .kinematic_viscosity_100_celsius_square_millimetres_per_second(),
            8.86);
  EXPECT_EQ(table.lubricants[0].asperity_friction_coefficient(), 0.1);
}

TEST(Candidates, OutsideARangeAreRefusedWithTheLikelySlip) {
  v1::Schema schema;
  v1::Constraint& row = *schema.add_constraints();
  row.set_message("Lubricant");
  row.set_field("pressure_viscosity_coefficient_per_pascal");
  row.set_unit("1/Pa");
  row.set_minimum(1e-10);
  row.set_maximum(1e-6);
  CandidateTable table = candidates("pressure-viscosity (1/GPa)\n20e-9\n20\n");
  check_candidate_ranges(schema, table);
  EXPECT_THAT(table.refusals[0],
              testing::ContainsRegex("pressure-viscosity \\(1/GPa\\) = 2e-17 1/Pa.* "
                                     "1e-10 to 1e-06 1/Pa.* 20e-9 "));
  EXPECT_EQ(table.refusals[1], "");
}

/// Three candidates at two conditions with weights 3/4 and 1/4; the last one is refused at the
/// second condition.
Screening sample_screening() {
  Screening out;
  out.table =
      candidates("name,asperity_friction_coefficient,cost\na,0.1,\"1,5\"\nb,0.08,2\nc,0.2,3\n");
  for (const double speed : {20.0, 60.0}) {
    v1::PointCondition& condition = *out.request.add_conditions();
    condition.set_speed_kilometres_per_hour(speed);
    condition.set_sump_temperature_celsius(90);
  }
  out.weights = {0.75, 0.25};
  out.base.set_lubricant_revision("lubricants/x@1");
  out.base.set_model_version("model-1");
  const auto add = [](double value, v1::EvaluatePointsResponse& answer) {
    answer.add_refusal_numbers(0);
    answer.add_pinion_torque_newton_metres(1);
    answer.add_wheel_torque_newton_metres(3);
    answer.add_inefficiency_rms_percent(value);
    answer.add_inefficiency_energy_mean_percent(value);
    answer.add_mesh_loss_power_watts(10 * value);
    answer.add_dynamic_transmission_error_minimum_metres(-1e-6);
    answer.add_dynamic_transmission_error_maximum_metres(1e-6);
    answer.add_contact_loss(false);
    answer.add_settled(true);
    answer.add_period_in_mesh_cycles(1);
    answer.add_estimated_relative_error(1e-3);
    answer.add_model(v1::POINT_MODEL_FULL);
  };
  for (const double value : {2.0, 2.0}) add(value, out.base);
  v1::EvaluatePointsResponse answer;
  for (const double value : {2.2, 1.0 / 3, 1.0, 2.0, 0.1, 0.1}) add(value, answer);
  answer.set_refusal_numbers(5, 1);
  v1::PointRefusal& refusal = *answer.add_refusals();
  refusal.set_reason("TOO_HOT");
  refusal.set_message("the contact is too hot, \"far\"\ntoo hot");
  for (int row = 0; row < 6; ++row) out.points.push_back(screened_point(answer, row));
  out.refusals.assign(answer.refusals().begin(), answer.refusals().end());
  return out;
}

TEST(Screening, RanksByTheWeightedMean) {
  const Screening screening = sample_screening();
  const std::vector<CandidateFigures> ranking = ranked(screening);
  ASSERT_EQ(ranking.size(), 3U);
  EXPECT_EQ(screening.table.names[ranking[0].candidate], "b");
  EXPECT_DOUBLE_EQ(ranking[0].inefficiency, 0.75 * 1 + 0.25 * 2);
  EXPECT_DOUBLE_EQ(ranking[0].solver_error, 1e-3 * 1.25);
  EXPECT_EQ(screening.table.names[ranking[1].candidate], "a");
  EXPECT_THAT(ranking[2].refusal, HasSubstr("(at 60 km/h and 90 C)"));
  const std::string report = screening_report(screening, ranking, {}, 1, OutputFormat::kTable);
  EXPECT_THAT(report, HasSubstr("-37.50"));  // 1.25 after 2
  EXPECT_THAT(report, HasSubstr("c: the contact is too hot"));
  EXPECT_THAT(report, HasSubstr("cost"));
  const std::string csv = screening_report(screening, ranking, {}, 1, OutputFormat::kCsv);
  EXPECT_THAT(csv, HasSubstr("\n2,a,0.1,\"1,5\","));
}

TEST(Screening, ContactFiguresAreTheLeastFilmTheHighestTemperatureAndMeans) {
  Screening screening = sample_screening();
  EXPECT_THROW(check_front_column(screening, "film_ratio_minimum"), Failure);
  screening.request.set_contact_figures(true);
  screening.points[2].contact = {0.9, 1.2, 400, 380, 30, 8, 0.02, 1e9, 40};
  screening.points[3].contact = {0.8, 1.0, 390, 370, 10, 4, 0.06, 2e9, 30};
  const std::vector<CandidateFigures> ranking = ranked(screening);
  EXPECT_THAT(ranking[0].contact,
              testing::ElementsAre(0.8, 1.15, 400, 377.5, 25, 7, 0.03, 2e9, 40));
  const std::string report = screening_report(screening, ranking, {}, 1, OutputFormat::kTable);
  EXPECT_THAT(report, HasSubstr("127"));  // 400 K in degrees Celsius
  EXPECT_THAT(screening_report(screening, ranking, {}, 1, OutputFormat::kJson),
              HasSubstr("\"film_ratio_minimum\": 0.8, \"film_ratio_mean\": 1.15"));
  const std::vector<CsvLine> lines =
      read_csv(screening_report(screening, ranking, {}, 1, OutputFormat::kCsv));
  EXPECT_EQ(lines[0].cells.size(), lines[1].cells.size());
  EXPECT_EQ(lines[0].cells.size(), lines[3].cells.size());
  const ScreeningFront front = screening_front(screening, ranking, "film_ratio_minimum", true);
  EXPECT_EQ(front.values[1], 0.8);
  std::ostringstream csv;
  write_screening_csv(screening, csv);
  EXPECT_THAT(csv.str(), HasSubstr(",0.001,0.9,1.2,400,380,30,8,0.02,1e+09,40,false,"));
}

TEST(Screening, WritesEveryPointAsCsv) {
  std::ostringstream csv;
  write_screening_csv(sample_screening(), csv);
  const std::vector<CsvLine> lines = read_csv(csv.str());
  ASSERT_EQ(lines.size(), 7U);
  for (const CsvLine& line : lines) EXPECT_EQ(line.cells.size(), lines[0].cells.size());
  EXPECT_THAT(csv.str(),
              HasSubstr("candidate,asperity_friction_coefficient,cost,speed_kilometres"));
  EXPECT_THAT(csv.str(), HasSubstr("\na,0.1,\"1,5\",60,0,90,0,1,3,0.3333333333333333,"));
  EXPECT_THAT(csv.str(), HasSubstr("TOO_HOT,\"the contact is too hot, \"\"far\"\" too hot\""));
}

TEST(Screening, PointsThatAreNotComputedSaySo) {
  Screening screening = sample_screening();
  std::vector<std::vector<double>> columns(screened_columns(false).size(), {std::nan("")});
  columns.back()[0] = -1;
  screening.points[0] = screened_point(columns, 0);
  EXPECT_EQ(refusal_of(screening, 0, 0).reason(), "NOT_COMPUTED");
  EXPECT_EQ(refusal_of(screening, 0, 1).reason(), "");
  EXPECT_EQ(refusal_of(screening, 2, 1).reason(), "TOO_HOT");
  EXPECT_NE(candidate_figures(screening, 0).refusal, "");
  screening.table.refusals[0] = "no oil";
  EXPECT_EQ(refusal_of(screening, 0, 0).reason(), "INVALID_CANDIDATE");
}

TEST(Screening, IsACampaignOfItsAcceptedCandidatesWithWhatIsCarriedAlong) {
  Screening screening = sample_screening();
  screening.request.set_lubricant("lubricants/x@1");
  screening.table.refusals[1] = "out of range";
  const v1::Campaign campaign = campaign_of(screening, "c.csv");
  EXPECT_EQ(campaign.display_name(), "c.csv");
  EXPECT_EQ(campaign.lubricant(), "lubricants/x@1");
  ASSERT_EQ(campaign.candidate_columns_size(), 1);
  EXPECT_EQ(campaign.candidate_columns(0).path(), "lubricant.asperity_friction_coefficient");
  EXPECT_THAT(campaign.candidate_columns(0).values(), ElementsAre(0.1, 0.2));
  ASSERT_EQ(campaign.candidate_attributes_size(), 2);
  EXPECT_THAT(campaign.candidate_attributes(0).texts(), ElementsAre("a", "c"));
  EXPECT_THAT(campaign.candidate_attributes(1).texts(), ElementsAre("1,5", "3"));
  EXPECT_THAT(campaign.condition_weights(), ElementsAre(0.75, 0.25));
  screening.table.cells[0][1] = "1.5";
  EXPECT_THAT(campaign_of(screening, "").candidate_attributes(1).values(), ElementsAre(1.5, 3));
}

TEST(Screening, ACampaignsAttributesHaveNamesThatTheServerTakes) {
  Screening screening = sample_screening();
  screening.table = candidates(
      "candidate,relaxation time (ns),treat rate,treat_rate,settled,Öl\na,400,1,2,3,x\n");
  std::vector<std::string> names;
  const v1::Campaign campaign = campaign_of(screening, "");
  for (const auto& each : campaign.candidate_attributes()) names.push_back(each.name());
  EXPECT_THAT(names, ElementsAre("name", "treat_rate", "treat_rate_2", "settled_2", "__l"));
}

TEST(Screening, CandidatesThatEqualTheBaseAreCandidatesOfACampaign) {
  Screening screening = sample_screening();
  screening.bases = base_of_tests();
  screening.table.parameters.clear();
  const v1::Campaign campaign = campaign_of(screening, "");
  ASSERT_EQ(campaign.candidate_columns_size(), 1);
  EXPECT_EQ(campaign.candidate_columns(0).values_size(), 3);
}

TEST(Screening, IsTheSameRequestWithAnotherTitleWeightsOrColumnsThatDecideNoFigure) {
  Screening screening = sample_screening();
  const std::string id = screening_request_id(campaign_of(screening, "a.csv"), "model");
  screening.weights = {0.5, 0.5};
  screening.table.cells[0][1] = "7";
  v1::Campaign other = campaign_of(screening, "b.csv");
  other.add_labels()->set_key("project");
  EXPECT_EQ(screening_request_id(other, "model"), id);
}

TEST(Screening, IsAnotherRequestWithOtherCandidatesConditionsOrModel) {
  const Screening screening = sample_screening();
  const auto id = [](const Screening& each) {
    return screening_request_id(campaign_of(each, ""), each.base.model_version());
  };
  EXPECT_THAT(id(screening), testing::MatchesRegex("screen-[0-9a-f]+"));
  EXPECT_EQ(id(screening), id(sample_screening()));
  Screening other = screening;
  other.request.mutable_conditions(0)->set_speed_kilometres_per_hour(21);
  EXPECT_NE(id(other), id(screening));
  other = screening;
  other.table.parameters[0].values[1] *= 1 + 1e-15;
  EXPECT_NE(id(other), id(screening));
  other = screening;
  other.base.set_model_version("model-2");
  EXPECT_NE(id(other), id(screening));
}

TEST(Screening, WritesJsonLines) {
  std::ostringstream written;
  write_screening_json_lines(sample_screening(), written);
  const std::string lines = written.str();
  EXPECT_THAT(lines, HasSubstr("{\"candidate\": \"a\", \"asperity_friction_coefficient\": 0.1, "
                               "\"cost\": \"1,5\", \"speed_kilometres_per_hour\": 20,"));
  EXPECT_THAT(lines,
              HasSubstr("\"refusal_message\": \"the contact is too hot, \\\"far\\\" too hot\""));
  EXPECT_THAT(lines, Not(HasSubstr("NaN")));
}

TEST(Candidates, MayStateTheirUncertainties) {
  const CandidateTable table = candidates(
      "relaxation time (ns),relaxation_time_seconds.standard_uncertainty,"
      "asperity_friction_coefficient.standard_uncertainty\n"
      "400,20ns,0.01\n"
      "500,,\n");
  ASSERT_EQ(table.uncertainties.size(), 2U);
  EXPECT_THAT(table.uncertainties[0].values, ElementsAre(DoubleNear(2e-8, 1e-20), 0));
  EXPECT_THAT(table.uncertainties[1].values, ElementsAre(0.01, 0));
  EXPECT_THAT(candidates_error("relaxation time (ns),relaxation_time_seconds.standard_uncertainty\n"
                               "400,-1e-9\n"),
              HasSubstr("-1e-9"));
}

TEST(Screening, NamesTies) {
  const Screening screening = sample_screening();
  const std::vector<CandidateFigures> ranking = ranked(screening);
  v1::RankCandidatesResponse answer;
  answer.set_compared(2);
  answer.add_own_uncertain_parameters("lubricant.asperity_friction_coefficient");
  for (std::size_t i = 0; i < 2; ++i) {
    v1::RankedCandidate& each = *answer.add_candidates();
    each.set_candidate(static_cast<int>(ranking[i].candidate));
    each.mutable_comparison()->set_standard_uncertainty(i == 0 ? 0.8 : 0.6);
    each.mutable_comparison()->set_worse_probability(i == 0 ? 0.5 : 0.7);
    each.mutable_comparison()->set_tied(true);
  }
  const std::vector<std::size_t> candidates = {0, 1, 2};
  const RankingConfidence tied = ranking_confidence(ranking, candidates, answer, 0.95);
  ASSERT_EQ(tied.of.size(), 2U);
  EXPECT_TRUE(tied.of[1]->is_tied);
  EXPECT_DOUBLE_EQ(tied.of[1]->standard_uncertainty, 0.6);
  const std::string report = screening_report(screening, ranking, tied, 5, OutputFormat::kTable);
  EXPECT_THAT(report, HasSubstr("1 of 1 "));
  EXPECT_THAT(report, HasSubstr(" 95 %"));
  EXPECT_THAT(screening_report(screening, ranking, tied, 5, OutputFormat::kCsv),
              HasSubstr(",is_tied_with_best,"));
  answer.mutable_candidates(1)->mutable_comparison()->set_worse_probability(0.999);
  answer.mutable_candidates(1)->mutable_comparison()->set_tied(false);
  const RankingConfidence sure = ranking_confidence(ranking, candidates, answer, 0.95);
  EXPECT_FALSE(sure.of[1]->is_tied);
  EXPECT_THAT(screening_report(screening, ranking, sure, 5, OutputFormat::kTable),
              HasSubstr("> 99 %"));
  // Without a comparison nothing can be said.
  answer.mutable_candidates(1)->clear_comparison();
  EXPECT_FALSE(ranking_confidence(ranking, candidates, answer, 0.95).of[1]);
  const RankingConfidence none = ranking_confidence(ranking, candidates, {}, 0.95);
  EXPECT_TRUE(none.of.empty());
}

/// Twenty candidates whose inefficiency is 1 + friction / 0.1 + 0.5 if the additive is B, plus a
/// little that alternates.
Screening linear_screening() {
  Screening out = sample_screening();
  std::string text = "name,asperity_friction_coefficient,additive,cost,kind,long\n";
  for (int i = 0; i < 20; ++i) {
    text += "c" + std::to_string(i) + "," + std::to_string(0.05 + 0.005 * (i * 7 % 20)) + "," +
            (i % 3 == 0 ? "B" : "A") + "," + std::to_string(20 - i) + ",x,text" +
            std::to_string(i) + "\n";
  }
  out.table = candidates(text);
  out.points.clear();
  for (int i = 0; i < 20; ++i) {
    ScreenedPoint point;
    point.figures[ScreenedPoint::kEnergyMean] =
        1 + out.table.parameters[0].values[static_cast<std::size_t>(i)] / 0.1 +
        (i % 3 == 0 ? 0.5 : 0) + (i % 2 == 0 ? 1e-3 : -1e-3);
    out.points.insert(out.points.end(), 2, point);
  }
  return out;
}

v1::EstimateCandidateEffectsResponse sample_effects() {
  v1::EstimateCandidateEffectsResponse out;
  v1::CandidateEffect& effect = *out.add_effects();
  effect.set_column("lubricant.asperity_friction_coefficient");
  effect.set_from_candidate(0);
  effect.set_to_candidate(1);
  effect.set_effect(0.95);
  effect.set_effect_minimum(0.9);
  effect.set_effect_maximum(1);
  effect.add_collinear_columns("lubricant.relaxation_time_seconds");
  v1::ColumnWithoutEffect& left_out = *out.add_left_out();
  left_out.set_column("surface.asperity_radius_metres");
  left_out.set_reason(v1::ColumnWithoutEffect::CONSTANT);
  return out;
}

TEST(Screening, ShowsTheEffectsOfTheServiceByTypedColumnsAndCells) {
  const Screening screening = linear_screening();
  const ScreeningEffects effects = screening_effects(screening, {3, 0}, sample_effects());
  ASSERT_EQ(effects.effects.size(), 1U);
  EXPECT_EQ(effects.effects[0].column, "asperity_friction_coefficient");
  EXPECT_EQ(effects.effects[0].from, screening.table.cells[3][0]);
  EXPECT_EQ(effects.effects[0].to, screening.table.cells[0][0]);
  const std::string report = effects_report(effects);
  EXPECT_THAT(report, HasSubstr("lubricant.relaxation_time_seconds"));
  EXPECT_THAT(report, HasSubstr("surface.asperity_radius_metres ("));
}

TEST(Screening, PutsWithheldCandidatesBehindTheOthersWithTheirWarnings) {
  Screening screening = sample_screening();
  screening.points[2].verdict_withheld = true;  // of b, which loses least
  v1::RankCandidatesResponse answer;
  answer.add_candidates()->set_candidate(1);
  answer.mutable_candidates(0)->set_label("b");
  v1::CandidateWarning& warning = *answer.add_warnings();
  warning.set_code("THICK_FILM");
  warning.set_summary("too thick");
  warning.set_level(v1::WARNING_LEVEL_WITHHOLDS_VERDICT);
  warning.add_candidates(1);
  set_warnings({0, 1, 2}, answer, screening);
  const std::vector<CandidateFigures> ranking = ranked(screening);
  EXPECT_EQ(screening.table.names[ranking[0].candidate], "a");
  EXPECT_EQ(screening.table.names[ranking[1].candidate], "b");
  const std::string report = screening_report(screening, ranking, {}, 5, OutputFormat::kTable);
  EXPECT_THAT(report, HasSubstr("withheld: too thick"));
  EXPECT_THAT(report, HasSubstr("[THICK_FILM]"));
  EXPECT_THAT(screening_report(screening, ranking, {}, 5, OutputFormat::kCsv),
              testing::ContainsRegex("\n2,b,.*,true,THICK_FILM,\n"));
  EXPECT_THAT(screening_report(screening, ranking, {}, 5, OutputFormat::kJson),
              HasSubstr("\"warnings\": \"THICK_FILM\""));
}

TEST(CampaignRanking, MarksWithheldAndListsRefusedCandidates) {
  v1::RankCandidatesResponse answer;
  answer.set_ranked(2);
  answer.set_withheld(1);
  answer.set_compared(1);
  answer.set_draws(199);
  answer.set_not_included("Tooth contact only");
  for (int i = 0; i < 2; ++i) {
    v1::RankedCandidate& each = *answer.add_candidates();
    each.set_candidate(i);
    each.set_label(i == 0 ? "a" : "b");
    each.set_value(1 - 0.5 * i);
  }
  answer.mutable_candidates(0)->mutable_comparison()->set_tied(true);
  answer.mutable_candidates(1)->set_verdict_withheld(true);
  v1::CandidateWarning& warning = *answer.add_warnings();
  warning.set_code("THICK_FILM");
  warning.set_summary("too thick");
  warning.set_level(v1::WARNING_LEVEL_WITHHOLDS_VERDICT);
  warning.add_candidates(1);
  v1::RefusedCandidate& refused = *answer.add_refused_candidates();
  refused.set_candidate(2);
  refused.set_label("c");
  refused.mutable_refusal()->set_reason("BELOW_POUR_POINT");
  refused.mutable_refusal()->set_message("too cold");
  const std::string table = ranking_answer_text({}, answer, OutputFormat::kTable);
  for (const char* part : {"withheld: too thick", "c: too cold [BELOW_POUR_POINT]", "[THICK_FILM]",
                           "Tooth contact only"}) {
    EXPECT_THAT(table, HasSubstr(part));
  }
  const std::vector<CsvLine> lines = read_csv(ranking_answer_text({}, answer, OutputFormat::kCsv));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines[1].cells, testing::Contains("false"));
  EXPECT_THAT(lines[2].cells, testing::Contains("THICK_FILM"));
  EXPECT_THAT(lines[3].cells.back(), HasSubstr("BELOW_POUR_POINT"));
}

TEST(Screening, FindsTheParetoFrontOfAColumn) {
  const Screening screening = linear_screening();
  const std::vector<CandidateFigures> ranking = ranked(screening);
  const ScreeningFront front = screening_front(screening, ranking, "cost", false);
  ASSERT_FALSE(front.front.empty());
  EXPECT_EQ(front.front.front(), ranking.front().candidate);
  EXPECT_EQ(front.front.back(), 19U);  // the cheapest
  EXPECT_EQ(screening_front(screening, ranking, "cost", true).front.back(), 0U);
  EXPECT_THAT(front_report(screening, ranking, front), HasSubstr("c19"));
  try {
    screening_front(screening, ranking, "costs", false);
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("cost "));
  }
  EXPECT_THROW(screening_front(screening, ranking, "additive", false), Failure);
  const ScreeningEffects effects = screening_effects(screening, {0, 1}, sample_effects());
  const std::string picture = screening_plot(screening, ranking, &front, &effects);
  EXPECT_THAT(picture, HasSubstr("asperity_friction_coefficient: "));
  EXPECT_GT(picture.size(), screening_plot(screening, ranking, nullptr, &effects).size());
  const std::string json = screening_report(
      screening, ranking, {}, 1, OutputFormat::kJson,
      {{"pareto_front", front_json(screening, front)}, {"main_effects", effects_json(effects)}});
  EXPECT_THAT(json, HasSubstr("\"pareto_front\": {\"column\": \"cost\", \"wants_most\": false"));
  EXPECT_THAT(json, HasSubstr("\"main_effects\": {"));
  EXPECT_THAT(json, HasSubstr("{\"column\": \"asperity_friction_coefficient\", \"from\": "));
}

}  // namespace
}  // namespace tribodyn::client
