// Decisions about the candidates of a campaign: ranking, Pareto front, effects and promotion.
#include "server/application/campaign_decisions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/campaigns.h"
#include "server/application/points.h"
#include "server/contract/constraints.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"
#include "tests/support/improved_yasutomi.h"

namespace tribodyn::server {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kAlphaColumn[] = "lubricant.pressure_viscosity_coefficient_per_pascal";
constexpr char kFriction[] = "surface.asperity_friction_coefficient";
constexpr int kCandidates = 12;

/// Candidates that differ in a parameter of the lubricant and one of the surface, at two
/// conditions. Their cost is 2 + 3 concentration + (5 with additive B).
v1::Campaign table_of_candidates() {
  v1::Campaign out;
  out.set_lubricant("lubricants/paper-fluid-1");
  v1::CandidateColumn& alpha = *out.add_candidate_columns();
  alpha.set_path(kAlphaColumn);
  v1::CandidateColumn& friction = *out.add_candidate_columns();
  friction.set_path(kFriction);
  for (const char* name : {"name", "additive", "concentration", "cost"}) {
    out.add_candidate_attributes()->set_name(name);
  }
  for (int i = 0; i < kCandidates; ++i) {
    alpha.add_values(1.2e-8 * (1 + 0.002 * ((5 * i) % kCandidates)));
    friction.add_values(0.08 + 0.01 * (i % 5));
    out.mutable_candidate_attributes(0)->add_texts("oil " + std::to_string(i));
    out.mutable_candidate_attributes(1)->add_texts(i % 3 == 0 ? "B" : "A");
    out.mutable_candidate_attributes(2)->add_values(0.5 * (i % 4));
    out.mutable_candidate_attributes(3)->add_values(2 + 1.5 * (i % 4) + (i % 3 == 0 ? 5 : 0));
  }
  for (const double speed : {30.0, 110.0}) {
    out.add_conditions()->set_speed_kilometres_per_hour(speed);
    out.add_condition_weights(speed);
  }
  out.set_contact_figures(true);
  return out;
}

class CandidateDecisions : public testing::Test {
 protected:
  std::string create(const v1::Campaign& campaign,
                     v1::Campaign::State state = v1::Campaign::SUCCEEDED) {
    v1::CreateCampaignRequest request;
    *request.mutable_campaign() = campaign;
    const auto created = create_campaign(application_, request);
    if (!created.ok()) throw std::runtime_error(created.error().message());
    v1::GetCampaignRequest get;
    get.set_name(created.message().name());
    EXPECT_TRUE(
        eventually([&] { return get_campaign(application_, get).message().state() == state; }));
    return get.name();
  }
  /// The figures of all rows of a campaign.
  v1::EvaluatePointsResponse points_of(const v1::Campaign& campaign) {
    v1::EvaluatePointsRequest request;
    request.set_lubricant(campaign.lubricant());
    *request.mutable_candidate_columns() = campaign.candidate_columns();
    *request.mutable_conditions() = campaign.conditions();
    request.set_contact_figures(true);
    return evaluate_points(application_, request).message();
  }
  /// The weighted means of a column with two conditions.
  static std::vector<double> means(const google::protobuf::RepeatedField<double>& rows,
                                   double first_weight = 30.0 / 140) {
    std::vector<double> out;
    for (int i = 0; i < rows.size(); i += 2) {
      out.push_back(first_weight * rows[i] + (1 - first_weight) * rows[i + 1]);
    }
    return out;
  }
  v1::RankCandidatesResponse rank(const v1::RankCandidatesRequest& request) {
    const auto out = rank_candidates(application_, request);
    if (!out.ok()) throw std::runtime_error(out.error().message() + complaints(out.error()));
    return out.message();
  }
  static v1::RankCandidatesRequest rank_request(const std::string& name) {
    v1::RankCandidatesRequest out;
    out.set_name(name);
    out.set_ignore_stated_uncertainties(true);
    return out;
  }

