#include "server/application/project_space.h"

#include <fmt/format.h>

#include "server/application/errors.h"

namespace tribodyn::server {

std::optional<google::rpc::Status> project_full(Application& application, const CallContext& call) {
  constexpr double kRetryAfterDeletion = 60;  // [s]; somebody has to delete some first
  const std::int64_t most = application.project_bytes;
  if (most <= 0 || application.store.result_bytes(call.project, call.limits) < most) {
    return std::nullopt;
  }
  return over_quota(
      "project " + call.project, "project-megabytes",
      fmt::format("{:.3g} MB of results; delete simulations and campaigns that nobody needs",
                  1e-6 * static_cast<double>(most)),
      kRetryAfterDeletion);
}

std::optional<google::rpc::Status> project_busy(Application& application, double cost_seconds,
                                                const CallContext& call) {
  constexpr double kRetrySeconds = 10;
  const double most = 3600 * application.project_quotas->quota().processor_hours;
  if (most <= 0 ||
      application.store.unfinished_seconds(call.project, call.limits) + cost_seconds <= most) {
    return std::nullopt;
  }
  return over_quota(
      "project " + call.project, "project-processor-hours",
      fmt::format("{:.3g} processor hours of simulations and campaigns that wait and run",
                  most / 3600),
      kRetrySeconds);
}

}  // namespace tribodyn::server
