#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "client/cpp/commands/command.h"
#include "client/cpp/commands/label_filter.h"
#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/resources/candidate_table.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/service/campaign_run.h"
#include "client/cpp/service/screening_campaign.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr int kRowsOfATable = 20;  // that `campaigns columns` shows on a terminal by default

struct CampaignFlags {
  std::vector<std::string> names;
  ListOptions list;
  DeleteOptions deletion;
  std::optional<v1::CampaignBudget> budget;
  std::vector<std::string> columns;
  int start_row = 0;
  std::optional<int> row_count;
  std::string row_filter;
  std::vector<std::string> label_filters;
  v1::Campaign changed;                  ///< display name and labels
  std::vector<std::string> update_mask;  ///< which of them change
  std::string path;                      ///< of a table
  std::vector<std::string> lubricants;
};

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
    table.add_row({resource_id(each.name()), state_text(each.state()),
                   percent_text(done_share(each)), std::to_string(each.points()),
                   std::to_string(each.points_refused()), day_and_time(each.create_time()),
                   duration_text(each.processor_seconds()), resource_id(each.lubricant_revision()),
                   each.display_name()});
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
                    {"stop_message", each.stop().message()}});
  }
  return csv_text(rows);
}

std::string campaigns_text(const std::vector<v1::Campaign>& campaigns, OutputFormat format) {
  if (format == OutputFormat::kTable) return campaigns_table(campaigns);
  if (format == OutputFormat::kCsv) return campaigns_csv(campaigns);
  v1::ListCampaignsResponse list;
  *list.mutable_campaigns() = {campaigns.begin(), campaigns.end()};
  list.set_total_size(static_cast<int>(campaigns.size()));
  return json_text(list);
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
  sheet.line("state", state_text(campaign.state()));
  if (campaign.has_stop()) {
    sheet.remark(campaign.stop().reason() + ": " + campaign.stop().message());
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

int run_campaigns_list(const CampaignFlags& flags, const CommonOptions& options) {
  ListOptions wanted = flags.list;
  wanted.filter = with_labels(wanted.filter, flags.label_filters);
  const auto list = options.connect().list_campaigns(wanted);
  std::cout << campaigns_text(list.resources, options.output_format);
  if (list.has_more) {
    std::cerr << "These are " << list.resources.size() << " of " << list.total_size
              << ". Use --limit N, or for the next page\n--page-token " << list.next_page_token
              << "\n";
  }
  return kExitOk;
}

int run_campaigns_show(const CampaignFlags& flags, const CommonOptions& options) {
  const v1::Campaign campaign =
      options.connect().get_campaign(resource_name("campaigns", flags.names.front()));
  switch (options.output_format) {
    case OutputFormat::kTable:
      std::cout << campaign_sheet(campaign);
      break;
    case OutputFormat::kCsv:
      std::cout << campaigns_csv({campaign});
      break;
    case OutputFormat::kJson:
      std::cout << json_text(campaign);
  }
  return kExitOk;
}

/// Calls `change` for each campaign and prints the new states.
template <class Change>
int run_campaigns_each(const CampaignFlags& flags, const CommonOptions& options,
                       const Change& change) {
  Connection connection = options.connect();
  std::vector<v1::Campaign> campaigns;
  for (const std::string& name : flags.names) {
    campaigns.push_back(change(connection, resource_name("campaigns", name)));
  }
  std::cout << campaigns_text(campaigns, options.output_format);
  return kExitOk;
}

/// Says of a campaign that had ended before that its state did not change.
void report_ended(const v1::Campaign& before, const char* action) {
  if (!has_ended(before.state())) return;
  std::cerr << printable(before.name()) << " had already ended (" << state_text(before.state())
            << "); nothing to " << action << ".\n";
}

int run_campaigns_pause(const CampaignFlags& flags, const CommonOptions& options) {
  return run_campaigns_each(flags, options, [](Connection& connection, const std::string& name) {
    report_ended(connection.get_campaign(name), "pause");
    return connection.pause_campaign(name);
  });
}

int run_campaigns_resume(const CampaignFlags& flags, const CommonOptions& options) {
  return run_campaigns_each(flags, options, [&](Connection& connection, const std::string& name) {
    return connection.resume_campaign(name, flags.budget);
  });
}

int run_campaigns_update(const CampaignFlags& flags, const CommonOptions& options) {
  return run_campaigns_each(flags, options, [&](Connection& connection, const std::string& name) {
    v1::Campaign campaign = flags.changed;
    campaign.set_name(name);
    return connection.update_campaign(campaign, flags.update_mask);
  });
}

/// Returns the request that adds the rows of a table to a campaign. A parameter of the campaign
/// that the table leaves out is as in the base.
v1::AppendCandidatesRequest rows_to_append(const CampaignFlags& flags, const v1::Schema& schema,
                                           const v1::Campaign& campaign, Connection& connection) {
  const std::string text = read_table_file(flags.path, kLargestFile);
  CandidateBase base;
  base.lubricant = connection.get<v1::Lubricant>(campaign.lubricant_revision());
  if (!campaign.surface_revision().empty()) {
    base.surface = connection.get<v1::Surface>(campaign.surface_revision());
  }
  const ResourcePointer stated = base_of_rows(connection, kind_of(*v1::Lubricant::descriptor()),
                                              campaign.lubricant_revision());
  base.stated = dynamic_cast<const v1::Lubricant&>(*stated);
  Screening further;
  further.table = read_candidates(text, flags.path, base, {});
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

int run_campaigns_append(const CampaignFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const std::string name = resource_name("campaigns", flags.names.front());
  v1::AppendCandidatesRequest request;
  if (!flags.path.empty()) {
    const v1::Campaign campaign = connection.get_campaign(name, v1::CAMPAIGN_VIEW_FULL);
    request = rows_to_append(flags, connection.schema(), campaign, connection);
  }
  request.set_name(name);
  *request.mutable_candidate_lubricants() = {flags.lubricants.begin(), flags.lubricants.end()};
  std::cout << campaigns_text({connection.append_candidates(request)}, options.output_format);
  return kExitOk;
}

int run_campaigns_cancel(const CampaignFlags& flags, const CommonOptions& options) {
  return run_campaigns_each(flags, options, [](Connection& connection, const std::string& name) {
    report_ended(connection.get_campaign(name), "cancel");
    return connection.cancel_campaign(name);
  });
}

int run_campaigns_delete(const CampaignFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  for (const std::string& each : flags.names) {
    const std::string name = resource_name("campaigns", each);
    connection.delete_campaign(name, flags.deletion);
    std::cerr << "deleted " << printable(name) << "\n";
  }
  return kExitOk;
}

std::vector<std::string> row_cells(const HistoryRows& rows, std::size_t row,
                                   std::string (*text)(double)) {
  std::vector<std::string> out;
  for (const std::vector<double>& column : rows.columns) out.push_back(text(column[row]));
  return out;
}

void print_csv(Connection& connection, const std::string& name, const CampaignRowsOptions& part) {
  connection.stream_campaign(
      name, part,
      [](const v1::HistorySchema& schema) {
        std::vector<std::string> header;
        for (const auto& each : schema.columns()) header.push_back(each.name());
        std::cout << csv_line(header);
      },
      [](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.front().size(); ++i) {
          std::cout << csv_line(row_cells(rows, i, shortest));
        }
      });
}

void print_table(Connection& connection, const std::string& name, const CampaignRowsOptions& part) {
  std::optional<Table> table;
  std::int64_t row_number = part.start_row;
  const bool is_filtered = !part.filter.empty();
  v1::HistorySchema schema;
  connection.stream_campaign(
      name, part,
      [&](const v1::HistorySchema& found) {
        schema = found;
        std::vector<Table::Column> columns = {
            {is_filtered ? "match" : "row", "", Table::Align::kRight}};
        for (const auto& each : found.columns()) {
          columns.push_back({each.name(), each.unit(), Table::Align::kDecimal});
        }
        table.emplace(std::move(columns));
      },
      [&](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.front().size(); ++i) {
          std::vector<std::string> cells =
              row_cells(rows, i, [](double value) { return significant(value, 6); });
          cells.insert(cells.begin(), std::to_string(row_number++));
          table->add_row(std::move(cells));
        }
      });
  std::cout << table->text();
  if (is_filtered) {
    std::cerr << row_number - part.start_row << " of the rows looked at satisfy the filter; the "
              << "column row has their numbers.\n";
  } else if (row_number < schema.total_rows()) {
    std::cerr << "Rows " << part.start_row << " to " << row_number - 1 << " of "
              << schema.total_rows()
              << ", counted from 0; --start-row, --row-count and --output csv "
              << "show others.\n";
  }
}

void print_json(Connection& connection, const std::string& name, const CampaignRowsOptions& part) {
  v1::History out;
  connection.stream_campaign(
      name, part,
      [&](const v1::HistorySchema& schema) {
        out.set_start_row(schema.start_row());
        out.set_total_rows(schema.total_rows());
        for (const auto& each : schema.columns()) {
          v1::History::Column* column = out.add_columns();
          column->set_name(each.name());
          column->set_unit(each.unit());
        }
      },
      [&](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.size(); ++i) {
          out.mutable_columns(static_cast<int>(i))
              ->mutable_values()
              ->Add(rows.columns[i].begin(), rows.columns[i].end());
        }
      });
  std::cout << json_text(out);
}

