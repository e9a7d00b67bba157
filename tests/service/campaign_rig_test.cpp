// Campaigns of a rig: thousands of candidates at rig conditions, with the bits of EvaluateRig.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "server/application/campaign_decisions.h"
#include "server/application/rigs.h"
#include "server/simulation/campaign_columns.h"
#include "tests/service/campaign_fixture.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr char kAlphaOfRig[] = "lubricant.pressure_viscosity_coefficient_per_pascal";

/// A rough ball on a disc, at 2 temperatures x 2 loads x 1 speed x 3 slide-roll ratios.
v1::Campaign rig_campaign(int candidates) {
  v1::Campaign out;
  out.set_lubricant("lubricants/paper-fluid-1");
  out.set_surface("surfaces/run-in");
  v1::CampaignRig& rig = *out.mutable_rig();
  rig.set_radius_x_metres(0.0127);
  rig.set_composite_rms_height_metres(20e-9);
  v1::RigGrid& grid = *rig.mutable_grid();
  for (const double celsius : {40.0, 100.0}) grid.add_supply_temperatures_celsius(celsius);
  for (const double pressure : {0.6e9, 0.9e9}) grid.add_mean_pressures_pascals(pressure);
  grid.add_entrainment_speeds_metres_per_second(2);
  for (const double percent : {0.0, 5.0, 50.0}) grid.add_slide_roll_ratios_percent(percent);
  v1::CandidateColumn& alpha = *out.add_candidate_columns();
  alpha.set_path(kAlphaOfRig);
  v1::CandidateColumn& friction = *out.add_candidate_columns();
  friction.set_path("surface.asperity_friction_coefficient");
  v1::CandidateAttribute& names = *out.add_candidate_attributes();
  names.set_name("name");
  for (int i = 0; i < candidates; ++i) {
    alpha.add_values(1.2e-8 + 1e-8 * ((7 * i) % candidates) / candidates);
    friction.add_values(0.08 + 0.04 * (i % 7) / 7);
    names.add_texts(fmt::format("oil {}", i));
  }
  return out;
}

v1::EvaluateRigRequest request_of(const v1::Campaign& campaign, const std::string& lubricant,
                                  const std::string& surface) {
  const v1::CampaignRig& rig = campaign.rig();
  v1::EvaluateRigRequest out;
  out.set_lubricant(lubricant);
  out.set_surface(surface);
  out.set_radius_x_metres(rig.radius_x_metres());
  out.set_composite_rms_height_metres(rig.composite_rms_height_metres());
  *out.mutable_conditions() = rig.conditions();
  if (rig.has_grid()) *out.mutable_grid() = rig.grid();
  return out;
}

class RigCampaign : public CampaignTest {
 protected:
  std::string run(const v1::Campaign& campaign) {
    std::string name = create(campaign);
    EXPECT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
    return name;
  }

  /// Expects that the rows of a candidate have the bits of a rig.
  void expect_rows(const Table& table, int candidate, const v1::EvaluateRigRequest& request) {
    Application application = bench_.application();
    const auto answer = evaluate_rig(application, request, CallContext());
    ASSERT_TRUE(answer.ok()) << complaints(answer.error());
    v1::EvaluateRigResponse figures = answer.message();
    const std::ptrdiff_t conditions = figures.traction_coefficient_size();
    const auto rows = [&](const std::string& column) {
      const auto begin = table.at(column).begin() + candidate * conditions;
      return std::vector<double>(begin, begin + conditions);
    };
    for (const RigColumn& each : rig_columns()) {
      const auto& expected = *(figures.*each.column)();
      EXPECT_TRUE(have_equal_bits(rows(std::string(each.name)), {expected.begin(), expected.end()}))
          << each.name << " of candidate " << candidate;
    }
    const auto& loads = figures.load_newtons();
    EXPECT_EQ(rows("load_newtons"), std::vector<double>(loads.begin(), loads.end()));
  }

  std::string refusal_of(const v1::Campaign& campaign) {
    const auto created = try_create(campaign);
    return created.ok() ? "" : complaints(created.error());
  }
};

