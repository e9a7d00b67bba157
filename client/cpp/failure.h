#pragma once

#include <stdexcept>
#include <string>

#include "tribodyn/client/error.h"

namespace tribodyn::client {

/// What the command line tells its caller.
enum ExitCode {
  kExitOk = 0,
  kExitFailed = 1,         ///< the server refused, or a simulation failed or was cancelled
  kExitUsage = 2,          ///< the command line or a file itself is wrong
  kExitCannotConnect = 3,  ///< no server at the address, or none that answers in time
  kExitDiffers = 4,        ///< of diff --exit-code: the fluids differ
  kExitInterrupted = 130,  ///< Ctrl-C; the simulation goes on
};

/// Ends a command. what() is the whole text for a person, possibly of several lines.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit_code, const std::string& text)
      : std::runtime_error(text), exit_code_(exit_code) {}
  /// Of a call that brought no answer: with what to do about it.
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
               "\n  Start one with `tribodynd`, or name another with --server or TRIBODYN_SERVER.";
      case ServiceError::Kind::kNoAnswer:
        return text + "\n  A longer wait: --timeout-seconds.";
      case ServiceError::Kind::kRefused:
        break;
    }
    return "the server refused: " + text;
  }

  ExitCode exit_code_;
};

}  // namespace tribodyn::client
