// REST with a thousand readers of events: what they add to the time of a short read, what they take
// in memory, and whether any of them misses or repeats an event while each connects again twenty
// times. One thread of the server computes all the time. Figures that are compared are of one run
// on one machine. usage: rest_benchmark [RESULTS.json [CLIENTS [SECONDS]]]
//
// Default: build/benchmark/results.json, 1000 clients, 20 s a phase.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/benchmark/load_client.h"
#include "tests/benchmark/measurements.h"
#include "tests/service/server_process.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRequestsPerSecond = 200;
constexpr double kEventsPerSecond = 2;
constexpr int kReconnects = 20;
constexpr double kMostMegabytes = 100;
constexpr double kMostSlower = 2;  // p99 with the readers over p99 without

int connect_to(int port) {
  const int out = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (out < 0 || connect(out, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0) {
    throw std::runtime_error("cannot connect");
  }
  return out;
}

/// A tribodynd whose REST interface listens on a free port.
class Server {
 public:
  Server()
      : process_({"--listen", "127.0.0.1:0", "--http-listen", "127.0.0.1:0", "--database",
                  folder_.file("x.sqlite"), "--port-file", folder_.file("port"), "--threads", "1"},
                 folder_.file("log")) {
    if (wait_for_address(folder_.file("port"), process_).empty()) {
      throw std::runtime_error(process_.log());
    }
    const std::string log = process_.log();
    const std::string mark = "REST at http://127.0.0.1:";
    port_ = std::atoi(log.c_str() + log.find(mark) + mark.size());
  }
  int port() const { return port_; }
  int id() const { return server_of(folder_.file("x.sqlite")); }
  static std::string head(const std::string& verb, const std::string& target,
                          const std::string& more = {}) {
    return verb + " " + target + " HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " +
           owner_token() + "\r\n" + more + "\r\n";
  }

 private:
  TemporaryFolder folder_;
  ServerProcess process_;
  int port_ = 0;
};

/// Requests one after another over one connection.
class Caller {
 public:
  explicit Caller(int port) : socket_(connect_to(port)) {}
  ~Caller() { close(socket_); }
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;

  /// Returns the body of an answer with the status 200. Throws std::runtime_error for others.
  std::string call(const std::string& request) {
    if (send(socket_, request.data(), request.size(), MSG_NOSIGNAL) < 0) {
      throw std::runtime_error("cannot send");
    }
    std::string all;
    std::size_t end = std::string::npos;
    std::size_t length = 0;
    while (end == std::string::npos || all.size() < end + length) {
      char part[65536];
      const ssize_t count = recv(socket_, part, sizeof part, 0);
      if (count <= 0) throw std::runtime_error("the server hung up: " + all);
      all.append(part, static_cast<std::size_t>(count));
      if (end != std::string::npos || all.find("\r\n\r\n") == std::string::npos) continue;
      end = all.find("\r\n\r\n") + 4;
      const std::size_t place = all.find("Content-Length: ");
      length = std::strtoul(all.c_str() + place + 16, nullptr, 10);
    }
    if (!all.starts_with("HTTP/1.1 200")) throw std::runtime_error(all);
    return all.substr(end);
  }

 private:
  const int socket_;
};

/// A reader of events that connects again from the last one that it has.
struct Reader {
  int socket = -1;
  std::string unread;
  std::int64_t position = 0;
  std::vector<std::int64_t> numbers;  // of changes of state
  int connects = 0;
};

/// All readers, on one thread.
class Readers {
 public:
  Readers(int port, std::string names, int count)
      : port_(port), names_(std::move(names)), epoll_(epoll_create1(0)), readers_(count) {
    for (Reader& each : readers_) open(each);
    thread_ = std::thread([this] { run(); });
  }
  ~Readers() { stop(); }
  Readers(const Readers&) = delete;
  Readers& operator=(const Readers&) = delete;

  /// From now on each reader connects again so many times, evenly over a time.
  void reconnect(int times, double seconds) {
    interval_ = seconds / (times * static_cast<double>(readers_.size()));
    begin_ = Clock::now();
    left_ = times * static_cast<long>(readers_.size());
  }
  long reconnects_left() const { return left_; }
  /// Smallest number of changes of state that any reader has.
  long least() const { return least_; }
  void stop() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
    for (Reader& each : readers_) {
      if (each.socket >= 0) close(each.socket);
      each.socket = -1;
    }
  }
  const std::vector<Reader>& all() const { return readers_; }

 private:
  void open(Reader& reader) {
    reader.unread.clear();
    reader.socket = connect_to(port_);
    ++reader.connects;
    const std::string request = Server::head(
        "GET", "/v1/simulations:watch" + names_,
        reader.position > 0 ? fmt::format("Last-Event-ID: {}\r\n", reader.position) : "");
    send(reader.socket, request.data(), request.size(), MSG_NOSIGNAL);
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = &reader;
    epoll_ctl(epoll_, EPOLL_CTL_ADD, reader.socket, &event);
  }
  void reopen(Reader& reader) {
    close(reader.socket);  // which also takes it out of epoll
    open(reader);
  }
  void read(Reader& reader) {
    char part[65536];
    const ssize_t count = recv(reader.socket, part, sizeof part, MSG_DONTWAIT);
    if (count < 0) return;
    if (count == 0) return reopen(reader);
    reader.unread.append(part, static_cast<std::size_t>(count));
    for (std::size_t end; (end = reader.unread.find("\n\n")) != std::string::npos;) {
      const std::string event = reader.unread.substr(0, end);
      reader.unread.erase(0, end + 2);
      const std::size_t id = event.find("id: ");
      if (id == std::string::npos) continue;
      reader.position = std::atoll(event.c_str() + id + 4);
      if (event.find("\"STATE_CHANGE\"") != std::string::npos) {
        reader.numbers.push_back(reader.position);
      }
    }
  }
  void run() {
    std::size_t next = 0;
    while (!is_stopping_) {
      epoll_event events[256];
      const int count = epoll_wait(epoll_, events, 256, 1);
      for (int i = 0; i < count; ++i) read(*static_cast<Reader*>(events[i].data.ptr));
      const std::chrono::duration<double> past = Clock::now() - begin_;
      while (left_ > 0 && interval_ * static_cast<double>(done_) < past.count()) {
        reopen(readers_[next++ % readers_.size()]);
        ++done_;
        --left_;
      }
      std::size_t least = readers_.front().numbers.size();
      for (const Reader& each : readers_) least = std::min(least, each.numbers.size());
      least_ = static_cast<long>(least);
    }
  }

  const int port_;
  const std::string names_;
  const int epoll_;
  std::vector<Reader> readers_;
  double interval_ = 0;
  Clock::time_point begin_;
  long done_ = 0;
  std::atomic<long> left_ = 0;
  std::atomic<long> least_ = 0;
  std::atomic<bool> is_stopping_ = false;
  std::thread thread_;
};

