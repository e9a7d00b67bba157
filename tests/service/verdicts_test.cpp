// What decides between oils is said alike by every method.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/application/campaign_decisions.h"
#include "server/application/contacts.h"
#include "server/application/cycles.h"
#include "server/application/points.h"
#include "server/application/rigs.h"
#include "server/application/simulations.h"
#include "tests/service/campaign_fixture.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::Contains;

struct DataSheet {
  const char* id;
  double kv40, kv100, density;
  v1::Lubricant::BaseOilClass base_oil;
};
// Two PAO oils that nobody can tell apart, a mineral one and a thick mineral one.
const std::vector<DataSheet> kOils = {
    {"pao-a", 55.9, 9.23, 885, v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
    {"pao-b", 63.8, 10.44, 885, v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN},
    {"group-iii", 102, 15.1, 870, v1::Lubricant::BASE_OIL_CLASS_GROUP_III},
    {"naphthenic", 328, 25.3, 910, v1::Lubricant::BASE_OIL_CLASS_NAPHTHENIC}};

class Verdicts : public CampaignTest {
 protected:
  std::string add(const DataSheet& sheet, std::optional<double> pour_point = {},
                  std::optional<double> friction = {}, const std::string& id = {}) {
    v1::CreateLubricantRequest request;
    request.set_lubricant_id(id.empty() ? sheet.id : id);
    v1::Lubricant& out = *request.mutable_lubricant();
    out.set_base_oil_class(sheet.base_oil);
    auto& measured = *out.mutable_measurements();
    measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(sheet.kv40);
    measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(sheet.kv100);
    measured.set_density_15_celsius_kilograms_per_cubic_metre(sheet.density);
    if (pour_point) out.set_pour_point_celsius(*pour_point);
    if (friction) out.set_asperity_friction_coefficient(*friction);
    Application application = bench_.application();
    const auto made = create_lubricant(application, request);
    if (!made.ok()) throw std::runtime_error(complaints(made.error()));
    return made.message().name();
  }
  std::vector<std::string> add_all() {
    std::vector<std::string> out;
    for (const DataSheet& each : kOils) out.push_back(add(each));
    return out;
  }
  static void set_condition(double speed, double sump, v1::PointCondition& out) {
    out.set_speed_kilometres_per_hour(speed);
    out.set_sump_temperature_celsius(sump);
  }
  v1::ComparePointsResponse compared(const std::vector<std::string>& oils, double speed,
                                     double sump, const v1::ModelOptions& options = {}) {
    v1::ComparePointsRequest request;
    for (const std::string& each : oils) request.add_lubricants(each);
    set_condition(speed, sump, *request.add_conditions());
    *request.mutable_model_options() = options;
    Application application = bench_.application();
    const auto out = compare_points(application, request);
    if (!out.ok()) throw std::runtime_error(complaints(out.error()));
    return out.message();
  }
  v1::RankCandidatesResponse ranked(const std::vector<std::string>& oils, double speed, double sump,
                                    const v1::ModelOptions& options = {}) {
    v1::Campaign campaign;
    for (const std::string& each : oils) campaign.add_candidate_lubricants(each);
    set_condition(speed, sump, *campaign.add_conditions());
    *campaign.mutable_model_options() = options;
    const std::string name = create(campaign);
    EXPECT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
    v1::RankCandidatesRequest request;
    request.set_name(name);
    Application application = bench_.application();
    const auto out = rank_candidates(application, request);
    if (!out.ok()) throw std::runtime_error(complaints(out.error()));
    return out.message();
  }
};

v1::ModelOptions paper() {
  v1::ModelOptions out;
  out.set_preset(v1::ModelOptions::PAPER);
  return out;
}

TEST_F(Verdicts, OfAComparisonAndOfACampaignAreTheSame) {
  const std::vector<std::string> oils = add_all();
  int ties = 0, told = 0;
  for (const double speed : {30.0, 100.0}) {
    const v1::RankCandidatesResponse ranking = ranked(oils, speed, 60);
    ASSERT_EQ(ranking.candidates_size(), 4);
    const std::string best = oils[static_cast<std::size_t>(ranking.candidates(0).candidate())];
    std::vector<std::string> ordered;
    for (const auto& each : ranking.candidates()) {
      ordered.push_back(oils[static_cast<std::size_t>(each.candidate())]);
    }
    const v1::ComparePointsResponse comparison = compared(ordered, speed, 60);
    for (int i = 1; i < 4; ++i) {
      SCOPED_TRACE(ordered[static_cast<std::size_t>(i)]);
      const v1::ComparedLubricant& one = comparison.lubricants(i);
      const v1::CandidateComparison& other = ranking.candidates(i).comparison();
      EXPECT_NEAR(one.mean_inefficiency_percent().value(), ranking.candidates(i).value(),
                  2e-3 * ranking.candidates(i).value());
      EXPECT_NEAR(one.mean_inefficiency_percent().standard_uncertainty(),
                  other.standard_uncertainty(), 0.1 * other.standard_uncertainty());
      const double p = 1 - one.mean_difference().lower_probability();
      EXPECT_NEAR(other.worse_probability(), p,
                  3.3 * std::sqrt(2 * p * (1 - p) / comparison.draws()) + 0.01);
      const auto verdict = one.mean_difference().verdict();
      if (p > 0.99 || p < 0.95) {  // within sampling error of the threshold either may be said
        EXPECT_EQ(other.tied(), verdict == v1::ComparedDifference::CANNOT_BE_TOLD_APART);
      }
      ++(other.tied() ? ties : told);
    }
  }
  EXPECT_GT(ties, 0);
  EXPECT_GT(told, 0);
}

TEST_F(Verdicts, NameWhatWouldTellTwoOilsApart) {
  const std::vector<std::string> oils = add_all();
  int named = 0;
  for (std::size_t first = 0; first < oils.size(); ++first) {
    std::vector<std::string> turned = oils;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
    for (const double speed : {20.0, 100.0}) {
      const v1::ComparePointsResponse answer = compared(turned, speed, 60);
      for (const v1::ComparedLubricant& each : answer.lubricants()) {
        const v1::ComparedDifference& out = each.mean_difference();
        if (out.deciding_inputs().empty()) continue;
        ++named;
        EXPECT_EQ(out.verdict(), v1::ComparedDifference::CANNOT_BE_TOLD_APART);
        for (const v1::DecidingInput& input : out.deciding_inputs()) {
          EXPECT_GE(input.factor(), 0.05);
          EXPECT_LT(input.factor(), 1);
          // Known so much better, the linear model's interval leaves out 0.
          double variance = 0;
          for (const v1::InputShare& share : out.shares()) {
            const bool is_it = share.input() == input.input() &&
                               share.lubricant_revision() == input.lubricant_revision();
            variance += share.effect() * share.effect() * (is_it ? 0 : 1);
          }
          if (!out.all_needed()) {
            EXPECT_LT(1.96 * std::sqrt(variance), std::abs(out.difference_percent().value()));
          }
        }
      }
    }
  }
  EXPECT_GT(named, 0);
}

TEST_F(Verdicts, AreWithheldInTheColdByEveryMethodWithoutInletHeating) {
  const std::vector<std::string> oils = add_all();
  for (const double speed : {20.0, 60.0, 120.0}) {
    SCOPED_TRACE(speed);
    const v1::ComparePointsResponse comparison = compared(oils, speed, -20, paper());
    for (const v1::ComparedLubricant& each : comparison.lubricants()) {
      if (!each.points(0).refusal_reason().empty()) continue;
      EXPECT_TRUE(std::isnan(each.best_probability()));
      std::set<std::string> codes;
      for (const auto& warning : each.points(0).warnings()) codes.insert(warning.code());
      EXPECT_THAT(codes, Contains("INLET_HEATING_LEFT_OUT"));
      if (each.differences_size() > 0 && each.differences(0).has_difference_percent()) {
        EXPECT_EQ(each.differences(0).verdict(), v1::ComparedDifference::WITHHELD);
      }
    }
    const v1::RankCandidatesResponse ranking = ranked(oils, speed, -20, paper());
    EXPECT_EQ(ranking.withheld(), ranking.ranked());
    for (const auto& each : ranking.candidates()) {
      EXPECT_TRUE(each.verdict_withheld());
      EXPECT_FALSE(each.has_comparison());
    }
  }
  Application application = bench_.application();
  v1::ExplainPointsRequest explanation;
  explanation.set_lubricant(oils[0]);
  explanation.set_other_lubricant(oils[1]);
  set_condition(60, -20, *explanation.add_conditions());
  *explanation.mutable_model_options() = paper();
  std::set<std::string> codes;
  const auto explained = explain_points(application, explanation);
  ASSERT_TRUE(explained.ok());
  for (const auto& each : explained.message().points(0).warnings()) codes.insert(each.code());
  EXPECT_THAT(codes, Contains("INLET_HEATING_LEFT_OUT"));

  v1::EvaluateRigRequest rig;
  rig.set_lubricant(oils[2]);
  rig.set_radius_x_metres(0.0127);
  *rig.mutable_model_options() = paper();
  v1::RigCondition& condition = *rig.add_conditions();
  condition.set_load_newtons(38);
  condition.set_entrainment_speed_metres_per_second(2);
  condition.set_supply_temperature_celsius(-20);
  codes.clear();
  const auto run = evaluate_rig(application, rig, CallContext());
  ASSERT_TRUE(run.ok());
  for (const auto& each : run.message().range_warnings()) codes.insert(each.code());
  EXPECT_THAT(codes, Contains("INLET_HEATING_LEFT_OUT"));
}

TEST_F(Verdicts, OfACampaignNameTheConditionsThatAWarningConcerns) {
  v1::Campaign campaign;
  campaign.add_candidate_lubricants(add(kOils[0]));
  set_condition(30, 90, *campaign.add_conditions());
  set_condition(60, -20, *campaign.add_conditions());
  set_condition(120, -20, *campaign.add_conditions());
  *campaign.mutable_model_options() = paper();
  v1::RankCandidatesRequest request;
  request.set_name(create(campaign));
  ASSERT_TRUE(reaches(request.name(), v1::Campaign::SUCCEEDED));
  Application application = bench_.application();
  const auto ranking = rank_candidates(application, request);
  ASSERT_TRUE(ranking.ok());
  std::string where;
  for (const auto& each : ranking.message().warnings()) {
    if (each.code() == "INLET_HEATING_LEFT_OUT") where = each.where();
  }
  EXPECT_THAT(where, testing::AllOf(testing::HasSubstr("60 to 120 km/h"),
                                    testing::HasSubstr("sump -20 C")));
}

TEST_F(Verdicts, OfAThinPaoOverAThickMineralOilHoldOnTheMotorwayInTheCold) {
  // 75W-90 PAO against an 85W-140 at a sump of 10 C and 120 km/h.
  const std::string thin =
      add({"x", 102, 15.1, 870, v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN}, {}, {}, "thin");
  const std::string thick =
      add({"x", 328, 25.3, 910, v1::Lubricant::BASE_OIL_CLASS_GROUP_I}, {}, {}, "thick");
  const v1::ComparePointsResponse comparison = compared({thin, thick}, 120, 10);
  EXPECT_GT(comparison.lubricants(1).mean_difference().difference_percent().value(), 0);
  const v1::RankCandidatesResponse ranking = ranked({thick, thin}, 120, 10);
  EXPECT_EQ(ranking.candidates(0).candidate(), 1);
  EXPECT_FALSE(ranking.candidates(0).verdict_withheld());
}

TEST_F(Verdicts, SeeThatThickerOilLosesMoreInTheCold) {
  const std::vector<std::string> oils = add_all();
  v1::EvaluatePointsRequest request;
  request.set_lubricant(oils[0]);
  set_condition(100, -20, *request.add_conditions());
  request.add_elasticity_parameters("lubricant.vogel_viscosity_prefactor_pascal_seconds");
  Application application = bench_.application();
  const auto with = evaluate_points(application, request);
  ASSERT_TRUE(with.ok()) << complaints(with.error());
  *request.mutable_model_options() = paper();
  const auto without = evaluate_points(application, request);
  ASSERT_TRUE(without.ok());
  EXPECT_GT(with.message().elasticities(0).values(0), 0);
  EXPECT_LT(without.message().elasticities(0).values(0), 0);
  EXPECT_TRUE(without.message().verdict_withheld(0));
  EXPECT_FALSE(with.message().verdict_withheld(0));
}

TEST_F(Verdicts, ListAnOilBelowItsPourPointWithTheReason) {
  const std::vector<std::string> oils = {add(kOils[0]), add(kOils[2], -12.0)};
  const v1::ComparePointsResponse comparison = compared(oils, 60, -20);
  EXPECT_EQ(comparison.lubricants(0).points(0).refusal_reason(), "");
  EXPECT_EQ(comparison.lubricants(1).points(0).refusal_reason(), "BELOW_POUR_POINT");
  const v1::RankCandidatesResponse ranking = ranked(oils, 60, -20);
  EXPECT_EQ(ranking.candidates_size(), 1);
  ASSERT_EQ(ranking.refused_candidates_size(), 1);
  EXPECT_EQ(ranking.refused_candidates(0).candidate(), 1);
  EXPECT_EQ(ranking.refused_candidates(0).refusal().reason(), "BELOW_POUR_POINT");
  v1::Simulation simulation = point_simulation();
  simulation.set_lubricant(oils[1]);
  simulation.set_sump_temperature_celsius(-20);
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = simulation;
  Application application = bench_.application();
  EXPECT_FALSE(create_simulation(application, request).ok());
  request.mutable_simulation()->set_sump_temperature_celsius(-12);
  EXPECT_TRUE(create_simulation(application, request).ok());
}

TEST_F(Verdicts, TellTwoAdditivePackagesOnOneBaseOilApart) {
  const std::vector<std::string> oils = {add(kOils[2], {}, 0.17, "plain"),
                                         add(kOils[2], {}, 0.08, "modified")};
  const v1::ComparePointsResponse comparison = compared(oils, 30, 90);
  const v1::ComparedDifference& difference = comparison.lubricants(1).mean_difference();
  EXPECT_LT(difference.difference_percent().value(), -0.2);
  EXPECT_EQ(difference.verdict(), v1::ComparedDifference::LOWER);
  const v1::RankCandidatesResponse ranking = ranked(oils, 30, 90);
  EXPECT_EQ(ranking.candidates(0).candidate(), 1);
  EXPECT_FALSE(ranking.candidates(1).comparison().tied());
}

TEST_F(Verdicts, LeaveOutOilsWhoseUncertaintyNobodyStated) {
  v1::CreateLubricantRequest request;
  request.set_lubricant_id("exact");
  v1::Lubricant exact = seed<v1::Lubricant>("lubricants/paper-fluid-2");
  exact.clear_name();
  for (auto& each : *exact.mutable_provenance()) each.clear_standard_uncertainty();
  *request.mutable_lubricant() = exact;
  Application application = bench_.application();
  ASSERT_TRUE(create_lubricant(application, request).ok());
  const v1::ComparePointsResponse comparison = compared(
      {"lubricants/paper-fluid-1", "lubricants/exact", "lubricants/paper-fluid-3"}, 60, 40);
  EXPECT_TRUE(comparison.lubricants(0).uncertainty_stated());
  EXPECT_FALSE(comparison.lubricants(1).uncertainty_stated());
  EXPECT_TRUE(std::isnan(comparison.lubricants(1).best_probability()));
  EXPECT_NEAR(
      comparison.lubricants(0).best_probability() + comparison.lubricants(2).best_probability(), 1,
      1e-12);
  EXPECT_EQ(comparison.lubricants(1).mean_difference().verdict(),
            v1::ComparedDifference::UNCERTAINTY_NOT_STATED);
  EXPECT_FALSE(comparison.not_included().empty());
}

}  // namespace
}  // namespace tribodyn::server
