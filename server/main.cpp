// tribodynd: parses flags, opens the store, runs simulations and serves gRPC until told to stop.
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "core/version.h"
#include "server/api/grpc_server.h"
#include "server/app/stored_inputs.h"
#include "server/store/maintenance.h"
#include "server/store/seeds.h"
#include "server/store/store.h"

namespace tribodyn::server {
namespace {

// Exit codes, also for scripts that start the server.
constexpr int kStopped = 0;
constexpr int kFailed = 1;
constexpr int kBadFlags = 2;
constexpr int kBadDatabase = 3;
constexpr int kCannotListen = 4;

constexpr auto kShutdownLimit = std::chrono::seconds(10);

struct Flags {
  std::string file;  // of backup and restore
  std::string listen = "127.0.0.1:50651";
  std::string database;
  int threads = 0;
  std::string port_file;
  std::string log_level = "info";
  double call_limit_seconds = 30;
  double stream_limit_seconds = 3600;
};

/// Subcommands take the place of serving; each needs --database.
void add_commands(CLI::App& app, Flags& flags) {
  app.require_subcommand(0, 1);
  const auto add = [&](const char* name, const char* description, bool with_file) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_option("--database", flags.database, "SQLite file")->required();
    if (with_file) command->add_option("FILE", flags.file, "The backup")->required();
  };
  add("backup", "Copies a database to FILE, also while a server runs on it", true);
  add("restore",
      "Puts the backup FILE in the place of a database, kept as DATABASE.replaced; refuses while a "
      "server runs on it, and a damaged FILE",
      true);
  add("check",
      "Says what is wrong with a database: damage, broken references, gaps in revisions, contents "
      "that are not what was written. Exit code 3 when something is",
      false);
}

/// The exit code of a subcommand.
int run_command(const std::string& name, const Flags& flags) {
  if (name == "backup") {
    backup_database(flags.database, flags.file);
  } else if (name == "restore") {
    restore_database(flags.file, flags.database);
  } else {
    const std::vector<std::string> problems = check_database(flags.database, hash_stored_inputs);
    for (const std::string& problem : problems) std::fprintf(stderr, "%s\n", problem.c_str());
    if (!problems.empty()) return kBadDatabase;
  }
  return kStopped;
}

void add_flags(CLI::App& app, Flags& flags) {
  app.set_version_flag("--version",
                       std::string("tribodynd " TRIBODYN_VERSION " (") + kModelVersion + ")");
  app.add_option("--listen", flags.listen,
                 "Loopback address and port (0: any free one), or unix:PATH")
      ->capture_default_str();
  app.add_option("--database", flags.database,
                 "SQLite file; made when missing. Keep it on a local "
                 "disk");
  app.add_option("--threads", flags.threads,
                 "Simulations at a time; 0: one per processor. Recommended: 0")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--call-limit-seconds", flags.call_limit_seconds,
                 "A call ends after this long, whatever its client allows. Recommended: 30")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  app.add_option("--stream-limit-seconds", flags.stream_limit_seconds,
                 "So does a watch or the reading of a history; clients watch on. Recommended: 3600")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  app.add_option("--port-file", flags.port_file,
                 "Write the address here once the server answers; removed at the end");
  app.add_option("--log-level", flags.log_level, "Recommended: info")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
}

/// Signals that end the server, blocked in every thread so that the main one can wait for them.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return signals;
}

/// Every connection is a file: take as many as the system grants.
void raise_file_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// Written under another name first: who sees the file sees all of it.
void write_port_file(const std::string& path, const std::string& address) {
  const std::string unfinished = path + ".new";
  std::ofstream(unfinished) << address << '\n';
  std::filesystem::rename(unfinished, path);
}

/// Ends the process if the orderly way takes too long; what runs then is requeued at the next
/// start.
void start_watchdog() {
  std::thread([] {
    std::this_thread::sleep_for(kShutdownLimit);
    spdlog::critical("shutdown took longer than {} s; ending at once", kShutdownLimit.count());
    spdlog::shutdown();
    _exit(kFailed);
  }).detach();
}

void serve(const Flags& flags, const ListenAddress& address, const sigset_t& signals) {
  Store store(flags.database);
  store.add_resources(seed_resources(), system_time());
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  SimulationJobs::Options options;
  options.threads = flags.threads == 0 ? processors : flags.threads;
  SimulationJobs jobs(store, options);
  Application application{store, jobs};
  const std::size_t resumed = jobs.resume();  // before a client can add to the queue
  if (resumed > 0) spdlog::info("{} unfinished simulations are queued again", resumed);
  const auto milliseconds = [](double seconds) {
    return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds));
  };
  jobs.start();
  GrpcServer server(
      application, address,
      {milliseconds(flags.call_limit_seconds), milliseconds(flags.stream_limit_seconds)});
  spdlog::info("tribodynd " TRIBODYN_VERSION " ({}) listens on {} with {} threads", kModelVersion,
               server.address(), options.threads);
  if (!flags.port_file.empty()) write_port_file(flags.port_file, server.address());

  int signal = 0;
  sigwait(&signals, &signal);
  spdlog::info("signal {}: stopping", signal);
  start_watchdog();
  if (!flags.port_file.empty()) std::filesystem::remove(flags.port_file);
  server.shutdown();
  jobs.stop();
  spdlog::info("stopped");
}

int complain(int code, const char* sentence) {
  std::fprintf(stderr, "tribodynd: %s\n", sentence);
  return code;
}

int run(int argc, char** argv) {
  Flags flags;
  CLI::App app("Tribodyn server: what a lubricant costs in a hypoid axle");
  add_flags(app, flags);
  add_commands(app, flags);
  try {
    app.parse(argc, argv);
    if (flags.database.empty()) throw CLI::RequiredError("--database");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kStopped : kBadFlags;
  }
  const sigset_t signals = block_signals();
  raise_file_limit();
  umask(077);  // formulations are for their owner
  spdlog::set_default_logger(spdlog::stderr_logger_mt("tribodynd"));
  spdlog::set_level(spdlog::level::from_str(flags.log_level));
  try {
    const std::vector<CLI::App*> command = app.get_subcommands();
    if (!command.empty()) return run_command(command.front()->get_name(), flags);
    serve(flags, parse_listen_address(flags.listen), signals);
    return kStopped;
  } catch (const ListenError& error) {
    return complain(kCannotListen, error.what());
  } catch (const StoreError& error) {
    return complain(kBadDatabase, error.what());
  }
}

}  // namespace
}  // namespace tribodyn::server

int main(int argc, char** argv) try {
  return tribodyn::server::run(argc, argv);
} catch (const std::exception& error) {
  return tribodyn::server::complain(tribodyn::server::kFailed, error.what());
} catch (...) {
  return tribodyn::server::complain(tribodyn::server::kFailed, "unknown error");
}
