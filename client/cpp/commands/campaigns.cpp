#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "client/cpp/commands/campaign_command.h"
#include "client/cpp/commands/label_filter.h"
#include "client/cpp/report/campaign_report.h"
#include "client/cpp/report/screening.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct ListFlags {
  ListOptions list;
  std::vector<std::string> label_filters;
};

int run_list(const ListFlags& flags, const CommonOptions& options) {
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

/// Calls `change` for each campaign and prints the new states.
template <class Change>
int run_each(const std::vector<std::string>& names, const CommonOptions& options,
             const Change& change) {
  Connection connection = options.connect();
  std::vector<v1::Campaign> campaigns;
  for (const std::string& name : names) campaigns.push_back(change(connection, name));
  std::cout << campaigns_text(campaigns, options.output_format);
  return kExitOk;
}

/// Says of a campaign that had ended before that its state did not change.
void report_ended(const v1::Campaign& before, const char* action) {
  if (!has_ended(before.state())) return;
  std::cerr << printable(before.name()) << " had already ended (" << state_text(before)
            << "); nothing to " << action << ".\n";
}

Command campaigns_list_command() {
  const auto flags = std::make_shared<ListFlags>();
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
      "`tribodyn help filters` lists the fields.",
      [flags](const std::string& text) { flags->list.filter = text; });
  command.flags.texts("--label", "KEY[=VALUE]", "List only campaigns with this label; repeatable.",
                      [flags](const std::string& text) { flags->label_filters.push_back(text); });
  command.check = [flags](Complaints& complaints) {
    if (flags->list.limit < 1 || flags->list.limit > 100000) {
      complaints.emplace_back("--limit must be 1 to 100000");
    }
  };
  command.run = [flags](const CommonOptions& options) { return run_list(*flags, options); };
  return command;
}

Command campaigns_show_command() {
  const auto name = std::make_shared<std::string>();
  Command command = one_campaign_command(
      {"campaigns show", "show the state of a campaign",
       "Prints the state of a campaign: its progress, what it rests on and why "
       "points have no figures. `tribodyn screen --campaign NAME` ranks its "
       "candidates.",
       "tribodyn campaigns show 12"},
      *name);
  command.run = [name](const CommonOptions& options) {
    std::cout << campaign_text(options.connect().get_campaign(*name), options.output_format);
    return kExitOk;
  };
  return command;
}

struct UpdateFlags {
  std::vector<std::string> names;
  v1::Campaign changed;                  ///< display name and labels
  std::vector<std::string> update_mask;  ///< which of them change
};

Command campaigns_update_command() {
  const auto flags = std::make_shared<UpdateFlags>();
  Command command = campaigns_command(
      {"campaigns update", "change the title or the labels of campaigns",
       "Changes the title or the labels of campaigns, whatever their state. Labels that are given "
       "take the place of all present ones.",
       "tribodyn campaigns update 12 --title 'Friction modifiers' --label project=axle"},
      flags->names);
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
  add_check(command, [flags](Complaints& complaints) {
    if (flags->update_mask.empty()) {
      complaints.emplace_back("give --title, --label or --no-labels: nothing would change");
    }
  });
  command.run = [flags](const CommonOptions& options) {
    return run_each(flags->names, options, [&](Connection& connection, const std::string& name) {
      v1::Campaign campaign = flags->changed;
      campaign.set_name(name);
      return connection.update_campaign(campaign, flags->update_mask);
    });
  };
  return command;
}

/// Returns a command that stops campaigns: `stop` pauses or cancels one.
Command stop_command(const CampaignTexts& texts, const char* action,
                     v1::Campaign (Connection::*stop)(const std::string&)) {
  const auto names = std::make_shared<std::vector<std::string>>();
  Command command = campaigns_command(texts, *names);
  command.run = [names, action, stop](const CommonOptions& options) {
    return run_each(*names, options, [&](Connection& connection, const std::string& name) {
      report_ended(connection.get_campaign(name), action);
      return (connection.*stop)(name);
    });
  };
  return command;
}

struct ResumeFlags {
  std::vector<std::string> names;
  std::optional<v1::CampaignBudget> budget;
};

Command campaigns_resume_command() {
  const auto flags = std::make_shared<ResumeFlags>();
  Command command = campaigns_command(
      {"campaigns resume", "resume campaigns that are paused",
       "Resumes campaigns at their missing points. Without a budget here the present one stays.",
       "tribodyn campaigns resume 12 --points 20000"},
      flags->names);
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
  command.run = [flags](const CommonOptions& options) {
    return run_each(flags->names, options, [&](Connection& connection, const std::string& name) {
      return connection.resume_campaign(name, flags->budget);
    });
  };
  return command;
}

struct DeleteFlags {
  std::vector<std::string> names;
  DeleteOptions deletion;
};

Command campaigns_delete_command() {
  const auto flags = std::make_shared<DeleteFlags>();
  Command command = campaigns_command(
      {"campaigns delete", "delete campaigns and their figures for good",
       "Deletes campaigns with all of their rows. Refused while a campaign has not ended unless "
       "--cancel is set.",
       "tribodyn campaigns delete 12 --cancel"},
      flags->names);
  command.flags.group("Options");
  command.flags.toggle("--cancel", "Cancel campaigns that have not ended, then delete them.",
                       [flags] { flags->deletion.cancel = true; });
  command.flags.toggle("--allow-missing", "Skip campaigns that do not exist.",
                       [flags] { flags->deletion.allow_missing = true; });
  command.run = [flags](const CommonOptions& options) {
    Connection connection = options.connect();
    for (const std::string& name : flags->names) {
      connection.delete_campaign(name, flags->deletion);
      std::cerr << "deleted " << printable(name) << "\n";
    }
    return kExitOk;
  };
  return command;
}

}  // namespace

std::vector<Command> campaign_commands() {
  std::vector<Command> out;
  out.push_back(campaigns_list_command());
  out.push_back(campaigns_show_command());
  out.push_back(campaigns_update_command());
  out.push_back(campaign_append_command());
  out.push_back(stop_command(
      {"campaigns pause", "pause campaigns",
       "Pauses campaigns; what is computed is kept, and `campaigns resume` continues them.",
       "tribodyn campaigns pause 12"},
      "pause", &Connection::pause_campaign));
  out.push_back(campaigns_resume_command());
  out.push_back(stop_command({"campaigns cancel", "cancel campaigns",
                              "Cancels campaigns; their rows stay. A campaign that has ended does "
                              "not change.",
                              "tribodyn campaigns cancel 12"},
                             "cancel", &Connection::cancel_campaign));
  out.push_back(campaigns_delete_command());
  out.push_back(campaign_columns_command());
  return out;
}

}  // namespace tribodyn::client
