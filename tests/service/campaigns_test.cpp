// Campaigns: many candidates at many conditions, computed in tiles that outlive the process.
#include "server/application/campaigns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/points.h"
#include "server/application/simulations.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/campaign_inputs.h"
#include "server/storage/campaign_suspects.h"
#include "server/storage/maintenance.h"
#include "tests/service/campaign_fixture.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(CampaignTest, HasTheBitsOfEvaluatePoints) {
  const v1::Campaign campaign = campaign_of(100);
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  v1::EvaluatePointsRequest points;
  points.set_lubricant(campaign.lubricant());
  *points.mutable_candidate_columns() = campaign.candidate_columns();
  *points.mutable_conditions() = campaign.conditions();
  Application application = bench_.application();
  const auto expected = evaluate_points(application, points);
  ASSERT_TRUE(expected.ok());
  const Table table = read(name);
  EXPECT_EQ(table.size(), kCampaignColumns.size());
  const v1::EvaluatePointsResponse& figures = expected.message();
  const auto expect_column = [&](const std::string& column, const auto& values) {
    EXPECT_TRUE(have_equal_bits(table.at(column), {values.begin(), values.end()})) << column;
  };
  expect_column("refusal_number", figures.refusal_numbers());
  expect_column("pinion_torque_newton_metres", figures.pinion_torque_newton_metres());
  expect_column("wheel_torque_newton_metres", figures.wheel_torque_newton_metres());
  expect_column("inefficiency_rms_percent", figures.inefficiency_rms_percent());
  expect_column("inefficiency_energy_mean_percent", figures.inefficiency_energy_mean_percent());
  expect_column("mesh_loss_power_watts", figures.mesh_loss_power_watts());
  expect_column("dynamic_transmission_error_minimum_metres",
                figures.dynamic_transmission_error_minimum_metres());
  expect_column("dynamic_transmission_error_maximum_metres",
                figures.dynamic_transmission_error_maximum_metres());
  expect_column("contact_loss", figures.contact_loss());
  expect_column("settled", figures.settled());
  expect_column("period_in_mesh_cycles", figures.period_in_mesh_cycles());
  expect_column("estimated_relative_error", figures.estimated_relative_error());
  expect_column("model", figures.model());
  expect_column("responses_coexist", figures.responses_coexist());
}

TEST_F(CampaignTest, ColumnsOnRequestHaveTheBitsOfEvaluatePoints) {
  v1::Campaign campaign = campaign_of(10);
  campaign.set_contact_figures(true);
  campaign.add_elasticity_parameters("lubricant.relaxation_time_seconds");
  campaign.add_elasticity_parameters("surface.asperity_friction_coefficient");
  campaign.add_elasticity_figures("inefficiency_energy_mean_percent");
  campaign.add_elasticity_figures("film_ratio_mean");
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  v1::EvaluatePointsRequest points;
  points.set_lubricant(campaign.lubricant());
  *points.mutable_candidate_columns() = campaign.candidate_columns();
  *points.mutable_conditions() = campaign.conditions();
  points.set_contact_figures(true);
  *points.mutable_elasticity_parameters() = campaign.elasticity_parameters();
  *points.mutable_elasticity_figures() = campaign.elasticity_figures();
  Application application = bench_.application();
  const auto expected = evaluate_points(application, points);
  ASSERT_TRUE(expected.ok());
  const Table table = read(name);
  EXPECT_EQ(table.size(), kCampaignColumns.size() + kContactFigureColumns.size() + 5);
  const v1::EvaluatePointsResponse& figures = expected.message();
  const auto expect_column = [&](const std::string& column, const auto& values) {
    EXPECT_TRUE(have_equal_bits(table.at(column), {values.begin(), values.end()})) << column;
  };
  expect_column("mesh_loss_power_watts", figures.mesh_loss_power_watts());
  expect_column("film_ratio_minimum", figures.film_ratio_minimum());
  expect_column("film_ratio_mean", figures.film_ratio_mean());
  expect_column("contact_temperature_maximum_kelvin", figures.contact_temperature_maximum_kelvin());
  expect_column("contact_temperature_mean_kelvin", figures.contact_temperature_mean_kelvin());
  expect_column("viscous_loss_power_watts", figures.viscous_loss_power_watts());
  expect_column("boundary_loss_power_watts", figures.boundary_loss_power_watts());
  expect_column("mean_friction_coefficient", figures.mean_friction_coefficient());
  expect_column("maximum_pressure_maximum_pascals", figures.maximum_pressure_maximum_pascals());
  expect_column("flash_temperature_rise_maximum_kelvin",
                figures.flash_temperature_rise_maximum_kelvin());
  expect_column("elasticities_one_sided", figures.elasticities_one_sided());
  ASSERT_EQ(figures.elasticities_size(), 4);
  for (const v1::ElasticityColumn& each : figures.elasticities()) {
    expect_column("elasticity." + each.figure() + "." + each.parameter(), each.values());
  }
}

