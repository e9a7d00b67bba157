#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "google/rpc/status.pb.h"
#include "server/application/message_source.h"

namespace tribodyn::server {

/// The form in which the messages of a stream become the body of a response.
class StreamFormat {
 public:
  virtual ~StreamFormat() = default;
  /// Returns the order in which the form takes columns.
  virtual AnyMessageSource::Order order() const { return AnyMessageSource::Order::kChunks; }
  /// Returns the headers that the form needs.
  virtual std::map<std::string, std::string> headers() const = 0;
  /// Returns the text of the next message; "" if it waits for further ones.
  virtual std::string part(const google::protobuf::Message& message) = 0;
  /// Returns true if length() is not nullopt after the first message.
  virtual bool has_length() const { return false; }
  /// Returns the length of all texts of the stream [bytes]; nullopt if only its end reveals it.
  virtual std::optional<std::uint64_t> length() const { return std::nullopt; }
  /// Returns the text of the end of the stream, or nullopt if the form cannot express such an end:
  /// the response is then broken off.
  virtual std::optional<std::string> end(const google::rpc::Status& status) = 0;
};

/// A position that clients resume a stream after: the field "after_x" of the request stands for the
/// field "x" of a message.
struct ResumeFields {
  const google::protobuf::FieldDescriptor* request = nullptr;
  const google::protobuf::FieldDescriptor* message = nullptr;
};
/// Returns the fields of a method, or nullopt if its streams cannot be resumed so.
std::optional<ResumeFields> resume_fields(const google::protobuf::MethodDescriptor& method);

/// The texts of the latest messages of event streams: streams that send the same events share them.
/// Safe for concurrent access.
class EventTexts {
 public:
  /// Returns a message as JSON.
  std::string of(const google::protobuf::Message& message);

 private:
  static constexpr std::size_t kMost = 500;  // some 800 bytes each with the key

  std::mutex mutex_;
  std::unordered_map<std::string, std::string> texts_;  // guarded by mutex_; by type and bytes
};

/// Server-sent events: a message each, as JSON; its position is the event's id. A heartbeat is a
/// comment with an id. An event "end" follows the last message, an event "failure" with the error
/// one that is missing.
std::unique_ptr<StreamFormat> event_stream_format(const google::protobuf::MethodDescriptor& method,
                                                  std::shared_ptr<EventTexts> texts);

/// JSON, a line each: {"result": message}, and after the last one {"error": ...} if any is missing.
std::unique_ptr<StreamFormat> json_lines_format();

}  // namespace tribodyn::server
