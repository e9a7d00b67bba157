#include "server/application/errors.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "google/rpc/error_details.pb.h"
#include "server/application/log_text.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

constexpr std::string_view kReasonPrefix = "ERROR_REASON_";

google::rpc::BadRequest bad_request(const Violations& violations) {
  google::rpc::BadRequest out;
  std::size_t bytes = 0;
  std::size_t shown = 0;
  for (const Violation& violation : violations) {
    bytes += violation.field.size() + violation.description.size() + 12;
    if (bytes > kMaximumBadRequestBytes) break;
    ++shown;
    auto* added = out.add_field_violations();
    added->set_field(violation.field);
    added->set_description(violation.description);
  }
  if (shown < violations.size()) {
    auto* rest = out.add_field_violations();
    rest->set_field("*");
    rest->set_description(fmt::format("{} more violations", violations.size() - shown));
  }
  return out;
}

/// Adds a RetryInfo. Its delay is `seconds`, rounded up to a millisecond.
google::rpc::Status with_retry(google::rpc::Status status, double seconds) {
  google::rpc::RetryInfo info;
  *info.mutable_retry_delay() = google::protobuf::util::TimeUtil::MillisecondsToDuration(
      static_cast<std::int64_t>(std::ceil(1e3 * seconds)));
  status.add_details()->PackFrom(info);
  return status;
}

// Retry delays [s]
constexpr int kRestartSeconds = 5;  // of a server that is shutting down
constexpr int kStoreSeconds = 5;
constexpr int kContentionSeconds = 1;
constexpr int kMemorySeconds = 5;
constexpr std::size_t kLongestCause = 500;  // [bytes], in the log

google::rpc::Status make_error(google::rpc::Code code, const std::string& reason,
                               const std::string& message, const ErrorMetadata& metadata) {
  google::rpc::Status status;
  status.set_code(code);
  status.set_message(message);
  google::rpc::ErrorInfo info;
  info.set_domain(kErrorDomain);
  info.set_reason(reason);
  for (const auto& [key, value] : metadata) (*info.mutable_metadata())[key] = value;
  status.add_details()->PackFrom(info);
  return status;
}

/// Returns an error with ResourceInfo, whose metadata name the resource too.
google::rpc::Status resource_error(google::rpc::Code code, v1::ErrorReason reason,
                                   const std::string& type, const std::string& name,
                                   const std::string& message, ErrorMetadata metadata = {}) {
  metadata.emplace("name", name);
  google::rpc::Status status = error(code, reason, message, metadata);
  google::rpc::ResourceInfo info;
  info.set_resource_type(type);
  info.set_resource_name(name);
  status.add_details()->PackFrom(info);
  return status;
}

}  // namespace

std::string reason_text(v1::ErrorReason reason) {
  return v1::ErrorReason_Name(reason).substr(kReasonPrefix.size());
}

v1::ErrorReason reason_of(const google::rpc::Status& status) {
  google::rpc::ErrorInfo info;
  for (const auto& detail : status.details()) {
    if (detail.UnpackTo(&info)) break;
  }
  v1::ErrorReason out = v1::ERROR_REASON_UNSPECIFIED;
  v1::ErrorReason_Parse(std::string(kReasonPrefix) + info.reason(), &out);
  return out;
}

google::rpc::Status error(google::rpc::Code code, v1::ErrorReason reason,
                          const std::string& message, const ErrorMetadata& metadata) {
  return make_error(code, reason_text(reason), message, metadata);
}

google::rpc::Status refused(const Refusal& refusal) {
  return make_error(google::rpc::INVALID_ARGUMENT, refusal.reason(), refusal.what(), {});
}

google::rpc::Status invalid(const Violations& violations) {
  const Violation& first = violations.front();
  std::string message = first.field.empty() ? first.description
                                            : fmt::format("{}: {}", first.field, first.description);
  if (violations.size() > 1) message += fmt::format(" (and {} more)", violations.size() - 1);
  return with_violations(
      error(google::rpc::INVALID_ARGUMENT, v1::ERROR_REASON_INVALID_FIELDS, message,
            {{"field", first.field}, {"violations", std::to_string(violations.size())}}),
      violations);
}

google::rpc::Status with_violations(google::rpc::Status status, const Violations& violations) {
  status.add_details()->PackFrom(bad_request(violations));
  return status;
}

google::rpc::Status not_found(const std::string& type, const std::string& name,
                              const std::string& message, v1::ErrorReason reason) {
  return resource_error(google::rpc::NOT_FOUND, reason, type, name, message);
}

google::rpc::Status already_exists(v1::ErrorReason reason, const std::string& type,
                                   const std::string& name, const std::string& message,
                                   const ErrorMetadata& metadata, const Violations& violations) {
  const google::rpc::Status status =
      resource_error(google::rpc::ALREADY_EXISTS, reason, type, name, message, metadata);
  return violations.empty() ? status : with_violations(status, violations);
}

google::rpc::Status not_possible(v1::ErrorReason reason, const std::string& type,
                                 const std::string& name, const std::string& message,
                                 const ErrorMetadata& metadata) {
  return resource_error(google::rpc::FAILED_PRECONDITION, reason, type, name, message, metadata);
}

google::rpc::Status aborted(v1::ErrorReason reason, const std::string& type,
                            const std::string& name, const std::string& message, bool may_retry,
                            const ErrorMetadata& metadata) {
  const google::rpc::Status status =
      resource_error(google::rpc::ABORTED, reason, type, name, message, metadata);
  return may_retry ? with_retry(status, kContentionSeconds) : status;
}