TEST_F(CampaignTest, ARefusedRowHasNaNInColumnsOnRequest) {
  v1::Campaign campaign = campaign_of(1);
  campaign.set_contact_figures(true);
  campaign.add_elasticity_parameters("lubricant.relaxation_time_seconds");
  v1::CandidateColumn& column = *campaign.add_candidate_columns();
  column.set_path("lubricant.vogel_reference_temperature_kelvin");
  column.add_values(350);
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  for (const auto& [column_name, values] : read(name)) {
    if (column_name == "refusal_number") continue;
    for (const double value : values) EXPECT_TRUE(std::isnan(value)) << column_name;
  }
}

TEST_F(CampaignTest, ItsHashDependsOnTheColumnsOnRequest) {
  const v1::Campaign plain = campaign_of(1);
  v1::Campaign with_contact = plain, with_elasticities = plain;
  with_contact.set_contact_figures(true);
  with_elasticities.add_elasticity_parameters("lubricant.relaxation_time_seconds");
  const std::string hash = get(create(plain)).input_hash();
  EXPECT_NE(get(create(with_contact)).input_hash(), hash);
  EXPECT_NE(get(create(with_elasticities)).input_hash(), hash);
}

TEST_F(CampaignTest, TellsItsProgressAndWhatItRestsOn) {
  const std::string name = create(campaign_of(50));
  EXPECT_EQ(name, "campaigns/1");
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign done = get(name);
  EXPECT_EQ(done.candidates(), 50);
  EXPECT_EQ(done.points(), 300);
  EXPECT_EQ(done.points_done(), 300);
  EXPECT_EQ(done.points_refused(), 0);
  EXPECT_EQ(done.first_missing_row(), 300);
  EXPECT_GT(done.processor_seconds(), 0);
  EXPECT_EQ(done.lubricant_revision(), "lubricants/paper-fluid-1@1");
  EXPECT_EQ(done.input_hash().size(), 64U);
  EXPECT_TRUE(done.has_end_time());
  EXPECT_EQ(done.condition_weights_size(), 6);
  EXPECT_EQ(done.candidate_columns_size(), 0) << "view BASIC";
  const v1::Campaign whole = get(name, v1::CAMPAIGN_VIEW_FULL);
  EXPECT_EQ(whole.candidate_columns(0).values_size(), 50);
  EXPECT_EQ(whole.candidate_attributes(0).texts(1), "additive 1");
}

TEST_F(CampaignTest, ReadsColumnsOfCandidatesAndConditionsBesideFigures) {
  const v1::Campaign campaign = campaign_of(40);
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const Table all = read(name);
  const Table part =
      read(name,
           {"candidate", "condition", "sump_temperature_celsius", "inlet_temperature_rise_kelvin",
            "cost_euros_per_kilogram", "lubricant.pressure_viscosity_coefficient_per_pascal",
            "mesh_loss_power_watts"},
           71, 3);
  EXPECT_THAT(part.at("candidate"), ElementsAre(11, 12, 12));
  EXPECT_THAT(part.at("condition"), ElementsAre(5, 0, 1));
  EXPECT_THAT(part.at("sump_temperature_celsius"), ElementsAre(90, 40, 40));
  EXPECT_THAT(part.at("inlet_temperature_rise_kelvin"), ElementsAre(20, 20, 20));
  EXPECT_THAT(part.at("cost_euros_per_kilogram"), ElementsAre(13, 14, 14));
  EXPECT_EQ(part.at("lubricant.pressure_viscosity_coefficient_per_pascal")[1],
            campaign.candidate_columns(0).values(12));
  const auto& losses = all.at("mesh_loss_power_watts");
  EXPECT_THAT(part.at("mesh_loss_power_watts"), ElementsAre(losses[71], losses[72], losses[73]));
  v1::ReadCampaignRequest request;
  request.set_name(name);
  request.add_columns("mesh_loss_power_wats");
  request.set_start_row(241);
  EXPECT_THAT(complaints(open(request).error()),
              testing::AllOf(HasSubstr("did you mean \"mesh_loss_power_watts\"?"),
                             HasSubstr("start_row = 241; allowed: 0 to 240")));
}

