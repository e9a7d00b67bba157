// Candidates of campaigns that the server makes or that are lubricants, candidates that are added,
// labels, and rows that satisfy a condition.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "core/decisions/design.h"
#include "core/uncertainty/drawn_value.h"
#include "core/uncertainty/normal_draws.h"
#include "google/rpc/code.pb.h"
#include "server/application/campaign_decisions.h"
#include "server/application/points.h"
#include "server/storage/maintenance.h"
#include "tests/service/campaign_fixture.h"
#include "tests/service/resource_calls.h"
#include "tests/service/uncertain_fluids.h"

namespace tribodyn::server {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr char kRelaxationPath[] = "lubricant.relaxation_time_seconds";
constexpr char kFrictionPath[] = "surface.asperity_friction_coefficient";

/// A campaign at two conditions, without candidates.
v1::Campaign two_conditions() {
  v1::Campaign out;
  out.set_lubricant("lubricants/paper-fluid-1");
  for (const double speed : {40.0, 90.0}) {
    out.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  return out;
}

v1::DesignFactor factor_of(const std::string& parameter, double minimum, double maximum) {
  v1::DesignFactor out;
  out.set_parameter(parameter);
  out.set_minimum(minimum);
  out.set_maximum(maximum);
  return out;
}

v1::Campaign designed(v1::CandidateDesign::Method method, int count, int seed) {
  v1::Campaign out = two_conditions();
  v1::CandidateDesign& design = *out.mutable_candidate_design();
  design.set_method(method);
  design.set_count(count);
  design.set_seed(seed);
  *design.add_factors() = factor_of(kFrictionPath, 0.05, 0.12);
  v1::DesignFactor& relaxation = *design.add_factors() = factor_of(kRelaxationPath, 1e-7, 4e-7);
  relaxation.set_scale(v1::DesignFactor::LOGARITHMIC);
  return out;
}

std::vector<double> values_of(const v1::Campaign& campaign, const std::string& path) {
  for (const v1::CandidateColumn& each : campaign.candidate_columns()) {
    if (each.path() == path) return {each.values().begin(), each.values().end()};
  }
  ADD_FAILURE() << path;
  return {};
}

class CandidatesTest : public CampaignTest {
 protected:
  v1::Campaign whole(const std::string& name) { return get(name, v1::CAMPAIGN_VIEW_FULL); }

  /// Adds a lubricant like paper fluid 1, whose relaxation time is `factor` times as long.
  std::string add_lubricant(const std::string& id, double factor, double uncertainty = 0) {
    auto fluid = exact_seed<v1::Lubricant>("lubricants/paper-fluid-1");
    fluid.set_relaxation_time_seconds(factor * fluid.relaxation_time_seconds());
    fluid.set_display_name("Oil " + id);
    v1::Label& label = *fluid.add_labels();
    label.set_key("series");
    label.set_value("b");
    set_uncertainty(fluid, "relaxation_time_seconds", uncertainty);
    fluid.set_name("lubricants/" + id);
    v1::CreateLubricantRequest request;
    fluid.clear_name();
    *request.mutable_lubricant() = fluid;
    request.set_lubricant_id(id);
    Application application = bench_.application();
    const auto made = create_lubricant(application, request);
    if (!made.ok()) throw std::runtime_error(complaints(made.error()));
    return made.message().name();
  }

  Outcome<v1::Campaign> append(const std::string& name, const v1::AppendCandidatesRequest& stated) {
    return call(append_candidates, name, stated);
  }

  /// Candidates [first, last) of campaign_of(of).
  static v1::AppendCandidatesRequest part_of(int of, int first, int last) {
    v1::Campaign part = campaign_of(of);
    v1::AppendCandidatesRequest out;
    for (v1::CandidateColumn& each : *part.mutable_candidate_columns()) {
      v1::CandidateColumn& column = *out.add_candidate_columns();
      column.set_path(each.path());
      for (int i = first; i < last; ++i) column.add_values(each.values(i));
    }
    for (v1::CandidateAttribute& each : *part.mutable_candidate_attributes()) {
      v1::CandidateAttribute& attribute = *out.add_candidate_attributes();
      attribute.set_name(each.name());
      for (int i = first; i < last && !each.texts().empty(); ++i)
        attribute.add_texts(each.texts(i));
      for (int i = first; i < last && !each.values().empty(); ++i) {
        attribute.add_values(each.values(i));
      }
    }
    return out;
  }
  /// The first candidates of campaign_of(of).
  static v1::Campaign first_of(int of, int count) {
    v1::Campaign out = campaign_of(of);
    const v1::AppendCandidatesRequest part = part_of(of, 0, count);
    *out.mutable_candidate_columns() = part.candidate_columns();
    *out.mutable_candidate_attributes() = part.candidate_attributes();
    return out;
  }
};

TEST_F(CandidatesTest, ADesignHasTheNumbersOfItsAlgorithmWhateverTheTime) {
  for (const auto method : {v1::CandidateDesign::SOBOL, v1::CandidateDesign::LATIN_HYPERCUBE}) {
    const v1::Campaign first = whole(create(designed(method, 16, 7)));
    EXPECT_EQ(first.candidates(), 16);
    EXPECT_EQ(first.candidate_design().algorithm_version(), kDesignVersion);
    EXPECT_EQ(first.candidate_design().seed(), 7);
    const Eigen::MatrixXd shares = method == v1::CandidateDesign::SOBOL
                                       ? sobol_design(16, 2, 7)
                                       : latin_hypercube_design(16, 2, 7);
    for (int i = 0; i < 16; ++i) {
      EXPECT_EQ(values_of(first, kFrictionPath)[static_cast<std::size_t>(i)],
                value_in_range({0.05, 0.12}, shares(i, 0)));
      EXPECT_EQ(values_of(first, kRelaxationPath)[static_cast<std::size_t>(i)],
                value_in_range({1e-7, 4e-7, true}, shares(i, 1)));
    }
    const v1::Campaign again = whole(create(designed(method, 16, 7)));
    EXPECT_EQ(again.input_hash(), first.input_hash());
    EXPECT_NE(get(create(designed(method, 16, 8))).input_hash(), first.input_hash());
  }
}

TEST_F(CandidatesTest, AGridHasEveryCombinationTheLastFactorFastest) {
  v1::Campaign campaign = designed(v1::CandidateDesign::GRID, 0, 0);
  campaign.mutable_candidate_design()->mutable_factors(0)->set_levels(2);
  campaign.mutable_candidate_design()->mutable_factors(1)->set_levels(3);
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign made = whole(name);
  EXPECT_THAT(values_of(made, kFrictionPath), ElementsAre(0.05, 0.05, 0.05, 0.12, 0.12, 0.12));
  EXPECT_DOUBLE_EQ(values_of(made, kRelaxationPath)[1], 2e-7);
  EXPECT_EQ(read(name, {"mesh_loss_power_watts"}).at("mesh_loss_power_watts").size(), 12U);
}

TEST_F(CandidatesTest, ADesignFollowsTheStandardUncertaintiesOfItsBase) {
  add_lubricant("uncertain", 1, 3e-8);
  v1::Campaign campaign = two_conditions();
  campaign.set_lubricant("lubricants/uncertain");
  campaign.mutable_candidate_design()->set_method(v1::CandidateDesign::LATIN_HYPERCUBE);
  campaign.mutable_candidate_design()->set_count(40);
  campaign.mutable_candidate_design()->set_seed(3);
  const v1::Campaign made = whole(create(campaign));
  const auto base = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  const Eigen::MatrixXd shares = latin_hypercube_design(40, made.candidate_columns_size(), 3);
  int column = 0;
  while (made.candidate_columns(column).path() != kRelaxationPath) ++column;
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(
        made.candidate_columns(column).values(i),
        drawn_value(base.relaxation_time_seconds(), 3e-8, normal_quantile(shares(i, column))));
  }
  campaign.mutable_candidate_design()->add_factors()->set_parameter(kRelaxationPath);
  EXPECT_EQ(whole(create(campaign)).candidate_columns_size(), 1);
  campaign.mutable_candidate_design()->mutable_factors(0)->set_parameter(
      "lubricant.vogel_temperature_coefficient_kelvin");
  EXPECT_THAT(complaints(try_create(campaign).error()),
              HasSubstr("candidate_design.factors[0]: "
                        "lubricant.vogel_temperature_coefficient_kelvin has no range, and "
                        "lubricants/uncertain states no standard uncertainty"));
}

TEST_F(CandidatesTest, ADesignStatesAllItsViolationsAtOnce) {
  v1::Campaign campaign = designed(v1::CandidateDesign::SOBOL, 0, -1);
  v1::CandidateDesign& design = *campaign.mutable_candidate_design();
  design.set_algorithm_version(2);
  design.mutable_factors(0)->set_maximum(-0.1);
  design.mutable_factors(1)->set_minimum(9e-7);
  design.mutable_factors(1)->set_levels(3);
  *design.add_factors() = factor_of("lubricant.relaxation_time", 1, 2);
  *design.add_factors() = factor_of(kFrictionPath, 0.1, 0.2);
  design.add_factors()->set_parameter("surface.asperity_radius_metres");
  design.mutable_factors(4)->set_minimum(1e-5);
  campaign.mutable_budget()->set_points(-1);
  EXPECT_THAT(
      complaint_lines(try_create(campaign).error()),
      UnorderedElementsAre(
          HasSubstr("campaign.candidate_design.seed: seed = -1; allowed: 0 to 9007199254740991"),
          HasSubstr("campaign.candidate_design.algorithm_version: algorithm_version = 2"),
          HasSubstr(
              "campaign.candidate_design.factors[0].maximum: asperity_friction_coefficient = -0.1"),
          HasSubstr("campaign.candidate_design.factors[1].maximum: the range is 9e-07 to 4e-07"),
          HasSubstr("campaign.candidate_design.factors[1].levels: levels = 3; allowed: 0"),
          HasSubstr("did you mean \"lubricant.relaxation_time_seconds\"?"),
          HasSubstr("campaign.candidate_design.factors[3].parameter: "
                    "\"surface.asperity_friction_coefficient\" is listed twice"),
          HasSubstr("campaign.candidate_design.factors[4].maximum: not set; allowed: both ends"),
          HasSubstr("campaign.candidate_design.count: count = 0; allowed: 1 to 100000"),
          HasSubstr("campaign.budget.points: points = -1")));
}

TEST_F(CandidatesTest, AGridOfTooManyCandidatesIsRefused) {
  v1::Campaign campaign = designed(v1::CandidateDesign::GRID, 0, 0);
  campaign.mutable_candidate_design()->mutable_factors(0)->set_levels(1000);
  campaign.mutable_candidate_design()->mutable_factors(1)->set_levels(1000);
  EXPECT_THAT(complaints(try_create(campaign).error()),
              HasSubstr("the grid has 1000000 candidates; allowed: at most 100000"));
}

TEST_F(CandidatesTest, LubricantsAreCandidatesWithTheBitsOfTheirOwn) {
  add_lubricant("b-1", 1.5, 4e-8);
  add_lubricant("b-2", 0.5);
  v1::Campaign campaign = two_conditions();
  campaign.clear_lubricant();
  campaign.add_candidate_lubricants("lubricants/b-2");
  campaign.add_candidate_lubricants("lubricants/paper-fluid-2@1");
  campaign.add_candidate_lubricants("lubricants/b-1");
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign made = whole(name);
  EXPECT_THAT(made.candidate_lubricants(),
              ElementsAre("lubricants/b-2@1", "lubricants/paper-fluid-2@1", "lubricants/b-1@1"));
  EXPECT_EQ(made.lubricant_revision(), "lubricants/b-2@1");
  EXPECT_EQ(made.candidate_attributes(0).name(), "name");
  EXPECT_EQ(made.candidate_attributes(0).texts(2), "Oil b-1");
  const auto& attributes = made.candidate_attributes();
  const auto uncertain =
      std::find_if(attributes.begin(), attributes.end(), [](const v1::CandidateAttribute& each) {
        return each.name() == "relaxation_time_seconds.uncertainty";
      });
  ASSERT_NE(uncertain, attributes.end());
  EXPECT_THAT(uncertain->values(), ElementsAre(0, testing::_, 4e-8));
  const auto losses = read(name, {"mesh_loss_power_watts"}).at("mesh_loss_power_watts");
  Application application = bench_.application();
  for (int i = 0; i < 3; ++i) {
    v1::EvaluatePointsRequest points;
    points.set_lubricant(made.candidate_lubricants(i));
    *points.mutable_conditions() = campaign.conditions();
    const auto alone = evaluate_points(application, points);
    ASSERT_TRUE(alone.ok());
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(losses[static_cast<std::size_t>(2 * i + k)],
                alone.message().mesh_loss_power_watts(k));
    }
  }
  v1::PromoteCandidateRequest promote;
  promote.set_name(name);
  promote.set_candidate(2);
  promote.set_lubricant_id("chosen");
  const auto chosen = promote_candidate(application, promote);
  ASSERT_TRUE(chosen.ok()) << complaints(chosen.error());
  EXPECT_EQ(chosen.message().lubricant().derived_from(), "lubricants/b-1@1");
}

