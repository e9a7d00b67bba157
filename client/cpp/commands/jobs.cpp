#include <google/protobuf/util/time_util.h>

#include <iostream>
#include <memory>

#include "client/cpp/commands/label_filter.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/commands/show_results.h"
#include "client/cpp/report/results.h"
#include "client/cpp/resources/kind.h"
#include "client/cpp/service/follow.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using google::protobuf::util::TimeUtil;

struct JobFlags {
  std::vector<std::string> names;
  ListOptions list;
  std::vector<std::string> labels;
  DeleteOptions deletion;
  ResultDetails details;
};

std::string time_text(const google::protobuf::Timestamp& time) {
  const google::protobuf::Timestamp whole = TimeUtil::SecondsToTimestamp(time.seconds());
  return TimeUtil::ToString(whole);
}

std::string jobs_table(const std::vector<v1::Simulation>& simulations) {
  Table table({{"Name", "", Table::Align::kLeft},
               {"State", "", Table::Align::kLeft},
               {"done", "%"},
               {"pinned", "", Table::Align::kLeft},
               {"Created", "UTC", Table::Align::kLeft},
               {"took", ""},
               {"Lubricant", "", Table::Align::kLeft},
               {"Study", "", Table::Align::kLeft},
               {"Title", "", Table::Align::kLeft}});
  for (const v1::Simulation& simulation : simulations) {
    const double seconds = run_seconds(simulation);
    table.add_row({resource_id(simulation.name()), state_text(simulation.state()),
                   percent_text(simulation.progress_fraction()), simulation.pinned() ? "yes" : "",
                   simulation.has_create_time() ? time_text(simulation.create_time()) : "-",
                   seconds >= 0 ? duration_text(seconds) : "-", resource_id(simulation.lubricant()),
                   study_text(simulation), simulation.display_name()});
  }
  return table.text();
}

std::string jobs_csv(const std::vector<v1::Simulation>& simulations) {
  std::vector<CsvRow> rows;
  for (const v1::Simulation& simulation : simulations) {
    const Inputs inputs = inputs_of(simulation);
    const double seconds = run_seconds(simulation);
    rows.push_back(
        {{"name", simulation.name()},
         {"display_name", simulation.display_name()},
         {"state", v1::Simulation::State_Name(simulation.state())},
         {"progress_fraction", shortest(simulation.progress_fraction())},
         {"create_time",
          simulation.has_create_time() ? TimeUtil::ToString(simulation.create_time()) : ""},
         {"attempt", std::to_string(simulation.attempt())},
         {"pinned", simulation.pinned() ? "true" : "false"},
         {"cache_hit", simulation.cache_hit() ? "true" : "false"},
         {"input_hash", simulation.input_hash()},
         {"run_seconds", seconds >= 0 ? shortest(seconds) : ""},
         {"lubricant", inputs.lubricant},
         {"gear_set", inputs.gear_set},
         {"surface", inputs.surface},
         {"vehicle", inputs.vehicle},
         {"sump_temperature_celsius", shortest(inputs.sump_temperature_celsius)},
         {"study", study_text(simulation)},
         {"error_reason", simulation.error().reason()},
         {"error_message", simulation.error().message()}});
  }
  return csv_text(rows);
}

std::string jobs_text(const std::vector<v1::Simulation>& simulations, OutputFormat format,
                      bool alone) {
  switch (format) {
    case OutputFormat::kTable:
      return jobs_table(simulations);
    case OutputFormat::kCsv:
      return jobs_csv(simulations);
    case OutputFormat::kJson:
      break;
  }
  return results_text(simulations, format, alone, {}, {});
}

int run_list(const JobFlags& flags, const CommonOptions& options) {
  ListOptions list_options = flags.list;
  list_options.filter = with_labels(list_options.filter, flags.labels);
  const auto list = options.connect().list_simulations(list_options);
  std::cout << jobs_text(list.resources, options.output_format, false);
  if (list.has_more) {
    std::cerr << "These are " << list.resources.size() << " of " << list.total_size
              << ". Use --limit N, or for the next page\n--page-token " << list.next_page_token
              << "\n";
  }
  return kExitOk;
}

/// Prints the result of a job that has one; the state of any other job.
int run_get(const JobFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const v1::Simulation simulation =
      connection.get_simulation(resource_name("simulations", flags.names.front()));
  if (simulation.state() == v1::Simulation::SUCCEEDED) {
    std::cout << shown_results({simulation}, connection, options, true, flags.details);
    return report_failures({simulation});
  }
  std::cout << jobs_text({simulation}, options.output_format, true);
  return has_ended(simulation.state()) ? report_failures({simulation}) : kExitOk;
}

/// Watches all jobs until they have ended.
std::vector<v1::Simulation> ended(Connection& connection, const std::vector<v1::Simulation>& jobs,
                                  const CommonOptions& options) {
  std::vector<std::string> labels;
  for (const v1::Simulation& job : jobs) labels.push_back(job.lubricant());
  return follow(connection, jobs, labels, options.progress_form());
}

