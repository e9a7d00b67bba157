#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/screen_run.h"
#include "client/cpp/report/campaign_report.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/report/screening_decisions.h"
#include "client/cpp/report/screening_plot.h"
#include "client/cpp/report/screening_report.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/service/campaign_run.h"
#include "client/cpp/service/follow.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Candidates that are compared with the best one, from the best on: at least and at most. It takes
/// two points for each input and condition, and the server compares as many as 20,000 points allow.
constexpr int kLeastCompared = 30, kMostCompared = 200;

void normalise(std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
}

/// Sets the conditions and their weights. A setting without a flag has its default value.
void set_screened_conditions(const ScreenFlags& flags, Screening& screening) {
  ConditionFlags conditions = flags.conditions;
  if (conditions.sumps.empty()) conditions.sumps.push_back(40);
  if (!conditions.common.has_inlet_temperature_rise_kelvin()) {
    conditions.common.set_inlet_temperature_rise_kelvin(20);
  }
  for (v1::PointCondition& each : conditions.conditions()) {
    *screening.request.add_conditions() = std::move(each);
  }
  screening.weights = conditions.weights();
  normalise(screening.weights);
}

/// Sets the revisions of the base that was evaluated.
void set_revisions(Screening& screening) {
  const v1::EvaluatePointsResponse& base = screening.base;
  screening.request.set_lubricant(base.lubricant_revision());
  screening.request.set_surface(base.surface_revision());
  screening.request.set_gear_set(base.gear_set_revision());
  screening.request.set_vehicle(base.vehicle_revision());
}

/// Evaluates the base and reads the table. Everything that is wrong with the command shows here.
Screening prepared_screening(ScreenFlags& flags, const v1::Schema& schema, Connection& connection) {
  // A table that cannot be read needs no server.
  const std::string text = read_table_file(flags.path, kLargestFile);
  Screening out;
  out.request = flags.request;
  set_screened_conditions(flags, out);
  out.base = connection.evaluate_points(out.request);
  set_revisions(out);
  CandidateBase& base = out.bases;
  base.lubricant = connection.get<v1::Lubricant>(out.request.lubricant());
  base.surface = connection.get<v1::Surface>(out.request.surface());
  const ResourcePointer stated =
      base_of_rows(connection, kind_of(*v1::Lubricant::descriptor()), out.request.lubricant());
  base.stated = dynamic_cast<const v1::Lubricant&>(*stated);
  out.table = read_candidates(text, flags.path, base, flags.carried);
  if (!flags.pareto_column.empty()) check_front_column(out, flags.pareto_column);
  if (!out.table.note.empty()) std::cerr << "tribodyn: " << printable(out.table.note) << "\n";
  characterise_candidates(connection, base, out.table);
  check_candidate_ranges(schema, out.table);
  return out;
}

/// Returns the place of a value among those that were given before it, in their order.
std::size_t place_among(double value, std::vector<double>& values) {
  const auto found = std::find(values.begin(), values.end(), value);
  const auto place = static_cast<std::size_t>(found - values.begin());
  if (found == values.end()) values.push_back(value);
  return place;
}

/// Sets weights of a campaign's conditions that the command line states.
void set_weights(const ScreenFlags& flags, Screening& screening) {
  if (!flags.conditions.has_weights()) return;
  std::vector<double> speeds, sumps;
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (const v1::PointCondition& each : screening.request.conditions()) {
    places.emplace_back(place_among(each.speed_kilometres_per_hour(), speeds),
                        place_among(each.sump_temperature_celsius(), sumps));
  }
  Complaints complaints;
  check_weight_counts(flags.conditions, speeds.size(), sumps.size(), complaints);
  if (!complaints.empty()) throw Failure(kExitUsage, joined(complaints, "\n"));
  for (std::size_t k = 0; k < places.size(); ++k) {
    screening.weights[k] = flags.conditions.weight(places[k].first, places[k].second);
  }
  normalise(screening.weights);
}

