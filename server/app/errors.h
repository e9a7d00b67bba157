#pragma once

#include <string>

#include "google/rpc/code.pb.h"
#include "google/rpc/status.pb.h"
#include "server/convert/violations.h"

namespace tribodyn::server {

inline constexpr char kErrorDomain[] = "tribodyn";

/// An error with ErrorInfo (domain "tribodyn" and the reason, UPPER_SNAKE_CASE).
google::rpc::Status error(google::rpc::Code code, const std::string& reason,
                          const std::string& message);

/// INVALID_ARGUMENT with every violation as BadRequest. Details travel in a header block that gRPC
/// clients limit to 8 KiB: what does not fit is counted in a last violation.
google::rpc::Status invalid(const Violations& violations);

/// An error whatever the fields hold, with the fields that it is about as BadRequest.
google::rpc::Status with_violations(google::rpc::Status status, const Violations& violations);

/// NOT_FOUND with ResourceInfo.
google::rpc::Status not_found(const std::string& type, const std::string& name,
                              const std::string& message);

/// ALREADY_EXISTS with ResourceInfo and, unless empty, BadRequest.
google::rpc::Status already_exists(const std::string& reason, const std::string& type,
                                   const std::string& name, const std::string& message,
                                   const Violations& violations = {});

/// FAILED_PRECONDITION with ResourceInfo.
google::rpc::Status not_possible(const std::string& reason, const std::string& type,
                                 const std::string& name, const std::string& message);

/// ABORTED with ResourceInfo: others changed it meanwhile; with RetryInfo where the same request
/// may succeed a moment later.
google::rpc::Status aborted(const std::string& reason, const std::string& type,
                            const std::string& name, const std::string& message, bool may_retry);

/// UNAVAILABLE with RetryInfo: the database cannot be used at the moment.
google::rpc::Status store_failed();

/// RESOURCE_EXHAUSTED with RetryInfo.
google::rpc::Status exhausted(const std::string& message, int retry_seconds);

/// DEADLINE_EXCEEDED, by the server's own limit or the client's.
google::rpc::Status deadline_exceeded();

/// UNAVAILABLE, SHUTTING_DOWN, with RetryInfo.
google::rpc::Status shutting_down();

/// Serialised size of BadRequest that surely reaches a client.
inline constexpr std::size_t kMaximumBadRequestBytes = 5500;

}  // namespace tribodyn::server
