#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/support/status.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tribodyn::server {

/// Sends any bytes to any method, also those without generated stubs.
class RawClient {
 public:
  explicit RawClient(std::shared_ptr<grpc::Channel> channel) : channel_(std::move(channel)) {}

  /// Makes a unary call. Returns the status and the answer as bytes.
  std::pair<grpc::Status, std::string> call(const std::string& method, const std::string& request);

  /// Makes a call that answers with a stream. Returns the status and all answers. Without a request
  /// the client ends its side of the call at once.
  std::pair<grpc::Status, std::vector<std::string>> read_all(
      const std::string& method, const std::optional<std::string>& request);

  /// A stream on which one request is sent and nothing is read. It is open while the object exists.
  struct Stream;
  std::shared_ptr<Stream> open(const std::string& method,
                               const std::optional<std::string>& request);

  /// Returns the answer of server reflection to "list services".
  std::string list_services();

 private:
  std::shared_ptr<grpc::Channel> channel_;
};

/// Connections to a local port on which nothing is sent. They are open while the object exists.
class SilentConnections {
 public:
  SilentConnections(int port, int count);
  ~SilentConnections();
  SilentConnections(const SilentConnections&) = delete;
  SilentConnections& operator=(const SilentConnections&) = delete;

 private:
  std::vector<int> descriptors_;
};

/// A call on its own connection whose request of `size` bytes lacks its last byte. Sends as much as
/// the server reads. The call is open while the object exists.
class HalfSentCall {
 public:
  HalfSentCall(int port, const std::string& method, std::size_t size);
  ~HalfSentCall();
  HalfSentCall(const HalfSentCall&) = delete;
  HalfSentCall& operator=(const HalfSentCall&) = delete;

 private:
  int descriptor_;
};

/// Calls on a connection of their own, of which only the headers are sent. The client acknowledges
/// none of the server's limits. The calls are open while the object exists.
class HeadersOfCalls {
 public:
  HeadersOfCalls(int port, const std::string& method, int count);
  ~HeadersOfCalls();
  HeadersOfCalls(const HeadersOfCalls&) = delete;
  HeadersOfCalls& operator=(const HeadersOfCalls&) = delete;

  /// Returns true if the server has closed the connection.
  bool is_closed() const;

 private:
  int descriptor_;
};

/// Connects to a local port, sends bytes that are not HTTP/2, and disconnects.
void send_raw_bytes(int port, const std::string& bytes);

}  // namespace tribodyn::server
