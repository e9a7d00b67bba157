#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "core/study/prepared_scene.h"
#include "core/study/scene.h"

namespace tribodyn::server {

/// Prepared gear sets between the studies that use them. Preparing one takes longer than solving a
/// point. A study takes the prepared gear set that it needs and gives it back, so that no two
/// threads use one at the same time. Safe for concurrent access without external synchronization.
class PreparedGearSets {
 public:
  /// The gear set of the scene, prepared for the caller alone. `revision`: the name of the gear set
  /// with its revision, "gearSets/A@1", which determines gear set and solid. Throws Refusal as
  /// PreparedGearSet does.
  std::shared_ptr<PreparedGearSet> take(const std::string& revision, const Scene& scene);

  /// Keeps a prepared gear set for the next study. The caller must not use it any more. A gear set
  /// whose grids have more than kMostSteps steps is dropped.
  void give_back(const std::string& revision, const ModelOptions& options,
                 std::shared_ptr<PreparedGearSet> gear_set);

  /// How many are kept at present.
  std::size_t size() const;

  /// The one used longest ago is dropped beyond it: as many as the threads of a usual server need
  /// for two gear sets or models at a time.
  static constexpr std::size_t kMostKept = 8;
  /// Steps of all grids of one gear set, of 2.6 kB each: 5 MB. All points from 20 to 140 km/h at
  /// the usual tolerance need 500 together, a point at 1e-6 at most 1500, a point at 1e-8 up to
  /// 6000.
  static constexpr long kMostSteps = 2000;

 private:
  struct Kept {
    std::string revision;
    ModelOptions options;
    std::shared_ptr<PreparedGearSet> gear_set;
  };

  mutable std::mutex mutex_;
  std::list<Kept> kept_;  // guarded by mutex_; the one used last comes first
};

}  // namespace tribodyn::server
