#include "server/daemon/daemon.h"

#include <fmt/format.h>
#include <malloc.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "core/version.h"
#include "server/application/stored_inputs.h"
#include "server/daemon/owner_token.h"
#include "server/daemon/service_manager.h"
#include "server/daemon/token_watch.h"
#include "server/simulation/golden_case.h"
#include "server/simulation/result_key.h"
#include "server/storage/database_files.h"
#include "server/storage/durable_files.h"
#include "server/storage/maintenance.h"
#include "server/storage/schema.h"
#include "server/storage/seeds.h"
#include "server/storage/store.h"
#include "server/storage/token_table.h"
#include "server/transport/grpc/grpc_server.h"
#include "server/transport/http/description_pages.h"
#include "server/transport/http/http_server.h"
#include "server/transport/http/rest_handler.h"

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto kShutdownLimit = seconds(30);
constexpr auto kHurriedLimit = seconds(3);
constexpr milliseconds kLockWait{1500};  // a command on tokens has the database for a moment

milliseconds to_milliseconds(double value) {
  return milliseconds(static_cast<std::int64_t>(1000 * value));
}

/// Writes the addresses, a line each. A reader never sees a part of the file.
void write_port_file(const std::string& path, const std::vector<std::string>& addresses) {
  replace_file(path, fmt::format("{}\n", fmt::join(addresses, "\n")), 0644);
}

/// Waits for a signal. Returns its number, or -1 after `limit`.
int wait_for_signal(const sigset_t& signals, seconds limit) {
  const timespec time{limit.count(), 0};
  return sigtimedwait(&signals, nullptr, &time);
}

/// Compares the open database files with those at their path. Logs when a file is missing or
/// replaced, and when it is back, and sets the health status accordingly.
class DatabaseFileWatch {
 public:
  DatabaseFileWatch(const Store& store, GrpcServer& server) : store_(store), server_(server) {}

  void check() {
    const std::string misplaced = store_.misplaced();
    if (misplaced.empty() == is_in_place_) return;
    is_in_place_ = misplaced.empty();
    server_.set_serving(is_in_place_);
    if (is_in_place_) {
      spdlog::warn("the database is back at its path; changes are accepted again");
    } else {
      spdlog::critical("{}", misplaced);
    }
  }

 private:
  const Store& store_;
  GrpcServer& server_;
  bool is_in_place_ = true;
};

/// Waits for a signal and returns its number. Checks the database files once a second, and returns
/// free heap memory to the system every ten seconds: without that the process grew by about 2 MB an
/// hour after a busy period.
int wait_for_stop(const sigset_t& signals, DatabaseFileWatch& file_watch) {
  constexpr seconds kCheckInterval(1);
  constexpr int kChecksPerTrim = 10;
  for (int checks = 1;; ++checks) {
    const int signal = wait_for_signal(signals, kCheckInterval);
    if (signal > 0) return signal;
    file_watch.check();
    if (checks % kChecksPerTrim == 0) malloc_trim(0);
  }
}

/// Starts a thread that ends the process if the shutdown takes longer than kShutdownLimit;
/// unfinished simulations then run again after the next start. A second signal cancels the wait for
/// running simulations, a third one ends the process.
void start_watchdog(const sigset_t& signals, std::atomic<bool>& hurry) {
  std::thread([&signals, &hurry] {
    if (wait_for_signal(signals, kShutdownLimit) > 0) {
      hurry = true;
      wait_for_signal(signals, kHurriedLimit);
    }
    spdlog::critical("the shutdown takes too long; the process ends now");
    spdlog::shutdown();
    _exit(kExitFailed);
  }).detach();
}

