#pragma once

#include <google/protobuf/message.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>
#include <random>
#include <string>

namespace tribodyn::client {

/// Whether a request may be sent again when nobody knows what became of it: it reads, checks, or
/// comes to the same however often it is carried out (cancel, delete, and create with a
/// request_id).
bool may_repeat(const google::protobuf::Message& request);

/// Whether the answer says that the request had no effect and may succeed later: the server shuts
/// down, or too many wait.
bool was_turned_away(const grpc::Status& status);

/// How long the server asks to wait; nothing when it does not say.
std::optional<std::chrono::milliseconds> retry_delay(const grpc::Status& status);

/// Pauses between tries: doubling, and drawn at random (full jitter) so that clients that failed
/// together do not come back together; never shorter than what the server asks for. Not safe for
/// concurrent access.
class Backoff {
 public:
  Backoff();
  /// Before the next try.
  std::chrono::milliseconds next(std::optional<std::chrono::milliseconds> asked = {});
  /// After a success.
  void reset();

 private:
  std::mt19937_64 random_;
  std::chrono::milliseconds longest_;
};

/// A random name for a request (UUID version 4).
std::string new_request_id();

}  // namespace tribodyn::client
