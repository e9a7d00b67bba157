#include "server/simulation/prepared_gear_sets.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tribodyn::server {

std::shared_ptr<PreparedGearSet> PreparedGearSets::take(const Source& source, const Scene& scene) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& each) {
      return each.source == source && each.options == scene.options;
    });
    if (found != entries_.end()) {
      std::shared_ptr<PreparedGearSet> out = std::move(found->gear_set);
      entries_.erase(found);
      return out;
    }
  }
  return std::make_shared<PreparedGearSet>(scene.gear_set, scene.solid, scene.options);
}

void PreparedGearSets::give_back(const Source& source, const ModelOptions& options,
                                 std::shared_ptr<PreparedGearSet> gear_set) {
  if (gear_set->grids().steps_kept() > kMaximumSteps) return;
  std::list<Entry> dropped;  // freed after the mutex is released
  const std::lock_guard lock(mutex_);
  entries_.push_front({source, options, std::move(gear_set)});
  if (entries_.size() > kCapacity) {
    dropped.splice(dropped.end(), entries_, std::prev(entries_.end()));
  }
}

std::size_t PreparedGearSets::size() const {
  const std::lock_guard lock(mutex_);
  return entries_.size();
}

}  // namespace tribodyn::server