TEST_F(CampaignTest, PausesWhenItsBudgetIsSpentAndContinuesWithTheSameBits) {
  const v1::Campaign whole = campaign_of(300);
  v1::Campaign limited = whole;
  limited.mutable_budget()->set_points(200);
  const std::string name = create(limited);
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  const v1::Campaign paused = get(name);
  EXPECT_EQ(paused.stop().reason(), "BUDGET_SPENT");
  EXPECT_GE(paused.points_done(), 200);
  EXPECT_LT(paused.points_done(), 1800);
  const Table early = read(name, {"refusal_number", "mesh_loss_power_watts"}, 1799, 1);
  EXPECT_THAT(early.at("refusal_number"), ElementsAre(kNotComputed));
  EXPECT_TRUE(std::isnan(early.at("mesh_loss_power_watts")[0]));
  v1::ResumeCampaignRequest more;
  more.mutable_budget()->set_points(0);
  ASSERT_TRUE(call(resume_campaign, name, more).ok());
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  EXPECT_EQ(get(name).points_done(), 1800);
  const std::string undisturbed = create(whole);
  ASSERT_TRUE(reaches(undisturbed, v1::Campaign::SUCCEEDED));
  EXPECT_EQ(get(undisturbed).input_hash(), get(name).input_hash());
  expect_equal_tables(read(name), read(undisturbed));
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(CampaignTest, ContinuesAfterARestartAtTheMissingRows) {
  const std::string name = create(campaign_of(2 * kThousand));
  ASSERT_TRUE(eventually([&] { return get(name).points_done() > 0; }));
  bench_.restart(quick_studies());
  const v1::Campaign restarted = get(name);
  EXPECT_GT(restarted.points_done(), 0);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign done = get(name);
  EXPECT_EQ(done.points_done(), 12 * kThousand);
  EXPECT_GT(done.processor_seconds(), restarted.processor_seconds());
  const std::string undisturbed = create(campaign_of(2 * kThousand));
  ASSERT_TRUE(reaches(undisturbed, v1::Campaign::SUCCEEDED));
  expect_equal_tables(read(name), read(undisturbed));
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(CampaignTest, AWatchHasEveryStateAndGrowingProgressUntilTheEnd) {
  const std::string name = create(campaign_of(3 * kThousand));
  const auto source = watch(name);
  auto event = next_event(*source);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind(), v1::CampaignEvent::STATE_CHANGE);
  EXPECT_EQ(event->state(), v1::Campaign::RUNNING);
  EXPECT_EQ(event->points(), 18 * kThousand);
  std::int32_t done = event->points_done();
  while (done < 2000) {
    event = next_event(*source);
    ASSERT_TRUE(event);
    EXPECT_EQ(event->kind(), v1::CampaignEvent::PROGRESS);
    EXPECT_GT(event->points_done(), done);
    EXPECT_LE(event->first_missing_row(), event->points_done());
    done = event->points_done();
    if (event->first_missing_row() == 0) continue;  // a later tile was written first
    const Table written = read(name, {"refusal_number"}, 0, event->first_missing_row());
    EXPECT_THAT(written.at("refusal_number"), testing::Each(0)) << "can be read";
  }
  ASSERT_TRUE(call<v1::PauseCampaignRequest>(pause_campaign, name).ok());
  do {
    event = next_event(*source);
    ASSERT_TRUE(event);
  } while (event->kind() == v1::CampaignEvent::PROGRESS);
  EXPECT_EQ(event->state(), v1::Campaign::PAUSED);
  EXPECT_EQ(event->stop().reason(), "PAUSE_REQUESTED");
  ASSERT_TRUE(call<v1::ResumeCampaignRequest>(resume_campaign, name).ok());
  std::optional<v1::CampaignEvent> last;
  while ((event = next_event(*source))) last = event;
  ASSERT_TRUE(last);
  EXPECT_EQ(last->state(), v1::Campaign::SUCCEEDED);
  EXPECT_EQ(last->first_missing_row(), 18 * kThousand);
  EXPECT_FALSE(next_event(*watch(name, last->version()))) << "the client has the end";
  event = next_event(*watch(name, last->version() - 1));
  ASSERT_TRUE(event);
  EXPECT_EQ(event->version(), last->version());
}

TEST_F(CampaignTest, AWatchEndsWithTheDeletion) {
  v1::Campaign limited = campaign_of(3 * kThousand);
  limited.mutable_budget()->set_points(100);
  const std::string name = create(limited);
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  const auto source = watch(name);
  v1::DeleteCampaignRequest request;
  request.set_cancel(true);
  ASSERT_TRUE(call(delete_campaign, name, request).ok());
  std::optional<v1::CampaignEvent> last;
  while (const auto event = next_event(*source)) last = event;
  ASSERT_TRUE(last);
  EXPECT_EQ(last->kind(), v1::CampaignEvent::DELETED);
  EXPECT_EQ(last->version(), 0);
}

TEST_F(CampaignTest, AWatchRefusesAVersionThatNoEventHas) {
  v1::WatchCampaignRequest request;
  request.set_after_version(-1);
  EXPECT_THAT(complaints(call(watch_campaign, create(campaign_of(1)), request).error()),
              HasSubstr("after_version = -1; allowed: 0 or more"));
}

TEST_F(CampaignTest, IsPausedAndResumedByRequest) {
  const std::string name = create(campaign_of(3 * kThousand));
  const auto paused = call<v1::PauseCampaignRequest>(pause_campaign, name);
  ASSERT_TRUE(paused.ok());
  ASSERT_EQ(paused.message().state(), v1::Campaign::PAUSED);
  EXPECT_EQ(paused.message().stop().reason(), "PAUSE_REQUESTED");
  for (int i = 0; i < 20; ++i) {  // whatever its parts do meanwhile
    ASSERT_TRUE(call<v1::ResumeCampaignRequest>(resume_campaign, name).ok());
    ASSERT_TRUE(call<v1::PauseCampaignRequest>(pause_campaign, name).ok());
  }
  EXPECT_LT(get(name).points_done(), 18 * kThousand);
  EXPECT_EQ(call<v1::ResumeCampaignRequest>(resume_campaign, name).message().state(),
            v1::Campaign::RUNNING);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  EXPECT_EQ(get(name).points_done(), 18 * kThousand);
  EXPECT_EQ(call<v1::ResumeCampaignRequest>(resume_campaign, name).error().code(),
            google::rpc::FAILED_PRECONDITION);
  EXPECT_EQ(call<v1::PauseCampaignRequest>(pause_campaign, name).message().state(),
            v1::Campaign::SUCCEEDED)
      << "it has ended";
}

TEST_F(CampaignTest, AReadMaskNamesTheFieldsOfAnAnswer) {
  v1::Campaign campaign = campaign_of(3);
  v1::CandidateColumn& glass = *campaign.add_candidate_columns();
  glass.set_path("lubricant.vogel_reference_temperature_kelvin");
  for (int i = 0; i < 3; ++i) glass.add_values(i == 1 ? 350 : 170);  // the second is refused
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign whole = get(name, v1::CAMPAIGN_VIEW_FULL);
  ASSERT_GT(whole.refusals_size(), 0);
  const auto answer = [&](std::initializer_list<const char*> paths, v1::CampaignView view = {}) {
    v1::GetCampaignRequest request;
    request.set_view(view);
    for (const char* path : paths) request.mutable_read_mask()->add_paths(path);
    return call(get_campaign, name, request);
  };
  EXPECT_EQ(answer({"*"}, v1::CAMPAIGN_VIEW_FULL).message().SerializeAsString(),
            whole.SerializeAsString());

  v1::Campaign expected;
  expected.set_state(v1::Campaign::SUCCEEDED);
  expected.set_points_refused(whole.points_refused());
  EXPECT_EQ(answer({"state", "points_refused"}).message().SerializeAsString(),
            expected.SerializeAsString());
  expected.Clear();
  for (const v1::CandidateColumn& column : whole.candidate_columns()) {
    expected.add_candidate_columns()->set_path(column.path());
  }
  EXPECT_EQ(answer({"candidate_columns.path"}).message().SerializeAsString(),
            expected.SerializeAsString())
      << "without a view, the mask alone decides";
  expected.clear_candidate_columns();
  *expected.mutable_refusals() = whole.refusals();
  expected.set_first_missing_row(whole.first_missing_row());
  EXPECT_EQ(answer({"refusals", "first_missing_row", "candidate_columns"}, v1::CAMPAIGN_VIEW_BASIC)
                .message()
                .SerializeAsString(),
            expected.SerializeAsString())
      << "a mask names fields of the view";

  v1::ListCampaignsRequest list;
  list.mutable_read_mask()->add_paths("name");
  list.mutable_read_mask()->add_paths("candidate_columns");
  Application application = bench_.application();
  const auto listed = list_campaigns(application, list);
  ASSERT_EQ(listed.message().campaigns_size(), 1);
  expected.Clear();
  expected.set_name(name);
  EXPECT_EQ(listed.message().campaigns(0).SerializeAsString(), expected.SerializeAsString());

  const char* complaint =
      "read_mask: \"stat\" is not a field of Campaign; did you mean \"state\"?\n";
  EXPECT_EQ(complaints(answer({"stat"}).error()), complaint);
  list.mutable_read_mask()->set_paths(0, "stat");
  EXPECT_EQ(complaints(list_campaigns(application, list).error()), complaint);
}

TEST_F(CampaignTest, CancelledKeepsItsRowsAndIsDeleted) {
  const std::string name = create(campaign_of(3000));
  ASSERT_TRUE(eventually([&] { return get(name).points_done() > 0; }));
  EXPECT_EQ(call<v1::DeleteCampaignRequest>(delete_campaign, name).error().code(),
            google::rpc::FAILED_PRECONDITION);
  ASSERT_EQ(call<v1::CancelCampaignRequest>(cancel_campaign, name).message().state(),
            v1::Campaign::CANCELLED);
  const v1::Campaign cancelled = get(name);
  EXPECT_GT(cancelled.points_done(), 0);
  // Of two tiles that run at the same time the second may be done alone.
  const std::vector<double> numbers = read(name, {"refusal_number"}).at("refusal_number");
  EXPECT_GE(std::count(numbers.begin(), numbers.end(), 0.0), cancelled.points_done());
  EXPECT_TRUE(call<v1::DeleteCampaignRequest>(delete_campaign, name).ok());
  EXPECT_EQ(call<v1::GetCampaignRequest>(get_campaign, name).error().code(),
            google::rpc::NOT_FOUND);
  const std::string running = create(campaign_of(3000));
  EXPECT_EQ(running, "campaigns/2") << "no name is given twice";
  v1::DeleteCampaignRequest request;
  request.set_cancel(true);
  EXPECT_TRUE(call(delete_campaign, running, request).ok());
  SQLite::Database raw = bench_.open_database();
  EXPECT_EQ(raw.execAndGet("SELECT count(*) FROM campaign_blobs").getInt(), 0);
}

/// A candidate that solidifies at the inlet says nothing about the others.
TEST_F(CampaignTest, RefusedRowsHaveAReasonAndDoNotStopIt) {
  v1::Campaign campaign = campaign_of(240);
  campaign.mutable_conditions()->DeleteSubrange(3, 3);  // those of 90 C
  campaign.clear_condition_weights();
  v1::CandidateColumn& vogel = *campaign.mutable_candidate_columns(1);
  vogel.set_path("lubricant.vogel_reference_temperature_kelvin");
  for (int i = 0; i < 240; ++i) vogel.set_values(i, i % 2 == 0 ? 150 : 350 + 0.01 * i);
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign done = get(name);
  EXPECT_EQ(done.points_refused(), 360);
  const Table table = read(name, {"refusal_number", "candidate", "mesh_loss_power_watts"});
  std::set<int> numbers;
  for (std::size_t i = 0; i < 720; ++i) {
    const int number = static_cast<int>(table.at("refusal_number")[i]);
    const bool is_refused = static_cast<int>(table.at("candidate")[i]) % 2 == 1;
    ASSERT_EQ(number > 0, is_refused) << i;
    ASSERT_EQ(std::isnan(table.at("mesh_loss_power_watts")[i]), is_refused) << i;
    if (!is_refused) continue;
    numbers.insert(number);
    ASSERT_LE(number, done.refusals_size());
    EXPECT_EQ(done.refusals(number - 1).reason(), "INVALID_AT_INLET");
    EXPECT_NE(done.refusals(number - 1).message(), "");
  }
  EXPECT_EQ(numbers.size(), 101U) << "a hundred sentences, and one for all others";
}

TEST_F(CampaignTest, MetricsCountItsPointsItsTilesAndItsEnd) {
  v1::Campaign campaign = campaign_of(kThousand);
  v1::CandidateColumn& vogel = *campaign.mutable_candidate_columns(1);
  vogel.set_path("lubricant.vogel_reference_temperature_kelvin");
  for (int i = 0; i < kThousand; ++i) vogel.set_values(i, i % 10 == 0 ? 390 : 150);
  create(campaign);
  const std::string cancelled = create(campaign_of(10 * kThousand));
  ASSERT_TRUE(call<v1::CancelCampaignRequest>(cancel_campaign, cancelled).ok());
  ASSERT_TRUE(reaches("campaigns/1", v1::Campaign::SUCCEEDED));
  ASSERT_TRUE(eventually([&] { return bench_.jobs().scheduler().occupancy().parts == 0; }));
  const StoredCampaign done = *bench_.store().numbered_campaign("default", 1);
  const StoredCampaign partly = *bench_.store().numbered_campaign("default", 2);
  ASSERT_EQ(done.points_refused, 6 * kThousand / 10);
  const std::int64_t refused = done.points_refused + partly.points_refused;
  const auto tiles = bench_.store().campaign_tiles(done.id).size() +
                     bench_.store().campaign_tiles(partly.id).size();
  const std::string text = bench_.jobs().metrics().text({});
  const auto line = [](const std::string& name, auto value) {
    return HasSubstr("\n" + name + " " + std::to_string(value) + "\n");
  };
  EXPECT_THAT(text, line("tribodyn_campaign_points_total{outcome=\"computed\"}",
                         done.points_done + partly.points_done - refused));
  EXPECT_THAT(text, line("tribodyn_campaign_points_total{outcome=\"refused\"}", refused));
  EXPECT_THAT(text, line("tribodyn_campaign_tiles_total", tiles));
  EXPECT_THAT(text, line("tribodyn_campaigns_ended_total{outcome=\"succeeded\"}", 1));
  EXPECT_THAT(text, line("tribodyn_campaigns_ended_total{outcome=\"cancelled\"}", 1));
  EXPECT_THAT(text, line("tribodyn_campaigns_ended_total{outcome=\"failed\"}", 0));
}

TEST_F(CampaignTest, TotalsAreOfTheCampaignsThatRunOrArePausedAlsoAfterARestart) {
  const auto totals = [&] { return bench_.jobs().campaigns().totals(); };
  const std::string name = create(campaign_of(3 * kThousand));
  const CampaignTotals all = totals();
  EXPECT_EQ(all.running, 1U);
  EXPECT_GT(all.points_left, 0);
  EXPECT_LE(all.points_left, 18 * kThousand);
  EXPECT_GT(all.seconds_left, 0);
  ASSERT_TRUE(call<v1::PauseCampaignRequest>(pause_campaign, name).ok());
  bench_.restart(quick_studies());
  const CampaignTotals paused = totals();
  EXPECT_EQ(paused.paused, 1U);
  EXPECT_EQ(paused.running, 0U);
  EXPECT_EQ(paused.points_left, 0) << "nothing is to be computed";
  v1::ResumeCampaignRequest small_budget;
  small_budget.mutable_budget()->set_points(get(name).points_done() + 1);
  ASSERT_TRUE(call(resume_campaign, name, small_budget).ok());
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  EXPECT_TRUE(eventually([&] { return totals().paused == 1; })) << "its budget is spent";
  v1::ResumeCampaignRequest no_budget;
  no_budget.mutable_budget();
  ASSERT_TRUE(call(resume_campaign, name, no_budget).ok());
  EXPECT_EQ(totals().paused, 0U);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  EXPECT_TRUE(eventually([&] { return totals().running == 0; }));
  EXPECT_EQ(totals().seconds_left, 0);
}

TEST_F(CampaignTest, TotalsHaveACampaignThatPausesAtItsBeginning) {
  const std::string name = create(campaign_of(3 * kThousand));
  ASSERT_TRUE(call<v1::PauseCampaignRequest>(pause_campaign, name).ok());
  ASSERT_TRUE(eventually([&] { return bench_.jobs().scheduler().occupancy().parts == 0; }));
  const std::int64_t id = bench_.store().numbered_campaign("default", 1)->id;
  bench_.store().change_campaign({.id = id, .to = CampaignState::kRunning});
  for (int i = 0; i < 3; ++i) bench_.store().begin_campaign(id);  // as processes that are lost
  bench_.restart(quick_studies());
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  EXPECT_TRUE(eventually([&] { return bench_.jobs().campaigns().totals().paused == 1; }));
  EXPECT_EQ(bench_.jobs().campaigns().totals().running, 0U);
}

TEST_F(CampaignTest, ARequestIdMakesOneCampaign) {
  const std::string name = create(campaign_of(10), "one");
  EXPECT_EQ(create(campaign_of(10), "one"), name);
  v1::Campaign other = campaign_of(10);
  other.mutable_candidate_attributes(1)->set_values(3, 99);
  const auto refused = try_create(other, "one");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message(), HasSubstr("differs in campaign.candidate_attributes"));
  EXPECT_NE(create(campaign_of(10)), name);
}