std::vector<std::string> all_rig_columns() {
  std::vector<std::string> out{"refusal_number", "load_newtons"};
  for (const RigColumn& each : rig_columns()) out.emplace_back(each.name);
  return out;
}

TEST_F(RigCampaign, HasTheBitsOfEvaluateRigOfEveryLubricant) {
  v1::Campaign campaign = rig_campaign(1);
  campaign.clear_candidate_columns();
  campaign.clear_candidate_attributes();
  campaign.clear_lubricant();
  for (const char* name : {"paper-fluid-1", "paper-fluid-2", "shell-t9"}) {
    campaign.add_candidate_lubricants(fmt::format("lubricants/{}", name));
  }
  const Table table = read(run(campaign), all_rig_columns());
  for (int i = 0; i < campaign.candidate_lubricants_size(); ++i) {
    expect_rows(table, i,
                request_of(campaign, campaign.candidate_lubricants(i), "surfaces/run-in"));
  }
}

TEST_F(RigCampaign, HasTheBitsOfEvaluateRigOfAPromotedCandidate) {
  const v1::Campaign campaign = rig_campaign(9);
  const std::string name = run(campaign);
  Application application = bench_.application();
  v1::PromoteCandidateRequest promotion;
  promotion.set_name(name);
  promotion.set_candidate(5);
  promotion.set_lubricant_id("best");
  promotion.set_surface_id("its-surface");
  const auto promoted = promote_candidate(application, promotion);
  ASSERT_TRUE(promoted.ok()) << complaints(promoted.error());
  expect_rows(read(name, all_rig_columns()), 5,
              request_of(campaign, "lubricants/best", "surfaces/its-surface"));
}

TEST_F(RigCampaign, SmoothSpecimensHaveNoFilmRatioAndNoSurface) {
  v1::Campaign campaign = rig_campaign(3);
  campaign.clear_surface();
  campaign.mutable_rig()->clear_composite_rms_height_metres();
  EXPECT_THAT(refusal_of(campaign), HasSubstr("the specimens are smooth"));
  campaign.mutable_candidate_columns()->RemoveLast();
  const std::string name = run(campaign);
  const Table table = read(name, {"film_ratio"});
  for (const double ratio : table.at("film_ratio")) EXPECT_TRUE(std::isnan(ratio));
  const v1::Campaign done = get(name);
  EXPECT_EQ(done.lubricant_revision(), "lubricants/paper-fluid-1@1");
  EXPECT_EQ(done.surface_revision() + done.gear_set_revision() + done.vehicle_revision(), "");
  EXPECT_EQ(done.points(), 36);
}

TEST_F(RigCampaign, TellsAllFieldsOfTheAxleByName) {
  v1::Campaign campaign = rig_campaign(2);
  campaign.set_gear_set("gearSets/reference-axle");
  campaign.set_vehicle("vehicles/passenger-car");
  campaign.set_tolerance(1e-3);
  campaign.set_contact_figures(true);
  campaign.add_elasticity_parameters("lubricant.relaxation_time_seconds");
  campaign.add_elasticity_figures("film_ratio_mean");
  campaign.add_conditions()->set_speed_kilometres_per_hour(50);
  campaign.add_condition_weights(1);
  campaign.mutable_rig()->set_radius_x_metres(-1);
  campaign.mutable_rig()->mutable_grid()->set_mean_pressures_pascals(1, 1);
  campaign.mutable_candidate_attributes(0)->set_name("load_newtons");
  campaign.add_candidate_columns()->set_path("surface.composite_rms_height_metres");
  campaign.mutable_candidate_columns(2)->add_values(1e-7);
  campaign.mutable_candidate_columns(2)->add_values(1e-7);
  const std::string text = refusal_of(campaign);
  for (const char* field :
       {"campaign.gear_set", "campaign.vehicle", "campaign.tolerance", "campaign.contact_figures",
        "campaign.elasticity_parameters", "campaign.elasticity_figures", "campaign.conditions",
        "campaign.condition_weights", "campaign.rig.radius_x_metres",
        "campaign.rig.grid.mean_pressures_pascals", "campaign.candidate_attributes[0].name",
        "campaign.candidate_columns[2].path"}) {
    EXPECT_THAT(text, HasSubstr(field));
  }
}

