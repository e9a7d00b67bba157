#include "server/daemon/settings.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "core/version.h"
#include "server/application/grant.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

constexpr double kLongestDrainSeconds = 25;              // [s], of the 30 s of a shutdown
constexpr std::uintmax_t kLargestConfigBytes = 1 << 20;  // one line for each flag takes 1 KiB

/// Returns a check of the range of a number with a decimal point. CLI::Range accepts NaN.
CLI::Validator between(double least, double most) {
  const std::string range = fmt::format("{} to {}", least, most);
  return {[=](std::string& text) {
            double value = 0;
            const bool is_allowed =
                CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
            return is_allowed ? std::string() : text + " is not a number from " + range;
          },
          range};
}

CLI::Validator project_id() {
  return {[](std::string& id) {
            return is_project_id(id) ? std::string()
                                     : id + " is no project: allowed are 1 to 63 lower-case "
                                            "letters, digits and '-', first a letter, last no '-'";
          },
          ""};
}

/// Adds a flag for a number from `least` to `most`.
void add_number(CLI::App& app, const std::string& flag, double& value, double least, double most,
                const std::string& description) {
  app.add_option(flag, value, description)->check(between(least, most))->capture_default_str();
}
void add_number(CLI::App& app, const std::string& flag, int& value, int least, int most,
                const std::string& description) {
  app.add_option(flag, value, description)->check(CLI::Range(least, most))->capture_default_str();
}

/// Adds a flag for the ids of projects, with commas between them.
void add_projects(CLI::App& app, std::vector<std::string>& projects,
                  const std::string& description) {
  app.add_option("--projects", projects, description)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(project_id());
}

/// Adds `tokens create|list|revoke|rotate`.
void add_token_commands(CLI::App& app, Settings& settings) {
  TokenSettings& token = settings.token;
  CLI::App* tokens = app.add_subcommand(
      "tokens",
      "Create, list, revoke and rotate bearer tokens of a database, also while a server uses it: "
      "a change holds when the command ends, for running streams too");
  tokens->require_subcommand(1);
  const auto add = [&](const char* action, const char* description) {
    CLI::App* command = tokens->add_subcommand(action, description);
    command->add_option("--database", settings.database, "SQLite file")->required();
    command->parse_complete_callback([&token, action] { token.action = action; });
    return command;
  };
  const auto add_name = [&](CLI::App* command) {
    command->add_option("NAME", token.name, "Who uses the token, e.g. anna-laptop")
        ->required()
        ->check(project_id());
  };
  const auto add_expiry = [&](CLI::App* command) {
    add_number(*command, "--expire-days", token.expire_days, 0, 36500,
               "The token is refused after this time; 0: never");
  };
  CLI::App* create = add("create", "Print a new token to standard output");
  add_name(create);
  create
      ->add_option("--scope", token.scope,
                   "read; write: also change resources and run simulations; admin: also purge")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Scope>{
              {"read", Scope::kRead}, {"write", Scope::kWrite}, {"admin", Scope::kAdmin}},
          CLI::ignore_case))
      ->default_str("write");
  add_projects(*create, token.projects,
               "Projects that the token is for, e.g. gearboxes,axles. Default: all");
  create->add_flag(
      "--certificate", token.of_certificate,
      "For the client whose TLS certificate has the common name NAME; prints no token");
  add_expiry(create);
  create
      ->add_option("--calls-per-second", token.calls_per_second,
                   "Quota of calls, in place of the server's --principal-calls-per-second")
      ->check(between(0.001, 1e6));
  create
      ->add_option("--streams", token.streams,
                   "Quota of open streams, in place of the server's --principal-streams")
      ->check(CLI::Range(1, 1'000'000));
  create
      ->add_option("--processor-hours", token.processor_hours,
                   "Quota of waiting and running simulations, in place of the server's "
                   "--principal-processor-hours")
      ->check(between(0.0001, 1e6));
  add("list", "Print all tokens, also expired and revoked ones, without their secrets");
  add_name(add("revoke", "Refuse every token of NAME from now on, and end its streams"));
  add("end-sessions",
      "End the sessions of all browsers, by a new key for them in DATABASE.sessions");
  CLI::App* rotate = add("rotate",
                         "Print a new token in place of that of NAME, with the same scope and "
                         "projects. The owner's goes to DATABASE.token");
  add_name(rotate);
  add_expiry(rotate);
  add_number(*rotate, "--overlap-hours", token.overlap_hours, 0, 8760,
             "The former token stays valid for this time");
}

