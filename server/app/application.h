#pragma once

#include "server/jobs/simulation_jobs.h"
#include "server/store/store.h"

namespace tribodyn::server {

/// What the functions of this folder work on. Safe for concurrent access: both members are.
struct Application {
  Store& store;
  SimulationJobs& jobs;
};

}  // namespace tribodyn::server