std::vector<v1::Simulation> named_jobs(const JobFlags& flags, Connection& connection) {
  std::vector<v1::Simulation> jobs;
  for (const std::string& name : flags.names) {
    jobs.push_back(connection.get_simulation(resource_name("simulations", name)));
  }
  return jobs;
}

int run_watch(const JobFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const auto jobs = ended(connection, named_jobs(flags, connection), options);
  std::cout << shown_results(jobs, connection, options, false, flags.details);
  return report_failures(jobs);
}

int run_wait(const JobFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const auto jobs = ended(connection, named_jobs(flags, connection), options);
  std::cout << jobs_text(jobs, options.output_format, false);
  return report_failures(jobs);
}

/// Returns a request with the same inputs. It names the revisions, because names without revision
/// may mean other revisions by now.
v1::Simulation request_of(const v1::Simulation& job) {
  v1::Simulation out = job;
  clear_output_only(out);
  const auto pin = [](const std::string& revision, std::string* name) {
    if (!revision.empty()) *name = revision;
  };
  pin(job.lubricant_revision(), out.mutable_lubricant());
  pin(job.gear_set_revision(), out.mutable_gear_set());
  pin(job.surface_revision(), out.mutable_surface());
  pin(job.vehicle_revision(), out.mutable_vehicle());
  return out;
}

int run_again(const JobFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  CreateOptions create;
  create.force = true;
  InterruptText interrupts(kNothingSubmitted);
  std::vector<v1::Simulation> jobs;
  const std::vector<v1::Simulation> named = named_jobs(flags, connection);
  for (const v1::Simulation& job : named) {
    interrupts.set(interrupted_submission(connection, jobs, false));
    jobs.push_back(connection.create_simulation(request_of(job), create));
  }
  interrupts.set(interrupted_submission(connection, jobs, true));
  jobs = ended(connection, jobs, options);
  std::cout << shown_results(jobs, connection, options, false, flags.details);
  return report_failures(jobs);
}

/// Calls `change` for each job and prints the new states.
int run_each(const JobFlags& flags, const CommonOptions& options,
             v1::Simulation (Connection::*action)(const std::string&)) {
  Connection connection = options.connect();
  std::vector<v1::Simulation> jobs;
  for (const std::string& name : flags.names) {
    jobs.push_back((connection.*action)(resource_name("simulations", name)));
  }
  std::cout << jobs_text(jobs, options.output_format, false);
  return kExitOk;
}

/// Like run_each(), and reports the jobs that had ended before.
int run_cancel(const JobFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const std::vector<v1::Simulation> before = named_jobs(flags, connection);
  std::vector<v1::Simulation> after;
  for (const v1::Simulation& job : before) {
    after.push_back(connection.cancel_simulation(job.name()));
  }
  std::cout << jobs_text(after, options.output_format, false);
  for (std::size_t i = 0; i < after.size(); ++i) {
    // A job that ended between the two calls was not cancelled by the second call.
    if (!has_ended(before[i].state()) && after[i].state() == v1::Simulation::CANCELLED) continue;
    std::cerr << printable(after[i].name()) << " had already ended ("
              << state_text(after[i].state()) << "); nothing to cancel.\n";
  }
  return kExitOk;
}

int run_delete(const JobFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  for (const std::string& each : flags.names) {
    const std::string name = resource_name("simulations", each);
    connection.delete_simulation(name, flags.deletion);
    std::cerr << "deleted " << printable(name) << "\n";
  }
  return kExitOk;
}

int run_pin(const JobFlags& flags, const CommonOptions& options) {
  return run_each(flags, options, &Connection::pin_simulation);
}

int run_unpin(const JobFlags& flags, const CommonOptions& options) {
  return run_each(flags, options, &Connection::unpin_simulation);
}

Command job_command(const char* path, const char* summary, const char* about, const char* example,
                    bool several, bool shows_results,
                    int (*run)(const JobFlags&, const CommonOptions&),
                    const std::shared_ptr<JobFlags>& flags = std::make_shared<JobFlags>()) {
  Command command{path, summary, about, {example}, {}, {}, {}};
  command.flags.group("Arguments");
  const char* description = "The job, e.g. 12 or simulations/12 (`tribodyn jobs list`).";
  const auto add = [flags](const std::string& name) { flags->names.push_back(name); };
  if (several) {
    command.flags.texts("name", "NAME", description, add).collection = "simulations";
  } else {
    command.flags.text("name", "NAME", description, add).collection = "simulations";
  }
  if (shows_results) {
    command.flags.group("Options");
    command.flags.toggle("--assumptions", "Print every assumption of the result.",
                         [flags] { flags->details.assumptions = true; });
    command.flags.toggle("--solver-details", kSolverDetailsHelp,
                         [flags] { flags->details.solver = true; });
  }
  command.check = [flags](Complaints& complaints) {
    if (flags->names.empty()) {
      complaints.emplace_back("NAME is missing; `tribodyn jobs list` shows the jobs");
    }
  };
  command.run = [flags, run](const CommonOptions& options) { return run(*flags, options); };
  return command;
}

}  // namespace

