#include "server/app/simulations.h"

#include <google/protobuf/util/time_util.h>

#include <charconv>
#include <optional>

#include "server/app/guard.h"
#include "server/app/paging.h"
#include "server/app/simulation_lookup.h"
#include "server/convert/input_hash.h"
#include "server/convert/simulation_inputs.h"

namespace tribodyn::server {
namespace {

constexpr int kDefaultPageSize = 50;
constexpr int kRetrySeconds = 10;

static_assert(static_cast<int>(StoredState::kQueued) == v1::Simulation::QUEUED);
static_assert(static_cast<int>(StoredState::kRunning) == v1::Simulation::RUNNING);
static_assert(static_cast<int>(StoredState::kSucceeded) == v1::Simulation::SUCCEEDED);
static_assert(static_cast<int>(StoredState::kFailed) == v1::Simulation::FAILED);
static_assert(static_cast<int>(StoredState::kCancelled) == v1::Simulation::CANCELLED);

using google::protobuf::util::TimeUtil;

template <class Row>
void set_revisions(const Row& row, v1::Simulation& out) {
  out.set_lubricant_revision(row.lubricant_revision);
  out.set_gear_set_revision(row.gear_set_revision);
  out.set_surface_revision(row.surface_revision);
  out.set_vehicle_revision(row.vehicle_revision);
}

/// What a request that is only checked would become; without a name.
v1::Simulation preview(const v1::Simulation& requested, const NewSimulation& simulation) {
  v1::Simulation out = requested;
  set_revisions(simulation, out);
  out.set_state(v1::Simulation::QUEUED);
  return out;
}

/// The stored row as a message, without its result.
v1::Simulation to_message(Application& application, const StoredSimulation& stored) {
  v1::Simulation out;
  out.ParseFromString(stored.request);
  out.set_name(simulation_name(stored.id));
  out.set_state(static_cast<v1::Simulation::State>(stored.state));
  set_revisions(stored, out);
  *out.mutable_create_time() = TimeUtil::MicrosecondsToTimestamp(stored.create_time);
  if (stored.start_time) {
    *out.mutable_start_time() = TimeUtil::MicrosecondsToTimestamp(*stored.start_time);
  }
  if (stored.end_time) {
    *out.mutable_end_time() = TimeUtil::MicrosecondsToTimestamp(*stored.end_time);
  }
  if (stored.state == StoredState::kFailed) {
    out.mutable_error()->set_reason(stored.error_reason);
    out.mutable_error()->set_message(stored.error_message);
  }
  if (stored.state == StoredState::kSucceeded) {
    out.set_progress_fraction(1);
  } else if (stored.state == StoredState::kRunning) {
    const auto progress = application.jobs.progress(stored.id);
    if (progress && !has_ended(progress->state)) out.set_progress_fraction(progress->fraction);
  }
  return out;
}

}  // namespace

Outcome<v1::Simulation> create_simulation(Application& application,
                                          const v1::CreateSimulationRequest& request) {
  return guarded<v1::Simulation>([&]() -> Outcome<v1::Simulation> {
    if (!request.has_simulation()) return invalid({{"simulation", "not set"}});
    Violations violations;
    const auto inputs = read_simulation(request.simulation(), resource_lookup(application.store),
                                        "simulation", violations);
    if (!inputs) return invalid(violations);
    const v1::Simulation& effective = inputs->effective;
    NewSimulation simulation{.request = inputs->requested.SerializeAsString(),
                             .input_hash = input_hash(*inputs),
                             .lubricant_revision = effective.lubricant_revision(),
                             .gear_set_revision = effective.gear_set_revision(),
                             .surface_revision = effective.surface_revision(),
                             .vehicle_revision = effective.vehicle_revision()};
    if (request.validate_only()) return preview(inputs->requested, simulation);
    const auto id = application.jobs.submit(simulation);
    if (!id) {
      return exhausted("too many simulations wait already; try again later", kRetrySeconds);
    }
    const auto stored = application.store.simulation(*id);
    if (!stored) return error(google::rpc::INTERNAL, "INTERNAL", "the simulation is gone");
    return to_message(application, *stored);
  });
}

Outcome<v1::Simulation> get_simulation(Application& application,
                                       const v1::GetSimulationRequest& request) {
  return guarded<v1::Simulation>([&]() -> Outcome<v1::Simulation> {
    const auto found = find_simulation(application, request.name());
    if (!found.ok()) return found.error();
    v1::Simulation out = to_message(application, found.message());
    if (const auto result = application.store.result(found.message().id)) {
      out.mutable_result()->ParseFromString(*result);
    }
    return out;
  });
}

Outcome<v1::ListSimulationsResponse> list_simulations(Application& application,
                                                      const v1::ListSimulationsRequest& request) {
  return guarded<v1::ListSimulationsResponse>([&]() -> Outcome<v1::ListSimulationsResponse> {
    Violations violations;
    const int size = page_size(request.page_size(), kDefaultPageSize, violations);
    const std::optional<std::int64_t> before = simulation_id(request.page_token());
    if (!request.page_token().empty() && !before) add_bad_page_token(violations);
    if (!violations.empty()) return invalid(violations);
    const Page<StoredSimulation> page =
        application.store.simulations(before.value_or(0), size, kMaximumPageBytes);
    v1::ListSimulationsResponse response;
    for (const StoredSimulation& row : page.rows) {
      *response.add_simulations() = to_message(application, row);
    }
    if (page.more) response.set_next_page_token(simulation_name(page.rows.back().id));
    return response;
  });
}

Outcome<v1::Simulation> cancel_simulation(Application& application,
                                          const v1::CancelSimulationRequest& request) {
  return guarded<v1::Simulation>([&]() -> Outcome<v1::Simulation> {
    const auto found = find_simulation(application, request.name());
    if (!found.ok()) return found.error();
    application.jobs.cancel(found.message().id);
    v1::GetSimulationRequest now;
    now.set_name(request.name());
    return get_simulation(application, now);
  });
}

}  // namespace tribodyn::server
