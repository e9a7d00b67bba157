#pragma once

#include <atomic>
#include <memory>

#include "server/execution/simulation_jobs.h"
#include "server/storage/store.h"

namespace tribodyn::server {

/// What the functions of this folder work on. Safe for concurrent access: all members are.
struct Application {
  Store& store;
  SimulationJobs& jobs;
  /// Histories that are being read; shared, as a reader may outlive the object.
  std::shared_ptr<std::atomic<int>> open_histories = std::make_shared<std::atomic<int>>(0);
};

}  // namespace tribodyn::server
