#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/crash/clients.h"
#include "tests/crash/history.h"
#include "tests/service/server_process.h"
#include "tests/service/support.h"

namespace tribodyn::crash {

/// A server that is killed again and again while clients use it.
class CrashRun {
 public:
  /// `command`: the server's program and the arguments before those of this class. `patience`: a
  /// simulation whose state does not change for this time counts as never ending.
  CrashRun(std::vector<std::string> command, std::chrono::milliseconds patience);

  /// Runs `clients` clients, kills the server `crashes` times, stops the clients, starts the server
  /// once more, reads all its data, and stops it. Reports a fatal failure of the running test if
  /// the server does not start, die or stop as expected.
  void play(int clients, int crashes);
  /// Computes every submitted scene on a tribodynd that is not killed.
  void compute_undisturbed();

  const History& history() { return recorder_.finished(); }
  std::string database() const { return folder_.file("tribodyn.db"); }

 private:
  std::string address() const { return "unix:" + folder_.file("socket"); }
  void start();
  void kill_server();
  void stop_server();
  void crash_under_load(int clients, int crashes);
  void read_everything();
  void wait_for_ends(client::Connection& connection) const;
  void wait_for_campaigns(client::Connection& connection) const;
  void read_campaigns(client::Connection& connection);

  const std::vector<std::string> command_;
  const std::chrono::milliseconds patience_;
  const std::uint64_t seed_;
  server::TemporaryFolder folder_;
  std::unique_ptr<server::ServerProcess> process_;
  Recorder recorder_;
};

}  // namespace tribodyn::crash
