#include "client/cpp/report/campaign_report.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>

#include "client/cpp/report/screening.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/progress.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {
namespace {

std::string day_and_time(const google::protobuf::Timestamp& time) {
  using google::protobuf::util::TimeUtil;
  return TimeUtil::ToString(TimeUtil::SecondsToTimestamp(time.seconds()));
}

double done_share(const v1::Campaign& campaign) {
  return static_cast<double>(campaign.points_done()) / std::max(campaign.points(), 1);
}

std::string campaigns_table(const std::vector<v1::Campaign>& campaigns) {
  Table table({{"Name", "", Table::Align::kLeft},
               {"State", "", Table::Align::kLeft},
               {"done", "%"},
               {"points", ""},
               {"refused", ""},
               {"Created", "UTC", Table::Align::kLeft},
               {"processor", ""},
               {"Lubricant", "", Table::Align::kLeft},
               {"Title", "", Table::Align::kLeft}});
  for (const v1::Campaign& each : campaigns) {
    table.add_row({resource_id(each.name()), state_text(each), percent_text(done_share(each)),
                   std::to_string(each.points()), std::to_string(each.points_refused()),
                   day_and_time(each.create_time()), duration_text(each.processor_seconds()),
                   resource_id(each.lubricant_revision()), each.display_name()});
  }
  return table.text();
}

std::string campaigns_csv(const std::vector<v1::Campaign>& campaigns) {
  std::vector<CsvRow> rows;
  for (const v1::Campaign& each : campaigns) {
    rows.push_back({{"name", each.name()},
                    {"display_name", each.display_name()},
                    {"state", v1::Campaign::State_Name(each.state())},
                    {"candidates", std::to_string(each.candidates())},
                    {"points", std::to_string(each.points())},
                    {"points_done", std::to_string(each.points_done())},
                    {"points_refused", std::to_string(each.points_refused())},
                    {"processor_seconds", shortest(each.processor_seconds())},
                    {"create_time", day_and_time(each.create_time())},
                    {"lubricant", each.lubricant_revision()},
                    {"gear_set", each.gear_set_revision()},
                    {"surface", each.surface_revision()},
                    {"vehicle", each.vehicle_revision()},
                    {"model_version", each.model_version()},
                    {"input_hash", each.input_hash()},
                    {"stored_bytes", std::to_string(each.stored_bytes())},
                    {"stop_reason", each.stop().reason()},
                    {"stop_message", each.stop().message()},
                    {"stalled_reason", each.stalled().reason()},
                    {"stalled_message", each.stalled().message()}});
  }
  return csv_text(rows);
}

std::string budget_text(const v1::CampaignBudget& budget) {
  std::vector<std::string> out;
  if (budget.processor_seconds() > 0) {
    out.push_back(duration_text(budget.processor_seconds()) + " of a processor");
  }
  if (budget.points() > 0) out.push_back(std::to_string(budget.points()) + " points");
  return out.empty() ? "none" : joined(out, ", ");
}

std::string campaign_sheet(const v1::Campaign& campaign) {
  Sheet sheet;
  sheet.heading(campaign.name() + (campaign.display_name().empty() ? "" : ": ") +
                campaign.display_name());
  sheet.line("state", state_text(campaign));
  if (const v1::CampaignStop why = reason_for_state(campaign); !why.reason().empty()) {
    sheet.remark(why.reason() + ": " + why.message());
  }
  sheet.line("points computed", std::to_string(campaign.points_done()), "",
             "of " + std::to_string(campaign.points()) + ", " +
                 std::to_string(campaign.candidates()) + " candidates at " +
                 std::to_string(campaign.points() / std::max(campaign.candidates(), 1)) +
                 " conditions" + (campaign.has_rig() ? " of a rig" : ""));
  sheet.line("points without figures", std::to_string(campaign.points_refused()));
  sheet.line("processor time", duration_text(campaign.processor_seconds()));
  sheet.line("budget", budget_text(campaign.budget()));
  sheet.line("size in the database", significant(1e-3 * campaign.stored_bytes(), 3), "kB");
  sheet.line("created", day_and_time(campaign.create_time()));
  if (campaign.has_end_time()) sheet.line("ended", day_and_time(campaign.end_time()));
  if (campaign.has_expire_time()) {
    sheet.line("may be removed from", day_and_time(campaign.expire_time()));
  }
  sheet.heading("What it rests on");
  sheet.line("lubricant", campaign.lubricant_revision());
  sheet.line("surface",
             campaign.surface_revision().empty() ? "none: smooth" : campaign.surface_revision());
  if (!campaign.has_rig()) {
    sheet.line("gear set", campaign.gear_set_revision());
    sheet.line("vehicle", campaign.vehicle_revision());
  }
  sheet.line("model", campaign.model_version());
  sheet.line("hash of inputs", campaign.input_hash());
  sheet.line("request id", campaign.request_id());
  if (campaign.refusals_size() > 0) sheet.heading("Why points have no figures");
  for (int i = 0; i < campaign.refusals_size(); ++i) {
    sheet.remark(std::to_string(i + 1) + ": " + campaign.refusals(i).message() + " (" +
                 campaign.refusals(i).reason() + ")");
  }
  return sheet.text();
}

}  // namespace

v1::CampaignStop reason_for_state(const v1::Campaign& campaign) {
  return campaign.has_stalled() ? campaign.stalled() : campaign.stop();
}

std::string state_text(const v1::Campaign& campaign) {
  switch (campaign.state()) {
    case v1::Campaign::RUNNING:
      return campaign.has_stalled() ? "stalled" : "running";
    case v1::Campaign::PAUSED:
      return "paused";
    case v1::Campaign::SUCCEEDED:
      return "succeeded";
    case v1::Campaign::FAILED:
      return "failed";
    case v1::Campaign::CANCELLED:
      return "cancelled";
    default:
      return "unknown state";
  }
}

std::string points_text(const v1::Campaign& campaign) {
  return std::to_string(campaign.points_done()) + " of " + std::to_string(campaign.points()) +
         " points";
}

std::string campaigns_text(const std::vector<v1::Campaign>& campaigns, OutputFormat format) {
  if (format == OutputFormat::kTable) return campaigns_table(campaigns);
  if (format == OutputFormat::kCsv) return campaigns_csv(campaigns);
  v1::ListCampaignsResponse list;
  *list.mutable_campaigns() = {campaigns.begin(), campaigns.end()};
  list.set_total_size(static_cast<int>(campaigns.size()));
  return json_text(list);
}

std::string campaign_text(const v1::Campaign& campaign, OutputFormat format) {
  switch (format) {
    case OutputFormat::kTable:
      return campaign_sheet(campaign);
    case OutputFormat::kCsv:
      return campaigns_csv({campaign});
    case OutputFormat::kJson:
      break;
  }
  return json_text(campaign);
}

}  // namespace tribodyn::client
