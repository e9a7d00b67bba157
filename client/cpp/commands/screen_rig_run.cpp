#include <algorithm>
#include <iostream>

#include "client/cpp/commands/candidate_flags.h"
#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/commands/screen_run.h"
#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/service/campaign_run.h"
#include "client/cpp/service/follow.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Returns the campaign of a rig that the command line describes. Says which rows of the table
/// cannot be computed.
v1::Campaign rig_campaign_request(const ScreenFlags& flags, Connection& connection,
                                  std::string& model_version) {
  constexpr std::size_t kMostNamed = 8;  // rows that cannot be computed
  const std::string text =
      flags.path.empty() ? std::string() : read_table_file(flags.path, kLargestFile);
  const std::vector<std::string> lubricants = candidate_lubricants(flags, connection);
  v1::EvaluateRigRequest rig = rig_of_screen(flags.rig, flags.request);
  if (rig.lubricant().empty()) rig.set_lubricant(lubricants.front());
  const v1::EvaluateRigResponse base = connection.evaluate_rig(rig);
  model_version = base.model_version();
  Screening screening;
  screening.request.set_lubricant(base.lubricant_revision());
  screening.request.set_surface(base.surface_revision());
  *screening.request.mutable_model_options() = flags.request.model_options();
  if (flags.path.empty()) {
    v1::Campaign out = campaign_without_candidates(
        screening,
        lubricants.empty() ? "design" : std::to_string(lubricants.size()) + " lubricants");
    set_made_candidates(flags, lubricants, out);
    set_rig(rig, out);
    return out;
  }
  screening.bases.lubricant = connection.get<v1::Lubricant>(base.lubricant_revision());
  if (!base.surface_revision().empty()) {
    screening.bases.surface = connection.get<v1::Surface>(base.surface_revision());
  }
  const ResourcePointer stated =
      base_of_rows(connection, kind_of(*v1::Lubricant::descriptor()), base.lubricant_revision());
  screening.bases.stated = dynamic_cast<const v1::Lubricant&>(*stated);
  CandidateTable& table = screening.table;
  table = read_candidates(text, flags.path, screening.bases, flags.carried);
  if (!table.note.empty()) std::cerr << "tribodyn: " << printable(table.note) << "\n";
  characterise_candidates(connection, screening.bases, table);
  check_candidate_ranges(connection.schema(), table);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.refusals[i].empty() || ++refused > kMostNamed) continue;
    std::cerr << "tribodyn: " << printable(table.names[i])
              << " is left out: " << printable(table.refusals[i]) << "\n";
  }
  if (refused > kMostNamed) std::cerr << "... and " << refused - kMostNamed << " others\n";
  if (refused == table.size()) throw Failure(kExitFailed, "no candidate can be computed");
  v1::Campaign out = campaign_of(screening, table_title(flags.path));
  set_rig(rig, out);
  return out;
}

/// Returns the campaign of a rig once it has ended or is paused, with its candidates.
v1::Campaign computed_rig_campaign(const ScreenFlags& flags, Connection& connection,
                                   const CommonOptions& options, InterruptText& interrupts) {
  std::string name = flags.campaign;
  if (name.empty()) {
    std::string model_version;
    const v1::Campaign request = rig_campaign_request(flags, connection, model_version);
    interrupts.set(kCampaignMayExist);
    name = create_or_find(connection, request, model_version).name();
  }
  interrupts.set(interrupted_campaign(connection, name));
  go_on(flags, connection.get_campaign(name), connection);
  follow_to_end(connection, name, options.progress_form());
  return connection.get_campaign(name, v1::CAMPAIGN_VIEW_FULL);
}

}  // namespace

int run_rig_screen(const ScreenFlags& flags, Connection& connection, const CommonOptions& options,
                   InterruptText& interrupts) {
  const v1::Campaign campaign = computed_rig_campaign(flags, connection, options, interrupts);
  const bool is_complete = campaign.state() == v1::Campaign::SUCCEEDED;
  if (!is_complete) report_stop(campaign, connection);
  if (!flags.csv_path.empty()) {
    write_file(flags.csv_path, [&](std::ostream& file) {
      read_rig_rows(connection, campaign,
                    [&file](const std::vector<std::string>& cells) { file << csv_line(cells); });
    });
  }
  const OutputFormat format = options.output_format;
  v1::RankCandidatesRequest ranking;
  ranking.set_name(campaign.name());
  ranking.set_count(format == OutputFormat::kTable ? std::min(flags.top, kMostCandidates)
                                                   : kMostCandidates);
  *ranking.mutable_objective() =
      flags.rig.objectives.empty() ? usual_objective(campaign) : flags.rig.objectives.front();
  ranking.set_confidence(flags.confidence);
  ranking.set_ignore_stated_uncertainties(flags.leaves_out_uncertainty);
  if (!flags.leaves_out_uncertainty) {
    *ranking.mutable_uncertainties() = {flags.uncertainties.begin(), flags.uncertainties.end()};
  }
  const v1::RankCandidatesResponse best = connection.rank_candidates(ranking);
  const bool is_json = format == OutputFormat::kJson;
  std::string out = ranking_answer_text(ranking, best, format);
  if (is_json) {
    out = "{\n\"campaign\": " + json_quoted(campaign.name()) + ",\n\"ranking\": " + out;
  }
  const auto add = [&](const char* member, const std::string& text) {
    out += is_json ? std::string(",\n\"") + member + "\": " + text : "\n" + text;
  };
  if (!flags.pareto_column.empty()) {
    v1::FindParetoCandidatesRequest request;
    request.set_name(campaign.name());
    *request.mutable_first() = ranking.objective();
    request.mutable_second()->set_wants_most(flags.wants_most);
    Complaints complaints;
    read_candidate_figure("--pareto", flags.pareto_column,
                          *request.mutable_second()->mutable_figure(), complaints);
    if (!complaints.empty()) throw Failure(kExitUsage, joined(complaints, "\n"));
    add("pareto_front",
        front_answer_text(request, connection.find_pareto_candidates(request), best, format));
  }
  if (flags.wants_effects) {
    v1::EstimateCandidateEffectsRequest request;
    request.set_name(campaign.name());
    *request.mutable_figure() = ranking.objective().figure();
    add("main_effects",
        effects_answer_text(request, connection.estimate_candidate_effects(request), best, format));
  }
  if (format == OutputFormat::kTable) {
    const std::string program = program_of(connection), id = resource_id(campaign.name());
    Sheet sheet;
    sheet.remark("The server keeps the figures as " + campaign.name() + ": `" + program +
                 " screen --campaign " + id + "` ranks them again, `" + program +
                 " campaigns columns " + id + "` prints them, `" + program + " campaigns delete " +
                 id + "` deletes them.");
    out += "\n" + sheet.text();
  }
  std::cout << out << (is_json ? "}\n" : "");
  return is_complete && !best.candidates().empty() ? kExitOk : kExitFailed;
}

}  // namespace tribodyn::client