int run_campaigns_columns(const CampaignFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const std::string name = resource_name("campaigns", flags.names.front());
  CampaignRowsOptions part;
  part.columns = flags.columns;
  part.start_row = flags.start_row;
  part.filter = flags.row_filter;
  const bool is_table = options.output_format == OutputFormat::kTable;
  const bool is_short = is_table && part.filter.empty();
  part.row_count = flags.row_count.value_or(is_short ? kRowsOfATable : 0);
  switch (options.output_format) {
    case OutputFormat::kTable:
      print_table(connection, name, part);
      break;
    case OutputFormat::kCsv:
      print_csv(connection, name, part);
      break;
    case OutputFormat::kJson:
      print_json(connection, name, part);
  }
  return kExitOk;
}

Command campaign_command(const char* path, const char* summary, const char* about,
                         const char* example, bool several,
                         int (*run)(const CampaignFlags&, const CommonOptions&),
                         const std::shared_ptr<CampaignFlags>& flags) {
  Command command{path, summary, about, {example}, {}, {}, {}};
  command.flags.group("Arguments");
  const char* description = "The campaign, e.g. 12 or campaigns/12 (`tribodyn campaigns list`).";
  const auto add = [flags](const std::string& name) { flags->names.push_back(name); };
  if (several) {
    command.flags.texts("name", "NAME", description, add).collection = "campaigns";
  } else {
    command.flags.text("name", "NAME", description, add).collection = "campaigns";
  }
  command.check = [flags](Complaints& complaints) {
    if (flags->names.empty()) {
      complaints.emplace_back("NAME is missing; `tribodyn campaigns list` shows the campaigns");
    }
  };
  command.run = [flags, run](const CommonOptions& options) { return run(*flags, options); };
  return command;
}