TEST_F(CampaignTest, ValidateOnlyStatesWhatItWouldTakeAndMakesNothing) {
  const auto preview = try_create(campaign_of(1000), "", true);
  ASSERT_TRUE(preview.ok());
  EXPECT_EQ(preview.message().name(), "");
  EXPECT_EQ(preview.message().points(), 6000);
  EXPECT_GT(preview.message().cost_estimate().processor_seconds(), 0.02);
  EXPECT_LT(preview.message().cost_estimate().processor_seconds(), 5);
  EXPECT_EQ(bench_.store().campaigns({.project = "default", .restrictions = {}, .limit = 10}).total,
            0);
}

TEST_F(CampaignTest, StatesAllViolationsAtOnce) {
  v1::Campaign wrong = campaign_of(4);
  wrong.set_lubricant("lubricants/paper-fluid-11");
  wrong.mutable_candidate_columns(1)->set_values(2, -1);
  wrong.mutable_candidate_attributes(0)->add_texts("one too many");
  wrong.mutable_candidate_attributes(1)->set_name("mesh_loss_power_watts");
  wrong.mutable_condition_weights()->RemoveLast();
  wrong.mutable_budget()->set_processor_seconds(-1);
  EXPECT_THAT(
      complaint_lines(try_create(wrong).error()),
      testing::UnorderedElementsAre(
          HasSubstr("campaign.lubricant: "),
          HasSubstr("campaign.candidate_columns[1].values[2]: asperity_friction_coefficient = -1"),
          HasSubstr("campaign.candidate_attributes[0]: 5 texts and 0 values; allowed: 4"),
          HasSubstr("campaign.candidate_attributes[1].name: \"mesh_loss_power_watts\" is the name "
                    "of another column"),
          HasSubstr("campaign.condition_weights: 5 weights"),
          HasSubstr("campaign.budget.processor_seconds: processor_seconds = -1")));
}

