#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>

namespace tribodyn::server {

/// Returns the seed of random schedules: TRIBODYN_TEST_SEED repeats those of an earlier run.
inline std::uint64_t first_schedule_seed() {
  const char* given = std::getenv("TRIBODYN_TEST_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device()();
}

}  // namespace tribodyn::server