Command campaign_command(const char* path, const char* summary, const char* about,
                         const char* example,
                         int (*run)(const CampaignFlags&, const CommonOptions&)) {
  return campaign_command(path, summary, about, example, true, run,
                          std::make_shared<CampaignFlags>());
}

Command campaigns_list_command() {
  const auto flags = std::make_shared<CampaignFlags>();
  flags->list.limit = 20;
  Command command{
      "campaigns list",
      "list the newest campaigns",
      "Lists campaigns, newest first: the tables that `tribodyn screen` or other clients "
      "had screened.",
      {"tribodyn campaigns list --limit 5"},
      {},
      {},
      {}};
  command.flags.whole_number("--limit,-n", {"campaigns", "1 to 100000", "20"},
                             "Maximum number of campaigns listed",
                             [flags](int value) { flags->list.limit = value; });
  command.flags.text("--page-token", "TOKEN",
                     "Read the next page; the previous page printed the token.",
                     [flags](const std::string& text) { flags->list.page_token = text; });
  command.flags.text(
      "--filter", "FILTER",
      "Only campaigns that satisfy it, e.g. 'state = RUNNING AND lubricant = my-oil'; "
      "fields: display_name, state, lubricant, gear_set, surface, vehicle and "
      "labels.KEY.",
      [flags](const std::string& text) { flags->list.filter = text; });
  command.flags.texts("--label", "KEY[=VALUE]", "List only campaigns with this label; repeatable.",
                      [flags](const std::string& text) { flags->label_filters.push_back(text); });
  command.check = [flags](Complaints& complaints) {
    if (flags->list.limit < 1 || flags->list.limit > 100000) {
      complaints.emplace_back("--limit must be 1 to 100000");
    }
  };
  command.run = [flags](const CommonOptions& options) {
    return run_campaigns_list(*flags, options);
  };
  return command;
}