TEST_F(CampaignTest, WhatDecidesNoFigureIsChangedAfterItsEnd) {
  const std::string name = create(campaign_of(4));
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign before = get(name, v1::CAMPAIGN_VIEW_FULL);
  v1::UpdateCampaignRequest request;
  request.mutable_campaign()->set_name(name);
  request.mutable_campaign()->add_condition_weights(1);
  v1::CandidateAttribute& cost = *request.mutable_campaign()->add_candidate_attributes();
  cost.set_name("cost_euros_per_litre");
  for (int i = 0; i < 3; ++i) cost.add_values(i);
  request.mutable_update_mask()->add_paths("condition_weights");
  request.mutable_update_mask()->add_paths("candidate_attributes");
  Application application = bench_.application();
  const auto refused = update_campaign(application, request, CallContext());
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(complaints(refused.error()),
              testing::AllOf(testing::HasSubstr("campaign.condition_weights"),
                             testing::HasSubstr("campaign.candidate_attributes[0]")))
      << "one weight of six, three values of four";
  cost.add_values(3);
  request.mutable_campaign()->clear_condition_weights();
  ASSERT_TRUE(update_campaign(application, request, CallContext()).ok());
  const v1::Campaign after = get(name, v1::CAMPAIGN_VIEW_FULL);
  EXPECT_TRUE(after.condition_weights().empty());
  ASSERT_EQ(after.candidate_attributes_size(), 1);
  EXPECT_EQ(after.candidate_attributes(0).name(), "cost_euros_per_litre");
  EXPECT_EQ(after.candidate_columns_size(), before.candidate_columns_size());
  EXPECT_EQ(after.input_hash(), before.input_hash());
  EXPECT_EQ(after.stored_bytes() - before.stored_bytes(),
            static_cast<std::int64_t>(after.ByteSizeLong()) -
                static_cast<std::int64_t>(before.ByteSizeLong()));
}