SimulationJobs::Options job_options(const Settings& settings) {
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  SimulationJobs::Options options;
  options.threads = settings.threads == 0 ? processors : settings.threads;
  options.heartbeat = to_milliseconds(settings.heartbeat_seconds);
  options.limits.jobs = static_cast<std::size_t>(settings.waiting_simulations);
  options.limits.cost_seconds = 3600 * settings.waiting_processor_hours;
  if (settings.keep_days > 0) {
    options.retention.keep = static_cast<Microseconds>(settings.keep_days * 86'400e6);
  }
  options.retention.disk_budget_bytes =
      static_cast<std::int64_t>(1e6 * settings.disk_budget_megabytes);
  return options;
}

void shut_down(const Settings& settings, const sigset_t& signals, GrpcServer& server,
               SimulationJobs& jobs) {
  // static, because the watchdog thread outlives this function
  static std::atomic<bool> hurry = false;
  start_watchdog(signals, hurry);
  notify_service_manager("STOPPING=1");
  server.set_serving(false);
  if (!settings.port_file.empty()) std::filesystem::remove(settings.port_file);
  if (!jobs.scheduler().drain(to_milliseconds(settings.drain_seconds),
                              [] { return hurry.load(); })) {
    spdlog::info("running simulations are queued again");
  }
  jobs.stop();
  server.shutdown();
}

int complain(int code, const std::string& sentence) {
  spdlog::critical("{}", sentence);
  std::fprintf(stderr, "tribodynd: %s\n", sentence.c_str());
  return code;
}

std::string audit_file(const Settings& settings) { return settings.database + ".audit"; }

/// The REST interface and the HTTP servers that carry it, one for each address.
struct Rest {
  RestHandler handler;
  std::deque<HttpServer> servers;
  Rest(CallDispatcher& dispatcher, std::map<std::string, RestHandler::Page> pages,
       const RestDashboard& dashboard, const std::vector<ListenAddress>& addresses,
       const TlsFiles& tls)
      : handler(dispatcher, std::move(pages), {}, dashboard) {
    for (const ListenAddress& each : addresses)
      servers.emplace_back(handler, each, HttpLimits(), tls);
  }
};

/// The page /healthz: 503 while gRPC's health check answers NOT_SERVING.
std::function<HttpResponse(const HttpRequest&)> health_page(const GrpcServer& server) {
  return [&server](const HttpRequest&) {
    HttpResponse out;
    out.headers["Content-Type"] = "text/plain; charset=utf-8";
    out.headers["Cache-Control"] = "no-store";
    out.status = server.is_serving() ? 200 : 503;
    out.body = server.is_serving()
                   ? "ok\n"
                   : "not serving: the server starts or stops, or its database was moved\n";
    return out;
  };
}

/// The page /metrics.
std::function<HttpResponse(const HttpRequest&)> metrics_page(CallDispatcher& dispatcher,
                                                             const Metrics& metrics) {
  return [&](const HttpRequest&) {
    HttpResponse out;
    out.headers["Content-Type"] = "text/plain; version=0.0.4; charset=utf-8";
    out.body = metrics.text(dispatcher.workload());
    return out;
  };
}

/// Returns the addresses of the REST interface. Throws ListenError.
std::vector<ListenAddress> http_addresses(const Settings& settings) {
  if (settings.http_listen.empty()) return {};
  std::vector<ListenAddress> out = parse_listen_addresses(settings.http_listen);
  for (const ListenAddress& each : out) require_tls(each, settings.tls);
  return out;
}

/// Reads the files of the dashboard. Returns null, and logs why, if there are none.
std::shared_ptr<const StaticFiles> dashboard_files(const Settings& settings) {
  const std::filesystem::path folder = settings.dashboard.empty()
                                           ? default_dashboard_folder()
                                           : std::filesystem::path(settings.dashboard);
  try {
    if (!folder.empty()) return std::make_shared<StaticFiles>(folder);
    spdlog::info("no dashboard: it is not built (deploy/build-dashboard)");
  } catch (const std::exception& failure) {
    spdlog::warn("no dashboard: {}", failure.what());
  }
  return nullptr;
}

/// Starts the REST interface. Returns null if no address is set.
std::unique_ptr<Rest> listen_for_http(const Settings& settings, CallDispatcher& dispatcher,
                                      SimulationJobs& jobs, const GrpcServer& server,
                                      Microseconds now) {
  if (settings.http_listen.empty()) return nullptr;
  Metrics& metrics = jobs.metrics();
  metrics.set_build(TRIBODYN_VERSION, kModelVersion, platform());
  const std::string database = canonical_path(settings.database).string();
  metrics.set_files({{"database", database},
                     {"write_ahead_log", database + "-wal"},
                     {"audit", audit_file(settings)},
                     {"log", "/proc/self/fd/2"}});
  std::map<std::string, RestHandler::Page> pages = description_pages(dispatcher.methods());
  pages["/metrics"] = {metrics_page(dispatcher, metrics)};
  pages["/healthz"] = {health_page(server), true};
  const RestDashboard dashboard{
      std::make_shared<SessionCookies>(std::make_shared<SessionFile>(settings.database, now)),
      dashboard_files(settings)};
  auto out = std::make_unique<Rest>(dispatcher, std::move(pages), dashboard,
                                    http_addresses(settings), settings.tls);
  for (const HttpServer& each : out->servers) {
    spdlog::info("REST at {}://{}", each.is_encrypted() ? "https" : "http",
                 to_text(each.address()));
  }
  if (dashboard.files) spdlog::info("the addresses of REST also serve the dashboard");
  return out;
}

}  // namespace

