#include "server/application/project_space.h"

#include <fmt/format.h>

#include "server/application/errors.h"

namespace tribodyn::server {

std::optional<google::rpc::Status> project_full(Application& application, const CallContext& call) {
  const std::int64_t most = application.project_bytes;
  if (most <= 0 || application.store.result_bytes(call.project, call.limits) < most) {
    return std::nullopt;
  }
  return over_quota(
      "project " + call.project, "project-megabytes",
      fmt::format("{:.3g} MB of results; delete simulations and campaigns that nobody needs",
                  1e-6 * static_cast<double>(most)),
      std::nullopt);
}

std::optional<google::rpc::Status> take_hours(Application& application, double cost_seconds,
                                              const CallContext& call, WorkPlace& place) {
  constexpr double kRetrySeconds = 10;
  const auto over = [&](const std::string& whose, const std::string& quota, double hours) {
    const bool can_fit = cost_seconds <= 3600 * hours;
    return over_quota(
        whose, quota,
        fmt::format("{:.3g} processor hours of simulations and campaigns that wait and run{}",
                    hours,
                    can_fit ? ""
                            : fmt::format("; this one alone takes about {:.3g}: divide it",
                                          cost_seconds / 3600)),
        can_fit ? std::optional(kRetrySeconds) : std::nullopt);
  };
  const double principals = call.grant->quota.processor_hours;
  if (principals > 0) {
    place.of_principal = call.grant->allowance.reserve(cost_seconds, 3600 * principals, [&] {
      return application.jobs.unfinished_seconds(payer(call));
    });
    if (place.of_principal == nullptr) {
      return over(call.grant->principal, "processor-hours", principals);
    }
  }
  const double projects = application.project_quotas->quota().processor_hours;
  if (projects > 0) {
    place.of_project = application.project_quotas->of(call.project);
    place.in_project = place.of_project->reserve(cost_seconds, 3600 * projects, [&] {
      return application.store.unfinished_seconds(call.project, call.limits);
    });
    if (place.in_project == nullptr) {
      return over("project " + call.project, "project-processor-hours", projects);
    }
  }
  return std::nullopt;
}

}  // namespace tribodyn::server
