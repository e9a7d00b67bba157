// The server under load: what it adds to an empty gRPC method, a bare commit, an empty stream and
// the core's own time. Figures that are compared are of one run on one machine. usage:
// service_benchmark [RESULTS.json [PART...]]      default: build/benchmark/results.json, all parts:
// requests, lists, histories, watchers, overload, refusals, interactive, screening, bands,
// campaigns, estimates
#include <SQLiteCpp/Database.h>
#include <fmt/format.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <random>
#include <thread>

#include "core/rig/rig.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/field_behavior.h"
#include "server/mapping/to_core.h"
#include "server/simulation/compute.h"
#include "server/simulation/compute_task.h"
#include "server/simulation/cost_estimate.h"
#include "server/simulation/simulation_inputs.h"
#include "tests/benchmark/load_client.h"
#include "tests/benchmark/measurements.h"
#include "tests/service/raw_client.h"
#include "tests/service/server_process.h"
#include "tests/service/support.h"
#include "tests/support/paths.h"
#include "tribodyn/v1/campaigns.grpc.pb.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"
#include "tribodyn/v1/points.grpc.pb.h"
#include "tribodyn/v1/simulations.grpc.pb.h"

namespace tribodyn::server {
namespace {

using Clock = std::chrono::steady_clock;
using Stub = v1::SimulationService::Stub;
using std::chrono::seconds;

constexpr int kRuns = 5;
constexpr double kMegabyte = 1e6;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A tribodynd over a database in a folder of its own.
class Server {
 public:
  explicit Server(std::vector<std::string> flags = {}) : flags_(std::move(flags)) { start(); }

  void start() {
    std::filesystem::remove(folder_.file("port"));
    std::vector<std::string> all = {"--listen",    "127.0.0.1:0",        "--database",  database(),
                                    "--port-file", folder_.file("port"), "--log-level", "warn"};
    all.insert(all.end(), flags_.begin(), flags_.end());
    process_ = std::make_unique<ServerProcess>(all, folder_.file("log"));
    address_ = wait_for_address(folder_.file("port"), *process_);
    if (address_.empty()) throw std::runtime_error(process_->log());
    stub_ = v1::SimulationService::NewStub(connect(address_));
  }
  void stop() {
    process_->signal(SIGTERM);
    process_->wait(seconds(40));
  }

  std::string database() const { return folder_.file("tribodyn.db"); }
  std::string file(const std::string& name) const { return folder_.file(name); }
  const std::string& address() const { return address_; }
  int id() const { return server_of(database()); }
  Stub& stub() const { return *stub_; }
  std::shared_ptr<grpc::Channel> another_channel() const { return connect(address_, true); }
  std::unique_ptr<Stub> another_stub() const {
    return v1::SimulationService::NewStub(another_channel());
  }

 private:
  TemporaryFolder folder_;
  std::vector<std::string> flags_;
  std::unique_ptr<ServerProcess> process_;
  std::string address_;
  std::unique_ptr<Stub> stub_;
};

/// Another process that answers with nothing.
class EmptyServer {
 public:
  EmptyServer() : pipe_(popen((empty_server_program() + " " + folder_.file("port")).c_str(), "w")) {
    if (!eventually([&] { return std::filesystem::exists(folder_.file("port")); })) {
      throw std::runtime_error("the empty server does not start");
    }
    std::string address;
    std::ifstream(folder_.file("port")) >> address;
    stub_ = v1::SimulationService::NewStub(connect(address));
  }
  ~EmptyServer() { pclose(pipe_); }
  EmptyServer(const EmptyServer&) = delete;
  EmptyServer& operator=(const EmptyServer&) = delete;
  Stub& stub() const { return *stub_; }

