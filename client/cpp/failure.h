#pragma once

#include <stdexcept>
#include <string>

#include "tribodyn/client/error.h"

namespace tribodyn::client {

/// Exit codes of the command line.
enum ExitCode {
  kExitOk = 0,
  kExitFailed = 1,  ///< the server rejected the request, or a simulation failed or was cancelled
  kExitUsage = 2,   ///< an error in the command line or in a file
  kExitCannotConnect = 3,  ///< no server at the address, or no answer in time
  kExitDiffers = 4,        ///< diff --exit-code: the fluids differ
  kExitInterrupted = 130,  ///< Ctrl-C; the simulation goes on
};

/// Ends a command. what() is the whole text for the user, possibly of several lines.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& text)
      : std::runtime_error(text), exit_code_(exit_code) {}
  /// Constructs the failure of a call, with advice to the user.
  explicit Failure(const ServiceError& error) : Failure(exit_code_of(error), text_of(error)) {}
  ExitCode exit_code() const { return exit_code_; }

 private:
  static ExitCode exit_code_of(const ServiceError& error) {
    return error.kind() == ServiceError::Kind::kRefused ? kExitFailed : kExitCannotConnect;
  }
  static std::string text_of(const ServiceError& error) {
    const std::string text = error.what();
    switch (error.kind()) {
      case ServiceError::Kind::kCannotConnect:
        return text +
               "\n  Start it with `tribodynd`, or name another server with --server or "
               "TRIBODYN_SERVER.";
      case ServiceError::Kind::kNoAnswer:
        return text + "\n  Use --timeout-seconds to wait longer.";
      case ServiceError::Kind::kRefused:
        break;
    }
    return "the server rejected the request: " + text;
  }

  ExitCode exit_code_;
};

}  // namespace tribodyn::client
