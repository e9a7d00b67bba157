#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/refusal.h"
#include "google/rpc/code.pb.h"
#include "google/rpc/status.pb.h"
#include "server/contract/violations.h"
#include "server/storage/call_limits.h"
#include "server/storage/store_error.h"
#include "tribodyn/v1/errors.pb.h"

namespace tribodyn::server {

/// ErrorInfo.domain of every error.
inline constexpr char kErrorDomain[] = "tribodyn.dev";

/// ErrorInfo.metadata: the variables in the message of an error, by name (AIP-193).
using ErrorMetadata = std::map<std::string, std::string>;

/// Returns "NOT_FOUND" for ERROR_REASON_NOT_FOUND.
std::string reason_text(v1::ErrorReason reason);
/// Returns the reason in the ErrorInfo of an error; UNSPECIFIED if it has none.
v1::ErrorReason reason_of(const google::rpc::Status& status);

// The functions below return errors. Each has an ErrorInfo with domain, reason and metadata.

google::rpc::Status error(google::rpc::Code code, v1::ErrorReason reason,
                          const std::string& message, const ErrorMetadata& metadata = {});

/// INVALID_ARGUMENT for inputs that the model refuses, with the reason of the refusal.
google::rpc::Status refused(const Refusal& refusal);

/// INVALID_ARGUMENT with every violation as BadRequest. gRPC clients limit the header block of the
/// details to 8 KiB: a last violation states the number of those that do not fit.
google::rpc::Status invalid(const Violations& violations);

/// Adds the fields that an error is about to `status` as BadRequest.
google::rpc::Status with_violations(google::rpc::Status status, const Violations& violations);

/// NOT_FOUND with ResourceInfo.
google::rpc::Status not_found(const std::string& type, const std::string& name,
                              const std::string& message,
                              v1::ErrorReason reason = v1::ERROR_REASON_NOT_FOUND);

/// ALREADY_EXISTS with ResourceInfo and, unless empty, BadRequest.
google::rpc::Status already_exists(v1::ErrorReason reason, const std::string& type,
                                   const std::string& name, const std::string& message,
                                   const ErrorMetadata& metadata = {},
                                   const Violations& violations = {});

/// FAILED_PRECONDITION with ResourceInfo.
google::rpc::Status not_possible(v1::ErrorReason reason, const std::string& type,
                                 const std::string& name, const std::string& message,
                                 const ErrorMetadata& metadata = {});

/// ABORTED with ResourceInfo: another writer changed the resource meanwhile. Has a RetryInfo if
/// `may_retry`: the same request may succeed a moment later.
google::rpc::Status aborted(v1::ErrorReason reason, const std::string& type,
                            const std::string& name, const std::string& message, bool may_retry,
                            const ErrorMetadata& metadata = {});

/// aborted(): the client's etag is not the present one; others kept writing.
google::rpc::Status etag_mismatch(const std::string& type, const std::string& name,
                                  const std::string& etag);
google::rpc::Status contention(const std::string& type, const std::string& name);

/// A failure of the database: DEADLINE_EXCEEDED, CANCELLED, DATA_LOSS, or UNAVAILABLE with
/// RetryInfo. Does not contain names of the server's files.
google::rpc::Status store_failed(const StoreError& failure);

/// RESOURCE_EXHAUSTED with RetryInfo.
google::rpc::Status exhausted(v1::ErrorReason reason, const std::string& message,
                              double retry_seconds);

/// RESOURCE_EXHAUSTED: `taker` ("anna", "project axles") has taken all that its quota allows.
/// `quota` is the setting without its dashes, e.g. "calls-per-second"; `limit` its value and unit.
/// With RetryInfo unless waiting alone does not help.
google::rpc::Status over_quota(const std::string& taker, const std::string& quota,
                               const std::string& limit, std::optional<double> retry_seconds);

/// DEADLINE_EXCEEDED: the client's deadline or the server's limit passed. Requires that nothing was
/// committed.
google::rpc::Status deadline_exceeded();
/// CANCELLED: the client cancelled the call. Requires that nothing was committed.
google::rpc::Status cancelled();
/// cancelled() if the client cancelled, else deadline_exceeded().
google::rpc::Status call_over(const CallLimits& limits);
/// DEADLINE_EXCEEDED, STREAM_TIME_LIMIT: the stream reached its longest duration.
google::rpc::Status stream_deadline_exceeded();

/// UNAUTHENTICATED: `what` is wrong with the credentials of the call. The message adds what to do.
google::rpc::Status unauthenticated(const std::string& what);
/// unauthenticated(): the token is not, or no longer, valid. The message does not say why.
google::rpc::Status token_refused();
/// PERMISSION_DENIED: the method needs a token of `scope`: "read", "write" or "admin".
google::rpc::Status scope_too_small(const std::string& scope);
/// PERMISSION_DENIED, whether or not the project exists.
google::rpc::Status project_not_granted(const std::string& project);

/// UNAVAILABLE, SHUTTING_DOWN, with RetryInfo.
google::rpc::Status shutting_down();

/// INTERNAL: a defect of the server. Logs `cause` with an id. The error contains only the id.
google::rpc::Status internal_error(std::string_view cause);

/// RESOURCE_EXHAUSTED, OUT_OF_MEMORY, with RetryInfo: an allocation failed. Logs the failure.
google::rpc::Status out_of_memory();

/// Largest serialised size of a BadRequest that fits the header block of every client [bytes].
inline constexpr std::size_t kMaximumBadRequestBytes = 5500;

}  // namespace tribodyn::server