 private:
  TemporaryFolder folder_;
  FILE* pipe_;
  std::unique_ptr<Stub> stub_;
};

/// What a call needs until it has ended.
template <class Request, class Response>
struct Call {
  grpc::ClientContext context;
  Request request;
  Response response;
};

StartRequest gets(Stub& stub, const std::string& name) {
  return [&stub, name](int, const std::function<void(bool)>& done) {
    const auto call = std::make_shared<Call<v1::GetSimulationRequest, v1::Simulation>>();
    call->request.set_name(name);
    stub.async()->GetSimulation(&call->context, &call->request, &call->response,
                                [call, done](const grpc::Status& status) { done(status.ok()); });
  };
}

v1::Simulation point_at(double speed) {
  v1::Simulation out = point_simulation();
  out.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(speed);
  return out;
}

/// Points that no earlier request has asked for.
StartRequest creates(Stub& stub, double first_speed) {
  return [&stub, first_speed](int number, const std::function<void(bool)>& done) {
    const auto call = std::make_shared<Call<v1::CreateSimulationRequest, v1::Simulation>>();
    *call->request.mutable_simulation() = point_at(first_speed + 1e-4 * number);
    stub.async()->CreateSimulation(&call->context, &call->request, &call->response,
                                   [call, done](const grpc::Status& status) { done(status.ok()); });
  };
}

v1::Simulation create(Stub& stub, const v1::Simulation& simulation, bool force = false) {
  grpc::ClientContext context;
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = simulation;
  request.set_force(force);
  v1::Simulation out;
  const grpc::Status status = stub.CreateSimulation(&context, request, &out);
  if (!status.ok()) throw std::runtime_error(status.error_message());
  return out;
}

void create_lubricants(const Server& server, const std::vector<v1::Lubricant>& fluids) {
  const auto stub = v1::LubricantService::NewStub(server.another_channel());
  grpc::ClientContext context;
  v1::BatchCreateLubricantsRequest request;
  v1::BatchCreateLubricantsResponse response;
  for (const v1::Lubricant& fluid : fluids) {
    v1::CreateLubricantRequest& one = *request.add_requests();
    one.set_lubricant_id(fluid.name().substr(fluid.name().find('/') + 1));
    *one.mutable_lubricant() = fluid;
  }
  request.mutable_read_mask()->add_paths("name");
  const grpc::Status status = stub->BatchCreateLubricants(&context, request, &response);
  if (!status.ok()) throw std::runtime_error(status.error_message());
}

/// Follows it to its end.
v1::Simulation::State wait_for(Stub& stub, const std::string& name) {
  grpc::ClientContext context;
  v1::WatchSimulationRequest request;
  request.set_name(name);
  const auto reader = stub.WatchSimulation(&context, request);
  v1::SimulationEvent event;
  while (reader->Read(&event)) {
  }
  reader->Finish();
  return event.state();
}

/// Bare commits as the store makes them, at the same rate.
Latencies commits(const std::string& file, double rate, seconds time) {
  SQLite::Database db(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  db.execAndGet("PRAGMA journal_mode = WAL");
  db.exec("PRAGMA synchronous = FULL");
  db.exec("CREATE TABLE IF NOT EXISTS rows (id INTEGER PRIMARY KEY, body BLOB)");
  return open_loop(rate, time, [&](int, const std::function<void(bool)>& done) {
    db.exec("INSERT INTO rows (body) VALUES (randomblob(500))");
    done(true);
  });
}

void measure_requests(std::vector<Measurement>& out) {
  const Server server;
  const EmptyServer empty;
  const std::string name = create(server.stub(), point_simulation()).name();
  wait_for(server.stub(), name);
  std::vector<double> get_ratios, submit_ratios, get_times, submit_times, commit_times;
  for (int run = 0; run < kRuns; ++run) {
    const double nothing = open_loop(1000, seconds(2), gets(empty.stub(), name)).percentile(0.99);
    const double get = open_loop(1000, seconds(2), gets(server.stub(), name)).percentile(0.99);
    const double commit = commits(server.file("bare.db"), 200, seconds(2)).percentile(0.99);
    const double submit =
        open_loop(200, seconds(2), creates(server.stub(), 30 + run)).percentile(0.99);
    get_ratios.push_back(get / nothing);
    submit_ratios.push_back((submit - 2e-3) / commit);
    get_times.push_back(get);
    submit_times.push_back(submit);
    commit_times.push_back(commit);
  }
  out.push_back({"get_at_1000_per_second_p99_over_empty_method", median(get_ratios), "-", 5});
  out.push_back({"get_at_1000_per_second_p99", 1e3 * median(get_times), "ms", {}});
  out.push_back(
      {"submit_at_200_per_second_p99_less_2_ms_over_commit", median(submit_ratios), "-", 5});
  out.push_back({"submit_at_200_per_second_p99", 1e3 * median(submit_times), "ms", {}});
  out.push_back({"bare_commit_at_200_per_second_p99", 1e3 * median(commit_times), "ms", {}});
}

/// Median time of a page of 50 among so many stored jobs [s].
double page_seconds(int jobs) {
  Server server;
  wait_for(server.stub(), create(server.stub(), point_simulation()).name());
  server.stop();
  {
    SQLite::Database db(server.database(), SQLite::OPEN_READWRITE);
    db.exec(fmt::format(
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < {}) "
        "INSERT INTO simulations (number, state, sequence, create_time, start_time, end_time, "
        "request, "
        "request_hash, input_hash, result, ledger, lubricant, gear_set, surface, vehicle) "
        "SELECT number + i, state, 0, create_time + 1000 * i, start_time, end_time, request, "
        "request_hash, "
        "input_hash, result, ledger, lubricant, gear_set, surface, vehicle FROM n, simulations",
        jobs - 1));
  }
  server.start();
  std::vector<double> times;
  v1::ListSimulationsRequest request;
  for (int i = 0; i < 200; ++i) {
    grpc::ClientContext context;
    v1::ListSimulationsResponse page;
    const auto begin = Clock::now();
    const grpc::Status status = server.stub().ListSimulations(&context, request, &page);
    times.push_back(seconds_since(begin));
    if (!status.ok() || page.simulations_size() != 50) throw std::runtime_error("no page");
    request.set_page_token(page.next_page_token());
  }
  return median(times);
}

void measure_lists(std::vector<Measurement>& out) {
  const double many = page_seconds(100'000);
  const double few = page_seconds(100);
  out.push_back({"page_of_100000_jobs_over_page_of_100", many / few, "-", 3});
  out.push_back({"page_of_50_among_100000_jobs", 1e3 * many, "ms", {}});
}

/// Reads a stream to its end; seconds until the first message and in all.
std::pair<double, double> read_stream(Stub& stub, const v1::ReadHistoryRequest& request) {
  grpc::ClientContext context;
  const auto begin = Clock::now();
  const auto reader = stub.ReadHistory(&context, request);
  v1::ReadHistoryResponse part;
  double first = 0;
  while (reader->Read(&part)) {
    if (first == 0) first = seconds_since(begin);
  }
  const grpc::Status status = reader->Finish();
  if (!status.ok()) throw std::runtime_error("a history broke off: " + status.error_message());
  return {first, seconds_since(begin)};
}

void measure_histories(std::vector<Measurement>& out) {
  const Server server;
  const EmptyServer empty;
  v1::Simulation simulation = point_simulation();
  v1::HistoryRequest* history = simulation.mutable_operating_point()->mutable_history();
  for (const char* column :
       {"time_seconds", "mesh_force_newtons", "dynamic_transmission_error_metres",
        "mesh_loss_power_watts", "pinion_speed_radians_per_second", "gear_speed_radians_per_second",
        "pinion_shaft_torque_newton_metres", "inefficiency_percent"}) {
    history->add_columns(column);
  }
  history->set_mesh_cycles(20);
  history->set_samples_per_mesh_cycle(100'000);
  const std::string name = create(server.stub(), simulation).name();
  if (wait_for(server.stub(), name) != v1::Simulation::SUCCEEDED) {
    throw std::runtime_error("no history");
  }
  v1::ReadHistoryRequest all;
  all.set_name(name);
  v1::ReadHistoryRequest nothing;
  nothing.set_row_count(8 * 2'000'000 / 32'768);  // chunks
  v1::ReadHistoryRequest overview = all;
  overview.set_max_points(4000);
  std::vector<double> firsts, ratios, rates, overviews;
  for (int run = 0; run < kRuns; ++run) {
    const auto [empty_first, empty_time] = read_stream(empty.stub(), nothing);
    const auto [first, time] = read_stream(server.stub(), all);
    firsts.push_back(first);
    ratios.push_back(empty_time / time);
    rates.push_back(128 / time);
    overviews.push_back(read_stream(server.stub(), overview).second);
  }
  out.push_back({"history_first_message", 1e3 * median(firsts), "ms", 10});
  out.push_back({"history_rate_over_empty_stream", median(ratios), "-", 1.0 / 3, false});
  out.push_back({"history_rate", median(rates), "MB/s", {}});
  out.push_back({"history_overview_of_4000_points", 1e3 * median(overviews), "ms", 20});
  all.set_row_count(250'000);
  const double growth = memory_growth(server.id(), [&] {
    std::vector<std::thread> readers;
    for (int i = 0; i < 64; ++i) {
      readers.emplace_back([&] { read_stream(*server.another_stub(), all); });
    }
    for (std::thread& reader : readers) reader.join();
  });
  out.push_back({"memory_growth_with_64_readers", growth / kMegabyte, "MB", 16});
}

/// A watch that reads, or does not, until it is told.
class Watcher final : public grpc::ClientReadReactor<v1::SimulationEvent> {
 public:
  Watcher(Stub& stub, const std::string& name, bool reads) {
    request_.set_name(name);
    stub.async()->WatchSimulation(&context_, &request_, this);
    if (reads) StartRead(&event_);
    AddHold();  // until finish()
    StartCall();
  }
  void OnReadDone(bool ok) override {
    if (!ok) return;
    ++events;
    if (event_.state() == v1::Simulation::CANCELLED) {
      heard = Clock::now();
      has_heard = true;
    }
    StartRead(&event_);
  }
  void OnDone(const grpc::Status&) override { is_done = true; }
  void finish() {
    context_.TryCancel();
    RemoveHold();
    eventually([&] { return is_done.load(); });
  }

  std::atomic<int> events = 0;
  std::atomic<bool> has_heard = false;
  std::atomic<bool> is_done = false;
  Clock::time_point heard;

 private:
  grpc::ClientContext context_;
  v1::WatchSimulationRequest request_;
  v1::SimulationEvent event_;
};

/// Simulations that do not end on their own.
v1::Simulation endless() {
  v1::Simulation out = curve_simulation();
  auto* curve = out.mutable_inefficiency_curve();
  curve->set_first_speed_kilometres_per_hour(60);
  curve->set_last_speed_kilometres_per_hour(80);
  curve->set_speed_step_kilometres_per_hour(0.0201);
  out.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  out.mutable_solver_options()->set_march_step_tolerance(1e-11);
  out.mutable_solver_options()->set_march_settling_tolerance(1e-12);
  out.mutable_solver_options()->set_maximum_mesh_cycles(10'000);
  return out;
}

void measure_watchers(std::vector<Measurement>& out) {
  constexpr int kWatchers = 1000;
  constexpr int kStalled = 50;
  const Server server({"--threads", "1"});
  const std::string name = create(server.stub(), endless()).name();
  std::vector<std::unique_ptr<Stub>> stubs;
  for (int i = 0; i < 20; ++i) stubs.push_back(server.another_stub());
  std::vector<std::unique_ptr<Watcher>> watchers;
  double latest = 0;
  const double growth = memory_growth(server.id(), [&] {
    for (int i = 0; i < kWatchers; ++i) {
      watchers.push_back(std::make_unique<Watcher>(*stubs[i % 20], name, i >= kStalled));
    }
    const auto all = [&](auto holds) {
      return eventually([&] {
        return std::all_of(watchers.begin() + kStalled, watchers.end(),
                           [&](const auto& each) { return holds(*each); });
      });
    };
    all([](const Watcher& each) { return each.events > 1; });
    std::this_thread::sleep_for(seconds(3));
    grpc::ClientContext context;
    v1::CancelSimulationRequest cancel;
    cancel.set_name(name);
    v1::Simulation ended;
    const auto begin = Clock::now();
    server.stub().CancelSimulation(&context, cancel, &ended);
    all([](const Watcher& each) { return each.has_heard.load(); });
    for (int i = kStalled; i < kWatchers; ++i) {
      latest = std::max(latest, std::chrono::duration<double>(watchers[i]->heard - begin).count());
    }
  });
  for (const auto& each : watchers) each->finish();
  out.push_back({"memory_growth_with_1000_watchers", growth / kMegabyte, "MB", 64});
  out.push_back({"latest_of_950_watchers_hears_an_event", 1e3 * latest, "ms", 100});
}

/// Requests the server's health over a connection of its own, again 5 ms after each answer. A stall
/// delays one request only, so the slowest answer is reported besides the percentile.
class HealthProbe {
 public:
  explicit HealthProbe(const Server& server)
      : client_(server.another_channel()), thread_([this] { ask(); }) {}
  /// How long the answers took.
  const Latencies& stop() {
    stop_ = true;
    thread_.join();
    std::sort(answers_.seconds.begin(), answers_.seconds.end());
    return answers_;
  }

 private:
  void ask() {
    do {
      const auto begin = Clock::now();
      client_.call("/grpc.health.v1.Health/Check", "");
      answers_.seconds.push_back(seconds_since(begin));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (!stop_);
  }

  RawClient client_;
  std::atomic<bool> stop_ = false;
  Latencies answers_;
  std::thread thread_;
};

/// Adds how long health checks took beside a load.
void report(const std::string& load, const Latencies& checks, std::vector<Measurement>& out) {
  out.push_back({load + "_slowest_health_check", 1e3 * checks.seconds.back(), "ms", 50});
  out.push_back({load + "_p99_health_check", 1e3 * checks.percentile(0.99), "ms", {}});
}

/// How many simulations a filter finds, at most `limit`.
int count(Stub& stub, const std::string& filter, int limit) {
  grpc::ClientContext context;
  v1::ListSimulationsRequest request;
  request.set_filter(filter);
  request.set_page_size(limit);
  v1::ListSimulationsResponse page;
  stub.ListSimulations(&context, request, &page);
  return page.simulations_size();
}

bool all_end(Stub& stub) {
  return eventually(
      [&] { return count(stub, "state = QUEUED", 1) + count(stub, "state = RUNNING", 1) == 0; });
}

/// When a request that was turned away is to come again; nothing for any other answer.
std::optional<std::chrono::nanoseconds> retry_time(const grpc::Status& status) {
  google::rpc::Status details;
  if (status.error_code() != grpc::StatusCode::RESOURCE_EXHAUSTED ||
      !details.ParseFromString(status.error_details())) {
    return std::nullopt;
  }
  for (const auto& any : details.details()) {
    google::rpc::RetryInfo info;
    if (any.UnpackTo(&info)) {
      return seconds(info.retry_delay().seconds()) +
             std::chrono::nanoseconds(info.retry_delay().nanos());
    }
  }
  return std::nullopt;
}

/// Submits points all at once, and those that are turned away again when they are told to come.
class Bulk {
 public:
  Bulk(Stub& stub, int count) : stub_(stub), count_(count) {
    for (int i = 0; i < count; ++i) due_.emplace(Clock::now(), i);
  }

  /// Returns when all are accepted, or refused for good.
  void run() {
    std::unique_lock lock(mutex_);
    while (accepted_ + unexplained_ < count_) {
      if (due_.empty()) {
        changed_.wait(lock);
        continue;
      }
      const auto [time, number] = *due_.begin();
      if (time > Clock::now()) {
        changed_.wait_until(lock, time);
        continue;
      }
      due_.erase(due_.begin());
      lock.unlock();
      submit(number);
      lock.lock();
    }
  }

  int accepted() const {
    const std::lock_guard lock(mutex_);
    return accepted_;
  }
  int turned_away() const { return turned_away_; }  ///< times; after run()
  int unexplained() const { return unexplained_; }  ///< after run()

 private:
  void submit(int number) {
    const auto call = std::make_shared<Call<v1::CreateSimulationRequest, v1::Simulation>>();
    *call->request.mutable_simulation() = point_at(20 + 1e-2 * number);
    stub_.async()->CreateSimulation(
        &call->context, &call->request, &call->response,
        [this, call, number](const grpc::Status& status) { note(number, status); });
  }

  void note(int number, const grpc::Status& status) {
    const auto retry = retry_time(status);
    const std::lock_guard lock(mutex_);
    if (status.ok()) {
      ++accepted_;
    } else if (retry) {
      ++turned_away_;
      due_.emplace(Clock::now() + *retry, number);
    } else {
      ++unexplained_;
    }
    changed_.notify_one();
  }

  Stub& stub_;
  const int count_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::multimap<Clock::time_point, int> due_;  // guarded by mutex_
  int accepted_ = 0;                           // guarded by mutex_
  int turned_away_ = 0;                        // guarded by mutex_
  int unexplained_ = 0;                        // guarded by mutex_
};

constexpr int kSubmissions = 10'000;

/// All find room.
void measure_overload(std::vector<Measurement>& out) {
  const Server server;
  const auto many = server.another_stub();
  const auto single = server.another_stub();
  HealthProbe health(server);
  const double processor_before = process_figures(server.id()).processor_seconds;
  const auto begin = Clock::now();
  Bulk bulk(*many, kSubmissions);
  double curve_seconds = 0;
  int waiting_at_the_end_of_the_curve = 0;
  std::thread curve([&] {
    eventually([&] { return bulk.accepted() > kSubmissions / 2; });
    const auto from = Clock::now();
    wait_for(*single, create(*single, curve_simulation()).name());
    curve_seconds = seconds_since(from);
    waiting_at_the_end_of_the_curve = count(*single, "state = QUEUED", 1000);
  });
  bulk.run();
  curve.join();
  const bool is_done = all_end(server.stub());
  const double all_seconds = seconds_since(begin);
  const double processor = process_figures(server.id()).processor_seconds - processor_before;
  const int lost = bulk.unexplained() + (is_done ? 0 : 1) + count(*single, "state = FAILED", 1000);
  out.push_back(
      {"overload_submissions_neither_accepted_nor_told_when", static_cast<double>(lost), "-", 0});
  report("overload", health.stop(), out);
  out.push_back({"overload_bulk_waiting_when_the_curve_ends",
                 static_cast<double>(waiting_at_the_end_of_the_curve), "jobs", 1, false});
  out.push_back({"overload_curve", curve_seconds, "s", {}});
  out.push_back({"overload_all", all_seconds, "s", {}});
  out.push_back({"processor_time_of_a_point_of_its_own", 1e3 * processor / kSubmissions, "ms", {}});
}

/// Most are turned away and come again when they are told to.
void measure_refusals(std::vector<Measurement>& out) {
  const Server server({"--waiting-simulations", "1000"});
  const auto many = server.another_stub();
  HealthProbe health(server);
  const auto begin = Clock::now();
  Bulk bulk(*many, kSubmissions);
  bulk.run();
  const bool is_done = all_end(server.stub());
  const int lost =
      bulk.unexplained() + (is_done ? 0 : 1) + count(server.stub(), "state = FAILED", 1000);
  out.push_back({"refusals_that_said_when_to_come", static_cast<double>(bulk.turned_away()),
                 "refusals", 1, false});
  out.push_back({"refused_submissions_not_finished_in_the_end", static_cast<double>(lost), "-", 0});
  report("refusals", health.stop(), out);
  out.push_back({"refusals_all", seconds_since(begin), "s", {}});
}

/// Ten curves of a thousand points.
v1::Simulation long_curve(int number) {
  v1::Simulation out = curve_simulation();
  auto* curve = out.mutable_inefficiency_curve();
  curve->set_first_speed_kilometres_per_hour(20 + 0.01 * number);
  curve->set_last_speed_kilometres_per_hour(119.9 + 0.01 * number);
  curve->set_speed_step_kilometres_per_hour(0.1);
  return out;
}

/// A request of the client that fills the queue.
v1::CreateSimulationRequest request_of(const v1::Simulation& simulation,
                                       v1::SchedulingClass scheduling_class) {
  v1::CreateSimulationRequest out;
  *out.mutable_simulation() = simulation;
  out.set_scheduling_class(scheduling_class);
  return out;
}

constexpr char kOneClient[] = "one";

/// A point with a history of a million numbers.
v1::Simulation point_with_history(int number) {
  v1::Simulation out = point_at(120 + 1e-3 * number);
  v1::HistoryRequest* history = out.mutable_operating_point()->mutable_history();
  history->add_columns("mesh_force_newtons");
  history->set_mesh_cycles(10);
  history->set_samples_per_mesh_cycle(100'000);
  return out;
}

/// Fills the queue with jobs of one client: points, histories, curves of a thousand points, and
/// marched curves that do not end on their own.
void fill_queue(Stub& stub, int jobs) {
  const Latencies filled =
      closed_loop(32, jobs, [&](int number, const std::function<void(bool)>& done) {
        const auto call = std::make_shared<Call<v1::CreateSimulationRequest, v1::Simulation>>();
        v1::Simulation simulation = point_at(20 + 1e-3 * number);
        if (number % 3 == 1) simulation = long_curve(number % 1000);
        if (number % 100 == 2) simulation = endless();
        if (number % 100 == 5) simulation = point_with_history(number);
        call->request = request_of(simulation, v1::SCHEDULING_CLASS_UNSPECIFIED);
        call->request.set_force(true);
        call->context.AddMetadata("tribodyn-client", kOneClient);
        stub.async()->CreateSimulation(
            &call->context, &call->request, &call->response,
            [call, done](const grpc::Status& status) { done(status.ok()); });
      });
  if (filled.failures > 0) throw std::runtime_error("the queue cannot be filled");
}

/// Times of points stated INTERACTIVE, from the request to the last event of their watch.
Latencies interactive_points(Stub& stub, double first_speed) {
  constexpr int kPoints = 300;
  return closed_loop(1, kPoints, [&](int number, const std::function<void(bool)>& done) {
    grpc::ClientContext context;
    context.AddMetadata("tribodyn-client", kOneClient);
    v1::Simulation created;
    const grpc::Status status = stub.CreateSimulation(
        &context,
        request_of(point_at(first_speed + 1e-2 * number), v1::SCHEDULING_CLASS_INTERACTIVE),
        &created);
    done(status.ok() && wait_for(stub, created.name()) == v1::Simulation::SUCCEEDED);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // as people and pages do
  });
}

/// How much longer a client waits for a point stated INTERACTIVE while jobs of its own fill three
/// quarters of the queue than while nothing waits.
void measure_interactive(std::vector<Measurement>& out) {
  for (const char* threads : {"1", "2"}) {
    const Server server({"--threads", threads});
    const Latencies idle = interactive_points(server.stub(), 30);
    fill_queue(server.stub(), 14'000);
    const Latencies busy = interactive_points(server.stub(), 60);
    const int waiting = count(server.stub(), "state = QUEUED", 1000);
    const int lost = idle.failures + busy.failures + (waiting == 1000 ? 0 : 1);
    const std::string name = fmt::format("interactive_with_{}_threads", threads);
    out.push_back({name + "_p99_beyond_idle", 1e3 * (busy.percentile(0.99) - idle.percentile(0.99)),
                   "ms", 50});
    out.push_back({name + "_p99_on_an_idle_server", 1e3 * idle.percentile(0.99), "ms", {}});
    out.push_back({name + "_p99_beside_a_full_queue", 1e3 * busy.percentile(0.99), "ms", {}});
    out.push_back({name + "_median_beside_a_full_queue", 1e3 * busy.percentile(0.5), "ms", {}});
    out.push_back({name + "_not_succeeded", static_cast<double>(lost), "-", 0});
  }
}

/// Candidates of a screening: variants of the paper's fluids that nobody has asked for before.
std::vector<v1::Lubricant> candidates(int count) {
  std::mt19937_64 random(20261122);
  const auto varied = [&](double value, double share) {
    return value * std::uniform_real_distribution<double>(1 - share, 1 + share)(random);
  };
  std::vector<v1::Lubricant> out;
  for (int i = 0; i < count; ++i) {
    v1::Lubricant fluid =
        seed<v1::Lubricant>("lubricants/paper-fluid-" + std::to_string(1 + i % 3));
    fluid.set_name("lubricants/candidate-" + std::to_string(i));
    fluid.set_vogel_viscosity_prefactor_pascal_seconds(
        varied(fluid.vogel_viscosity_prefactor_pascal_seconds(), 0.1));
    fluid.set_pressure_viscosity_coefficient_per_pascal(
        varied(fluid.pressure_viscosity_coefficient_per_pascal(), 0.1));
    fluid.set_relaxation_time_seconds(varied(fluid.relaxation_time_seconds(), 0.3));
    fluid.set_limiting_shear_stress_coefficient(
        varied(fluid.limiting_shear_stress_coefficient(), 0.1));
    out.push_back(fluid);
  }
  return out;
}

constexpr int kCandidates = 100;
constexpr std::array kSumpCelsius = {20.0, 40.0, 90.0};
constexpr int kSpeeds = 13;  ///< 20 to 140 km/h by 10
constexpr int kScreened = kCandidates * static_cast<int>(kSumpCelsius.size()) * kSpeeds;

/// Each candidate and sump as a curve whose points are solved independently of each other.
std::vector<v1::Simulation> screening_curves(const std::vector<v1::Lubricant>& fluids) {
  std::vector<v1::Simulation> out;
  for (const v1::Lubricant& fluid : fluids) {
    for (const double sump : kSumpCelsius) {
      v1::Simulation simulation = curve_simulation();
      simulation.set_lubricant(fluid.name());
      simulation.set_sump_temperature_celsius(sump);
      simulation.mutable_inefficiency_curve()->set_independent_points(true);
      out.push_back(simulation);
    }
  }
  return out;
}

/// The same points, each as a simulation.
std::vector<v1::Simulation> screening_points(const std::vector<v1::Lubricant>& fluids) {
  std::vector<v1::Simulation> out;
  for (const v1::Lubricant& fluid : fluids) {
    for (const double sump : kSumpCelsius) {
      for (int i = 0; i < kSpeeds; ++i) {
        v1::Simulation simulation = point_at(20 + 10 * i);
        simulation.set_lubricant(fluid.name());
        simulation.set_sump_temperature_celsius(sump);
        out.push_back(simulation);
      }
    }
  }
  return out;
}

/// Processor time of this thread since it began [s].
double thread_processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Fluids at each sump, as the core takes them.
std::vector<SimulationInputs> screening_inputs(const std::vector<v1::Lubricant>& fluids) {
  ResourceLookup lookup = seed_lookup();
  lookup.find = [&fluids,
                 seeds = lookup.find](const RevisionName& name) -> std::optional<FoundResource> {
    for (const v1::Lubricant& fluid : fluids) {
      if (fluid.name() == name.name) return FoundResource{1, false, fluid.SerializeAsString()};
    }
    return seeds(name);
  };
  std::vector<SimulationInputs> out;
  for (const v1::Simulation& simulation : screening_curves(fluids)) {
    Violations violations;
    out.push_back(read_simulation(simulation, lookup, "simulation", violations).value());
  }
  return out;
}

/// Processor time that the core's screening of some fluids takes on this thread, without the
/// conversion of messages [s].
double screen_on_this_thread(std::span<const SimulationInputs> inputs) {
  std::shared_ptr<PreparedGearSet> gear_set;
  double out = 0;
  for (const SimulationInputs& input : inputs) {
    const Scene physical = scene(input);
    const auto study = std::get<CurveStudy>(server::study(input));
    const double begin = thread_processor_seconds();
    if (!gear_set) {
      gear_set =
          std::make_shared<PreparedGearSet>(physical.gear_set, physical.solid, physical.options);
    }
    PreparedScene prepared(physical, gear_set);
    for (const double speed : study.vehicle_speeds) {
      OperatingCondition condition;
      condition.vehicle_speed = speed;
      screen_point(prepared, condition, study.options.point);
    }
    out += thread_processor_seconds() - begin;
  }
  return out;
}

/// The same on several threads at once, which share caches and memory as those of a server do [s].
double screen_in_core(const std::vector<SimulationInputs>& inputs, std::size_t threads) {
  std::vector<double> taken(threads);
  std::vector<std::thread> all;
  for (std::size_t i = 0; i < threads; ++i) {
    const std::size_t begin = i * inputs.size() / threads, end = (i + 1) * inputs.size() / threads;
    all.emplace_back([&, i, begin, end] {
      taken[i] = screen_on_this_thread(std::span(inputs).subspan(begin, end - begin));
    });
  }
  for (std::thread& each : all) each.join();
  return std::accumulate(taken.begin(), taken.end(), 0.0);
}

/// Processor time of the server from the first submission, 64 under way, until all have ended [s].
double screen_over_the_wire(const Server& server, const std::vector<v1::Simulation>& simulations) {
  const double begin = process_figures(server.id()).processor_seconds;
  const Latencies submitted = closed_loop(
      64, static_cast<int>(simulations.size()),
      [&](int number, const std::function<void(bool)>& done) {
        const auto call = std::make_shared<Call<v1::CreateSimulationRequest, v1::Simulation>>();
        *call->request.mutable_simulation() = simulations[number];
        server.stub().async()->CreateSimulation(
            &call->context, &call->request, &call->response,
            [call, done](const grpc::Status& status) { done(status.ok()); });
      });
  if (submitted.failures > 0) throw std::runtime_error("a submission was refused");
  while (count(server.stub(), "state = QUEUED", 1) + count(server.stub(), "state = RUNNING", 1)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (count(server.stub(), "state = SUCCEEDED", 1000) <
      std::min<int>(1000, static_cast<int>(simulations.size()))) {
    throw std::runtime_error("a screened simulation failed");
  }
  return process_figures(server.id()).processor_seconds - begin;
}

/// Fluids at every speed and sump as a request of EvaluatePoints.
v1::EvaluatePointsRequest evaluation(std::span<const v1::Lubricant> fluids) {
  v1::EvaluatePointsRequest out;
  out.set_lubricant("lubricants/paper-fluid-1");
  const google::protobuf::Descriptor& lubricant = *v1::Lubricant::descriptor();
  for (int i = 0; i < lubricant.field_count(); ++i) {
    const google::protobuf::FieldDescriptor* field = lubricant.field(i);
    if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE ||
        is_documentary(*field)) {
      continue;
    }
    v1::CandidateColumn& column = *out.add_candidate_columns();
    column.set_path("lubricant." + field->name());
    for (const v1::Lubricant& fluid : fluids) {
      column.add_values(fluid.GetReflection()->GetDouble(fluid, field));
    }
  }
  for (const double sump : kSumpCelsius) {
    for (int i = 0; i < kSpeeds; ++i) {
      v1::PointCondition& condition = *out.add_conditions();
      condition.set_speed_kilometres_per_hour(20 + 10 * i);
      condition.set_sump_temperature_celsius(sump);
    }
  }
  return out;
}

/// Processor time of the server for all candidates in calls of EvaluatePoints [s].
double evaluate_over_the_wire(const Server& server, std::span<const v1::Lubricant> fluids) {
  constexpr std::size_t kTogether = 50;  // times 39 conditions: nearly the 2000 points allowed
  const auto stub = v1::PointService::NewStub(connect(server.address()));
  const double begin = process_figures(server.id()).processor_seconds;
  for (std::size_t first = 0; first < fluids.size(); first += kTogether) {
    grpc::ClientContext context;
    v1::EvaluatePointsResponse response;
    const grpc::Status status =
        stub->EvaluatePoints(&context, evaluation(fluids.subspan(first, kTogether)), &response);
    if (!status.ok()) throw std::runtime_error(status.error_message());
    if (response.refusals_size() > 0) throw std::runtime_error(response.refusals(0).message());
  }
  return process_figures(server.id()).processor_seconds - begin;
}

/// What pipelines do: many fluids at the same speeds and sumps, as curves, as points or as calls
/// that store nothing, against the same points screened in the core alone.
void measure_screening(std::vector<Measurement>& out) {
  const std::vector<v1::Lubricant> fluids = candidates(kCandidates);
  const std::vector<SimulationInputs> inputs = screening_inputs(fluids);
  const auto milliseconds_a_point = [](double total) { return 1e3 * total / kScreened; };
  std::vector<double> core, curves, points, calls;
  for (int run = 0; run < 3; ++run) {
    core.push_back(milliseconds_a_point(screen_in_core(inputs, 1)));
    for (const bool as_curves : {true, false}) {
      const Server server;
      create_lubricants(server, fluids);
      (as_curves ? curves : points)
          .push_back(milliseconds_a_point(screen_over_the_wire(
              server, as_curves ? screening_curves(fluids) : screening_points(fluids))));
    }
    calls.push_back(milliseconds_a_point(evaluate_over_the_wire(Server(), fluids)));
  }
  out.push_back({"screened_point_in_the_core", median(core), "ms", {}});
  out.push_back({"screened_point_over_the_wire_in_a_curve", median(curves), "ms", 0.45});
  out.push_back({"screened_point_over_the_wire_of_its_own", median(points), "ms", 2.3});
  out.push_back({"screened_point_over_the_wire_by_evaluate_points", median(calls), "ms", {}});
  out.push_back(
      {"screened_point_by_evaluate_points_over_the_core", median(calls) / median(core), "-", {}});
  out.push_back(
      {"screened_point_in_a_curve_over_the_core", median(curves) / median(core), "-", {}});
  out.push_back(
      {"screened_point_of_its_own_over_the_core", median(points) / median(core), "-", {}});
}

void check_status(const grpc::Status& status) {
  if (!status.ok()) throw std::runtime_error(status.error_message());
}

/// An oil of which nothing but the numbers of its data sheet is known.
v1::Lubricant data_sheet_oil() {
  v1::Lubricant out;
  out.set_name("lubricants/sheet");
  out.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  auto& measured = *out.mutable_measurements();
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(103);
  measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(15.1);
  measured.set_density_15_celsius_kilograms_per_cubic_metre(868);
  return out;
}

/// What bands add to a curve: the curve that `tribodyn curve` requests by default, and the request
/// with which it finds the uncertainty at each speed. In time of the server's processor.
void measure_bands(std::vector<Measurement>& out) {
  constexpr int kBandDraws = 99;    // as `tribodyn curve` has them
  constexpr int kRepetitions = 20;  // processor time comes in units of 10 ms
  const Server server;
  create_lubricants(server, {data_sheet_oil()});
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/sheet");
  v1::InefficiencyCurveStudy& study = *simulation.mutable_inefficiency_curve();
  study.set_first_speed_kilometres_per_hour(20);
  study.set_last_speed_kilometres_per_hour(140);
  study.set_speed_step_kilometres_per_hour(5);
  v1::ComparePointsRequest request;
  request.add_lubricants("lubricants/sheet");
  request.set_draws(kBandDraws);
  for (int speed = 20; speed <= 140; speed += 5) {
    request.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  const auto stub = v1::SimulationService::NewStub(server.another_channel());
  const auto points = v1::PointService::NewStub(server.another_channel());
  const auto processor = [&server] { return process_figures(server.id()).processor_seconds; };
  std::vector<double> curves, bands;
  for (int run = 0; run < kRuns; ++run) {
    const double begin = processor();
    for (int i = 0; i < kRepetitions; ++i) {
      if (wait_for(*stub, create(*stub, simulation, true).name()) != v1::Simulation::SUCCEEDED) {
        throw std::runtime_error("the curve failed");
      }
    }
    const double middle = processor();
    for (int i = 0; i < kRepetitions; ++i) {
      grpc::ClientContext context;
      v1::ComparePointsResponse response;
      check_status(points->ComparePoints(&context, request, &response));
    }
    curves.push_back((middle - begin) / kRepetitions);
    bands.push_back((processor() - middle) / kRepetitions);
  }
  const double curve = median(curves), band = median(bands);
  out.push_back({"curve_of_25_speeds", 1e3 * curve, "ms", {}});
  out.push_back({"bands_of_a_curve_of_25_speeds", 1e3 * band, "ms", {}});
  out.push_back({"curve_with_bands_over_one_without", (curve + band) / curve, "-", 4});
}

v1::CreateCampaignRequest campaign_request(std::span<const v1::Lubricant> fluids) {
  const v1::EvaluatePointsRequest points = evaluation(fluids);
  v1::CreateCampaignRequest out;
  out.mutable_campaign()->set_lubricant(points.lubricant());
  *out.mutable_campaign()->mutable_candidate_columns() = points.candidate_columns();
  *out.mutable_campaign()->mutable_conditions() = points.conditions();
  return out;
}

v1::Campaign create_campaign(v1::CampaignService::Stub& stub,
                             const v1::CreateCampaignRequest& request) {
  grpc::ClientContext context;
  context.AddMetadata("tribodyn-client", kOneClient);
  v1::Campaign out;
  check_status(stub.CreateCampaign(&context, request, &out));
  return out;
}

/// Follows a campaign until it ends or pauses. Calls `progress` after each change.
v1::CampaignEvent follow_campaign(v1::CampaignService::Stub& stub, const std::string& name,
                                  const std::function<void(const v1::CampaignEvent&)>& progress) {
  grpc::ClientContext context;
  v1::WatchCampaignRequest request;
  request.set_name(name);
  const auto reader = stub.WatchCampaign(&context, request);
  v1::CampaignEvent event;
  while (reader->Read(&event)) {
    progress(event);
    if (event.state() != v1::Campaign::RUNNING) break;
  }
  context.TryCancel();
  reader->Finish();
  return event;
}

/// What one campaign took.
struct CampaignRun {
  double processor_seconds = 0;  ///< of the server, from the request until the last row
  double seconds = 0;            ///< the same by the clock
  double first_rows_seconds = 0;
  double bytes = 0;  ///< of its rows in the database
  double read_seconds = 0;
};

CampaignRun run_campaign(const v1::CreateCampaignRequest& request, std::size_t threads) {
  const Server server({"--threads", std::to_string(threads)});
  const auto stub = v1::CampaignService::NewStub(connect(server.address()));
  CampaignRun out;
  const double begin = process_figures(server.id()).processor_seconds;
  const auto start = Clock::now();
  const v1::Campaign created = create_campaign(*stub, request);
  const v1::CampaignEvent end =
      follow_campaign(*stub, created.name(), [&](const v1::CampaignEvent& event) {
        if (out.first_rows_seconds == 0 && event.points_done() > 0) {
          out.first_rows_seconds = seconds_since(start);
        }
      });
  out.seconds = seconds_since(start);
  out.processor_seconds = process_figures(server.id()).processor_seconds - begin;
  if (end.state() != v1::Campaign::SUCCEEDED || end.points_refused() > 0) {
    throw std::runtime_error("a campaign did not succeed");
  }
  {
    grpc::ClientContext context;
    v1::GetCampaignRequest get;
    get.set_name(created.name());
    v1::Campaign done;
    check_status(stub->GetCampaign(&context, get, &done));
    out.bytes = static_cast<double>(done.stored_bytes() - created.stored_bytes());
  }
  const auto before = Clock::now();
  grpc::ClientContext context;
  v1::ReadCampaignRequest read;
  read.set_name(created.name());
  const auto reader = stub->ReadCampaign(&context, read);
  std::size_t bytes = 0;
  for (v1::ReadCampaignResponse part; reader->Read(&part);) bytes += part.chunk().values().size();
  check_status(reader->Finish());
  if (bytes < static_cast<std::size_t>(end.points())) throw std::runtime_error("rows are missing");
  out.read_seconds = seconds_since(before);
  return out;
}

/// A campaign of a thousand fluids at 39 conditions against the same points screened in the core
/// alone, on as many threads: two threads slow each other down by some percent, in the core as in
/// the server.
void measure_campaign_cost(std::size_t threads, std::vector<Measurement>& out) {
  const std::vector<v1::Lubricant> fluids = candidates(1000);
  const std::vector<SimulationInputs> inputs = screening_inputs(fluids);
  const double points = 1000.0 * kSpeeds * std::size(kSumpCelsius);
  std::vector<double> core, server, ratios, bytes, first, reads;
  for (int run = 0; run < kRuns; ++run) {
    core.push_back(1e6 * screen_in_core(inputs, threads) / points);
    const CampaignRun campaign = run_campaign(campaign_request(fluids), threads);
    server.push_back(1e6 * campaign.processor_seconds / points);
    ratios.push_back(server.back() / core.back());
    bytes.push_back(campaign.bytes / points);
    first.push_back(1e3 * campaign.first_rows_seconds);
    reads.push_back(1e3 * campaign.read_seconds);
  }
  const std::string name = fmt::format("campaign_with_{}_threads", threads);
  out.push_back({name + "_point_in_the_core", median(core), "us", {}});
  out.push_back({name + "_point_in_the_server", median(server), "us", {}});
  out.push_back({name + "_point_over_the_core", median(ratios), "-", 1.05});
  out.push_back({name + "_bytes_of_a_point", median(bytes), "B", 60});
  out.push_back({name + "_first_rows_visible", median(first), "ms", 100});
  out.push_back({name + "_of_39000_points_read", median(reads), "ms", 150});
}

/// A campaign of two thousand fluids on a rough ball on a disc, at 36 conditions of two
/// temperatures, against the same rows of the core alone.
void measure_rig_campaign(std::vector<Measurement>& out) {
  const std::vector<v1::Lubricant> fluids = candidates(2000);
  v1::CreateCampaignRequest request = campaign_request(fluids);
  v1::Campaign& campaign = *request.mutable_campaign();
  campaign.clear_conditions();
  campaign.set_surface("surfaces/run-in");
  v1::CampaignRig& rig = *campaign.mutable_rig();
  rig.set_radius_x_metres(0.0127);
  v1::RigGrid& grid = *rig.mutable_grid();
  for (const double celsius : {40.0, 100.0}) grid.add_supply_temperatures_celsius(celsius);
  grid.add_loads_newtons(35);
  for (const double speed : {0.3, 1.0, 3.0}) grid.add_entrainment_speeds_metres_per_second(speed);
  for (const double percent : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    grid.add_slide_roll_ratios_percent(percent);
  }
  const v1::Surface surface = seed<v1::Surface>("surfaces/run-in");
  RigScene scene{{}, {}, {0.0127, 0.0127}, roughness(surface), boundary_friction(surface), {}};
  scene.options.hertz_solution = HertzSolution::kExact;
  scene.solids.body_1 = scene.solids.body_2 = {210e9, 0.3, 46, 7850, 470};
  double rows = 0, sum = 0;
  const auto in_core = [&] {
    rows = 0;
    const double begin = thread_processor_seconds();
    for (const v1::Lubricant& fluid : fluids) {
      scene.lubricant = to_core(fluid);
      for (const double celsius : grid.supply_temperatures_celsius()) {
        const Rig prepared(scene, celsius + kZeroCelsius);
        for (const double speed : grid.entrainment_speeds_metres_per_second()) {
          for (const double percent : grid.slide_roll_ratios_percent()) {
            sum += prepared.at({35, speed, 0.01 * percent}).traction_coefficient;
            ++rows;
          }
        }
      }
    }
    return thread_processor_seconds() - begin;
  };
  std::vector<double> core, server, ratios, bytes;
  for (int run = 0; run < kRuns; ++run) {
    core.push_back(1e6 * in_core() / rows);
    const CampaignRun done = run_campaign(request, 1);
    server.push_back(1e6 * done.processor_seconds / rows);
    ratios.push_back(server.back() / core.back());
    bytes.push_back(done.bytes / rows);
  }
  if (!(sum > 0)) throw std::runtime_error("a rig without traction");
  out.push_back({"rig_campaign_row_in_the_core", median(core), "us", {}});
  out.push_back({"rig_campaign_row_in_the_server", median(server), "us", {}});
  out.push_back({"rig_campaign_row_over_the_core", median(ratios), "-", 1.5});
  out.push_back({"rig_campaign_bytes_of_a_row", median(bytes), "B", 80});
}

/// How much faster two threads compute a campaign of some seconds than one.
void measure_campaign_threads(std::vector<Measurement>& out) {
  const std::vector<v1::Lubricant> fluids = candidates(4000);
  std::vector<double> ratios;
  for (int run = 0; run < 3; ++run) {
    const double one = run_campaign(campaign_request(fluids), 1).seconds;
    ratios.push_back(one / run_campaign(campaign_request(fluids), 2).seconds);
  }
  out.push_back({"campaign_two_threads_over_one", median(ratios), "-", 1.8, false});
}

/// How much longer a client waits for a point stated INTERACTIVE while its own campaign takes all
/// threads than while nothing runs.
void measure_interactive_beside_a_campaign(std::vector<Measurement>& out) {
  for (const char* threads : {"1", "2"}) {
    const Server server({"--threads", threads});
    const auto stub = v1::CampaignService::NewStub(connect(server.address()));
    const Latencies idle = interactive_points(server.stub(), 30);
    v1::CreateCampaignRequest request = campaign_request(candidates(1000));
    // Equal candidates are computed again: enough for as long as this takes.
    for (v1::CandidateColumn& column : *request.mutable_campaign()->mutable_candidate_columns()) {
      const std::vector<double> values(column.values().begin(), column.values().end());
      for (int i = 1; i < 50; ++i) column.mutable_values()->Add(values.begin(), values.end());
    }
    const std::string campaign = create_campaign(*stub, request).name();
    const Latencies busy = interactive_points(server.stub(), 60);
    v1::Campaign::State state{};
    follow_campaign(*stub, campaign, [&](const v1::CampaignEvent& event) {
      state = event.state();
      if (state != v1::Campaign::RUNNING) return;
      grpc::ClientContext context;
      v1::CancelCampaignRequest cancel;
      cancel.set_name(campaign);
      v1::Campaign cancelled;
      check_status(stub->CancelCampaign(&context, cancel, &cancelled));
    });
    const int lost = idle.failures + busy.failures + (state == v1::Campaign::CANCELLED ? 0 : 1);
    const std::string name = fmt::format("interactive_beside_a_campaign_with_{}_threads", threads);
    out.push_back({name + "_p99_beyond_idle", 1e3 * (busy.percentile(0.99) - idle.percentile(0.99)),
                   "ms", 50});
    out.push_back({name + "_p99", 1e3 * busy.percentile(0.99), "ms", {}});
    out.push_back({name + "_not_succeeded", static_cast<double>(lost), "-", 0});
  }
}

/// Ten million points, of which a tenth is computed: what the server keeps in memory beyond what it
/// has after a hundredth.
void measure_large_campaign(std::vector<Measurement>& out) {
  constexpr int kManyCandidates = 100'000, kConditions = 100;
  const Server server;
  const auto stub = v1::CampaignService::NewStub(connect(server.address()));
  v1::CreateCampaignRequest request;
  v1::Campaign& campaign = *request.mutable_campaign();
  campaign.set_lubricant("lubricants/paper-fluid-1");
  v1::CandidateColumn& column = *campaign.add_candidate_columns();
  column.set_path("lubricant.relaxation_time_seconds");
  for (int i = 0; i < kManyCandidates; ++i) column.add_values(1e-12 * (1 + 1e-4 * i));
  for (int i = 0; i < kConditions; ++i) {
    campaign.add_conditions()->set_speed_kilometres_per_hour(20 + 1.2 * i);
  }
  campaign.mutable_budget()->set_points(kManyCandidates);
  const auto start = Clock::now();
  const std::string name = create_campaign(*stub, request).name();
  const double accepted = seconds_since(start);
  const auto nothing = [](const v1::CampaignEvent&) {};
  follow_campaign(*stub, name, nothing);
  const double before = process_figures(server.id()).anonymous_bytes;
  grpc::ClientContext context;
  v1::ResumeCampaignRequest resume;
  resume.set_name(name);
  resume.mutable_budget()->set_points(10 * kManyCandidates);
  v1::Campaign resumed;
  check_status(stub->ResumeCampaign(&context, resume, &resumed));
  const auto from = Clock::now();
  const v1::CampaignEvent end = follow_campaign(*stub, name, nothing);
  if (end.stop().reason() != "BUDGET_SPENT") throw std::runtime_error("the campaign was stopped");
  out.push_back({"campaign_of_10000000_points_accepted", 1e3 * accepted, "ms", 1000});
  out.push_back({"campaign_of_10000000_points_rate",
                 9.0 * kManyCandidates / seconds_since(from),
                 "1/s",
                 {},
                 false});
  out.push_back({"campaign_of_10000000_points_memory_growth",
                 (process_figures(server.id()).anonymous_bytes - before) / kMegabyte, "MB", 8});
}

void measure_campaigns(std::vector<Measurement>& out) {
  measure_campaign_cost(1, out);
  measure_campaign_cost(2, out);
  measure_campaign_threads(out);
  measure_interactive_beside_a_campaign(out);
  measure_large_campaign(out);
}

struct EstimatedCase {
  const char* name;
  v1::Simulation simulation;
};

std::vector<EstimatedCase> estimated_cases() {
  std::vector<EstimatedCase> out = {
      {"smooth_point", point_at(100)},   {"impacting_point", point_at(40)},
      {"sharp_point", point_at(65)},     {"quasi_static_point", point_at(65)},
      {"marched_point", point_at(65)},   {"sharply_marched_point", point_at(65)},
      {"history", point_at(65)},         {"long_history", point_at(65)},
      {"marched_history", point_at(65)}, {"curve", curve_simulation()},
      {"long_curve", long_curve(0)}};
  out[2].simulation.mutable_solver_options()->set_tolerance(1e-6);
  out[3].simulation.mutable_operating_point()->set_model(v1::POINT_MODEL_QUASI_STATIC);
  out[4].simulation.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  out[5].simulation.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  out[5].simulation.mutable_solver_options()->set_march_step_tolerance(1e-9);
  out[8].simulation.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
  const std::array<std::pair<int, int>, 3> lengths = {{{10, 10'000}, {1000, 1000}, {100, 1000}}};
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    auto* history = out[6 + i].simulation.mutable_operating_point()->mutable_history();
    history->add_columns("mesh_force_newtons");
    history->set_mesh_cycles(lengths[i].first);
    history->set_samples_per_mesh_cycle(lengths[i].second);
  }
  return out;
}

/// Of the core's time for a simulation, over its estimate.
void measure_estimates(std::vector<Measurement>& out) {
  double worst = 1;
  for (const auto& [name, simulation] : estimated_cases()) {
    Violations violations;
    const auto inputs = read_simulation(simulation, seed_lookup(), "simulation", violations);
    if (!inputs) throw std::runtime_error(violations.front().description);
    std::vector<double> times;
    for (int run = 0; run < kRuns; ++run) {
      PreparedGearSets gear_sets;
      const auto task = compute_task(*inputs, 1, 1, "", false);
      const auto begin = Clock::now();
      compute(task, {}, gear_sets, [](double, const StageText&) { return true; });
      times.push_back(seconds_since(begin));
    }
    const double ratio = median(times) / estimate_cost(*inputs).processor_seconds();
    worst = std::max({worst, ratio, 1 / ratio});
    out.push_back({fmt::format("time_over_estimate_of_{}", name), ratio, "-", {}});
  }
  out.push_back({"worst_factor_of_an_estimate", worst, "-", 3});
}

}  // namespace
}  // namespace tribodyn::server

int main(int argc, char** argv) try {
  using namespace tribodyn::server;
  using Measure = void (*)(std::vector<tribodyn::Measurement>&);
  const std::vector<std::pair<std::string, Measure>> parts = {
      {"requests", measure_requests},
      {"lists", measure_lists},
      {"histories", measure_histories},
      {"watchers", measure_watchers},
      {"overload", measure_overload},
      {"refusals", measure_refusals},
      {"interactive", measure_interactive},
      {"screening", measure_screening},
      {"bands", measure_bands},
      {"campaigns", measure_campaigns},
      {"interactive_beside_a_campaign", measure_interactive_beside_a_campaign},
      {"rig_campaigns", measure_rig_campaign},
      {"estimates", measure_estimates}};
  const std::string path = argc > 1 ? argv[1] : "build/benchmark/results.json";
  const std::vector<std::string> wanted(argv + std::min(argc, 2), argv + argc);
  std::printf("%s\n", tribodyn::machine_name().c_str());
  std::fflush(stdout);
  for (const auto& [name, measure] : parts) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    std::vector<tribodyn::Measurement> figures;
    measure(figures);
    tribodyn::print(figures);
    std::fflush(stdout);
    tribodyn::record(path, figures);
  }
  return 0;
} catch (const std::exception& failure) {  // its servers have been stopped
  std::fprintf(stderr, "service_benchmark: %s\n", failure.what());
  return 1;
}
