#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

#include "core/study/prepared_scene.h"
#include "core/study/scene.h"
#include "tribodyn/v1/gear_sets.pb.h"

namespace tribodyn::server {

/// Cache of prepared gear sets: preparing one takes longer than solving a point. A study takes a
/// gear set out and gives it back, so that no two threads use one at the same time. Safe for
/// concurrent access without external synchronization.
class PreparedGearSets {
 public:
  /// The message of a gear set, from which gear set and solid of a scene are made. parse_resource()
  /// shares one message among equal bodies. A name would not do: two projects may give it to
  /// different gear sets.
  using Source = std::shared_ptr<const v1::GearSet>;

  /// Returns the prepared gear set of the scene for the caller alone. `source` is the message of
  /// the gear set of the scene. Throws Refusal as PreparedGearSet does.
  std::shared_ptr<PreparedGearSet> take(const Source& source, const Scene& scene);

  /// Stores a prepared gear set for the next study. The caller must not use it afterwards. A gear
  /// set whose grids have more than kMaximumSteps steps is dropped.
  void give_back(const Source& source, const ModelOptions& options,
                 std::shared_ptr<PreparedGearSet> gear_set);

  /// Returns the number of stored gear sets.
  std::size_t size() const;

  /// Capacity. Above it the least recently used gear set is dropped. Enough for the threads of a
  /// usual server with two gear sets or models at a time.
  static constexpr std::size_t kCapacity = 8;
  /// Largest number of steps of all grids of a stored gear set; 2.6 kB each, 5 MB together.
  /// Measured: all points from 20 to 140 km/h at the usual tolerance need 500 together, a point at
  /// 1e-6 at most 1500, a point at 1e-8 up to 6000.
  static constexpr long kMaximumSteps = 2000;

 private:
  struct Entry {
    Source source;
    ModelOptions options;
    std::shared_ptr<PreparedGearSet> gear_set;
  };

  mutable std::mutex mutex_;
  std::list<Entry> entries_;  // guarded by mutex_; most recently used first
};

}  // namespace tribodyn::server