TEST_F(CampaignTest, ListsTheLatestFirstInPages) {
  for (int i = 0; i < 5; ++i) create(campaign_of(2));
  v1::ListCampaignsRequest request;
  request.set_page_size(2);
  std::vector<std::string> names;
  Application application = bench_.application();
  do {
    const auto page = list_campaigns(application, request);
    ASSERT_TRUE(page.ok());
    EXPECT_EQ(page.message().total_size(), 5);
    for (const auto& each : page.message().campaigns()) names.push_back(each.name());
    request.set_page_token(page.message().next_page_token());
  } while (!request.page_token().empty());
  EXPECT_THAT(names, ElementsAre("campaigns/5", "campaigns/4", "campaigns/3", "campaigns/2",
                                 "campaigns/1"));
}

TEST_F(CampaignTest, AnInteractiveSimulationRunsBesideIt) {
  create(campaign_of(20'000));
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  request.set_scheduling_class(v1::SCHEDULING_CLASS_INTERACTIVE);
  for (int i = 0; i < 5; ++i) {
    request.set_force(true);
    EXPECT_TRUE(bench_.reaches(bench_.create(request), v1::Simulation::SUCCEEDED));
  }
  EXPECT_EQ(get("campaigns/1").state(), v1::Campaign::RUNNING);
}

TEST_F(CampaignTest, ItsPrincipalsQuotaHoldsForItsEstimate) {
  v1::CreateCampaignRequest request;
  *request.mutable_campaign() = campaign_of(20'000);
  Application application = bench_.application();
  CallContext call;
  auto grant = std::make_shared<Grant>();
  grant->principal = "anna";
  grant->quota.processor_hours = 1e-4;
  call.grant = grant;
  const auto refused = create_campaign(application, request, call);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code(), google::rpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(refused.error().message(), HasSubstr("processor hours of simulations and campaigns"));
}

TEST_F(CampaignTest, CountsWithTheSimulationsOfItsPrincipalAndWhenItIsResumed) {
  v1::CreateCampaignRequest request;
  *request.mutable_campaign() = campaign_of(20'000);
  request.set_validate_only(true);
  Application application = bench_.application();
  CallContext call;
  auto grant = std::make_shared<Grant>();
  grant->principal = "anna";
  call.grant = grant;
  v1::CreateSimulationRequest simulation;
  *simulation.mutable_simulation() = long_simulation();
  simulation.set_force(true);
  simulation.set_validate_only(true);
  const auto seconds_of = [](const auto& preview) {
    return preview.message().cost_estimate().processor_seconds();
  };
  const double cost = seconds_of(create_campaign(application, request, call));
  const double more = seconds_of(create_simulation(application, simulation, call));
  grant->quota.processor_hours = (cost + 0.5 * std::min(cost, more)) / 3600;
  simulation.set_validate_only(false);
  request.set_validate_only(false);
  const auto first = create_campaign(application, request, call);
  ASSERT_TRUE(first.ok());
  const auto pause = [&](const std::string& name) {
    v1::PauseCampaignRequest out;
    out.set_name(name);
    return pause_campaign(application, out, call);
  };
  ASSERT_TRUE(pause(first.message().name()).ok());
  const auto second = create_campaign(application, request, call);
  ASSERT_TRUE(second.ok()) << "what is paused does not count";
  EXPECT_EQ(create_simulation(application, simulation, call).error().code(),
            google::rpc::RESOURCE_EXHAUSTED);
  v1::ResumeCampaignRequest resume;
  resume.set_name(first.message().name());
  EXPECT_EQ(resume_campaign(application, resume, call).error().code(),
            google::rpc::RESOURCE_EXHAUSTED);
  ASSERT_TRUE(pause(second.message().name()).ok());
  EXPECT_TRUE(resume_campaign(application, resume, call).ok());
}

TEST_F(CampaignTest, ExpiresAsSimulationsDo) {
  const std::string name = create(campaign_of(10));
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  EXPECT_GT(bench_.store().removable_bytes(), 0);
  EXPECT_GT(bench_.store().result_bytes("default"), 0);
  const std::string running = create(campaign_of(20'000));
  EXPECT_EQ(bench_.store().remove_oldest(system_time() + 1, 50).campaigns, 1);
  EXPECT_EQ(bench_.store().remove_oldest(system_time() + 1, 50).campaigns, 0);
  EXPECT_EQ(call<v1::GetCampaignRequest>(get_campaign, name).error().code(),
            google::rpc::NOT_FOUND);
  EXPECT_TRUE(call<v1::GetCampaignRequest>(get_campaign, running).ok());
}

TEST_F(CampaignTest, DamageIsFoundByReadersAndByTheCheck) {
  const std::string name = create(campaign_of(10));
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  bench_.open_database().exec("UPDATE campaign_blobs SET data = substr(data, 2) WHERE number = 5");
  EXPECT_THAT(check_database(bench_.database()), Contains(HasSubstr("campaigns/1: its tile")));
  EXPECT_THROW(read(name), StoreError);
  EXPECT_NO_THROW(read(name, {"pinion_torque_newton_metres"}));
}

TEST_F(CampaignTest, ACampaignThatKillsTheServerIsPaused) {
  v1::Campaign limited = campaign_of(20'000);
  limited.mutable_budget()->set_points(1);
  const std::string name = create(limited);
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  ASSERT_TRUE(eventually([&] { return bench_.jobs().scheduler().occupancy().parts == 0; }));
  const std::int64_t id = bench_.store().numbered_campaign("default", 1)->id;
  bench_.store().change_campaign({.id = id, .to = CampaignState::kRunning});
  for (int i = 0; i < 3; ++i) {  // as three processes that are lost
    EXPECT_EQ(bench_.store().begin_campaign(id)->state, CampaignState::kRunning);
  }
  const auto fourth = bench_.store().begin_campaign(id);
  EXPECT_EQ(fourth->state, CampaignState::kPaused);
  EXPECT_EQ(fourth->stop_reason, "WORKER_LOST");
}

TEST_F(CampaignTest, RowsAtWhichAProcessIsLostAreHalvedDownToOneCandidate) {
  v1::Campaign limited = campaign_of(20'000);
  limited.mutable_budget()->set_points(1);
  create(limited);
  ASSERT_TRUE(reaches("campaigns/1", v1::Campaign::PAUSED));
  ASSERT_TRUE(eventually([&] { return bench_.jobs().scheduler().occupancy().parts == 0; }));
  Store& store = bench_.store();
  const std::int64_t id = store.numbered_campaign("default", 1)->id;
  const auto suspects = [&] {
    std::vector<std::pair<std::int64_t, std::int64_t>> out;
    for (const CampaignSuspect& each : store.campaign_suspects(id)) {
      out.emplace_back(each.rows.first, each.rows.count);
    }
    return out;
  };
  const auto begin = [&] {  // as a process that starts does
    store.resume_campaigns();
    return store.begin_campaign(id);
  };
  store.change_campaign({.id = id, .to = CampaignState::kRunning, .budget = CampaignBudget()});
  ASSERT_EQ(begin()->lost_attempts, 1);
  store.begin_suspect(id, {6000, 18});  // three candidates
  EXPECT_EQ(begin()->lost_attempts, 1) << "the rows explain the loss";
  EXPECT_THAT(suspects(), ElementsAre(testing::Pair(6000, 6), testing::Pair(6006, 12)));
  store.begin_suspect(id, {6006, 12});
  begin();
  EXPECT_THAT(suspects(),
              ElementsAre(testing::Pair(6000, 6), testing::Pair(6006, 6), testing::Pair(6012, 6)));
  for (int i = 0; i < 3; ++i) {
    store.begin_suspect(id, {6006, 6});
    EXPECT_EQ(begin()->state, CampaignState::kRunning);
  }
  EXPECT_EQ(store.campaign_suspects(id)[1].lost_attempts, 3) << "nothing is left to halve";
  EXPECT_EQ(store.campaign_suspects(id)[0].lost_attempts, 0);
  NewTile tile;
  tile.rows = {6006, 6};
  tile.columns.assign(kCampaignColumns.size(), std::vector<double>(6, 1.5));
  ASSERT_TRUE(store.add_tile(id, tile, 1));
  EXPECT_THAT(suspects(), ElementsAre(testing::Pair(6000, 6), testing::Pair(6012, 6)));
  store.begin_suspect(id, {6000, 6});
  store.end_suspects(id);  // as a process that ends in good order
  begin();
  EXPECT_EQ(store.campaign_suspects(id)[0].lost_attempts, 0);
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
  for (int candidate = 0; candidate < kMaximumLostCandidates; ++candidate) {
    EXPECT_EQ(store.campaign(id)->state, CampaignState::kRunning) << candidate;
    for (int i = 0; i < 3; ++i) {
      store.begin_suspect(id, {9000 + 6 * candidate, 6});
      begin();
    }
  }
  const StoredCampaign paused = *store.campaign(id);
  EXPECT_EQ(paused.state, CampaignState::kPaused);
  EXPECT_EQ(paused.stop_reason, "WORKER_LOST");
  EXPECT_THAT(paused.stop_message, HasSubstr("11 candidates"));
}

/// Two tiles never have a row in common, and none is added to a campaign that has ended.
TEST_F(CampaignTest, TheStoreTakesEachRowOnce) {
  v1::Campaign limited = campaign_of(1000);
  limited.mutable_budget()->set_points(1);
  create(limited);
  ASSERT_TRUE(reaches("campaigns/1", v1::Campaign::PAUSED));
  ASSERT_TRUE(eventually([&] { return bench_.jobs().scheduler().occupancy().parts == 0; }));
  Store& store = bench_.store();
  const StoredCampaign campaign = *store.numbered_campaign("default", 1);
  NewTile tile;
  tile.rows = {5994, 6};
  tile.columns.assign(kCampaignColumns.size(), std::vector<double>(6, 1.5));
  ASSERT_TRUE(store.add_tile(campaign.id, tile, 1));
  EXPECT_EQ(store.add_tile(campaign.id, tile, 1), std::nullopt);
  EXPECT_EQ(store.campaign(campaign.id)->points_done, campaign.points_done + 6);
  std::vector<double> values(8, -7);
  store.read_campaign(campaign.id, 3, 5992, values);
  EXPECT_THAT(values, ElementsAre(-7, -7, 1.5, 1.5, 1.5, 1.5, 1.5, 1.5));
  store.change_campaign({.id = campaign.id, .to = CampaignState::kCancelled, .time = 2});
  tile.rows.first -= 6;
  EXPECT_EQ(store.add_tile(campaign.id, tile, 1), std::nullopt);
}

}  // namespace
}  // namespace tribodyn::server