TEST_F(CandidatesTest, LubricantsThatSatisfyAFilterAreCandidates) {
  add_lubricant("b-2", 1.5);
  add_lubricant("b-1", 0.5);
  v1::Campaign campaign = two_conditions();
  campaign.set_lubricant_filter("labels.series = b AND kv40 > 1");
  const std::string name = create(campaign, "by-filter");
  add_lubricant("b-3", 0.7);
  EXPECT_THAT(whole(name).candidate_lubricants(),
              ElementsAre("lubricants/b-1@1", "lubricants/b-2@1"))
      << "those at the time of creation";
  EXPECT_EQ(create(campaign, "by-filter"), name);
  EXPECT_EQ(get(create(campaign)).candidates(), 3);
  campaign.set_lubricant_filter("labels.series = c");
  EXPECT_THAT(complaints(try_create(campaign).error()),
              HasSubstr("campaign.lubricant_filter: \"labels.series = c\" is satisfied by no "
                        "lubricant; allowed: 1 to 5000"));
  campaign.set_lubricant_filter("lims = 4");
  campaign.clear_lubricant();
  EXPECT_THAT(complaint_lines(try_create(campaign).error()),
              ElementsAre(HasSubstr("campaign.lubricant_filter: \"lims\" is not a field")))
      << "the base, which would be the first of them, is not refused beside the filter";
}