Command campaigns_show_command() {
  return campaign_command("campaigns show", "show the state of a campaign",
                          "Prints the state of a campaign: its progress, what it rests on and why "
                          "points have no figures. `tribodyn screen --campaign NAME` ranks its "
                          "candidates.",
                          "tribodyn campaigns show 12", false, run_campaigns_show,
                          std::make_shared<CampaignFlags>());
}

Command campaigns_update_command() {
  const auto flags = std::make_shared<CampaignFlags>();
  Command command = campaign_command(
      "campaigns update", "change the title or the labels of campaigns",
      "Changes the title or the labels of campaigns, whatever their state. Labels that are given "
      "take the place of all present ones.",
      "tribodyn campaigns update 12 --title 'Friction modifiers' --label project=axle", true,
      run_campaigns_update, flags);
  command.flags.group("Options");
  const auto changes = [flags](const std::string& field) {
    auto& mask = flags->update_mask;
    if (std::find(mask.begin(), mask.end(), field) == mask.end()) mask.push_back(field);
  };
  command.flags.text("--title", "TEXT", "The title; '' removes it.",
                     [flags, changes](const std::string& text) {
                       flags->changed.set_display_name(text);
                       changes("display_name");
                     });
  command.flags.texts("--label", "KEY=VALUE", "A label; repeatable.",
                      [flags, changes](const std::string& text) {
                        const std::size_t mark = text.find('=');
                        v1::Label& added = *flags->changed.add_labels();
                        added.set_key(text.substr(0, mark));
                        if (mark != std::string::npos) added.set_value(text.substr(mark + 1));
                        changes("labels");
                      });
  command.flags.toggle("--no-labels", "Remove all labels.", [changes] { changes("labels"); });
  const auto check_names = command.check;
  command.check = [flags, check_names](Complaints& complaints) {
    check_names(complaints);
    if (flags->update_mask.empty()) {
      complaints.emplace_back("give --title, --label or --no-labels: nothing would change");
    }
  };
  return command;
}

Command campaigns_append_command() {
  const auto flags = std::make_shared<CampaignFlags>();
  Command command = campaign_command(
      "campaigns append", "add candidates to a campaign",
      "Adds the rows of a table to the candidates of a campaign, or lubricants to one whose "
      "candidates are lubricants. What is computed stays; a campaign that has succeeded runs "
      "again. "
      "The table has the columns of the one that the campaign was made of. `tribodyn screen "
      "--campaign NAME` follows and ranks them.",
      "tribodyn campaigns append 12 more.csv", false, run_campaigns_append, flags);
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
  const auto check_names = command.check;
  command.check = [flags, check_names](Complaints& complaints) {
    check_names(complaints);
    if (flags->path.empty() == flags->lubricants.empty()) {
      complaints.emplace_back("give either a table or --lubricants");
    }
  };
  return command;
}

