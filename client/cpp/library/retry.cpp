#include "client/cpp/library/retry.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace tribodyn::client {
namespace {

using google::protobuf::Message;
using std::chrono::milliseconds;

constexpr milliseconds kFirstPause(100);
constexpr milliseconds kLongestPause(5000);

bool has_field(const Message& request, const std::string& field) {
  return request.GetDescriptor()->FindFieldByName(field) != nullptr;
}

bool is_set(const Message& request, const std::string& field) {
  const auto* descriptor = request.GetDescriptor()->FindFieldByName(field);
  if (descriptor == nullptr) return false;
  if (descriptor->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_BOOL) {
    return request.GetReflection()->GetBool(request, descriptor);
  }
  return !request.GetReflection()->GetString(request, descriptor).empty();
}

template <class Detail>
std::optional<Detail> detail(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return std::nullopt;
  for (const auto& any : details.details()) {
    Detail out;
    if (any.Is<Detail>() && any.UnpackTo(&out)) return out;
  }
  return std::nullopt;
}

std::string reason_of(const grpc::Status& status) {
  const auto info = detail<google::rpc::ErrorInfo>(status);
  return info ? info->reason() : "";
}

}  // namespace

bool may_repeat(const Message& request) {
  static constexpr std::array<std::string_view, 9> kRepeatable = {
      "Get", "List", "Evaluate", "Compare", "Explain", "Pause", "Resume", "Cancel", "Delete"};
  const std::string& name = request.GetDescriptor()->name();
  // The repetition of a deletion for good would not find what the first one deleted.
  const bool deletes_for_good = (name.starts_with("Delete") || name.starts_with("Purge")) &&
                                has_field(request, "allow_missing");
  if (deletes_for_good) return is_set(request, "allow_missing");
  return std::any_of(kRepeatable.begin(), kRepeatable.end(),
                     [&](std::string_view each) { return name.starts_with(each); }) ||
         is_set(request, "validate_only") || is_set(request, "request_id");
}

std::optional<milliseconds> retry_delay(const grpc::Status& status) {
  const auto info = detail<google::rpc::RetryInfo>(status);
  if (!info) return std::nullopt;
  return milliseconds(1000 * info->retry_delay().seconds() +
                      (info->retry_delay().nanos() + 999'999) / 1'000'000);
}

bool was_turned_away(const grpc::Status& status) {
  const std::string reason = reason_of(status);
  return retry_delay(status) && reason != "STORE_FAILED" && reason != "OUT_OF_MEMORY";
}

bool is_over_quota(const grpc::Status& status) { return reason_of(status) == "QUOTA_EXCEEDED"; }

Backoff::Backoff() : random_(std::random_device()()), longest_(kFirstPause) {}

milliseconds Backoff::next(std::optional<milliseconds> requested) {
  std::uniform_int_distribution<std::int64_t> draw(0, longest_.count());
  const milliseconds pause = requested.value_or(milliseconds(0)) + milliseconds(draw(random_));
  longest_ = std::min(2 * longest_, kLongestPause);
  return pause;
}

void Backoff::reset() { longest_ = kFirstPause; }

std::string new_request_id() {
  std::random_device random;
  std::string out = "xxxxxxxx-xxxx-4xxx-Nxxx-xxxxxxxxxxxx";
  for (char& c : out) {
    if (c == 'x') c = "0123456789abcdef"[random() % 16];
    if (c == 'N') c = "89ab"[random() % 4];
  }
  return out;
}

}  // namespace tribodyn::client