TEST_F(CandidatesTest, OnlyOneWayToStateCandidatesIsAllowed) {
  v1::Campaign campaign = designed(v1::CandidateDesign::SOBOL, 4, 0);
  campaign.add_candidate_lubricants("lubricants/paper-fluid-2");
  EXPECT_THAT(complaints(try_create(campaign).error()),
              HasSubstr("campaign.candidate_lubricants: set beside candidate_design; allowed: one "
                        "of the two"));
  campaign.clear_candidate_design();
  campaign.add_candidate_lubricants("lubricants/paper-fluid-22");
  campaign.add_candidate_lubricants("lubricants/paper-fluid-2@1");
  campaign.add_candidate_attributes()->set_name("name");
  EXPECT_THAT(
      complaint_lines(try_create(campaign).error()),
      UnorderedElementsAre(
          HasSubstr("campaign.candidate_lubricants[1]: \"lubricants/paper-fluid-22\" does not "
                    "exist; did you mean \"lubricants/paper-fluid-2\"?"),
          HasSubstr("campaign.candidate_lubricants[2]: lubricants/paper-fluid-2@1 is listed "
                    "twice, first as candidate_lubricants[0]"),
          HasSubstr("campaign.candidate_attributes[0].name: \"name\": the server makes this "
                    "attribute")));
}