/// Adds the subcommands, which run instead of the server; each requires --database.
void add_commands(CLI::App& app, Settings& settings) {
  app.require_subcommand(0, 1);
  const auto add = [&](const char* name, const char* description, bool with_file) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_option("--database", settings.database, "SQLite file")->required();
    if (with_file) command->add_option("FILE", settings.file, "Backup file")->required();
  };
  add("backup", "Copy a database to FILE, also while a server uses it. An existing FILE is refused",
      true);
  add("restore",
      "Replace a database by the backup FILE and print the name of the replaced database "
      "(DATABASE.replaced). A database in use by a server and a damaged FILE are refused",
      true);
  add("check",
      "Print every problem of a database: damage, broken references, gaps in revisions and events, "
      "contents that differ from their checksum. The exit code is 3 if there is a problem",
      false);
}

/// Returns a check that refuses devices, folders, missing and too large files.
CLI::Validator settings_file() {
  return {[](std::string& path) {
            std::error_code missing;
            const auto status = std::filesystem::status(path, missing);
            if (!std::filesystem::exists(status)) return path + " does not exist";
            if (!std::filesystem::is_regular_file(status)) return path + " is not a regular file";
            if (std::filesystem::file_size(path, missing) > kLargestConfigBytes) {
              return path + " is larger than 1 MiB and so is not a settings file";
            }
            return std::string();
          },
          ""};
}

void add_flags(CLI::App& app, Settings& settings) {
  app.set_version_flag("--version",
                       std::string("tribodynd " TRIBODYN_VERSION " (") + kModelVersion + ")");
  app.add_flag(
      "--check", settings.check_only,
      "Check settings, database and a computed case, then exit: 0 if the server would start");
  app.add_option("--listen", settings.listen,
                 "Addresses with commas between them, each a numeric address and port (0: any free "
                 "one) or unix:PATH. Addresses beyond loopback need TLS. Only the owner's "
                 "processes reach a Unix socket, and they need no token. Default: the socket at "
                 "which tribodyn looks first, and 127.0.0.1:50651");
  app.add_option("--tls-certificate", settings.tls.certificate,
                 "PEM file with the certificate of the server and those that sign it, for "
                 "addresses beyond loopback; read again when it changes. "
                 "deploy/make-certificates makes one");
  app.add_option("--tls-key", settings.tls.key, "PEM file with the private key of the certificate");
  app.add_option("--tls-client-authorities", settings.tls.client_authorities,
                 "PEM file with the certificates that sign those of clients; then every client "
                 "beyond loopback needs one. `tribodynd tokens create NAME --certificate` says "
                 "what the client whose certificate has the common name NAME may do");
  app.add_option("--database", settings.database,
                 "SQLite file; created if missing. Use a local disk");
  add_projects(app, settings.projects,
               "Projects beside `default`, e.g. gearboxes,axles. A new one gets the resources that "
               "every database begins with. A project of the database stays without the flag");
  add_number(app, "--threads", settings.threads, 0, 1024,
             "Simulations computed at the same time; 0: one per processor. Recommended: 0");
  add_number(app, "--call-limit-seconds", settings.call_limit_seconds, 0, 86400,
             "Longest duration of a call, whatever deadline its client sets. Recommended: 30");
  add_number(app, "--stream-limit-seconds", settings.stream_limit_seconds, 0, 86400,
             "Longest duration of a WatchSimulation or ReadHistory stream; clients resume by "
             "themselves. Recommended: 3600");
  add_number(app, "--unread-limit-seconds", settings.unread_limit_seconds, 0.01, 86400,
             "A stream ends if its client reads nothing for this time. Recommended: 60");
  add_number(app, "--heartbeat-seconds", settings.heartbeat_seconds, 0, 3600,
             "Interval of the heartbeats of a watch without events. Recommended: 15");
  add_number(app, "--drain-seconds", settings.drain_seconds, 0, kLongestDrainSeconds,
             "Time that running simulations have to end after SIGTERM; the others run again after "
             "the next start. A second SIGTERM ends the wait. Recommended: 20");
  add_number(app, "--waiting-simulations", settings.waiting_simulations, 1, 1'000'000,
             "Capacity of the queue. Further submissions are refused with a retry delay. One "
             "client may use at most 75 %. Recommended: 20000");
  add_number(app, "--waiting-processor-hours", settings.waiting_processor_hours, 0.001, 1e6,
             "Capacity of the queue by estimated cost, in processor hours. Recommended: 100");
  add_number(app, "--principal-calls-per-second", settings.principal_calls_per_second, 0, 1e6,
             "Calls a second that one token may make on average; those of five seconds may come "
             "at once. Further ones are refused with a retry delay. 0: no limit. The owner has "
             "none of these quotas. Recommended: 200");
  add_number(app, "--principal-streams", settings.principal_streams, 0, 1'000'000,
             "Streams that one token may have open. 0: no limit. Recommended: 200");
  add_number(app, "--principal-processor-hours", settings.principal_processor_hours, 0, 1e6,
             "Estimated processor hours of waiting and running simulations of one token. 0: "
             "three quarters of --waiting-processor-hours may wait. Recommended: 0");
  add_number(app, "--project-calls-per-second", settings.project_calls_per_second, 0, 1e6,
             "Calls a second about one project that all tokens together may make on average. "
             "0: no limit. The owner makes as many as it wants. Recommended: 0");
  add_number(app, "--project-streams", settings.project_streams, 0, 1'000'000,
             "Streams about one project that all tokens together may have open. 0: no limit. "
             "Recommended: 0");
  add_number(app, "--project-processor-hours", settings.project_processor_hours, 0, 1e6,
             "Estimated processor hours of waiting and running simulations of one project. "
             "0: no limit but that of the queue. Recommended: 0");
  add_number(app, "--project-megabytes", settings.project_megabytes, 0, 1e9,
             "Results of a project; beyond it a project accepts no further simulations until "
             "some are deleted. 0: no limit. Recommended: 0");
  add_number(app, "--keep-days", settings.keep_days, 0, 36500,
             "Ended simulations are removed after this time, unless they are pinned; 0: never. "
             "Recommended: 0");
  add_number(app, "--disk-budget-megabytes", settings.disk_budget_megabytes, 0, 1e9,
             "Disk space for ended simulations and their results. Above it those that ended "
             "first are removed; pinned simulations, lubricants and other resources do not "
             "count. 0: no limit. Recommended: half of the disk");
  app.add_option(
      "--port-file", settings.port_file,
      "File for the address, written when the server accepts calls and removed at its end");
  app.add_option("--http-listen", settings.http_listen,
                 "Addresses, as those of --listen, of the REST interface, of /metrics for "
                 "Prometheus and of /healthz; none by default. Addresses beyond loopback need TLS. "
                 "Recommended: 127.0.0.1:50652");
  app.add_option("--dashboard", settings.dashboard,
                 "Folder with the files of the dashboard, which the address of --http-listen "
                 "serves. Default: the one that deploy/build-dashboard made, or that of the "
                 "installation");
  app.add_option("--log-level", settings.log_level, "Recommended: info")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
  app.set_config("--config", "",
                 "File with lines such as `threads = 4`; names are those of the flags")
      ->check(settings_file());
  app.allow_config_extras(false);
  app.footer(
      "Each flag can also be set in the environment (--listen as TRIBODYND_LISTEN) and in the file "
      "of --config. A flag overrides the environment, the environment overrides the file.");
}

