#pragma once

#include <stdexcept>
#include <string>

namespace tribodyn::client {

/// What the command line tells its caller.
enum ExitCode {
  kExitOk = 0,
  kExitFailed = 1,         ///< the server refused, or a simulation failed or was cancelled
  kExitUsage = 2,          ///< the command line itself is wrong
  kExitCannotConnect = 3,  ///< no server at the address
  kExitInterrupted = 130,  ///< Ctrl-C; the simulation goes on
};

/// Ends a command. what() is the whole text for a person, possibly of several lines.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& text)
      : std::runtime_error(text), exit_code_(exit_code) {}
  ExitCode exit_code() const { return exit_code_; }

 private:
  ExitCode exit_code_;
};

}  // namespace tribodyn::client