Command campaigns_resume_command() {
  const auto flags = std::make_shared<CampaignFlags>();
  Command command = campaign_command(
      "campaigns resume", "resume campaigns that are paused",
      "Resumes campaigns at their missing points. Without a budget here the present one stays.",
      "tribodyn campaigns resume 12 --points 20000", true, run_campaigns_resume, flags);
  command.flags.group("Options");
  const auto budget = [flags]() -> v1::CampaignBudget& {
    if (!flags->budget) flags->budget.emplace();
    return *flags->budget;
  };
  command.flags.number(
      "--processor-seconds", {"s", "0 to 1e9"},
      "Processor time after which the campaign pauses, counted from its start; 0: no limit",
      [budget](double value) { budget().set_processor_seconds(value); });
  command.flags.whole_number(
      "--points", {"points", "0 to 20000000"},
      "Points after which the campaign pauses, counted from its start; 0: no limit",
      [budget](int value) { budget().set_points(value); });
  return command;
}

Command campaigns_delete_command() {
  const auto flags = std::make_shared<CampaignFlags>();
  Command command = campaign_command(
      "campaigns delete", "delete campaigns and their figures for good",
      "Deletes campaigns with all of their rows. Refused while a campaign has not ended unless "
      "--cancel is set.",
      "tribodyn campaigns delete 12 --cancel", true, run_campaigns_delete, flags);
  command.flags.group("Options");
  command.flags.toggle("--cancel", "Cancel campaigns that have not ended, then delete them.",
                       [flags] { flags->deletion.cancel = true; });
  command.flags.toggle("--allow-missing", "Skip campaigns that do not exist.",
                       [flags] { flags->deletion.allow_missing = true; });
  return command;
}

Command campaigns_columns_command() {
  const auto flags = std::make_shared<CampaignFlags>();
  Command command = campaign_command(
      "campaigns columns", "print columns of a campaign",
      "Prints columns of a campaign by rows, finished or not. Row i * conditions + k is candidate "
      "i "
      "at condition k, counted from 0. Columns are the figures; refusal_number (0: the row has "
      "figures; n: sentence n of `campaigns show`; -1: not computed yet); candidate, condition; "
      "the "
      "fields of conditions, e.g. speed_kilometres_per_hour; the parameters of candidates, e.g. "
      "lubricant.relaxation_time_seconds; row; and the numbers that ride along with them.",
      "tribodyn campaigns columns 12 --columns candidate,inefficiency_energy_mean_percent "
      "--output csv",
      false, run_campaigns_columns, flags);
  command.flags.group("Options");
  command.flags.texts("--columns", "NAME",
                      "Columns, separated by commas. Default: refusal_number and all figures.",
                      [flags](const std::string& name) { flags->columns.push_back(name); });
  command.flags.whole_number("--start-row", {"rows", "0 to the last row", "0"}, "First row",
                             [flags](int value) { flags->start_row = value; });
  command.flags.whole_number("--row-count", {"rows", "0 or more", "20 in a table, else all"},
                             "Number of rows; 0: to the end",
                             [flags](int value) { flags->row_count = value; });
  command.flags.text("--filter", "FILTER",
                     "Only rows that satisfy all conditions, e.g. 'refusal_number > 0' or "
                     "'film_ratio_minimum < 1 AND additive = ZDDP': columns with = != < <= > >=.",
                     [flags](const std::string& text) { flags->row_filter = text; });
  return command;
}

}  // namespace

std::vector<Command> campaign_commands() {
  std::vector<Command> out;
  out.push_back(campaigns_list_command());
  out.push_back(campaigns_show_command());
  out.push_back(campaigns_update_command());
  out.push_back(campaigns_append_command());
  out.push_back(campaign_command(
      "campaigns pause", "pause campaigns",
      "Pauses campaigns; what is computed is kept, and `campaigns resume` continues them.",
      "tribodyn campaigns pause 12", run_campaigns_pause));
  out.push_back(campaigns_resume_command());
  out.push_back(campaign_command("campaigns cancel", "cancel campaigns",
                                 "Cancels campaigns; their rows stay. A campaign that has ended "
                                 "does not change.",
                                 "tribodyn campaigns cancel 12", run_campaigns_cancel));
  out.push_back(campaigns_delete_command());
  out.push_back(campaigns_columns_command());
  return out;
}

}  // namespace tribodyn::client