TEST_F(RigCampaign, RefusesMoreConditionsThanATileHolds) {
  v1::Campaign campaign = rig_campaign(2);
  v1::RigGrid& grid = *campaign.mutable_rig()->mutable_grid();
  for (int i = 0; i < 200; ++i) grid.add_slide_roll_ratios_percent(0.1 * i);
  for (int i = 0; i < 10; ++i) grid.add_entrainment_speeds_metres_per_second(1 + i);
  EXPECT_THAT(refusal_of(campaign), HasSubstr("combinations; allowed: at most 2000"));
}

TEST_F(RigCampaign, ARefusedRowStatesTheReasonOfEvaluateRig) {
  v1::Campaign campaign = rig_campaign(2);
  v1::CandidateColumn& column = *campaign.add_candidate_columns();
  column.set_path("lubricant.vogel_reference_temperature_kelvin");
  column.add_values(150);
  column.add_values(280);  // above the inlet of -10 C, below that of 100 C
  campaign.mutable_rig()->mutable_grid()->set_supply_temperatures_celsius(0, -10);
  const std::string name = run(campaign);
  const Table table = read(name, {"refusal_number", "traction_coefficient"});
  for (std::size_t row = 0; row < 24; ++row) {
    const bool is_refused = row >= 12 && row < 18;
    EXPECT_EQ(table.at("refusal_number")[row], is_refused ? 1 : 0) << row;
    EXPECT_EQ(std::isnan(table.at("traction_coefficient")[row]), is_refused) << row;
  }
  const v1::Campaign done = get(name);
  EXPECT_EQ(done.points_refused(), 6);
  ASSERT_EQ(done.refusals_size(), 1);
  EXPECT_EQ(done.refusals(0).reason(), "INVALID_AT_INLET");
}

TEST_F(RigCampaign, ItsHashIsThatOfItsInputs) {
  const v1::Campaign campaign = rig_campaign(2);
  const auto hash = [this](const v1::Campaign& each) {
    return try_create(each, "", true).message().input_hash();
  };
  v1::Campaign stated = campaign;
  stated.mutable_rig()->set_radius_y_metres(campaign.rig().radius_x_metres());
  EXPECT_EQ(hash(stated), hash(campaign));
  v1::Campaign other = campaign;
  other.mutable_rig()->mutable_grid()->set_slide_roll_ratios_percent(1, 6);
  EXPECT_NE(hash(other), hash(campaign));
  other = campaign;
  other.mutable_rig()->mutable_body_1()->set_youngs_modulus_pascals(1);
  EXPECT_THAT(refusal_of(other), HasSubstr("campaign.rig.body_1.youngs_modulus_pascals"));
  other = campaign;
  other.mutable_model_options()->set_isothermal(true);
  EXPECT_NE(hash(other), hash(campaign));
  // A grid is a short form of its conditions.
  v1::Campaign listed = campaign, loads = campaign;
  v1::RigGrid& grid = *loads.mutable_rig()->mutable_grid();
  grid.clear_mean_pressures_pascals();
  grid.add_loads_newtons(38);
  listed.mutable_rig()->clear_grid();
  for (const double celsius : grid.supply_temperatures_celsius()) {
    for (const double percent : grid.slide_roll_ratios_percent()) {
      v1::RigCondition& condition = *listed.mutable_rig()->add_conditions();
      condition.set_load_newtons(38);
      condition.set_entrainment_speed_metres_per_second(2);
      condition.set_slide_roll_ratio_percent(percent);
      condition.set_supply_temperature_celsius(celsius);
    }
  }
  EXPECT_EQ(hash(listed), hash(loads));
}

