#include "client/cpp/library/status.h"

#include <array>
#include <cctype>
#include <optional>
#include <vector>

#include "client/cpp/text/text.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace tribodyn::client {
namespace {

using Kind = ServiceError::Kind;

template <class Detail>
std::optional<Detail> find_detail(const google::rpc::Status& status) {
  for (const google::protobuf::Any& any : status.details()) {
    Detail detail;
    if (any.Is<Detail>() && any.UnpackTo(&detail)) return detail;
  }
  return std::nullopt;
}

std::string code_name(grpc::StatusCode code) {
  static constexpr std::array<const char*, 17> kNames = {"OK",
                                                         "CANCELLED",
                                                         "UNKNOWN",
                                                         "INVALID_ARGUMENT",
                                                         "DEADLINE_EXCEEDED",
                                                         "NOT_FOUND",
                                                         "ALREADY_EXISTS",
                                                         "PERMISSION_DENIED",
                                                         "RESOURCE_EXHAUSTED",
                                                         "FAILED_PRECONDITION",
                                                         "ABORTED",
                                                         "OUT_OF_RANGE",
                                                         "UNIMPLEMENTED",
                                                         "INTERNAL",
                                                         "UNAVAILABLE",
                                                         "DATA_LOSS",
                                                         "UNAUTHENTICATED"};
  const auto index = static_cast<std::size_t>(code);
  return index < kNames.size() ? kNames[index] : "code " + std::to_string(index);
}

/// Returns the text of a violation. The server's sentence mostly starts with the field's own name;
/// the path is put in front of it only where it selects one of several elements.
std::string violation_text(const FieldViolation& violation) {
  const std::string leaf = violation.field.substr(violation.field.rfind('.') + 1);
  const bool is_one_of_several = violation.field.find('[') != std::string::npos;
  if (!is_one_of_several && violation.description.rfind(leaf + " ", 0) == 0) {
    return violation.description;
  }
  return violation.field + ": " + violation.description;
}

ServiceError refusal(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) details.Clear();
  const auto info = find_detail<google::rpc::ErrorInfo>(details);
  const auto bad_request = find_detail<google::rpc::BadRequest>(details);
  const auto retry = find_detail<google::rpc::RetryInfo>(details);
  const auto resource = find_detail<google::rpc::ResourceInfo>(details);

  std::vector<FieldViolation> violations;
  if (bad_request) {
    for (const auto& violation : bad_request->field_violations()) {
      violations.push_back({printable(violation.field()), printable(violation.description())});
    }
  }
  std::string text = printable(status.error_message());
  // The server's message repeats the first violation, which is listed below.
  if (!violations.empty()) {
    text = std::to_string(violations.size()) +
           (violations.size() == 1 ? " invalid value" : " invalid values");
  } else if (text.empty()) {
    text = "the server sent no message";
  }
  const std::string reason = info ? printable(info->reason()) : "";
  text += " [" + (reason.empty() ? code_name(status.error_code()) : reason) + "]";
  for (const FieldViolation& violation : violations) text += "\n  " + violation_text(violation);
  std::optional<double> delay;
  if (retry) {
    delay =
        static_cast<double>(retry->retry_delay().seconds()) + 1e-9 * retry->retry_delay().nanos();
    text += "\n  try again in " + duration_text(*delay);
  }
  return {text,   static_cast<int>(status.error_code()),
          reason, violations,
          delay,  resource ? printable(resource->resource_name()) : ""};
}

/// Returns only the cause, e.g. "connection refused" for "failed to connect to all addresses; last
/// error: UNKNOWN: ipv4:...: Failed to connect to remote host: Connection refused".
std::string connection_reason(const std::string& message) {
  const std::size_t mark = message.rfind(": ");
  std::string reason = printable(mark == std::string::npos ? message : message.substr(mark + 2));
  if (reason.empty()) return "no connection";
  reason[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(reason[0])));
  return reason;
}

}  // namespace

ServiceError service_error(const grpc::Status& status, const std::string& address) {
  const bool answered = !status.error_details().empty();
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE && !answered) {
    return {Kind::kCannotConnect, "cannot connect to the server at " + address + ": " +
                                      connection_reason(status.error_message())};
  }
  if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED && !answered) {
    return {Kind::kNoAnswer, "no answer in time from the server at " + address};
  }
  return refusal(status);
}

bool never_connected(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNAVAILABLE &&
         status.error_message().rfind("failed to connect to all addresses", 0) == 0;
}

}  // namespace tribodyn::client
