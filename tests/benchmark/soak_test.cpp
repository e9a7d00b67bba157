// A server under a steady mix of requests must not grow: resident memory, threads and descriptors.
// usage: soak_test [SECONDS]      default: TRIBODYN_SOAK_SECONDS, else 90; the full mode is 7200
// The full mode prints the server's memory by kind each minute and counts the second hour.
#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/benchmark/load_client.h"
#include "tests/benchmark/measurements.h"
#include "tests/service/server_process.h"
#include "tests/service/support.h"
#include "tribodyn/v1/simulations.grpc.pb.h"

namespace tribodyn::server {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration;

constexpr double kFullSeconds = 7200;
constexpr double kLeastRequestsPerSecond = 400;
constexpr double kMostGrowthPerSecond = 2.0 / 120;  // [MB/s]
constexpr double kMostGrowthInFullMode = 0.2;       // [MB], in the second hour
constexpr auto kBetweenLooks = std::chrono::milliseconds(200);

/// Between the least and the most that was seen.
class Range {
 public:
  void add(int value) {
    least_ = std::min(least_, value);
    most_ = std::max(most_, value);
  }
  double width() const { return most_ - least_; }

 private:
  int least_ = std::numeric_limits<int>::max();
  int most_ = 0;
};

void check(const grpc::Status& status) {
  if (!status.ok()) throw std::runtime_error(status.error_message());
}

/// What a client does over and over: submit, watch, get, list, read a history.
class Client {
 public:
  Client(const std::string& address, int number)
      : stub_(v1::SimulationService::NewStub(connect(address))), number_(number) {}

  /// Requests made.
  int round() {
    v1::CreateSimulationRequest create;
    *create.mutable_simulation() = point_simulation();
    auto* point = create.mutable_simulation()->mutable_operating_point();
    // A third of them anew, the others from the cache.
    const int speed = round_ % 3 == 0 ? round_ : round_ % 7;
    point->mutable_cruise()->set_speed_kilometres_per_hour(20 + number_ + 1e-4 * speed);
    point->mutable_history()->add_columns("mesh_force_newtons");
    const std::string name = call(create, &v1::SimulationService::Stub::CreateSimulation).name();
    {
      grpc::ClientContext context;
      v1::WatchSimulationRequest watch;
      watch.set_name(name);
      const auto reader = stub_->WatchSimulation(&context, watch);
      v1::SimulationEvent event;
      while (reader->Read(&event)) {
      }
      check(reader->Finish());
    }
    {
      grpc::ClientContext context;
      v1::ReadHistoryRequest read;
      read.set_name(name);
      const auto reader = stub_->ReadHistory(&context, read);
      v1::ReadHistoryResponse part;
      while (reader->Read(&part)) {
      }
      check(reader->Finish());
    }
    v1::GetSimulationRequest get;
    get.set_name(name);
    for (int i = 0; i < 5; ++i) call(get, &v1::SimulationService::Stub::GetSimulation);
    v1::ListSimulationsRequest list;
    list.set_page_size(10);
    call(list, &v1::SimulationService::Stub::ListSimulations);
    ++round_;
    return 9;
  }

 private:
  template <class Request, class Response>
  Response call(const Request& request,
                grpc::Status (v1::SimulationService::Stub::*method)(grpc::ClientContext*,
                                                                    const Request&, Response*)) {
    grpc::ClientContext context;
    Response response;
    check((*stub_.*method)(&context, request, &response));
    return response;
  }

  std::unique_ptr<v1::SimulationService::Stub> stub_;
  int number_;
  int round_ = 0;
};

void print_memory(double seconds, const ProcessFigures& figures, std::int64_t requests) {
  fmt::print(
      "{:5.0f} s  resident {:6.2f} MB  anonymous {:6.2f}  files {:6.2f}  shared {:6.2f}  {} "
      "requests\n",
      seconds, figures.resident_bytes / 1e6, figures.anonymous_bytes / 1e6,
      figures.file_bytes / 1e6, figures.shared_bytes / 1e6, requests);
  std::fflush(stdout);
}

int run(double length) {
  const TemporaryFolder folder;
  const std::string database = folder.file("tribodyn.db");
  ServerProcess process({"--listen", "127.0.0.1:0", "--database", database, "--port-file",
                         folder.file("port"), "--log-level", "warn", "--threads", "2"},
                        folder.file("log"));
  const std::string address = wait_for_address(folder.file("port"), process);
  const int id = server_of(database);
  std::atomic<bool> stop = false;
  std::atomic<std::int64_t> requests = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back([&, i] {
      for (Client client(address, i); !stop;) requests += client.round();
    });
  }
  const auto begin = Clock::now();
  const bool is_full = length >= kFullSeconds;
  const double warm_up = is_full ? kFullSeconds / 2 : std::min(60.0, length / 2),
               counted = length - warm_up;
  const auto seconds = [begin] { return duration<double>(Clock::now() - begin).count(); };
  ProcessFigures last;
  double next_line = 0;
  const auto look = [&] {
    last = process_figures(id);
    if (is_full && seconds() >= next_line) {
      print_memory(seconds(), last, requests);
      next_line += 60;
    }
    std::this_thread::sleep_for(kBetweenLooks);
  };
  while (seconds() < warm_up) look();
  const std::int64_t requests_before = requests;
  const ProcessFigures first = process_figures(id);
  Range threads;
  Range descriptors;
  while (seconds() < length) {
    look();
    threads.add(last.threads);
    descriptors.add(last.descriptors);
  }
  const auto served = static_cast<double>(requests - requests_before);
  stop = true;
  for (std::thread& client : clients) client.join();
  const auto growth = [&](double ProcessFigures::*bytes) {
    return (last.*bytes - first.*bytes) / 1e6;
  };
  const std::vector<Measurement> figures = {
      {"soak_growth_of_resident_memory", growth(&ProcessFigures::resident_bytes), "MB",
       is_full ? kMostGrowthInFullMode : kMostGrowthPerSecond * counted},
      {"soak_growth_of_anonymous_memory", growth(&ProcessFigures::anonymous_bytes), "MB", {}},
      {"soak_growth_of_mapped_files", growth(&ProcessFigures::file_bytes), "MB", {}},
      {"soak_growth_of_shared_memory", growth(&ProcessFigures::shared_bytes), "MB", {}},
      {"soak_requests", served, "-", kLeastRequestsPerSecond * counted, false},
      {"soak_range_of_threads", threads.width(), "-", 0},
      {"soak_range_of_descriptors", descriptors.width(), "-", 0},
      {"soak_length", length, "s", {}}};
  print(figures);
  record("build/benchmark/results.json", figures);
  return std::all_of(figures.begin(), figures.end(), is_met) ? 0 : 1;
}

}  // namespace
}  // namespace tribodyn::server

int main(int argc, char** argv) {
  const char* set = std::getenv("TRIBODYN_SOAK_SECONDS");
  const char* text = argc > 1 ? argv[1] : set;
  return tribodyn::server::run(text == nullptr ? 90 : std::atof(text));
}
