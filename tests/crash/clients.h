#pragma once

#include <atomic>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/crash/history.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::crash {

/// A scene by its name: points and short curves, some of them asked for again and again.
v1::Simulation simulation_of(const std::string& scene);

/// One client that submits, repeats itself, watches, cancels and reads, and records what it is
/// told.
class Client {
 public:
  Client(std::string address, int number, std::uint64_t seed, Recorder& recorder);

  /// Until `stop`; submits some simulations, and one more for each of `crashes`.
  void run(const std::atomic<bool>& stop, const std::atomic<int>& crashes);

 private:
  struct Sent {
    std::string request_id;
    std::string scene;
    bool force = false;
    std::string name;  ///< empty: not acknowledged
  };

  int draw(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  std::string draw_scene();
  void act(bool may_submit);
  void submit(Sent& sent);
  void watch(const std::string& name);
  void cancel(const std::string& name);
  void read(const std::string& name);
  void note_end(const v1::Simulation& simulation);

  client::Connection connection_;
  const int number_;
  std::mt19937_64 random_;
  Recorder& recorder_;
  std::vector<Sent> sent_;
};

}  // namespace tribodyn::crash
