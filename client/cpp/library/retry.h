#pragma once

#include <google/protobuf/message.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>
#include <random>
#include <string>

namespace tribodyn::client {

/// Whether a request may be sent again when the fate of the first try is unknown: it reads, checks,
/// or has the same effect however often it is carried out (pause, resume, cancel, delete, and
/// create with a request_id). A second undelete is refused.
bool may_repeat(const google::protobuf::Message& request);

/// Returns the pause that the server requests before the next try; nullopt if it requests none.
std::optional<std::chrono::milliseconds> retry_delay(const grpc::Status& status);

/// Whether the status guarantees that the request had no effect and may succeed later: the server
/// requests a pause, for any reason but a failure amid the work.
bool was_turned_away(const grpc::Status& status);

/// Whether the status says that a quota of the caller is spent.
bool is_over_quota(const grpc::Status& status);

/// Pauses between tries. They double and are random (full jitter), so that clients that failed
/// together do not all retry together, and are never shorter than the server requests. Not safe for
/// concurrent access.
class Backoff {
 public:
  Backoff();
  /// Returns the pause before the next try. `requested` is the pause that the server requests.
  std::chrono::milliseconds next(std::optional<std::chrono::milliseconds> requested = {});
  /// Starts again with short pauses, after a success.
  void reset();

 private:
  std::mt19937_64 random_;
  std::chrono::milliseconds longest_;
};

/// Returns a random id for a request (UUID version 4).
std::string new_request_id();

}  // namespace tribodyn::client
