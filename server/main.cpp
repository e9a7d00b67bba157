// tribodynd: reads its settings, then serves gRPC until told to stop, or carries out a command.
#include <malloc.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "server/application/stored_inputs.h"
#include "server/daemon/daemon.h"
#include "server/daemon/token_command.h"
#include "server/storage/maintenance.h"
#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

/// Fewer descriptors leave none for connections beside the files that the server itself opens.
constexpr rlim_t kLeastFiles = 100;

/// Runs a command. Returns its exit code.
int run_command(const Settings& settings) {
  if (settings.command == "backup") {
    backup_database(settings.database, settings.file);
  } else if (settings.command == "restore") {
    if (const auto kept = restore_database(settings.file, settings.database)) {
      std::printf("the former database is kept as %s\n", kept->c_str());
    }
  } else if (settings.command == "tokens") {
    return change_tokens(settings);
  } else {
    const std::vector<std::string> problems = check_database(settings.database, hash_stored_inputs);
    for (const std::string& problem : problems) std::fprintf(stderr, "%s\n", problem.c_str());
    if (!problems.empty()) return kExitBadDatabase;
  }
  return kExitStopped;
}

/// Signals that end the server, blocked in every thread so that the main one can wait for them.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // A write beyond the limit of file sizes (ulimit -f) fails, as one on a full disk does.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  return signals;
}

/// Raises the limit of open files, as every connection is one. Returns the limit.
rlim_t raise_file_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return kLeastFiles;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
  return limit.rlim_cur;
}

int complain(int code, const char* sentence) {
  std::fprintf(stderr, "tribodynd: %s\n", sentence);
  return code;
}

int run(const std::vector<std::string>& arguments) {
  int exit_code = kExitStopped;
  const std::optional<Settings> settings = read_settings(arguments, &exit_code);
  if (!settings) return exit_code;
  static const sigset_t kSignals = block_signals();
  // Every heap keeps the memory that many readers of histories needed for a moment: 64 readers make
  // the server grow by 6 to 10 MB with two heaps, by 17 MB with four and by 20 MB with eight
  // (measured). The solver allocates no memory while it runs.
  mallopt(M_ARENA_MAX, 2);
  const rlim_t files = raise_file_limit();
  umask(077);  // only the owner may read formulations
  spdlog::set_default_logger(spdlog::stderr_logger_mt("tribodynd"));
  spdlog::set_level(spdlog::level::from_str(settings->log_level));
  try {
    if (!settings->command.empty()) return run_command(*settings);
    if (settings->check_only) return check(*settings);
    if (files < kLeastFiles) {
      const std::string limit = "the limit of open files is " + std::to_string(files) +
                                "; allowed: " + std::to_string(kLeastFiles) +
                                " or more (ulimit -n, LimitNOFILE of systemd)";
      return complain(kExitCannotListen, limit.c_str());
    }
    return serve(*settings, listen_addresses(*settings), kSignals);
  } catch (const ListenError& error) {
    return complain(kExitCannotListen, error.what());
  } catch (const StoreError& error) {
    return complain(
        error.kind() == StoreError::Kind::kOtherVersion ? kExitOtherVersion : kExitBadDatabase,
        error.what());
  }
}

}  // namespace
}  // namespace tribodyn::server

int main(int argc, char** argv) try {
  return tribodyn::server::run({argv + 1, argv + argc});
} catch (const std::exception& error) {
  return tribodyn::server::complain(tribodyn::server::kExitFailed, error.what());
} catch (...) {
  return tribodyn::server::complain(tribodyn::server::kExitFailed, "unknown error");
}
