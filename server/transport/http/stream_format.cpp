#include "server/transport/http/stream_format.h"

#include <cstdint>
#include <string_view>
#include <utility>

#include "google/rpc/code.pb.h"
#include "server/transport/http/rest_answer.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Time after which a browser connects again [ms].
constexpr char kRetry[] = "retry: 2000\n\n";

class EventStreamFormat final : public StreamFormat {
 public:
  EventStreamFormat(std::optional<ResumeFields> fields, std::shared_ptr<EventTexts> texts)
      : fields_(fields), texts_(std::move(texts)) {}

  std::map<std::string, std::string> headers() const override {
    return {{"Content-Type", "text/event-stream; charset=utf-8"},
            {"Cache-Control", "no-store"},
            {"X-Accel-Buffering", "no"}};  // nginx passes each event on
  }

  std::string part(const Message& message) override {
    std::string out = take_beginning();
    const std::int64_t position =
        fields_ ? message.GetReflection()->GetInt64(message, fields_->message) : 0;
    if (position > 0) out += "id: " + std::to_string(position) + "\n";
    if (is_heartbeat(message)) return out + ": heartbeat\n\n";
    return out + "data: " + texts_->of(message) + "\n\n";
  }

  std::optional<std::string> end(const google::rpc::Status& status) override {
    std::string out = take_beginning();
    if (status.code() == google::rpc::OK) return out + "event: end\ndata: {}\n\n";
    return out + "event: failure\ndata: " + error_response(status).body + "\n\n";
  }

 private:
  static bool is_heartbeat(const Message& message) {
    const FieldDescriptor* kind = message.GetDescriptor()->FindFieldByName("kind");
    return kind != nullptr && kind->enum_type() != nullptr &&
           message.GetReflection()->GetEnum(message, kind)->name() == "HEARTBEAT";
  }
  std::string take_beginning() {
    if (has_begun_) return {};
    has_begun_ = true;
    return kRetry;
  }

  const std::optional<ResumeFields> fields_;
  const std::shared_ptr<EventTexts> texts_;
  bool has_begun_ = false;
};

class JsonLinesFormat final : public StreamFormat {
 public:
  std::map<std::string, std::string> headers() const override {
    return {{"Content-Type", "application/x-ndjson"}, {"Cache-Control", "no-store"}};
  }
  std::string part(const Message& message) override {
    return "{\"result\":" + json_of(message, true) + "}\n";
  }
  std::optional<std::string> end(const google::rpc::Status& status) override {
    return status.code() == google::rpc::OK ? "" : error_response(status).body + "\n";
  }
};

}  // namespace

std::optional<ResumeFields> resume_fields(const google::protobuf::MethodDescriptor& method) {
  constexpr std::string_view kPrefix = "after_";
  const google::protobuf::Descriptor& request = *method.input_type();
  for (int i = 0; i < request.field_count(); ++i) {
    const FieldDescriptor& field = *request.field(i);
    if (!std::string_view(field.name()).starts_with(kPrefix)) continue;
    const FieldDescriptor* position =
        method.output_type()->FindFieldByName(field.name().substr(kPrefix.size()));
    if (position == nullptr || position->cpp_type() != FieldDescriptor::CPPTYPE_INT64) continue;
    return ResumeFields{&field, position};
  }
  return std::nullopt;
}

std::string EventTexts::of(const Message& message) {
  std::string key = message.GetDescriptor()->full_name() + '\0';
  message.AppendToString(&key);
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = texts_.find(key); found != texts_.end()) return found->second;
  }
  std::string out = json_of(message, true);
  const std::lock_guard lock(mutex_);
  if (texts_.size() == kMost) texts_.clear();
  texts_.emplace(std::move(key), out);
  return out;
}

std::unique_ptr<StreamFormat> event_stream_format(const google::protobuf::MethodDescriptor& method,
                                                  std::shared_ptr<EventTexts> texts) {
  return std::make_unique<EventStreamFormat>(resume_fields(method), std::move(texts));
}

std::unique_ptr<StreamFormat> json_lines_format() { return std::make_unique<JsonLinesFormat>(); }

}  // namespace tribodyn::server