google::rpc::Status etag_mismatch(const std::string& type, const std::string& name,
                                  const std::string& etag) {
  return aborted(v1::ERROR_REASON_ETAG_MISMATCH, type, name,
                 name + " has changed since this etag was given out; get it again", false,
                 {{"etag", plain_excerpt(etag)}});
}

google::rpc::Status contention(const std::string& type, const std::string& name) {
  return aborted(v1::ERROR_REASON_CONTENTION, type, name,
                 name + " keeps being changed by others; try again", true);
}

google::rpc::Status store_failed(const StoreError& failure) {
  if (failure.kind() == StoreError::Kind::kDeadline) return deadline_exceeded();
  if (failure.kind() == StoreError::Kind::kCancelled) return cancelled();
  if (failure.kind() == StoreError::Kind::kDataLoss ||
      failure.kind() == StoreError::Kind::kCorrupt) {
    return error(google::rpc::DATA_LOSS, v1::ERROR_REASON_STORED_DATA_DAMAGED,
                 "what the database holds is not what was written: `tribodynd check` names the "
                 "damage; a forced run computes a result again, and a backup restores the rest");
  }
  const bool is_misplaced = failure.kind() == StoreError::Kind::kMisplaced;
  return with_retry(is_misplaced
                        ? error(google::rpc::UNAVAILABLE, v1::ERROR_REASON_DATABASE_MISPLACED,
                                "the database's file was deleted, renamed or replaced on the "
                                "server; nothing is written until it is back")
                        : error(google::rpc::UNAVAILABLE, v1::ERROR_REASON_STORE_FAILED,
                                failure.kind() == StoreError::Kind::kFull
                                    ? "the disk of the database is full"
                                    : "the database could not be read or written"),
                    kStoreSeconds);
}

google::rpc::Status exhausted(v1::ErrorReason reason, const std::string& message,
                              double retry_seconds) {
  return with_retry(error(google::rpc::RESOURCE_EXHAUSTED, reason, message,
                          {{"retry_seconds", fmt::format("{:.3g}", retry_seconds)}}),
                    retry_seconds);
}

google::rpc::Status over_quota(const std::string& taker, const std::string& quota,
                               const std::string& limit, std::optional<double> retry_seconds) {
  std::string message = fmt::format("the quota of {} is {}", taker, limit);
  ErrorMetadata metadata{{"quota", quota}, {"limit", limit}};
  if (retry_seconds) {
    metadata["retry_seconds"] = fmt::format("{:.3g}", *retry_seconds);
    message += "; try again in " + metadata["retry_seconds"] + " s";
  }
  auto out =
      error(google::rpc::RESOURCE_EXHAUSTED, v1::ERROR_REASON_QUOTA_EXCEEDED, message, metadata);
  return retry_seconds ? with_retry(std::move(out), *retry_seconds) : out;
}

google::rpc::Status deadline_exceeded() {
  return error(google::rpc::DEADLINE_EXCEEDED, v1::ERROR_REASON_DEADLINE_EXCEEDED,
               "the deadline passed before the request was applied; nothing has changed");
}

google::rpc::Status cancelled() {
  return error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED,
               "the client cancelled before the request was applied; nothing has changed");
}

google::rpc::Status call_over(const CallLimits& limits) {
  return limits.is_cancelled() ? cancelled() : deadline_exceeded();
}

google::rpc::Status stream_deadline_exceeded() {
  return error(google::rpc::DEADLINE_EXCEEDED, v1::ERROR_REASON_STREAM_TIME_LIMIT,
               "the stream has been open for as long as it may be; call again to continue");
}

google::rpc::Status unauthenticated(const std::string& what) {
  return error(google::rpc::UNAUTHENTICATED, v1::ERROR_REASON_UNAUTHENTICATED,
               what +
                   "; name the file of a token in TRIBODYN_TOKEN_FILE or with --token-file (the "
                   "server keeps the owner's beside its database, as DATABASE.token), or send it "
                   "as \"authorization: Bearer TOKEN\"");
}

google::rpc::Status token_refused() {
  return unauthenticated("the token is unknown, has expired or was revoked");
}

google::rpc::Status scope_too_small(const std::string& scope) {
  return error(google::rpc::PERMISSION_DENIED, v1::ERROR_REASON_SCOPE_TOO_SMALL,
               "the token does not allow this; the method needs one of scope " + scope,
               {{"scope", scope}});
}

google::rpc::Status project_not_granted(const std::string& project) {
  return error(google::rpc::PERMISSION_DENIED, v1::ERROR_REASON_PROJECT_NOT_GRANTED,
               "the token is not for the project " + project, {{"project", project}});
}

google::rpc::Status shutting_down() {
  return with_retry(error(google::rpc::UNAVAILABLE, v1::ERROR_REASON_SHUTTING_DOWN,
                          "the server is shutting down"),
                    kRestartSeconds);
}

google::rpc::Status internal_error(std::string_view cause) {
  std::random_device random;
  const std::string id = fmt::format("{:016x}", (std::uint64_t{random()} << 32) | random());
  spdlog::error("event=internal_error id={} cause=\"{}\"", id, log_text(cause, kLongestCause));
  return error(google::rpc::INTERNAL, v1::ERROR_REASON_INTERNAL,
               fmt::format("internal error {}; the server's log states its cause", id),
               {{"id", id}});
}

google::rpc::Status out_of_memory() {
  spdlog::error("event=out_of_memory");
  return with_retry(error(google::rpc::RESOURCE_EXHAUSTED, v1::ERROR_REASON_OUT_OF_MEMORY,
                          "the server has no memory left for this request"),
                    kMemorySeconds);
}

}  // namespace tribodyn::server
