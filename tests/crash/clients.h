#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/crash/history.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::crash {

/// Returns the inputs of a scene, whose name is a number: a point or a short curve. Scenes 2 k and
/// 2 k + 1 differ in a single input, so that the test detects a result key that leaves an input
/// out.
v1::Simulation simulation_of(const std::string& scene);

/// Returns the bytes of a simulation's history; empty if it has none. Throws client::ServiceError.
std::string history_bytes(client::Connection& connection, const v1::Simulation& simulation);

/// Watches a simulation until it ends or for `patience`. Returns the simulation and appends its
/// changes of state to `events` as they arrive. Throws client::ServiceError.
v1::Simulation follow(client::Connection& connection, const std::string& name,
                      std::chrono::milliseconds patience, std::vector<SeenEvent>& events);

/// Returns true if the server refuses the request itself. Returns false if the server is dead, slow
/// or busy, so that the same request may succeed later.
bool is_refusal(const client::ServiceError& error);

/// One client. At random it submits, submits again under the same request_id, watches, cancels,
/// reads, updates a lubricant and creates batches of lubricants, and records the answers.
class Client {
 public:
  Client(std::string address, int number, std::uint64_t seed, Recorder& recorder);

  /// Works until `stop`. Submits a few simulations, and one more for each of `crashes`.
  void run(const std::atomic<bool>& stop, const std::atomic<int>& crashes);

 private:
  struct Sent {
    std::string request_id;
    std::string scene;
    bool force = false;
    bool is_urgent = false;  ///< has a deadline that it may miss
    std::string name;        ///< empty until the server acknowledges it
  };

  int draw(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  std::string draw_scene();
  void act(bool may_submit);
  void submit(Sent& sent);
  void watch(const std::string& name);
  void update_lubricant();
  void create_batch();
  void note_end(const v1::Simulation& simulation);

  client::Connection connection_;
  const int number_;
  std::mt19937_64 random_;
  Recorder& recorder_;
  std::vector<Sent> sent_;
  int updates_ = 0;
  int batches_ = 0;
};

}  // namespace tribodyn::crash
