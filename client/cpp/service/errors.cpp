#include "client/cpp/service/errors.h"

#include <algorithm>
#include <array>
#include <optional>

#include "client/cpp/text/text.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace tribodyn::client {
namespace {

template <class Detail>
std::optional<Detail> find_detail(const google::rpc::Status& status) {
  for (const google::protobuf::Any& any : status.details()) {
    Detail detail;
    if (any.Is<Detail>() && any.UnpackTo(&detail)) return detail;
  }
  return std::nullopt;
}

google::rpc::Status details_of(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) details.Clear();
  return details;
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

/// The server's sentences mostly begin with the field's own name, which is that of a flag; the path
/// in front of it would only hide it.
std::string violation_text(const google::rpc::BadRequest::FieldViolation& violation) {
  const std::string& path = violation.field();
  const std::string leaf = path.substr(path.rfind('.') + 1);
  if (violation.description().rfind(leaf + " ", 0) == 0) return printable(violation.description());
  return printable(path) + ": " + printable(violation.description());
}

}  // namespace

std::string flag_of_field(const std::string& field_path) {
  std::string flag = field_path.substr(field_path.rfind('.') + 1);
  flag = flag.substr(0, flag.find('['));
  std::replace(flag.begin(), flag.end(), '_', '-');
  return "--" + flag;
}

std::string readable_error(const grpc::Status& status) {
  const google::rpc::Status details = details_of(status);
  const auto info = find_detail<google::rpc::ErrorInfo>(details);
  const auto bad_request = find_detail<google::rpc::BadRequest>(details);
  const auto retry = find_detail<google::rpc::RetryInfo>(details);

  const int violations = bad_request ? bad_request->field_violations_size() : 0;
  std::string text = printable(status.error_message());
  // The server's message repeats the first violation, which follows anyway.
  if (violations > 0) {
    text = std::to_string(violations) + (violations == 1 ? " illegal field" : " illegal fields");
  } else if (text.empty()) {
    text = "no message";
  }
  text += " [" + (info ? printable(info->reason()) : code_name(status.error_code())) + "]";
  if (bad_request) {
    for (const auto& violation : bad_request->field_violations()) {
      text += "\n  " + violation_text(violation);
    }
  }
  if (retry) {
    const double seconds =
        static_cast<double>(retry->retry_delay().seconds()) + 1e-9 * retry->retry_delay().nanos();
    text += "\n  try again in " + duration_text(seconds);
  }
  return text;
}

Failure to_failure(const grpc::Status& status, const std::string& address) {
  const bool answered = !status.error_details().empty();
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE && !answered) {
    return Failure(kExitCannotConnect,
                   "cannot connect to the server at " + address + " (" +
                       printable(status.error_message()) +
                       ")\n  Start one with `tribodynd`, or name another with --server or "
                       "TRIBODYN_SERVER.");
  }
  if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED && !answered) {
    return Failure(kExitCannotConnect, "no answer in time from the server at " + address +
                                           "\n  A longer wait: --timeout-seconds.");
  }
  return Failure(kExitFailed, "the server refused: " + readable_error(status));
}

}  // namespace tribodyn::client