/// Creates the campaign whose candidates the server makes or finds, or finds the one that the same
/// command made.
v1::Campaign made_campaign(ScreenFlags& flags, Connection& connection, InterruptText& interrupts) {
  Screening screening;
  screening.request = flags.request;
  set_screened_conditions(flags, screening);
  const std::vector<std::string> lubricants = candidate_lubricants(flags, connection);
  if (screening.request.lubricant().empty()) screening.request.set_lubricant(lubricants.front());
  screening.base = connection.evaluate_points(screening.request);
  set_revisions(screening);
  v1::Campaign request = campaign_without_candidates(
      screening, lubricants.empty() ? "design" : std::to_string(lubricants.size()) + " lubricants");
  set_made_candidates(flags, lubricants, request);
  interrupts.set(kCampaignMayExist);
  return create_or_find(connection, request, screening.base.model_version());
}

/// Returns the campaign that the command line describes, and writes its candidates and conditions
/// to `screening`.
v1::Campaign campaign_to_follow(ScreenFlags& flags, const v1::Schema& schema,
                                Connection& connection, InterruptText& interrupts,
                                Screening& screening) {
  if (!flags.campaign.empty() || flags.has_design() || flags.has_lubricants()) {
    const std::string name = flags.campaign.empty()
                                 ? made_campaign(flags, connection, interrupts).name()
                                 : flags.campaign;
    v1::Campaign campaign = connection.get_campaign(name, v1::CAMPAIGN_VIEW_FULL);
    screening = screening_of(connection, campaign);
    set_weights(flags, screening);
    return campaign;
  }
  screening = prepared_screening(flags, schema, connection);
  const auto& refusals = screening.table.refusals;
  const bool is_any_accepted = std::any_of(refusals.begin(), refusals.end(),
                                           [](const std::string& each) { return each.empty(); });
  if (!is_any_accepted) return {};
  const v1::Campaign request = campaign_of(screening, table_title(flags.path));
  interrupts.set(kCampaignMayExist);
  return create_or_find(connection, request, screening.base.model_version());
}

/// Computes the points of a screening. Returns whether there are all of them.
bool compute(ScreenFlags& flags, const v1::Schema& schema, Connection& connection,
             const CommonOptions& options, InterruptText& interrupts, Screening& screening) {
  const v1::Campaign started = campaign_to_follow(flags, schema, connection, interrupts, screening);
  screening.program = program_of(connection);
  screening.campaign = started.name();
  screening.input_hash = started.input_hash();
  ScreenedPoint none{};
  none.figures.fill(std::nan(""));
  screening.points.assign(screening.table.size() * screening.conditions(), none);
  if (started.name().empty()) return true;
  interrupts.set(interrupted_campaign(connection, started.name()));
  if (started.points_done() > 0 && !has_ended(started.state())) {
    std::cerr << "tribodyn: resumes " << started.name() << " after " << points_text(started)
              << "\n";
  }
  go_on(flags, started, connection);
  const v1::Campaign campaign = follow_to_end(connection, started.name(), options.progress_form());
  read_points(connection, campaign, screening);
  if (campaign.model_version() != screening.base.model_version()) {
    std::cerr << "tribodyn: " << campaign.name() << " was computed by "
              << printable(campaign.model_version()) << ", its base now by "
              << printable(screening.base.model_version()) << "\n";
  }
  const bool is_complete = campaign.state() == v1::Campaign::SUCCEEDED;
  if (!is_complete) report_stop(campaign, connection);
  return is_complete;
}

/// Writes all points to the files that the command line names.
void write_point_files(const ScreenFlags& flags, const Screening& screening) {
  if (!flags.csv_path.empty()) {
    write_file(flags.csv_path, [&](std::ostream& file) { write_screening_csv(screening, file); });
  }
  if (!flags.json_lines_path.empty()) {
    write_file(flags.json_lines_path,
               [&](std::ostream& file) { write_screening_json_lines(screening, file); });
  }
}