std::vector<ListenAddress> listen_addresses(const Settings& settings) {
  std::vector<ListenAddress> out =
      settings.listen.empty() ? default_addresses() : parse_listen_addresses(settings.listen);
  for (const ListenAddress& each : out) require_tls(each, settings.tls);
  http_addresses(settings);
  if (settings.tls.is_set()) require_usable(settings.tls);
  return out;
}

int serve(const Settings& settings, const std::vector<ListenAddress>& addresses,
          const sigset_t& signals) {
  Store store(settings.database, schema_steps(), kLockWait);
  if (store.migration_backup()) {
    spdlog::info("the database was brought to schema {}; {} holds it as it was before",
                 schema_steps().size(), store.migration_backup()->string());
  }
  const std::vector<NewResource> seeds = seed_resources();
  store.add_project(kDefaultProject, seeds, system_time());
  for (const std::string& each : settings.projects) store.add_project(each, seeds, system_time());
  const SimulationJobs::Options options = job_options(settings);
  SimulationJobs jobs(store, options);
  Application application{.store = store, .jobs = jobs, .audit = AuditLog(audit_file(settings))};
  application.project_bytes = static_cast<std::int64_t>(1e6 * settings.project_megabytes);
  application.project_quotas = std::make_shared<ProjectQuotas>(
      Quota{settings.project_calls_per_second, settings.project_streams,
            settings.project_processor_hours});
  application.authorizer = std::make_shared<Authorizer>(Quota{settings.principal_calls_per_second,
                                                              settings.principal_streams,
                                                              settings.principal_processor_hours});
  TokenTable tokens(settings.database);
  provide_owner_token(tokens, settings.database, system_time());
  application.page_token_key = tokens.page_token_key();
  const TokenWatch token_watch(tokens, *application.authorizer);
  const std::size_t resumed = jobs.resume();  // before clients can submit
  if (resumed > 0) spdlog::info("{} unfinished simulations are queued again", resumed);
  CallDispatcher dispatcher(application, {to_milliseconds(settings.call_limit_seconds),
                                          to_milliseconds(settings.stream_limit_seconds),
                                          to_milliseconds(settings.unread_limit_seconds)});
  GrpcServer server(dispatcher, addresses, settings.tls);
  const std::unique_ptr<Rest> rest =
      listen_for_http(settings, dispatcher, jobs, server, system_time());
  const std::string wrong = jobs.start();
  if (!wrong.empty()) return complain(kExitWrongResults, wrong);
  server.set_serving(true);
  spdlog::info("tribodynd " TRIBODYN_VERSION " ({}) listens on {} with {} threads", kModelVersion,
               fmt::join(server.addresses(), " and "), options.threads);
  spdlog::info(
      "programs that do not use the Unix socket of the owner need a token; the owner's is in {}",
      owner_token_file(settings.database).string());
  if (!settings.port_file.empty()) write_port_file(settings.port_file, server.addresses());
  notify_service_manager("READY=1");

  DatabaseFileWatch file_watch(store, server);
  const int signal = wait_for_stop(signals, file_watch);
  spdlog::info("signal {}: stopping", signal);
  shut_down(settings, signals, server, jobs);
  spdlog::info("stopped");
  return kExitStopped;
}

int check(const Settings& settings) {
  listen_addresses(settings);
  if (std::filesystem::exists(settings.database)) {
    const std::vector<std::string> problems = check_database(settings.database, hash_stored_inputs);
    for (const std::string& problem : problems) std::fprintf(stderr, "%s\n", problem.c_str());
    if (!problems.empty()) return kExitBadDatabase;
  } else {
    require_usable_path(canonical_path(settings.database));
    const std::filesystem::path folder = std::filesystem::absolute(settings.database).parent_path();
    if (access(folder.c_str(), W_OK) != 0) {
      return complain(kExitBadDatabase,
                      "database " + settings.database + ": its folder is not writable");
    }
  }
  const std::string wrong = check_golden_case();
  return wrong.empty() ? kExitStopped : complain(kExitWrongResults, wrong);
}

}  // namespace tribodyn::server
