#include <algorithm>
#include <iostream>
#include <utility>

#include "client/cpp/commands/campaign_command.h"
#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/report/campaign_report.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/resources/candidate_table.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct AppendFlags {
  std::string name;
  std::string path;  ///< of a table
  std::vector<std::string> lubricants;
};

/// Returns the columns of a table that ride along in the campaign, although their names may
/// resemble those of parameters.
std::vector<std::string> carried_columns(const std::string& text, const v1::Campaign& campaign) {
  std::vector<std::string> out;
  for (const CsvLine& header : read_csv(text, 1)) {
    for (const std::string& cell : header.cells) {
      const std::string name = attribute_text(cell);
      const bool rides_along = std::any_of(
          campaign.candidate_attributes().begin(), campaign.candidate_attributes().end(),
          [&](const v1::CandidateAttribute& each) { return each.name() == name; });
      const bool is_own = name == "name" || name.ends_with("uncertainty");
      if (rides_along && !is_own) out.push_back(cell);
    }
  }
  return out;
}

/// Returns the request that adds the rows of a table to a campaign. A parameter of the campaign
/// that the table leaves out is as in the base.
v1::AppendCandidatesRequest rows_to_append(const std::string& path, const v1::Schema& schema,
                                           const v1::Campaign& campaign, Connection& connection) {
  const std::string text = read_table_file(path, kLargestFile);
  CandidateBase base;
  base.lubricant = connection.get<v1::Lubricant>(campaign.lubricant_revision());
  if (!campaign.surface_revision().empty()) {
    base.surface = connection.get<v1::Surface>(campaign.surface_revision());
  }
  const ResourcePointer stated = base_of_rows(connection, kind_of(*v1::Lubricant::descriptor()),
                                              campaign.lubricant_revision());
  base.stated = dynamic_cast<const v1::Lubricant&>(*stated);
  Screening further;
  further.table =
      read_candidates(text, path, base, carried_columns(text, campaign), CarriedBy::kCampaign);
  if (!further.table.note.empty()) {
    std::cerr << "tribodyn: " << printable(further.table.note) << "\n";
  }
  characterise_candidates(connection, base, further.table);
  check_candidate_ranges(schema, further.table);
  for (std::size_t i = 0; i < further.table.size(); ++i) {
    if (further.table.refusals[i].empty()) continue;
    throw Failure(kExitFailed, "candidate " + printable(further.table.names[i]) +
                                   " cannot be computed: " + printable(further.table.refusals[i]));
  }
  further.bases = std::move(base);
  return further_candidates(further, campaign);
}

int run_append(AppendFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  v1::AppendCandidatesRequest request;
  if (!flags.path.empty()) {
    const v1::Campaign campaign = connection.get_campaign(flags.name, v1::CAMPAIGN_VIEW_FULL);
    request = rows_to_append(flags.path, connection.schema(), campaign, connection);
  }
  request.set_name(flags.name);
  *request.mutable_candidate_lubricants() = {flags.lubricants.begin(), flags.lubricants.end()};
  std::cout << campaigns_text({connection.append_candidates(request)}, options.output_format);
  return kExitOk;
}

}  // namespace

Command campaign_append_command() {
  const auto flags = std::make_shared<AppendFlags>();
  Command command = one_campaign_command(
      {"campaigns append", "add candidates to a campaign",
       "Adds the rows of a table to the candidates of a campaign, or lubricants to one whose "
       "candidates are lubricants. What is computed stays; a campaign that has succeeded runs "
       "again. "
       "The table has the columns of the one that the campaign was made of. `tribodyn screen "
       "--campaign NAME` follows and ranks them.",
       "tribodyn campaigns append 12 more.csv"},
      flags->name);
  command.flags.text("table", "FILE.csv",
                     "Table of further candidates, one a row; - is standard input.",
                     [flags](const std::string& path) { flags->path = path; });
  command.flags.group("Options");
  command.flags
      .texts("--lubricants", "NAME", "Lubricants in place of a table, separated by commas",
             [flags](const std::string& name) {
               flags->lubricants.push_back(resource_name("lubricants", name));
             })
      .collection = "lubricants";
  add_check(command, [flags](Complaints& complaints) {
    if (flags->path.empty() == flags->lubricants.empty()) {
      complaints.emplace_back("give either a table or --lubricants");
    }
  });
  command.run = [flags](const CommonOptions& options) { return run_append(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
