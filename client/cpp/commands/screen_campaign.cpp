#include <iostream>

#include "client/cpp/commands/screen_run.h"
#include "client/cpp/report/campaign_report.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/service/follow.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {

std::vector<std::string> candidate_lubricants(const ScreenFlags& flags, Connection& connection) {
  std::vector<v1::Lubricant> found;
  for (const std::string& name : flags.lubricants) {
    found.push_back(connection.get<v1::Lubricant>(name));
  }
  if (!flags.lubricant_filter.empty()) {
    ListOptions list;
    list.filter = flags.lubricant_filter;
    found = connection.list<v1::Lubricant>(list).resources;
    if (found.empty()) {
      throw Failure(kExitUsage, "--lubricant-filter: no lubricant satisfies it");
    }
  }
  std::vector<std::string> out;
  for (const v1::Lubricant& each : found) {
    const std::string name = each.name().substr(0, each.name().find('@'));
    out.push_back(name + "@" + std::to_string(each.revision()));
  }
  return out;
}

void set_made_candidates(const ScreenFlags& flags, const std::vector<std::string>& lubricants,
                         v1::Campaign& campaign) {
  if (flags.has_design()) *campaign.mutable_candidate_design() = design_message(flags.design);
  *campaign.mutable_candidate_lubricants() = {lubricants.begin(), lubricants.end()};
}

std::string table_title(const std::string& path) {
  return path == "-" ? "" : path.substr(path.rfind('/') + 1);
}

void go_on(const ScreenFlags& flags, const v1::Campaign& campaign, Connection& connection) {
  const bool is_paused = campaign.state() == v1::Campaign::PAUSED;
  if (has_ended(campaign.state()) || (!is_paused && !flags.budget)) return;
  try {
    connection.resume_campaign(campaign.name(), flags.budget.value_or(v1::CampaignBudget()));
  } catch (const ServiceError& error) {
    if (error.reason() != "ENDED") throw;  // since it was created or read
  }
}

void report_stop(const v1::Campaign& campaign, const Connection& connection) {
  const std::string program = program_of(connection), id = resource_id(campaign.name());
  std::cerr << "tribodyn: " << campaign.name() << " is " << state_text(campaign) << " after "
            << points_text(campaign);
  if (campaign.has_stop()) std::cerr << ": " << printable(campaign.stop().message());
  std::cerr << "\n"
            << (campaign.state() == v1::Campaign::PAUSED
                    ? "  Go on: the same command, with a larger budget or none, or " + program +
                          " campaigns resume " + id
                    : "  To compute it again, delete it first: " + program + " campaigns delete " +
                          id)
            << "\n";
}

}  // namespace tribodyn::client