/// Returns how sure the ranking is, by the service. Where all compared candidates are ties, more
/// are compared.
RankingConfidence confidence_of(const ScreenFlags& flags, const Screening& screening,
                                const std::vector<CandidateFigures>& ranking,
                                Connection& connection) {
  if (screening.campaign.empty() || !ranking.front().refusal.empty()) return {};
  v1::RankCandidatesRequest request;
  request.set_name(screening.campaign);
  *request.mutable_condition_weights() = {screening.weights.begin(), screening.weights.end()};
  request.set_confidence(flags.confidence);
  *request.mutable_uncertainties() = {flags.uncertainties.begin(), flags.uncertainties.end()};
  const std::vector<std::size_t> candidates = accepted_candidates(screening.table);
  RankingConfidence out;
  for (const int count : {std::clamp(flags.top, kLeastCompared, kMostCompared), kMostCompared}) {
    request.set_count(count);
    const v1::RankCandidatesResponse answer = connection.rank_candidates(request);
    out = ranking_confidence(ranking, candidates, answer, flags.confidence);
    const bool has_all = answer.compared() < count || answer.ranked() <= count;
    if (out.of.empty() || has_all || !out.of.back() || !out.of.back()->is_tied) break;
  }
  return out;
}

/// The Pareto front and the main effects, each if the command line requests it.
struct Decisions {
  std::optional<ScreeningFront> front;
  std::optional<ScreeningEffects> effects;
};

Decisions decisions_of(const ScreenFlags& flags, const Screening& screening,
                       const std::vector<CandidateFigures>& ranking, Connection& connection) {
  Decisions out;
  if (!ranking.front().refusal.empty()) return out;
  if (!flags.pareto_column.empty()) {
    out.front = screening_front(screening, ranking, flags.pareto_column, flags.wants_most);
  }
  if (flags.wants_effects) {
    v1::EstimateCandidateEffectsRequest request;
    request.set_name(screening.campaign);
    *request.mutable_condition_weights() = {screening.weights.begin(), screening.weights.end()};
    out.effects = screening_effects(screening, accepted_candidates(screening.table),
                                    connection.estimate_candidate_effects(request));
  }
  return out;
}

}  // namespace

int run_axle_screen(ScreenFlags& flags, Connection& connection, const CommonOptions& options,
                    InterruptText& interrupts) {
  const v1::Schema schema = connection.schema();
  Screening screening;
  const bool is_complete = compute(flags, schema, connection, options, interrupts, screening);
  write_point_files(flags, screening);
  if (!screening.campaign.empty()) {
    v1::RankCandidatesRequest request;
    request.set_name(screening.campaign);
    *request.mutable_condition_weights() = {screening.weights.begin(), screening.weights.end()};
    set_warnings(accepted_candidates(screening.table), figures_ranking(connection, request),
                 screening);
  }
  const std::vector<CandidateFigures> ranking = ranked(screening);
  const RankingConfidence confidence = flags.leaves_out_uncertainty
                                           ? RankingConfidence()
                                           : confidence_of(flags, screening, ranking, connection);
  const auto [front, effects] = decisions_of(flags, screening, ranking, connection);
  std::map<std::string, std::string> members;
  if (front) members["pareto_front"] = front_json(screening, *front);
  if (effects) members["main_effects"] = effects_json(*effects);
  std::cout << screening_report(screening, ranking, confidence, static_cast<std::size_t>(flags.top),
                                options.output_format, members);
  if (options.output_format == OutputFormat::kTable) {
    if (front) std::cout << "\n" << front_report(screening, ranking, *front);
    if (effects) std::cout << "\n" << effects_report(*effects);
  }
  if (!flags.plot_path.empty() && (front || effects)) {
    write_file(flags.plot_path, screening_plot(screening, ranking, front ? &*front : nullptr,
                                               effects ? &*effects : nullptr));
  }
  return is_complete && ranking.front().refusal.empty() ? kExitOk : kExitFailed;
}

}  // namespace tribodyn::client