TEST_F(CandidatesTest, ARepeatedRequestForADesignIsToldFromAnother) {
  const v1::Campaign campaign = designed(v1::CandidateDesign::SOBOL, 8, 1);
  const std::string name = create(campaign, "d");
  EXPECT_EQ(create(campaign, "d"), name);
  EXPECT_THAT(try_create(designed(v1::CandidateDesign::SOBOL, 8, 2), "d").error().message(),
              HasSubstr("differs in campaign.candidate_design"));
}

TEST_F(CandidatesTest, AppendedRowsFollowThoseThatAreThereAndHaveTheSameBits) {
  const std::string name = create(first_of(100, 60));
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const Table before = read(name);
  const auto appended = append(name, part_of(100, 60, 100));
  ASSERT_TRUE(appended.ok()) << complaints(appended.error());
  EXPECT_EQ(appended.message().candidates(), 100);
  EXPECT_EQ(appended.message().points(), 600);
  EXPECT_EQ(appended.message().state(), v1::Campaign::RUNNING);
  EXPECT_FALSE(appended.message().has_end_time());
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  for (const auto& [column, values] : read(name, {}, 0, 360)) {
    EXPECT_TRUE(have_equal_bits(values, before.at(column))) << column;
  }
  const std::string at_once = create(campaign_of(100));
  ASSERT_TRUE(reaches(at_once, v1::Campaign::SUCCEEDED));
  expect_equal_tables(read(name), read(at_once));
  EXPECT_EQ(get(name).input_hash(), get(at_once).input_hash());
  EXPECT_EQ(whole(name).candidate_attributes(0).texts_size(), 100);
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

/// A campaign of the most candidates and columns: one of the model and 29 of values that ride
/// along.
v1::Campaign largest_campaign() {
  v1::Campaign out = campaign_of(1);
  const v1::CandidateColumn first = out.candidate_columns(0);
  out.clear_candidate_columns();
  out.clear_candidate_attributes();
  v1::CandidateColumn& column = *out.add_candidate_columns();
  column.set_path(first.path());
  column.mutable_values()->Resize(kMaximumCandidates, first.values(0));
  for (int i = 0; i < 29; ++i) {
    v1::CandidateAttribute& attribute = *out.add_candidate_attributes();
    attribute.set_name("x" + std::to_string(i));
    attribute.mutable_values()->Resize(kMaximumCandidates, i);
  }
  return out;
}

TEST_F(CandidatesTest, ThoseOfTheLargestTableFitAndLongerOnesAreRefusedWithTheNumberThatFits) {
  Application application = bench_.application();
  v1::CreateCampaignRequest request;
  request.set_validate_only(true);
  *request.mutable_campaign() = largest_campaign();
  v1::CandidateAttribute& names = *request.mutable_campaign()->add_candidate_attributes();
  names.set_name("name");
  for (int i = 0; i < kMaximumCandidates; ++i) names.add_texts(std::string(80, 'x'));
  const auto accepted = create_campaign(application, request);
  ASSERT_TRUE(accepted.ok()) << complaints(accepted.error());
  EXPECT_EQ(accepted.message().candidates(), kMaximumCandidates);
  EXPECT_LE(request.ByteSizeLong(), kMaximumCandidateBytes);
  for (std::string& each : *names.mutable_texts()) each.resize(200);
  const std::string refused = complaints(create_campaign(application, request).error());
  EXPECT_THAT(refused, HasSubstr("campaign.candidate_columns"));
  const std::size_t fit =
      kMaximumCandidates * kMaximumCandidateBytes / request.campaign().ByteSizeLong();
  EXPECT_THAT(refused, HasSubstr(" " + std::to_string(fit).substr(0, 3)));
}

TEST_F(CandidatesTest, ThoseThatAreAddedMayNotMakeTheTableTooLong) {
  constexpr int kFurther = kMaximumCandidates - 1;
  v1::Campaign campaign = campaign_of(1);
  v1::CandidateAttribute& remark = *campaign.add_candidate_attributes();
  remark.set_name("remark");
  remark.add_texts("");
  const std::string name = create(campaign);
  v1::AppendCandidatesRequest request;
  for (const v1::CandidateColumn& each : campaign.candidate_columns()) {
    v1::CandidateColumn& column = *request.add_candidate_columns() = each;
    column.mutable_values()->Resize(kFurther, each.values(0));
  }
  for (const v1::CandidateAttribute& each : campaign.candidate_attributes()) {
    v1::CandidateAttribute& attribute = *request.add_candidate_attributes();
    attribute.set_name(each.name());
    if (!each.values().empty()) attribute.mutable_values()->Resize(kFurther, 1);
    for (int i = 0; i < kFurther && each.values().empty(); ++i) {
      attribute.add_texts(std::string(200, 'x'));
    }
  }
  EXPECT_THAT(complaints(append(name, request).error()), HasSubstr("candidate_columns"));
  EXPECT_EQ(get(name).candidates(), 1);
}

TEST_F(CandidatesTest, CandidatesAreAddedWhileTheCampaignRuns) {
  const std::string name = create(first_of(kThousand, 100));
  for (int i = 100; i + 100 <= kThousand; i += 100) {
    ASSERT_TRUE(append(name, part_of(kThousand, i, i + 100)).ok());
  }
  const int rest = kThousand % 100;
  if (rest > 0) {
    ASSERT_TRUE(append(name, part_of(kThousand, kThousand - rest, kThousand)).ok());
  }
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  EXPECT_EQ(get(name).points_done(), 6 * kThousand);
  const std::string at_once = create(campaign_of(kThousand));
  ASSERT_TRUE(reaches(at_once, v1::Campaign::SUCCEEDED));
  expect_equal_tables(read(name), read(at_once));
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(CandidatesTest, CandidatesAreComputedAfterARestart) {
  v1::Campaign limited = first_of(400, 200);
  limited.mutable_budget()->set_points(1);
  const std::string name = create(limited);
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  ASSERT_TRUE(append(name, part_of(400, 200, 400)).ok());
  EXPECT_EQ(get(name).state(), v1::Campaign::PAUSED) << "it stays so";
  bench_.restart(quick_studies());
  v1::ResumeCampaignRequest more;
  more.mutable_budget();
  ASSERT_TRUE(call(resume_campaign, name, more).ok());
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  EXPECT_EQ(get(name).points_done(), 2400);
}

TEST_F(CandidatesTest, ARepeatedRequestAddsNothing) {
  const std::string name = create(first_of(30, 10), "made");
  v1::AppendCandidatesRequest request = part_of(30, 10, 20);
  request.set_request_id("more");
  ASSERT_TRUE(append(name, request).ok());
  EXPECT_EQ(append(name, request).message().candidates(), 20);
  v1::AppendCandidatesRequest other = part_of(30, 20, 30);
  other.set_request_id("more");
  EXPECT_EQ(append(name, other).error().code(), google::rpc::ALREADY_EXISTS);
  other.clear_request_id();
  other.set_validate_only(true);
  const auto preview = append(name, other);
  EXPECT_EQ(preview.message().candidates(), 30);
  EXPECT_GT(preview.message().cost_estimate().processor_seconds(), 0);
  EXPECT_EQ(get(name).candidates(), 20);
  EXPECT_EQ(create(first_of(30, 10), "made"), name) << "the request that made it stays known";
  v1::Campaign changed = first_of(30, 10);
  changed.mutable_candidate_attributes(1)->set_values(3, 99);
  EXPECT_THAT(try_create(changed, "made").error().message(),
              HasSubstr("differs in campaign.candidate_attributes"));
  v1::CancelCampaignRequest cancel;
  call(cancel_campaign, name, cancel);
  EXPECT_TRUE(append(name, request).ok()) << "it was added";
}

TEST_F(CandidatesTest, AnAppendWithOtherColumnsIsRefused) {
  const std::string name = create(first_of(30, 10));
  v1::AppendCandidatesRequest request = part_of(30, 10, 20);
  request.mutable_candidate_columns(0)->set_path(kRelaxationPath);
  request.mutable_candidate_columns(1)->set_values(4, -7);
  request.mutable_candidate_attributes(0)->set_name("aditive");
  EXPECT_THAT(
      complaint_lines(append(name, request).error()),
      testing::IsSupersetOf(
          {HasSubstr("candidate_columns: lacks the column "
                     "\"lubricant.pressure_viscosity_coefficient_per_pascal\""),
           HasSubstr(
               "candidate_columns[0].path: \"lubricant.relaxation_time_seconds\" is no column "
               "of the campaign"),
           HasSubstr("candidate_columns[1].values[4]: asperity_friction_coefficient = -7"),
           HasSubstr("candidate_attributes: lacks \"additive\" with texts"),
           HasSubstr("did you mean \"additive\"?")}));
  v1::AppendCandidatesRequest of_lubricants;
  of_lubricants.add_candidate_lubricants("lubricants/paper-fluid-2");
  EXPECT_THAT(complaints(append(name, of_lubricants).error()),
              HasSubstr("candidate_lubricants[0]: set; allowed: candidate_columns"));
  EXPECT_THAT(complaints(append(create(two_conditions()), part_of(30, 10, 20)).error()),
              HasSubstr("name: the campaign has one candidate, the base"));
}

TEST_F(CandidatesTest, CandidatesCannotBeAddedToACampaignThatWasCancelled) {
  const std::string name = create(first_of(30, 10));
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  SQLite::Database raw = bench_.open_database();
  EXPECT_THROW(raw.exec("UPDATE campaigns SET candidates = 9"), SQLite::Exception);
  v1::Campaign limited = first_of(30, 10);
  limited.mutable_budget()->set_points(1);
  const std::string other = create(limited);
  call<v1::CancelCampaignRequest>(cancel_campaign, other);
  if (get(other).state() == v1::Campaign::CANCELLED) {
    const auto refused = append(other, part_of(30, 10, 20));
    EXPECT_EQ(refused.error().code(), google::rpc::FAILED_PRECONDITION);
    EXPECT_THAT(refused.error().message(), HasSubstr("RUNNING, PAUSED or SUCCEEDED"));
  }
}

TEST_F(CandidatesTest, LubricantsAreAddedToLubricants) {
  add_lubricant("b-1", 1.5);
  add_lubricant("b-2", 0.5, 3e-8);
  v1::Campaign campaign = two_conditions();
  campaign.add_candidate_lubricants("lubricants/b-1");
  const std::string name = create(campaign);
  v1::AppendCandidatesRequest request;
  request.add_candidate_lubricants("lubricants/b-2");
  ASSERT_TRUE(append(name, request).ok()) << complaints(append(name, request).error());
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const v1::Campaign made = whole(name);
  EXPECT_THAT(made.candidate_lubricants(), ElementsAre("lubricants/b-1@1", "lubricants/b-2@1"));
  EXPECT_THAT(values_of(made, kRelaxationPath), testing::SizeIs(2));
  for (const v1::CandidateAttribute& each : made.candidate_attributes()) {
    EXPECT_EQ(each.texts_size() + each.values_size(), 2) << each.name();
  }
  EXPECT_THAT(complaints(append(name, request).error()),
              HasSubstr("candidate_lubricants[0]: lubricants/b-2@1 is a candidate already"));
}

TEST_F(CandidatesTest, ALubricantThatIsACandidateIsInUse) {
  add_lubricant("b-1", 1.5);
  v1::Campaign campaign = two_conditions();
  campaign.add_candidate_lubricants("lubricants/b-1");
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  v1::PurgeLubricantRequest purge;
  purge.set_name("lubricants/b-1");
  purge.set_delete_simulations(true);
  purge.set_validate_only(true);
  Application application = bench_.application();
  constexpr ResourceCall<v1::PurgeReport> purge_lubricant;
  const auto report = purge_lubricant(application, purge);
  ASSERT_TRUE(report.ok()) << complaints(report.error());
  EXPECT_EQ(report.message().campaigns(), 1);
}

TEST_F(CandidatesTest, NameAndLabelsChangeWhateverTheState) {
  v1::Campaign campaign = campaign_of(2);
  v1::Label& label = *campaign.add_labels();
  label.set_key("project");
  label.set_value("axle");
  const std::string name = create(campaign);
  create(campaign_of(3));
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  ASSERT_TRUE(reaches("campaigns/2", v1::Campaign::SUCCEEDED));
  Application application = bench_.application();
  const auto names = [&](const std::string& filter) {
    v1::ListCampaignsRequest request;
    request.set_filter(filter);
    const auto page = list_campaigns(application, request);
    if (!page.ok()) throw std::runtime_error(complaints(page.error()));
    std::vector<std::string> out;
    for (const auto& each : page.message().campaigns()) out.push_back(each.name());
    EXPECT_EQ(page.message().total_size(), static_cast<int>(out.size()));
    return out;
  };
  EXPECT_THAT(names("labels.project = axle"), ElementsAre("campaigns/1"));
  EXPECT_THAT(names("labels.project != axle"), ElementsAre("campaigns/2"));
  EXPECT_THAT(names("state = SUCCEEDED AND lubricant = paper-fluid-1"),
              ElementsAre("campaigns/2", "campaigns/1"));
  EXPECT_THAT(names("state = paused"), IsEmpty());
  EXPECT_THAT(names("create_time > 2020-01-01T00:00:00Z AND end_time > 2020-01-01T00:00:00Z"),
              ElementsAre("campaigns/2", "campaigns/1"));
  EXPECT_THAT(names("create_time > 2199-01-01T00:00:00Z"), IsEmpty());
  EXPECT_THAT(names("end_time > 2199-01-01T00:00:00Z"), IsEmpty());
  EXPECT_THAT(names("end_time:*"), ElementsAre("campaigns/2", "campaigns/1"));
  EXPECT_THAT(names("input_hash = " + get("campaigns/1").input_hash()), ElementsAre("campaigns/1"));
  v1::UpdateCampaignRequest request;
  request.mutable_campaign()->set_name("campaigns/2");
  request.mutable_campaign()->set_display_name("Second screening");
  *request.mutable_campaign()->add_labels() = label;
  const std::string hash = get("campaigns/2").input_hash();
  const auto updated = update_campaign(application, request);
  ASSERT_TRUE(updated.ok());
  EXPECT_EQ(updated.message().display_name(), "Second screening");
  EXPECT_EQ(updated.message().input_hash(), hash);
  EXPECT_EQ(updated.message().points_done(), 18);
  EXPECT_THAT(names("labels.project:* AND display_name : \"second\""), ElementsAre("campaigns/2"));
  request.mutable_campaign()->clear_labels();
  request.mutable_update_mask()->add_paths("labels");
  ASSERT_TRUE(update_campaign(application, request).ok());
  EXPECT_EQ(get("campaigns/2").display_name(), "Second screening");
  EXPECT_THAT(names("labels.project:*"), ElementsAre("campaigns/1"));
  for (int i = 0; i < 65; ++i) request.mutable_campaign()->add_labels()->set_key(std::to_string(i));
  EXPECT_THAT(complaints(update_campaign(application, request).error()),
              HasSubstr("campaign.labels: 65 entries; allowed: at most 64"));
  request.mutable_campaign()->clear_labels();
  request.mutable_update_mask()->set_paths(0, "tolerance");
  EXPECT_THAT(complaints(update_campaign(application, request).error()),
              HasSubstr("update_mask: \"tolerance\" cannot be changed; allowed: display_name, "
                        "labels, condition_weights, candidate_attributes, *"));
  EXPECT_THROW(names("labels.project > axle"), std::runtime_error);
  EXPECT_THROW(names("stat = x"), std::runtime_error);
  EXPECT_THROW(names("input_hash > a"), std::runtime_error);
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(CandidatesTest, OnlyRowsThatSatisfyAConditionAreRead) {
  v1::Campaign campaign = campaign_of(kThousand);
  v1::CandidateColumn& vogel = *campaign.mutable_candidate_columns(1);
  vogel.set_path("lubricant.vogel_reference_temperature_kelvin");
  for (int i = 0; i < kThousand; ++i) vogel.set_values(i, i % 7 == 3 ? 350 : 150);
  const std::string name = create(campaign);
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  const Table all = read(name, {"row", "candidate", "refusal_number", "mesh_loss_power_watts",
                                "speed_kilometres_per_hour", "cost_euros_per_kilogram"});
  const auto expect_rows = [&](const std::string& filter, std::int64_t start, std::int64_t count,
                               const auto& matches) {
    std::vector<double> expected;
    const std::int64_t end = count == 0 ? 6 * kThousand : start + count;
    for (std::int64_t i = start; i < end; ++i) {
      if (matches(static_cast<std::size_t>(i))) expected.push_back(static_cast<double>(i));
    }
    const Table found = read(name, {"mesh_loss_power_watts", "row"}, start, count, filter);
    EXPECT_EQ(found.at("row"), expected) << filter;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double value = all.at("mesh_loss_power_watts")[static_cast<std::size_t>(expected[i])];
      const double read_value = found.at("mesh_loss_power_watts")[i];
      EXPECT_TRUE(value == read_value || (std::isnan(value) && std::isnan(read_value))) << filter;
    }
  };
  expect_rows("refusal_number > 0", 0, 0,
              [&](std::size_t i) { return all.at("refusal_number")[i] > 0; });
  const double loss = all.at("mesh_loss_power_watts")[1];
  expect_rows("mesh_loss_power_watts < " + std::to_string(loss), 100, 1500, [&](std::size_t i) {
    return all.at("mesh_loss_power_watts")[i] < std::stod(std::to_string(loss));
  });
  expect_rows(
      "additive = \"additive 2\" AND speed_kilometres_per_hour != 30 AND "
      "cost_euros_per_kilogram >= 80",
      0, 0, [&](std::size_t i) {
        return static_cast<int>(all.at("candidate")[i]) % 3 == 2 &&
               all.at("speed_kilometres_per_hour")[i] != 30 &&
               all.at("cost_euros_per_kilogram")[i] >= 80;
      });
  expect_rows("candidate > 100000", 0, 0, [](std::size_t) { return false; });
  v1::ReadCampaignRequest request;
  request.set_name(name);
  for (const auto& [filter, complaint] : std::vector<std::pair<std::string, std::string>>{
           {"mesh_loss_power_wats < 3", "did you mean \"mesh_loss_power_watts\"?"},
           {"mesh_loss_power_watts < many", "mesh_loss_power_watts = \"many\"; allowed: a finite"},
           {"additive < x", "additive: allowed: = or !=, as its values are texts"},
           {"candidate", "e.g. refusal_number = 0"},
           {"candidate : 3", "candidate: allowed: = != < <= > >="}}) {
    request.set_filter(filter);
    EXPECT_THAT(complaints(open(request).error()), HasSubstr(complaint)) << filter;
  }
}

TEST_F(CandidatesTest, AFilterSeesTheRowsThatWereThereWhenItWasOpened) {
  v1::Campaign limited = campaign_of(kThousand);
  limited.mutable_budget()->set_points(100);
  const std::string name = create(limited);
  ASSERT_TRUE(reaches(name, v1::Campaign::PAUSED));
  ASSERT_TRUE(eventually([&] { return bench_.jobs().scheduler().occupancy().parts == 0; }));
  const int done = get(name).points_done();
  v1::ReadCampaignRequest request;
  request.set_name(name);
  request.set_filter("refusal_number = -1");
  request.add_columns("refusal_number");
  const auto source = open(request);
  ASSERT_TRUE(source.ok());
  v1::ResumeCampaignRequest more;
  more.mutable_budget();
  ASSERT_TRUE(call(resume_campaign, name, more).ok());
  ASSERT_TRUE(reaches(name, v1::Campaign::SUCCEEDED));
  std::int64_t rows = 0;
  for (v1::ReadCampaignResponse part;
       source.message()->next(part) == AnyMessageSource::Step::kMessage;) {
    if (part.has_schema()) {
      EXPECT_EQ(part.schema().row_count(), 6 * kThousand - done);
      continue;
    }
    std::vector<double> values(part.chunk().values().size() / sizeof(double));
    std::memcpy(values.data(), part.chunk().values().data(), part.chunk().values().size());
    EXPECT_THAT(values, Each(-1));
    rows += static_cast<std::int64_t>(values.size());
  }
  EXPECT_EQ(rows, 6 * kThousand - done);
  EXPECT_THAT(read(name, {"row"}, 0, 0, "refusal_number = -1").at("row"), IsEmpty());
}

}  // namespace
}  // namespace tribodyn::server