std::string post(const std::string& target, const std::string& body) {
  return Server::head(
             "POST", target,
             fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n", body.size())) +
         body;
}

/// Makes a simulation that runs for minutes, and `waiting` equal ones, which wait for its result
/// and take no thread. Returns the query that names all of them.
std::string make_simulations(int port, int waiting) {
  std::string body;
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  const v1::Simulation simulation = long_simulation();
  if (!google::protobuf::util::MessageToJsonString(simulation, &body, options).ok()) {
    throw std::runtime_error("cannot write a simulation as JSON");
  }
  Caller caller(port);
  std::string out = "?names=simulations/1";
  for (int i = 0; i <= waiting; ++i) {
    caller.call(post("/v1/simulations", body));
    if (i > 0) out += fmt::format("&names=simulations/{}", i + 1);
  }
  return out;
}

/// Cancels the simulations that wait, one after another: an event each.
class Writer {
 public:
  explicit Writer(int port) : caller_(port), thread_([this] { run(); }) {}
  ~Writer() { stop(); }
  void stop() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }
  int events() const { return events_; }

 private:
  void run() {
    for (auto due = Clock::now(); !is_stopping_;
         due += std::chrono::milliseconds(static_cast<int>(1000 / kEventsPerSecond))) {
      std::this_thread::sleep_until(due);
      caller_.call(post(fmt::format("/v1/simulations/{}:cancel", ++events_ + 1), "{}"));
    }
  }

  Caller caller_;
  std::atomic<int> events_ = 0;
  std::atomic<bool> is_stopping_ = false;
  std::thread thread_;
};