/// Returns the environment variable of a flag: TRIBODYND_DRAIN_SECONDS of "--drain-seconds".
std::string variable_of(const std::string& flag) {
  std::string out = "TRIBODYND_" + flag;
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return out;
}

/// Returns the settings of the environment as flags. The caller puts them before the arguments,
/// because the last value of a flag wins.
std::vector<std::string> from_environment(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_lnames().empty() || option->get_expected_min() == 0) continue;
    const std::string& flag = option->get_lnames().front();
    const char* value = std::getenv(variable_of(flag).c_str());
    if (value != nullptr && *value != '\0') out.push_back("--" + flag + "=" + value);
  }
  return out;
}

}  // namespace

std::optional<Settings> read_settings(const std::vector<std::string>& arguments, int* exit_code) {
  Settings settings;
  CLI::App app("Tribodyn server: what a lubricant costs in a hypoid axle", "tribodynd");
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  add_flags(app, settings);
  add_commands(app, settings);
  add_token_commands(app, settings);
  std::vector<std::string> words = from_environment(app);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::reverse(words.begin(), words.end());  // CLI11 expects the last argument first
  try {
    app.parse(std::move(words));
    if (settings.database.empty()) throw CLI::RequiredError("--database");
  } catch (const CLI::ParseError& error) {
    *exit_code = app.exit(error) == 0 ? kExitStopped : kExitBadSettings;
    return std::nullopt;
  }
  std::string wrong;
  if (settings.tls.certificate.empty() != settings.tls.key.empty()) {
    wrong = "--tls-certificate and --tls-key need each other";
  } else if (settings.token.action == "create" && settings.token.name == kOwner) {
    wrong = fmt::format("the server makes the token of {} by itself; use another name", kOwner);
  }
  if (!wrong.empty()) {
    fmt::print(stderr, "tribodynd: {}\n", wrong);
    *exit_code = kExitBadSettings;
    return std::nullopt;
  }
  if (!app.get_subcommands().empty()) settings.command = app.get_subcommands().front()->get_name();
  return settings;
}

}  // namespace tribodyn::server
