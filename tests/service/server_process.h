#pragma once

#include <grpcpp/channel.h>
#include <sys/types.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace tribodyn::server {

/// A tribodynd process. The destructor kills it.
class ServerProcess {
 public:
  /// Starts `program` with these arguments and appends its output to the file `log`. With
  /// `maximum_files` the server cannot open more files than that.
  ServerProcess(const std::vector<std::string>& arguments, std::string log, int maximum_files = 0,
                const std::string& program = server_program());
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  void signal(int number) const;
  /// Waits for the end of the process. Returns its exit code, or 128 + signal; -1 after the time
  /// limit.
  int wait(std::chrono::seconds limit = std::chrono::seconds(20));
  bool running();
  std::string log() const;
  /// Returns the value of a flag that the process was started with, or "".
  std::string flag(const std::string& name) const;
  /// Returns the peak memory of the process in KiB.
  long peak_memory_kibibytes() const;

 private:
  pid_t pid_ = -1;
  int exit_code_ = -1;
  std::string log_;
  std::vector<std::string> arguments_;
};

/// Waits for a file and returns its first line; empty if the process ends first. From then on
/// connect() and the client library use the owner's token of this process.
std::string wait_for_address(const std::string& port_file, ServerProcess& process);

/// Returns the first line of the file that TRIBODYN_TOKEN_FILE names; empty if there is none.
std::string owner_token();

/// Connects with the token of the owner of the server that listens there, or with another one.
/// Channels share connections to an address unless they are to have their own.
std::shared_ptr<grpc::Channel> connect(const std::string& address,
                                       bool with_own_connection = false);
std::shared_ptr<grpc::Channel> connect_with(const std::string& address, const std::string& token,
                                            bool with_own_connection = false);

}  // namespace tribodyn::server