TEST_F(RigCampaign, ContinuesAfterARestartInTheMiddleWithTheSameBits) {
  const std::string undisturbed = run(rig_campaign(700));
  v1::Campaign campaign = rig_campaign(700);
  campaign.mutable_budget()->set_points(3000);
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  EXPECT_LT(get(name).points_done(), 8400);
  bench_.restart(quick_studies());
  v1::ResumeCampaignRequest go_on;
  go_on.mutable_budget();
  ASSERT_TRUE(call(resume_campaign, name, go_on).ok());
  bench_.restart(quick_studies());  // while it runs, or just after
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  expect_equal_tables(read(name), read(undisturbed));
}

TEST_F(RigCampaign, FurtherCandidatesHaveTheBitsOfACampaignWithAll) {
  const v1::Campaign whole = rig_campaign(20);
  v1::Campaign part = whole;
  v1::AppendCandidatesRequest rest;
  for (int i = 0; i < 2; ++i) {
    auto& values = *part.mutable_candidate_columns(i)->mutable_values();
    v1::CandidateColumn& further = *rest.add_candidate_columns();
    further.set_path(part.candidate_columns(i).path());
    further.mutable_values()->Assign(values.begin() + 12, values.end());
    values.Truncate(12);
  }
  auto& texts = *part.mutable_candidate_attributes(0)->mutable_texts();
  v1::CandidateAttribute& names = *rest.add_candidate_attributes();
  names.set_name("name");
  for (int i = 12; i < 20; ++i) names.add_texts(texts[i]);
  texts.DeleteSubrange(12, 8);
  const std::string name = run(part);
  ASSERT_TRUE(call(append_candidates, name, rest).ok());
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const std::string all = run(whole);
  expect_equal_tables(read(name), read(all));
  EXPECT_EQ(get(name).input_hash(), get(all).input_hash());
}

TEST_F(RigCampaign, RowsAreFilteredByFiguresAndConditions) {
  const std::string name = run(rig_campaign(5));
  const Table table =
      read(name, {"slide_roll_ratio_percent", "supply_temperature_celsius", "candidate"}, 0, 0,
           "slide_roll_ratio_percent = 5 AND supply_temperature_celsius > 60 AND candidate = 3 AND "
           "traction_coefficient > 0");
  EXPECT_EQ(table.at("slide_roll_ratio_percent"), (std::vector<double>{5, 5}));
  EXPECT_EQ(table.at("supply_temperature_celsius"), (std::vector<double>{100, 100}));
}

TEST_F(RigCampaign, CandidatesAreRankedByTheirTraction) {
  const v1::Campaign campaign = rig_campaign(30);
  const std::string name = run(campaign);
  const std::vector<double> traction = read(name).at("traction_coefficient");
  std::vector<double> means;
  for (std::size_t i = 0; i < 30; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < 12; ++k) sum += traction[12 * i + k] / 12;
    means.push_back(sum);
  }
  v1::RankCandidatesRequest request;
  request.set_count(30);
  v1::ParameterUncertainty& uncertain = *request.add_uncertainties();
  uncertain.set_parameter(kAlphaOfRig);
  uncertain.set_relative_uncertainty(0.05);
  const auto answer = call(rank_candidates, name, request);
  ASSERT_TRUE(answer.ok()) << complaints(answer.error());
  const v1::RankCandidatesResponse& ranking = answer.message();
  ASSERT_EQ(ranking.candidates_size(), 30);
  std::vector<double> sorted = means;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < 30; ++i) {
    const v1::RankedCandidate& each = ranking.candidates(i);
    EXPECT_NEAR(each.value(), sorted[static_cast<std::size_t>(i)], 1e-15);
    EXPECT_FALSE(each.has_solver_error());
  }
  EXPECT_THAT(ranking.own_uncertain_parameters(), ElementsAre(kAlphaOfRig));
  EXPECT_GT(ranking.candidates(0).comparison().standard_uncertainty(), 0);
  EXPECT_TRUE(ranking.candidates(0).comparison().tied());
  EXPECT_FALSE(ranking.candidates(29).comparison().tied());
}

