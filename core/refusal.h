#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace tribodyn {

/// Why a calculation has no answer. Thrown by set-up and study functions (never by the right-hand
/// side or the contact kernel, which return a status); `reason` is a stable UPPER_SNAKE_CASE name
/// that reaches the client as ErrorInfo.reason, what() is the sentence for a person.
class Refusal : public std::runtime_error {
 public:
  Refusal(std::string reason, const std::string& sentence)
      : std::runtime_error(sentence), reason_(std::move(reason)) {}
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// Thrown out of a study when its caller asked to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace tribodyn