/// Gets one lubricant 200 times a second.
Latencies load(int port, double seconds) {
  constexpr int kConnections = 8;
  std::vector<Latencies> parts(kConnections);
  std::vector<std::thread> threads;
  for (int i = 0; i < kConnections; ++i) {
    threads.emplace_back([&, i] {
      Caller caller(port);
      const std::string request = Server::head("GET", "/v1/lubricants/paper-fluid-1");
      std::this_thread::sleep_for(std::chrono::duration<double>(i / kRequestsPerSecond));
      parts[static_cast<std::size_t>(i)] =
          open_loop(kRequestsPerSecond / kConnections, std::chrono::duration<double>(seconds),
                    [&](int, const std::function<void(bool)>& done) {
                      caller.call(request);
                      done(true);
                    });
    });
  }
  Latencies out;
  for (std::thread& each : threads) each.join();
  for (const Latencies& each : parts) {
    out.seconds.insert(out.seconds.end(), each.seconds.begin(), each.seconds.end());
  }
  std::sort(out.seconds.begin(), out.seconds.end());
  return out;
}

/// The changes of state that a reader from the beginning is sent, the last of them when no further
/// one comes for a second.
std::vector<std::int64_t> all_numbers(int port, const std::string& names) {
  Readers one(port, names, 1);
  for (long before = -1; before < one.least() || one.least() == 0;) {
    before = one.least();
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  one.stop();
  return one.all().front().numbers;
}

std::vector<Measurement> measure(int clients, double seconds) {
  const Server server;
  const int waiting = static_cast<int>(kEventsPerSecond * (4 * seconds + 60));
  const std::string names = make_simulations(server.port(), waiting);
  Writer writer(server.port());
  load(server.port(), 1);
  const Latencies alone = load(server.port(), seconds);
  Readers readers(server.port(), names, clients);
  // Each simulation became QUEUED; the last cancellation may be under way.
  const long past = waiting + 1 + writer.events() - 1;
  if (!eventually([&] { return readers.least() >= past; })) {
    throw std::runtime_error("the readers do not receive the past events");
  }
  const double processor = process_figures(server.id()).processor_seconds;
  const Latencies beside = load(server.port(), seconds);
  const double share = (process_figures(server.id()).processor_seconds - processor) / seconds;
  readers.reconnect(kReconnects, seconds);
  const Latencies reconnecting = load(server.port(), seconds);
  if (!eventually([&] { return readers.reconnects_left() == 0; })) {
    throw std::runtime_error("the readers do not connect again");
  }
  writer.stop();
  const double megabytes = process_figures(server.id()).resident_bytes / 1e6;
  const auto expected = all_numbers(server.port(), names);
  eventually([&] { return readers.least() >= static_cast<long>(expected.size()); });
  readers.stop();
  double wrong = 0;
  for (const Reader& each : readers.all()) wrong += each.numbers == expected ? 0 : 1;
  const double alone_ms = 1e3 * alone.percentile(0.99);
  const double beside_ms = 1e3 * beside.percentile(0.99);
  const std::string with = fmt::format("REST: {} readers of events", clients);
  return {{"REST: p99 of GetLubricant at 200 a second", alone_ms, "ms", {}},
          {with + ", p99 of GetLubricant at 200 a second", beside_ms, "ms", {}},
          {with + ", p99 over that without them", beside_ms / alone_ms, "", kMostSlower},
          {with + ", p99 while each connects again 20 times",
           1e3 * reconnecting.percentile(0.99),
           "ms",
           {}},
          {with + ", processors taken", share, "", {}},
          {with + ", memory of the server", megabytes, "MB", kMostMegabytes},
          {with + ", events", static_cast<double>(expected.size()), "", {}},
          {with + ", readers that miss or repeat an event", wrong, "", 0}};
}

}  // namespace
}  // namespace tribodyn::server

int main(int count, char** words) {
  using namespace tribodyn;
  const std::string results = count > 1 ? words[1] : "build/benchmark/results.json";
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
  try {
    const auto figures = server::measure(count > 2 ? std::atoi(words[2]) : 1000,
                                         count > 3 ? std::atof(words[3]) : 20);
    std::printf("%s\n", machine_name().c_str());
    print(figures);
    std::filesystem::create_directories(std::filesystem::absolute(results).parent_path());
    record(results, figures);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "rest_benchmark: %s\n", failure.what());
    return 1;
  }
  return 0;
}