TEST_F(RigCampaign, EffectsAreThoseOnTheTraction) {
  const std::string name = run(rig_campaign(30));
  const auto answer = call<v1::EstimateCandidateEffectsRequest>(estimate_candidate_effects, name);
  ASSERT_TRUE(answer.ok()) << complaints(answer.error());
  EXPECT_EQ(answer.message().effects_size(), 2);
  EXPECT_GT(answer.message().explained_share(), 0.9);
}

/// A campaign of the axle with the candidates of one of a rig.
v1::Campaign on_the_axle(v1::Campaign campaign) {
  campaign.clear_rig();
  for (const double speed : {30.0, 110.0}) {
    campaign.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  return campaign;
}

TEST_F(RigCampaign, ItsFiguresStandBesideThoseOfTheAxleInDecisions) {
  const v1::Campaign campaign = rig_campaign(25);
  const std::string rig = run(campaign), axle = run(on_the_axle(campaign));
  v1::FindParetoCandidatesRequest request;
  v1::CandidateFigure& traction = *request.mutable_second()->mutable_figure();
  traction.set_campaign("projects/default/" + rig);
  traction.set_column("traction_coefficient");
  traction.set_aggregate(v1::CandidateFigure::MAXIMUM);
  request.set_beaten_count(25);
  const auto answer = call(find_pareto_candidates, axle, request);
  ASSERT_TRUE(answer.ok()) << complaints(answer.error());
  const v1::FindParetoCandidatesResponse& front = answer.message();
  EXPECT_EQ(front.candidates_size() + front.beaten_candidates_size(), 25);
  const std::vector<double> rows = read(rig).at("traction_coefficient");
  const std::vector<double> losses = read(axle).at("inefficiency_energy_mean_percent");
  for (const auto* part : {&front.candidates(), &front.beaten_candidates()}) {
    for (const v1::ParetoCandidate& each : *part) {
      const std::ptrdiff_t i = each.candidate();
      EXPECT_EQ(each.second_value(),
                *std::max_element(rows.begin() + 12 * i, rows.begin() + 12 * i + 12));
      EXPECT_NEAR(each.first_value(),
                  0.5 * (losses[static_cast<std::size_t>(2 * i)] +
                         losses[static_cast<std::size_t>(2 * i + 1)]),
                  1e-15);
    }
  }
  // A limit on the axle's loss, in a ranking by the rig.
  v1::RankCandidatesRequest ranking;
  v1::CandidateConstraint& limit = *ranking.add_constraints();
  limit.mutable_figure()->set_campaign(axle);
  limit.set_maximum(front.candidates(0).first_value());
  const auto ranked = call(rank_candidates, rig, ranking);
  ASSERT_TRUE(ranked.ok()) << complaints(ranked.error());
  ASSERT_EQ(ranked.message().ranked(), 1);
  EXPECT_EQ(ranked.message().excluded(), 24);
  EXPECT_EQ(ranked.message().candidates(0).candidate(), front.candidates(0).candidate());
}

TEST_F(RigCampaign, AFigureOfOtherCandidatesIsRefused) {
  const v1::Campaign campaign = rig_campaign(6);
  v1::Campaign others = on_the_axle(campaign);
  others.mutable_candidate_columns(0)->set_values(2, 1.5e-8);
  const std::string rig = run(campaign), axle = run(others);
  const auto complaint = [&](const std::string& other) {
    v1::FindParetoCandidatesRequest request;
    request.mutable_second()->mutable_figure()->set_campaign(other);
    const auto answer = call(find_pareto_candidates, rig, request);
    return answer.ok() ? "" : complaints(answer.error());
  };
  EXPECT_THAT(complaint(axle), HasSubstr("second.figure.campaign"));
  EXPECT_THAT(complaint(axle), HasSubstr("the candidates of campaigns/2 are not those"));
  EXPECT_THAT(complaint("campaigns/77"), HasSubstr("campaigns/77 does not exist"));
  EXPECT_THAT(complaint("projects/acme/campaigns/1"), HasSubstr("allowed: a campaign of"));
  EXPECT_THAT(complaint(rig), IsEmpty()) << "itself";
}

}  // namespace
}  // namespace tribodyn::server
