#pragma once

#include <grpcpp/channel.h>
#include <sys/types.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace tribodyn::server {

/// A tribodynd of its own, killed when the object goes.
class ServerProcess {
 public:
  /// Starts `program` with these arguments and appends its output to the file `log`. With
  /// `maximum_files` the server may open no more files than that.
  ServerProcess(const std::vector<std::string>& arguments, std::string log, int maximum_files = 0,
                const std::string& program = server_program());
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  void signal(int number) const;
  /// Exit code, or 128 + signal, once it has ended; -1 after the time limit.
  int wait(std::chrono::seconds limit = std::chrono::seconds(20));
  bool running();
  std::string log() const;
  /// Most memory that it has held so far, in KiB.
  long peak_memory_kibibytes() const;

 private:
  pid_t pid_ = -1;
  int exit_code_ = -1;
  std::string log_;
};

/// The first line of a file once it is there; empty when the process ends first.
std::string wait_for_address(const std::string& port_file, ServerProcess& process);

std::shared_ptr<grpc::Channel> connect(const std::string& address);

}  // namespace tribodyn::server
