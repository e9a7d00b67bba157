#include "server/application/request_limits.h"

#include <string_view>

namespace tribodyn::server {
namespace {

constexpr std::size_t kMebibyte = 1 << 20;

/// The answer holds the gear set, and what the server adds to it, and must fit into a response.
constexpr std::size_t kGearSetBytes = kMaximumResponseBytes - kMebibyte;

struct RequestLimit {
  std::string_view method;
  std::size_t bytes;
};

constexpr RequestLimit kRequestLimits[] = {
    {"CreateGearSet", kGearSetBytes},
    {"UpdateGearSet", kGearSetBytes},
    {"ImportGearSet", kGearSetBytes},
    {"ImportLubricant", 2 * kMebibyte},        // with a table of 1 MiB
    {"ImportSurfaceProfiles", 4 * kMebibyte},  // with texts of 3 MiB
    {"BatchCreateLubricants", kMaximumRequestBytes},
    {"BatchUpdateLubricants", kMaximumRequestBytes},
    {"BatchCreateGearSets", kMaximumRequestBytes},
    {"BatchUpdateGearSets", kMaximumRequestBytes},
    {"BatchCreateSurfaces", kMaximumRequestBytes},
    {"BatchUpdateSurfaces", kMaximumRequestBytes},
    {"BatchCreateVehicles", kMaximumRequestBytes},
    {"BatchUpdateVehicles", kMaximumRequestBytes},
};

}  // namespace

std::size_t maximum_request_bytes(const google::protobuf::MethodDescriptor& method) {
  for (const RequestLimit& row : kRequestLimits) {
    if (row.method == method.name()) return row.bytes;
  }
  return kUsualRequestBytes;
}

}  // namespace tribodyn::server