  Bench bench_;
  Application application_ = bench_.application();
};

TEST_F(CandidateDecisions, RankingIsByTheWeightedMean) {
  const v1::Campaign campaign = table_of_candidates();
  v1::RankCandidatesRequest request = rank_request(create(campaign));
  const auto points = points_of(campaign);
  for (const bool wants_most : {false, true}) {
    request.mutable_objective()->set_wants_most(wants_most);
    const v1::RankCandidatesResponse out = rank(request);
    ASSERT_EQ(out.candidates_size(), kCandidates);
    EXPECT_EQ(out.ranked(), kCandidates);
    const std::vector<double> expected = means(points.inefficiency_energy_mean_percent());
    std::set<int> found;
    for (int i = 0; i < kCandidates; ++i) {
      const v1::RankedCandidate& each = out.candidates(i);
      found.insert(each.candidate());
      EXPECT_NEAR(each.value(), expected[static_cast<std::size_t>(each.candidate())], 1e-12);
      EXPECT_EQ(each.label(), "oil " + std::to_string(each.candidate()));
      EXPECT_GT(each.solver_error(), 0);
      EXPECT_LT(each.solver_error(), 2e-3 * each.value());
      if (i > 0) {
        const double rise = each.value() - out.candidates(i - 1).value();
        EXPECT_TRUE(wants_most ? rise <= 0 : rise >= 0);
      }
    }
    EXPECT_EQ(found.size(), static_cast<std::size_t>(kCandidates));
  }
  request.set_count(3);
  request.add_condition_weights(1);
  request.add_condition_weights(3);
  const v1::RankCandidatesResponse three = rank(request);
  ASSERT_EQ(three.candidates_size(), 3);
  const std::vector<double> expected = means(points.inefficiency_energy_mean_percent(), 0.25);
  EXPECT_NEAR(three.candidates(0).value(), *std::max_element(expected.begin(), expected.end()),
              1e-12);
}

TEST_F(CandidateDecisions, CandidatesWithinTheirUncertaintyAreTies) {
  v1::Campaign campaign = table_of_candidates();
  campaign.mutable_candidate_columns()->DeleteSubrange(1, 1);
  v1::CandidateColumn& alpha = *campaign.mutable_candidate_columns(0);
  for (int i = 0; i < kCandidates; ++i) alpha.set_values(i, 1.2e-8 * (1 + 0.01 * i));
  v1::RankCandidatesRequest request = rank_request(create(campaign));
  request.set_ignore_stated_uncertainties(true);
  const v1::RankCandidatesResponse exact = rank(request);
  EXPECT_EQ(exact.own_uncertain_parameters_size(), 0);
  for (const v1::RankedCandidate& each : exact.candidates()) {
    EXPECT_FALSE(each.has_comparison()) << "nobody stated an uncertainty";
  }

  v1::ParameterUncertainty& uncertainty = *request.add_uncertainties();
  uncertainty.set_parameter(kAlphaColumn);
  uncertainty.set_relative_uncertainty(0.02);
  const v1::RankCandidatesResponse out = rank(request);
  EXPECT_THAT(out.own_uncertain_parameters(), ElementsAre(kAlphaColumn));
  EXPECT_EQ(out.shared_uncertain_parameters_size(), 0);
  EXPECT_TRUE(out.candidates(0).comparison().tied());
  EXPECT_EQ(out.candidates(0).comparison().worse_probability(), 0.5);
  const double best = out.candidates(0).value();
  const double best_error = out.candidates(0).comparison().standard_uncertainty();
  for (int i = 1; i < kCandidates; ++i) {
    const v1::RankedCandidate& each = out.candidates(i);
    const v1::CandidateComparison& comparison = each.comparison();
    // The figure follows alpha* by a power: its slope is that between neighbours.
    const double slope = (each.value() - out.candidates(i - 1).value()) / 1.2e-10;
    const double value = alpha.values(each.candidate());
    EXPECT_NEAR(comparison.standard_uncertainty(), 0.02 * value * slope,
                0.03 * comparison.standard_uncertainty());
    const double certain =
        each.value() - best - each.solver_error() - out.candidates(0).solver_error();
    const double spread = std::hypot(best_error, comparison.standard_uncertainty());
    const double normal = 0.5 * std::erfc(-std::max(0.0, certain) / spread / std::numbers::sqrt2);
    EXPECT_NEAR(comparison.worse_probability(), normal,
                3.3 * std::sqrt(normal * (1 - normal) / out.draws()) + 1.0 / out.draws());
    EXPECT_EQ(comparison.tied(), comparison.worse_probability() < 0.975);
  }
  EXPECT_TRUE(out.candidates(1).comparison().tied());
  EXPECT_FALSE(out.candidates(kCandidates - 1).comparison().tied());
  request.set_confidence(0.5);
  EXPECT_FALSE(rank(request).candidates(2).comparison().tied());
}

TEST_F(CandidateDecisions, ErrorsThatAllCandidatesShareNearlyCancel) {
  v1::Campaign campaign = table_of_candidates();
  v1::RankCandidatesRequest request = rank_request(create(campaign));
  request.set_ignore_stated_uncertainties(true);
  v1::ParameterUncertainty& uncertainty = *request.add_uncertainties();
  uncertainty.set_parameter("lubricant.relaxation_time_seconds");
  uncertainty.set_relative_uncertainty(0.5);
  const v1::RankCandidatesResponse out = rank(request);
  EXPECT_THAT(out.shared_uncertain_parameters(), ElementsAre("lubricant.relaxation_time_seconds"));
  const v1::RankedCandidate& best = out.candidates(0);
  const v1::RankedCandidate& last = out.candidates(kCandidates - 1);
  EXPECT_GT(last.comparison().standard_uncertainty(), 0.1 * (last.value() - best.value()));
  EXPECT_GT(last.comparison().worse_probability(), 0.9999);
}

TEST_F(CandidateDecisions, TheTableMayStateTheUncertaintyOfEachCandidate) {
  v1::Campaign campaign = table_of_candidates();
  v1::CandidateAttribute& stated = *campaign.add_candidate_attributes();
  stated.set_name("asperity_friction_coefficient.uncertainty");
  for (int i = 0; i < kCandidates; ++i) stated.add_values(i == 3 ? 0.01 : 0);
  v1::RankCandidatesRequest request = rank_request(create(campaign));
  request.set_ignore_stated_uncertainties(true);
  const v1::RankCandidatesResponse out = rank(request);
  EXPECT_THAT(out.own_uncertain_parameters(), ElementsAre(kFriction));
  for (const v1::RankedCandidate& each : out.candidates()) {
    EXPECT_EQ(each.comparison().standard_uncertainty() > 0, each.candidate() == 3);
  }
}

TEST_F(CandidateDecisions, ConstraintsLeaveOutCandidates) {
  const v1::Campaign campaign = table_of_candidates();
  v1::RankCandidatesRequest request = rank_request(create(campaign));
  v1::CandidateConstraint& film = *request.add_constraints();
  film.mutable_figure()->set_column("film_ratio_minimum");
  film.mutable_figure()->set_aggregate(v1::CandidateFigure::MINIMUM);
  v1::CandidateConstraint& cost = *request.add_constraints();
  cost.mutable_figure()->set_column("cost");
  cost.set_maximum(8);
  const auto points = points_of(campaign);
  std::vector<double> least;
  for (int i = 0; i < kCandidates; ++i) {
    least.push_back(
        std::min(points.film_ratio_minimum(2 * i), points.film_ratio_minimum(2 * i + 1)));
  }
  std::vector<double> sorted = least;
  std::sort(sorted.begin(), sorted.end());
  film.set_minimum(sorted[4]);
  const v1::RankCandidatesResponse out = rank(request);
  int expected = 0;
  for (int i = 0; i < kCandidates; ++i) {
    const bool is_cheap = campaign.candidate_attributes(3).values(i) <= 8;
    expected += is_cheap && least[static_cast<std::size_t>(i)] >= sorted[4] ? 1 : 0;
  }
  ASSERT_GT(expected, 1);
  EXPECT_EQ(out.ranked(), expected);
  EXPECT_EQ(out.excluded(), kCandidates - expected);
  for (const v1::RankedCandidate& each : out.candidates()) {
    EXPECT_EQ(each.constraint_values(0), least[static_cast<std::size_t>(each.candidate())]);
    EXPECT_LE(each.constraint_values(1), 8);
  }
}

TEST_F(CandidateDecisions, RefusedAndMissingCandidatesAreCounted) {
  v1::Campaign campaign = table_of_candidates();
  v1::CandidateColumn& reference = *campaign.add_candidate_columns();
  reference.set_path("lubricant.vogel_reference_temperature_kelvin");
  for (int i = 0; i < kCandidates; ++i) reference.add_values(i == 2 ? 350 : 150);
  const v1::RankCandidatesResponse refused = rank(rank_request(create(campaign)));
  EXPECT_EQ(refused.refused(), 1);
  EXPECT_EQ(refused.ranked(), kCandidates - 1);
  for (const v1::RankedCandidate& each : refused.candidates()) EXPECT_NE(each.candidate(), 2);

  v1::Campaign large = table_of_candidates();
  large.clear_candidate_attributes();
  for (v1::CandidateColumn& each : *large.mutable_candidate_columns()) {
    const double value = each.values(0);
    for (int i = kCandidates; i < 5000; ++i) each.add_values(value);
  }
  large.mutable_budget()->set_points(1);
  const v1::RankCandidatesResponse missing =
      rank(rank_request(create(large, v1::Campaign::PAUSED)));
  EXPECT_GT(missing.missing(), 0);
  EXPECT_EQ(missing.ranked() + missing.missing(), 5000);
}

TEST_F(CandidateDecisions, PagesOfARankingAreTogetherTheRanking) {
  v1::RankCandidatesRequest request = rank_request(create(table_of_candidates()));
  v1::ParameterUncertainty& uncertainty = *request.add_uncertainties();
  uncertainty.set_parameter(kAlphaColumn);
  uncertainty.set_relative_uncertainty(0.02);
  request.set_count(10'000);
  const v1::RankCandidatesResponse whole = rank(request);
  ASSERT_EQ(whole.candidates_size(), kCandidates);
  EXPECT_EQ(whole.next_page_token(), "");
  for (const int count : {1, 5, kCandidates}) {
    v1::RankCandidatesResponse together;
    request.set_count(count);
    request.clear_page_token();
    do {
      const v1::RankCandidatesResponse page = rank(request);
      EXPECT_LE(page.candidates_size(), request.count());
      EXPECT_EQ(page.ranked(), kCandidates);
      together.mutable_candidates()->MergeFrom(page.candidates());
      together.set_compared(page.compared());
      request.set_page_token(page.next_page_token());
      request.set_count(count + together.candidates_size() % 2);  // pages may differ in length
    } while (!request.page_token().empty());
    ASSERT_EQ(together.candidates_size(), kCandidates) << count;
    EXPECT_EQ(together.compared(), whole.compared());
    for (int i = 0; i < kCandidates; ++i) {
      EXPECT_EQ(together.candidates(i).SerializeAsString(), whole.candidates(i).SerializeAsString())
          << "rank " << i << ", pages of " << count;
    }
  }
}

TEST_F(CandidateDecisions, APageOfAnotherRankingIsRefused) {
  const v1::Campaign campaign = table_of_candidates();
  v1::RankCandidatesRequest request = rank_request(create(campaign));
  request.set_count(5);
  request.set_page_token(rank(request).next_page_token());
  v1::RankCandidatesRequest other = request;
  other.set_confidence(0.5);
  EXPECT_THAT(complaints(rank_candidates(application_, other).error()), HasSubstr("page_token"));
  v1::AppendCandidatesRequest append;
  append.set_name(request.name());
  for (const v1::CandidateColumn& each : campaign.candidate_columns()) {
    v1::CandidateColumn& column = *append.add_candidate_columns();
    column.set_path(each.path());
    column.add_values(each.values(0));
  }
  for (const v1::CandidateAttribute& each : campaign.candidate_attributes()) {
    v1::CandidateAttribute& attribute = *append.add_candidate_attributes();
    attribute.set_name(each.name());
    if (each.texts_size() > 0) attribute.add_texts(each.texts(0));
    if (each.values_size() > 0) attribute.add_values(each.values(0));
  }
  EXPECT_EQ(rank(request).candidates_size(), 5);
  const auto appended = append_candidates(application_, append);
  ASSERT_TRUE(appended.ok()) << complaints(appended.error());
  const auto refused = rank_candidates(application_, request).error();
  EXPECT_EQ(refused.code(), google::rpc::ABORTED);
  EXPECT_THAT(refused.DebugString(), HasSubstr("RANKING_CHANGED"));
}

TEST_F(CandidateDecisions, NoOtherCandidateBeatsOneOfTheFrontAndOneBeatsEachOfTheOthers) {
  const v1::Campaign campaign = table_of_candidates();
  v1::FindParetoCandidatesRequest request;
  request.set_name(create(campaign));
  request.mutable_second()->mutable_figure()->set_column("film_ratio_mean");
  request.mutable_second()->set_wants_most(true);
  const auto out = find_pareto_candidates(application_, request);
  ASSERT_TRUE(out.ok()) << complaints(out.error());
  const auto points = points_of(campaign);
  const std::vector<double> losses = means(points.inefficiency_energy_mean_percent());
  const std::vector<double> films = means(points.film_ratio_mean());
  std::set<int> expected, found;
  for (int i = 0; i < kCandidates; ++i) {
    const auto a = static_cast<std::size_t>(i);
    bool is_beaten = false;
    for (std::size_t b = 0; b < losses.size(); ++b) {
      is_beaten = is_beaten || (losses[b] <= losses[a] && films[b] >= films[a] &&
                                (losses[b] < losses[a] || films[b] > films[a]));
    }
    if (!is_beaten) expected.insert(i);
  }
  double before = 0;
  for (const v1::ParetoCandidate& each : out.message().candidates()) {
    found.insert(each.candidate());
    EXPECT_GT(each.first_value(), before);
    before = each.first_value();
    EXPECT_NEAR(each.second_value(), films[static_cast<std::size_t>(each.candidate())], 1e-12);
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(out.message().beaten(), kCandidates - static_cast<int>(expected.size()));
  EXPECT_EQ(out.message().total_size(), static_cast<int>(expected.size()));
  EXPECT_EQ(out.message().beaten_candidates_size(), 0);
}

TEST_F(CandidateDecisions, TheBestBeatenCandidatesComeWithTheFrontIfTheyAreRequested) {
  const v1::Campaign campaign = table_of_candidates();
  v1::FindParetoCandidatesRequest request;
  request.set_name(create(campaign));
  request.mutable_second()->mutable_figure()->set_column("film_ratio_mean");
  request.mutable_second()->set_wants_most(true);
  request.set_beaten_count(10000);
  const auto all = find_pareto_candidates(application_, request);
  ASSERT_TRUE(all.ok()) << complaints(all.error());
  ASSERT_GT(all.message().beaten(), 3);
  ASSERT_EQ(all.message().beaten_candidates_size(), all.message().beaten());
  const auto points = points_of(campaign);
  const std::vector<double> losses = means(points.inefficiency_energy_mean_percent());
  const std::vector<double> films = means(points.film_ratio_mean());
  std::set<int> found;
  for (const v1::ParetoCandidate& each : all.message().candidates()) found.insert(each.candidate());
  double before = 0;
  for (const v1::ParetoCandidate& each : all.message().beaten_candidates()) {
    EXPECT_TRUE(found.insert(each.candidate()).second) << each.candidate();
    EXPECT_GE(each.first_value(), before);
    before = each.first_value();
    EXPECT_NEAR(each.first_value(), losses[static_cast<std::size_t>(each.candidate())], 1e-12);
    EXPECT_NEAR(each.second_value(), films[static_cast<std::size_t>(each.candidate())], 1e-12);
  }
  EXPECT_EQ(static_cast<int>(found.size()), kCandidates);
  request.set_beaten_count(2);
  const auto two = find_pareto_candidates(application_, request);
  ASSERT_TRUE(two.ok()) << complaints(two.error());
  ASSERT_EQ(two.message().beaten_candidates_size(), 2);
  EXPECT_EQ(two.message().beaten(), all.message().beaten());
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(two.message().beaten_candidates(i).candidate(),
              all.message().beaten_candidates(i).candidate());
  }
}

TEST_F(CandidateDecisions, EffectsOfALinearFigureAreItsCoefficients) {
  v1::EstimateCandidateEffectsRequest request;
  request.set_name(create(table_of_candidates()));
  request.mutable_figure()->set_column("cost");
  request.add_columns("additive");
  request.add_columns("concentration");
  const auto found = estimate_candidate_effects(application_, request);
  ASSERT_TRUE(found.ok()) << complaints(found.error());
  const v1::EstimateCandidateEffectsResponse& out = found.message();
  ASSERT_EQ(out.effects_size(), 2);
  EXPECT_EQ(out.effects(0).column(), "additive");
  EXPECT_NEAR(out.effects(0).effect(), 5, 1e-9);
  EXPECT_EQ(out.effects(0).from_candidate(), 1);  // the first of the more frequent A
  EXPECT_EQ(out.effects(0).to_candidate(), 0);
  EXPECT_EQ(out.effects(1).column(), "concentration");
  EXPECT_NEAR(out.effects(1).effect(), 3 * 1.5, 1e-9);  // from 0 to 1.5
  EXPECT_EQ(out.effects(1).to_candidate(), 3);
  EXPECT_NEAR(out.effects(1).effect_minimum(), 4.5, 1e-9);
  EXPECT_NEAR(out.effects(1).effect_maximum(), 4.5, 1e-9);
  EXPECT_NEAR(out.explained_share(), 1, 1e-12);
  EXPECT_EQ(out.candidates(), kCandidates);
  EXPECT_EQ(out.degrees_of_freedom(), kCandidates - 3);
}

TEST_F(CandidateDecisions, EffectsAreThoseOfWhatTheModelUses) {
  v1::Campaign campaign = table_of_candidates();
  v1::CandidateAttribute& batch = *campaign.add_candidate_attributes();
  batch.set_name("batch");
  for (int i = 0; i < kCandidates; ++i) batch.add_texts("7");
  v1::EstimateCandidateEffectsRequest request;
  request.set_name(create(campaign));
  const auto found = estimate_candidate_effects(application_, request);
  ASSERT_TRUE(found.ok()) << complaints(found.error());
  std::vector<std::string> columns, left_out;
  for (const auto& each : found.message().effects()) columns.push_back(each.column());
  for (const auto& each : found.message().left_out()) {
    left_out.push_back(each.column() + " " + v1::ColumnWithoutEffect::Reason_Name(each.reason()));
  }
  EXPECT_THAT(columns, testing::UnorderedElementsAre(kAlphaColumn, kFriction));
  EXPECT_THAT(left_out, testing::IsEmpty());
  EXPECT_GT(found.message().explained_share(), 0.99) << "the parameters explain the inefficiency";
  request.add_columns("additiv");
  EXPECT_THAT(complaints(estimate_candidate_effects(application_, request).error()),
              HasSubstr("columns[0]: \"additiv\" is no column of the candidates; did you mean "
                        "\"additive\"?"));
}

TEST_F(CandidateDecisions, APromotedCandidateHasItsNumbersAndTheirOrigin) {
  const v1::Campaign campaign = table_of_candidates();
  v1::PromoteCandidateRequest request;
  request.set_name(create(campaign));
  request.set_candidate(3);
  request.set_lubricant_id("best-oil");
  request.set_surface_id("best-film");
  request.set_validate_only(true);
  const auto preview = promote_candidate(application_, request);
  ASSERT_TRUE(preview.ok()) << complaints(preview.error());
  EXPECT_FALSE(bench_.store().resource("projects/default/lubricants/best-oil"));
  request.set_validate_only(false);
  const auto found = promote_candidate(application_, request);
  ASSERT_TRUE(found.ok()) << complaints(found.error());
  const v1::Lubricant& lubricant = found.message().lubricant();
  EXPECT_EQ(lubricant.name(), "lubricants/best-oil");
  EXPECT_EQ(lubricant.display_name(), "oil 3");
  EXPECT_EQ(lubricant.derived_from(), "lubricants/paper-fluid-1@1");
  const auto base = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  for (const v1::ParameterProvenance& each : lubricant.provenance()) {
    const bool is_overridden = std::string("lubricant.") + each.field() == kAlphaColumn;
    EXPECT_THAT(each.source(), HasSubstr("lubricants/paper-fluid-1@1"));
    if (is_overridden) {
      EXPECT_EQ(each.provenance(), v1::PROVENANCE_USER);
      EXPECT_EQ(each.source(), "candidate 3 (oil 3) of campaigns/1, in place of " +
                                   number_text(base.pressure_viscosity_coefficient_per_pascal()) +
                                   " in lubricants/paper-fluid-1@1");
    }
  }
  EXPECT_EQ(found.message().surface().name(), "surfaces/best-film");
  EXPECT_EQ(found.message().surface().derived_from(), "surfaces/run-in@1");
  // Both compute what the campaign computed, to the last bit.
  v1::EvaluatePointsRequest alone;
  alone.set_lubricant("lubricants/best-oil");
  alone.set_surface("surfaces/best-film");
  *alone.mutable_conditions() = campaign.conditions();
  const auto promoted = evaluate_points(application_, alone);
  ASSERT_TRUE(promoted.ok()) << complaints(promoted.error());
  const auto points = points_of(campaign);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(promoted.message().mesh_loss_power_watts(k), points.mesh_loss_power_watts(6 + k));
  }

  const auto again = promote_candidate(application_, request);
  EXPECT_EQ(again.error().code(), google::rpc::ALREADY_EXISTS);
  request.set_lubricant_id("other-oil");
  EXPECT_EQ(promote_candidate(application_, request).error().code(), google::rpc::ALREADY_EXISTS)
      << "of the surface";
  EXPECT_FALSE(bench_.store().resource("projects/default/lubricants/other-oil"))
      << "both are written or none";
}

TEST_F(CandidateDecisions, APromotedCandidateFollowsThePressureViscosityLawOfItsBase) {
  const PrintedYasutomi law = gear_oil_80w90();
  v1::CreateLubricantRequest oil;
  oil.set_lubricant_id("with-law");
  v1::Lubricant& stated = *oil.mutable_lubricant();
  stated = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  stated.clear_name();
  stated.clear_provenance();
  stated.clear_measurements();
  stated.clear_pressure_viscosity_coefficient_per_pascal();
  stated.clear_pressure_viscosity_temperature_kelvin();
  stated.set_vogel_reference_temperature_kelvin(law.glass_temperature - law.c2);
  stated.set_vogel_temperature_coefficient_kelvin(std::numbers::ln10 * law.c1 * law.c2);
  stated.set_vogel_viscosity_prefactor_pascal_seconds(law.of_pressure[kGlassViscosity] *
                                                      std::pow(10, -law.c1));
  v1::ImprovedYasutomi& parameters = *stated.mutable_improved_yasutomi();
  parameters.set_glass_viscosity_pascal_seconds(law.of_pressure[kGlassViscosity]);
  parameters.set_glass_temperature_rise_kelvin(law.of_pressure[kGlassTemperatureRise]);
  parameters.set_glass_pressure_factor_per_pascal(law.of_pressure[kGlassPressureFactor]);
  parameters.set_expansivity_pressure_factor_per_pascal(
      law.of_pressure[kExpansivityPressureFactor]);
  parameters.set_expansivity_exponent(law.of_pressure[kExpansivityExponent]);
  ASSERT_TRUE(create_lubricant(application_, oil).ok());
  v1::Campaign campaign;
  campaign.set_lubricant("lubricants/with-law");
  v1::CandidateColumn& column = *campaign.add_candidate_columns();
  column.set_path("lubricant.improved_yasutomi.glass_temperature_rise_kelvin");
  const double usual = law.of_pressure[kGlassTemperatureRise];
  column.add_values(usual);
  column.add_values(1.1 * usual);
  campaign.add_conditions()->set_speed_kilometres_per_hour(60);
  const std::string name = create(campaign);
  v1::RankCandidatesRequest rank_by_law = rank_request(name);
  rank_by_law.add_uncertainties()->set_parameter(column.path());
  rank_by_law.mutable_uncertainties(0)->set_relative_uncertainty(0.01);
  EXPECT_GT(rank(rank_by_law).candidates(1).comparison().standard_uncertainty(), 0);

  v1::PromoteCandidateRequest request;
  request.set_name(name);
  request.set_candidate(1);
  request.set_lubricant_id("promoted");
  const auto found = promote_candidate(application_, request);
  ASSERT_TRUE(found.ok()) << complaints(found.error());
  const v1::Lubricant& promoted = found.message().lubricant();
  EXPECT_EQ(promoted.improved_yasutomi().glass_temperature_rise_kelvin(), 1.1 * usual);
  EXPECT_FALSE(found.message().has_surface());
  v1::EvaluatePointsRequest base, alone;
  base.set_lubricant("lubricants/with-law");
  *base.add_candidate_columns() = column;
  *base.mutable_conditions() = campaign.conditions();
  alone.set_lubricant("lubricants/promoted");
  *alone.mutable_conditions() = campaign.conditions();
  EXPECT_EQ(evaluate_points(application_, alone).message().mesh_loss_power_watts(0),
            evaluate_points(application_, base).message().mesh_loss_power_watts(1));
}

TEST_F(CandidateDecisions, RequestsThatCannotBeAreRefusedByName) {
  const std::string name = create(table_of_candidates());
  v1::PromoteCandidateRequest promote;
  promote.set_name(name);
  promote.set_candidate(kCandidates);
  EXPECT_THAT(complaint_lines(promote_candidate(application_, promote).error()),
              ElementsAre("candidate: candidate = 12; allowed: 0 to 11",
                          "lubricant_id: not set; allowed: an id",
                          HasSubstr("surface_id: not set; allowed: an id, because candidates")));
  v1::RankCandidatesRequest request = rank_request(name);
  request.mutable_objective()->mutable_figure()->set_column("mesh_loss_power_watt");
  request.add_constraints()->mutable_figure()->set_column("condition");
  request.add_condition_weights(1);
  request.set_confidence(0.3);
  request.add_uncertainties()->set_parameter("lubricant.relaxation_time_second");
  const std::string text = complaints(rank_candidates(application_, request).error());
  for (const char* part :
       {"objective.figure.column: no such column here; did you mean \"mesh_loss_power_watts\"?",
        "constraints[0].figure.column: \"condition\" is no figure of candidates",
        "constraints[0].minimum: not set; allowed: this, maximum or both",
        "condition_weights: 1 weights; allowed: one for each of the 2 conditions",
        "confidence = 0.3; allowed: 0.5 to 0.9999",
        "uncertainties[0].parameter: \"lubricant.relaxation_time_second\" is no parameter",
        "uncertainties[0].absolute_uncertainty: not set"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  v1::FindParetoCandidatesRequest front;
  front.set_name(name);
  EXPECT_THAT(complaints(find_pareto_candidates(application_, front).error()),
              HasSubstr("second: not set"));
}

TEST_F(CandidateDecisions, ADeletedCampaignHasNone) {
  const std::string name = create(table_of_candidates());
  v1::DeleteCampaignRequest remove;
  remove.set_name(name);
  ASSERT_TRUE(delete_campaign(application_, remove).ok());
  const auto expect_missing = [&](auto request, auto decide) {
    request.set_name(name);
    EXPECT_EQ(decide(application_, request, CallContext()).error().code(), google::rpc::NOT_FOUND);
  };
  expect_missing(v1::RankCandidatesRequest(), rank_candidates);
  expect_missing(v1::FindParetoCandidatesRequest(), find_pareto_candidates);
  expect_missing(v1::EstimateCandidateEffectsRequest(), estimate_candidate_effects);
  expect_missing(v1::PromoteCandidateRequest(), promote_candidate);
}

}  // namespace
}  // namespace tribodyn::server
