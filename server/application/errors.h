#pragma once

#include <map>
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

/// The service that the reasons belong to: ErrorInfo.domain.
inline constexpr char kErrorDomain[] = "tribodyn.dev";

/// The variables of an error's message by name: ErrorInfo.metadata (AIP-193).
using ErrorMetadata = std::map<std::string, std::string>;

/// "NOT_FOUND" of ERROR_REASON_NOT_FOUND.
std::string reason_text(v1::ErrorReason reason);

/// An error with ErrorInfo: domain, reason and metadata.
google::rpc::Status error(google::rpc::Code code, v1::ErrorReason reason,
                          const std::string& message, const ErrorMetadata& metadata = {});

/// INVALID_ARGUMENT for what the model refuses; the reason is the refusal's.
google::rpc::Status refused(const Refusal& refusal);

/// INVALID_ARGUMENT with every violation as BadRequest. Details travel in a header block that gRPC
/// clients limit to 8 KiB: what does not fit is counted in a last violation.
google::rpc::Status invalid(const Violations& violations);

/// An error whatever the fields hold, with the fields that it is about as BadRequest.
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

/// ABORTED with ResourceInfo: others changed it meanwhile; with RetryInfo where the same request
/// may succeed a moment later.
google::rpc::Status aborted(v1::ErrorReason reason, const std::string& type,
                            const std::string& name, const std::string& message, bool may_retry,
                            const ErrorMetadata& metadata = {});

/// aborted(): the client's etag is not the present one; others kept writing.
google::rpc::Status etag_mismatch(const std::string& type, const std::string& name,
                                  const std::string& etag);
google::rpc::Status contention(const std::string& type, const std::string& name);

/// What a client is told of a failure of the database: DEADLINE_EXCEEDED, CANCELLED, DATA_LOSS, or
/// UNAVAILABLE with RetryInfo. It names no file of the server.
google::rpc::Status store_failed(const StoreError& failure);

/// RESOURCE_EXHAUSTED with RetryInfo.
google::rpc::Status exhausted(v1::ErrorReason reason, const std::string& message,
                              double retry_seconds);

/// DEADLINE_EXCEEDED, by the server's own limit or the client's. Only before anything is committed.
google::rpc::Status deadline_exceeded();
/// CANCELLED: the client gave up. Only before anything is committed.
google::rpc::Status cancelled();
/// deadline_exceeded() or cancelled(), whichever limit is over.
google::rpc::Status call_over(const CallLimits& limits);
/// DEADLINE_EXCEEDED for a stream that was open for as long as it may be.
google::rpc::Status stream_deadline_exceeded();

/// UNAVAILABLE, SHUTTING_DOWN, with RetryInfo.
google::rpc::Status shutting_down();

/// INTERNAL: a defect of the server. Logs `cause` under an id; the client gets the id and no cause.
google::rpc::Status internal_error(std::string_view cause);

/// RESOURCE_EXHAUSTED, OUT_OF_MEMORY, with RetryInfo: an allocation failed. Logs it.
google::rpc::Status out_of_memory();

/// Serialised size of BadRequest that surely reaches a client.
inline constexpr std::size_t kMaximumBadRequestBytes = 5500;

}  // namespace tribodyn::server
