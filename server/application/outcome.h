#pragma once

#include <utility>
#include <variant>

#include "google/rpc/status.pb.h"

namespace tribodyn::server {

/// Result of a use case: a message, or an error with its details. The code of the error is never
/// OK.
template <class Message>
class Outcome {
 public:
  Outcome(Message message) : value_(std::move(message)) {}          // NOLINT: a message is one
  Outcome(google::rpc::Status error) : value_(std::move(error)) {}  // NOLINT: an error is one

  bool ok() const { return value_.index() == 0; }
  const Message& message() const { return std::get<0>(value_); }
  Message& message() { return std::get<0>(value_); }
  const google::rpc::Status& error() const { return std::get<1>(value_); }

 private:
  std::variant<Message, google::rpc::Status> value_;
};

}  // namespace tribodyn::server
