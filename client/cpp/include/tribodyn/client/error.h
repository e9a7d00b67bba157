#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tribodyn::client {

/// One error that the server found in a request.
struct FieldViolation {
  std::string field;  ///< path in the request, e.g. "lubricant.measurements.densities[2]"
  /// Value, unit, allowed range and the equation that requires it, e.g. "sump_temperature_celsius =
  /// 900 C; allowed: -70 to 200 C (eq 14)".
  std::string description;
};

/// The failure of a call. what() is the whole text for the user, without control characters; it has
/// several lines if there are several violations.
class ServiceError : public std::runtime_error {
 public:
  enum class Kind {
    kCannotConnect,  ///< nothing listens at the address, or the connection was lost
    kNoAnswer,       ///< no answer within the time limit
    kRefused,        ///< the server answered with an error
  };

  ServiceError(Kind kind, const std::string& text) : std::runtime_error(text), kind_(kind) {}
  /// Constructs an error of kind kRefused.
  ServiceError(const std::string& text, int status_code, std::string reason,
               std::vector<FieldViolation> violations, std::optional<double> retry_delay_seconds,
               std::string resource_name = "")
      : std::runtime_error(text),
        kind_(Kind::kRefused),
        status_code_(status_code),
        reason_(std::move(reason)),
        violations_(std::move(violations)),
        retry_delay_seconds_(retry_delay_seconds),
        resource_name_(std::move(resource_name)) {}

  Kind kind() const { return kind_; }
  /// The number of a grpc::StatusCode, e.g. 5 for NOT_FOUND; 0 unless kind() is kRefused.
  int status_code() const { return status_code_; }
  /// The stable reason, e.g. "RESOURCE_NOT_FOUND"; may be empty.
  const std::string& reason() const { return reason_; }
  /// All violations of the request.
  const std::vector<FieldViolation>& violations() const { return violations_; }
  /// The pause before a retry that the server requests; nullopt if it requests none.
  std::optional<double> retry_delay_seconds() const { return retry_delay_seconds_; }
  /// The resource that the error is about, e.g. the one that a request_id has made; may be empty.
  const std::string& resource_name() const { return resource_name_; }

 private:
  Kind kind_;
  int status_code_ = 0;
  std::string reason_;
  std::vector<FieldViolation> violations_;
  std::optional<double> retry_delay_seconds_;
  std::string resource_name_;
};

}  // namespace tribodyn::client
