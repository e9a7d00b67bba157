#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "server/application/audit_log.h"
#include "server/application/authorizer.h"
#include "server/application/quota.h"
#include "server/application/shared_places.h"
#include "server/execution/simulation_jobs.h"
#include "server/simulation/prepared_gear_sets.h"
#include "server/storage/store.h"
#include "server/support/processor_slots.h"

namespace tribodyn::server {

/// Watches without names. Each commit wakes all of them, at about a microsecond each.
inline constexpr std::size_t kMostProjectWatches = 200;

/// The objects that every use case works on. Safe for concurrent access, as all members are.
struct Application {
  Store& store;
  SimulationJobs& jobs;
  /// Shared, because a stream may outlive the object.
  std::shared_ptr<Authorizer> authorizer = std::make_shared<Authorizer>();
  AuditLog audit = AuditLog({});
  /// Of the page tokens of lists; the database keeps it.
  std::string page_token_key = std::string(32, '\0');
  std::shared_ptr<ProjectQuotas> project_quotas = std::make_shared<ProjectQuotas>();
  /// Most bytes of results that a project may have; 0: no limit.
  std::int64_t project_bytes = 0;
  /// Number of histories that are being read. Shared, because a reader may outlive the object.
  std::shared_ptr<std::atomic<int>> open_histories = std::make_shared<std::atomic<int>>(0);
  /// The places of watches without names.
  SharedPlaces project_watches{kMostProjectWatches};
  /// For calls that compute; the executor has its own.
  std::shared_ptr<PreparedGearSets> gear_sets = std::make_shared<PreparedGearSets>();
  /// For checking the inputs of new simulations, on half of the processors. Beside 20,000 refused
  /// submissions on two processors the slowest health check took 25 to 35 ms with one slot, 35 to
  /// 44 ms with two and 44 to 58 ms with one for each of the eight threads that write
  /// (service_benchmark, three runs each).
  std::shared_ptr<ProcessorSlots> submission_slots = std::make_shared<ProcessorSlots>(
      std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / 2));
};

}  // namespace tribodyn::server