Command jobs_list_command() {
  const auto flags = std::make_shared<JobFlags>();
  flags->list.limit = 20;
  Command command{"jobs list",
                  "list the newest jobs",
                  "Lists jobs, newest first.",
                  {"tribodyn jobs list --limit 5", "tribodyn jobs list --label project=axle"},
                  {},
                  {},
                  {}};
  command.flags.whole_number("--limit,-n", {"jobs", "1 to 100000", "20"},
                             "Maximum number of jobs listed",
                             [flags](int value) { flags->list.limit = value; });
  command.flags.text("--filter", "FILTER",
                     "Restrictions joined by AND, e.g. 'state = failed AND lubricant = my-oil AND "
                     "pinned = true AND create_time > 2026-01-31T00:00:00Z'; `tribodyn help "
                     "filters` explains them.",
                     [flags](const std::string& text) { flags->list.filter = text; });
  command.flags.texts("--label", "KEY[=VALUE]", "List only jobs with this label; repeatable.",
                      [flags](const std::string& text) { flags->labels.push_back(text); });
  command.flags.text("--order-by", "FIELD",
                     "Order of the list; create_time lists the oldest first.",
                     [flags](const std::string& text) { flags->list.order_by = text; });
  command.flags.text(
      "--page-token", "TOKEN",
      "Read the next page; the previous page, with the same filter and order, printed the token.",
      [flags](const std::string& text) { flags->list.page_token = text; });
  command.check = [flags](Complaints& complaints) {
    if (flags->list.limit < 1 || flags->list.limit > 100000) {
      complaints.emplace_back("--limit must be 1 to 100000");
    }
  };
  command.run = [flags](const CommonOptions& options) { return run_list(*flags, options); };
  return command;
}

Command jobs_get_command() {
  return job_command("jobs get", "show the result or the state of a job",
                     "Prints the result of a job, or its state while it has none.",
                     "tribodyn jobs get 12 --output json", false, true, run_get);
}

Command jobs_watch_command() {
  return job_command("jobs watch", "watch jobs until they end, then print their results",
                     "Watches jobs until all have ended and prints their results. Ctrl-C stops "
                     "following; the jobs go on. For a picture or a CSV file of a finished job "
                     "repeat the command that submitted it, with --plot or --csv: its result is "
                     "there and is not computed again.",
                     "tribodyn jobs watch 12", true, true, run_watch);
}

Command jobs_wait_command() {
  return job_command(
      "jobs wait", "wait for jobs to end",
      "Waits until all jobs have ended and prints how they ended. Exit code 1 if one of them "
      "failed or was cancelled.",
      "tribodyn jobs wait 12 13", true, false, run_wait);
}

Command jobs_rerun_command() {
  return job_command(
      "jobs rerun", "recompute jobs from the same inputs",
      "Recomputes jobs from the revisions that they used, even if the "
      "result exists, and prints the results. A job fails if its result is not bit-identical.",
      "tribodyn jobs rerun 12", true, true, run_again);
}

Command jobs_cancel_command() {
  return job_command("jobs cancel", "cancel jobs",
                     "Cancels jobs; a job that has ended does not change.",
                     "tribodyn jobs cancel 12", true, false, run_cancel);
}

Command jobs_delete_command() {
  const auto flags = std::make_shared<JobFlags>();
  Command command = job_command(
      "jobs delete", "delete jobs and their results for good",
      "Deletes jobs with their events, results and histories. A result that another job shares "
      "stays. Refused while a job is pinned, or has not ended unless --cancel is set.",
      "tribodyn jobs delete 12 --cancel", true, false, run_delete, flags);
  command.flags.group("Options");
  command.flags.toggle("--cancel", "Cancel jobs that have not ended, then delete them.",
                       [flags] { flags->deletion.cancel = true; });
  command.flags.toggle("--allow-missing", "Skip jobs that do not exist.",
                       [flags] { flags->deletion.allow_missing = true; });
  return command;
}

Command jobs_pin_command() {
  return job_command("jobs pin", "keep jobs and their results for good",
                     "Pins jobs: they neither expire nor are evicted.", "tribodyn jobs pin 12",
                     true, false, run_pin);
}

Command jobs_unpin_command() {
  return job_command("jobs unpin", "unpin jobs, so that they expire normally",
                     "Unpins jobs: they expire, or are evicted to make room, as usual.",
                     "tribodyn jobs unpin 12", true, false, run_unpin);
}

}  // namespace tribodyn::client
