#include "server/daemon/settings.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "core/version.h"

namespace tribodyn::server {
namespace {

constexpr double kLongestDrainSeconds = 25;              // of the 30 s that a shutdown may take
constexpr std::uintmax_t kLargestConfigBytes = 1 << 20;  // a line for each flag takes 1 KiB

/// Subcommands take the place of serving; each needs --database.
void add_commands(CLI::App& app, Settings& settings) {
  app.require_subcommand(0, 1);
  const auto add = [&](const char* name, const char* description, bool with_file) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_option("--database", settings.database, "SQLite file")->required();
    if (with_file) command->add_option("FILE", settings.file, "The backup")->required();
  };
  add("backup",
      "Copies a database to FILE, also while a server runs on it; refuses a FILE that exists",
      true);
  add("restore",
      "Puts the backup FILE in the place of a database and prints the name under which it keeps "
      "the "
      "former one (DATABASE.replaced); refuses a database on which a server runs, and a damaged "
      "FILE",
      true);
  add("check",
      "Says what is wrong with a database: damage, broken references, gaps in revisions and "
      "events, contents that are not what was written. Exit code 3 when something is",
      false);
}

/// The allowed range of a number with a decimal point. CLI::Range lets NaN pass.
CLI::Validator between(double least, double most) {
  const std::string range = fmt::format("{} to {}", least, most);
  return {[=](std::string& text) {
            double value = 0;
            const bool is_allowed =
                CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
            return is_allowed ? std::string() : text + " is no number from " + range;
          },
          range};
}

/// Refuses what would be read without end, such as a device, and what is surely another file.
CLI::Validator settings_file() {
  return {[](std::string& path) {
            std::error_code missing;
            const auto status = std::filesystem::status(path, missing);
            if (!std::filesystem::exists(status)) return path + " does not exist";
            if (!std::filesystem::is_regular_file(status)) return path + " is no regular file";
            if (std::filesystem::file_size(path, missing) > kLargestConfigBytes) {
              return path + " is larger than 1 MiB, so it is no file of settings";
            }
            return std::string();
          },
          ""};
}

void add_seconds(CLI::App& app, const std::string& flag, double& value, double most,
                 const std::string& description) {
  app.add_option(flag, value, description)->check(between(0, most))->capture_default_str();
}

void add_flags(CLI::App& app, Settings& settings) {
  app.set_version_flag("--version",
                       std::string("tribodynd " TRIBODYN_VERSION " (") + kModelVersion + ")");
  app.add_flag(
      "--check", settings.check_only,
      "Check settings, database and a computed case, and end: 0 when a server would start");
  app.add_option("--listen", settings.listen,
                 "Loopback address and port (0: any free one), or unix:PATH")
      ->capture_default_str();
  app.add_option("--database", settings.database,
                 "SQLite file; made when missing. Keep it on a local "
                 "disk");
  app.add_option("--threads", settings.threads,
                 "Simulations computed at a time; 0: one per processor. Recommended: 0")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  add_seconds(app, "--call-limit-seconds", settings.call_limit_seconds, 86400,
              "A call ends after this long, whatever its client allows. Recommended: 30");
  add_seconds(app, "--stream-limit-seconds", settings.stream_limit_seconds, 86400,
              "So does a watch or the reading of a history; clients watch on. Recommended: 3600");
  app.add_option("--unread-limit-seconds", settings.unread_limit_seconds,
                 "A stream whose client takes nothing for this long is cut off. Recommended: 60")
      ->check(between(0.01, 86400))
      ->capture_default_str();
  add_seconds(app, "--heartbeat-seconds", settings.heartbeat_seconds, 3600,
              "A watch that has nothing to tell sends a sign of life so often. Recommended: 15");
  add_seconds(app, "--drain-seconds", settings.drain_seconds, kLongestDrainSeconds,
              "On SIGTERM running simulations may go on for so long; those that have not ended run "
              "again after the next start. A second SIGTERM ends the wait. Recommended: 20");
  app.add_option("--waiting-simulations", settings.waiting_simulations,
                 "More than these do not wait; further ones are told when to come again, and one "
                 "client may take three quarters. Recommended: 20000")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--waiting-processor-hours", settings.waiting_processor_hours,
                 "The same for the sum of their estimates. Recommended: 100")
      ->check(between(0.001, 1e6))
      ->capture_default_str();
  app.add_option("--keep-days", settings.keep_days,
                 "Simulations that have ended are removed after so long, unless pinned; 0: never. "
                 "Recommended: 0")
      ->check(between(0, 36500))
      ->capture_default_str();
  app.add_option("--disk-budget-megabytes", settings.disk_budget_megabytes,
                 "Space for simulations that have ended and their results; beyond it those that "
                 "ended first "
                 "are removed. Pinned ones, lubricants and other resources are kept and do not "
                 "count. 0: no "
                 "budget. Recommended: half of the disk")
      ->check(between(0, 1e9))
      ->capture_default_str();
  app.add_option("--port-file", settings.port_file,
                 "Write the address here once the server answers; removed at the end");
  app.add_option("--metrics-listen", settings.metrics_listen,
                 "Loopback address and port that answer GET /metrics for Prometheus; none by "
                 "default. Recommended: 127.0.0.1:50652");
  app.add_option("--log-level", settings.log_level, "Recommended: info")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
  app.set_config("--config", "", "File with lines such as `threads = 4`, named as the flags are")
      ->check(settings_file());
  app.allow_config_extras(false);
  app.footer(
      "Each flag may also stand in the environment, --listen as TRIBODYND_LISTEN, and in the file "
      "that --config names. Flags come before the environment, the environment before the file.");
}

/// "--drain-seconds" is TRIBODYND_DRAIN_SECONDS.
std::string variable_of(const std::string& flag) {
  std::string out = "TRIBODYND_" + flag;
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return out;
}

/// What the environment says, as flags; the last of several wins, and these come first.
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
  std::vector<std::string> words = from_environment(app);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    app.parse(std::move(words));
    if (settings.database.empty()) throw CLI::RequiredError("--database");
  } catch (const CLI::ParseError& error) {
    *exit_code = app.exit(error) == 0 ? kExitStopped : kExitBadSettings;
    return std::nullopt;
  }
  if (!app.get_subcommands().empty()) settings.command = app.get_subcommands().front()->get_name();
  return settings;
}

}  // namespace tribodyn::server
