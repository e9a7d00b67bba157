#include "server/simulation/prepared_gear_sets.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tribodyn::server {

std::shared_ptr<PreparedGearSet> PreparedGearSets::take(const std::string& revision,
                                                        const Scene& scene) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& each) {
      return each.revision == revision && each.options == scene.options;
    });
    if (found != kept_.end()) {
      std::shared_ptr<PreparedGearSet> out = std::move(found->gear_set);
      kept_.erase(found);
      return out;
    }
  }
  return std::make_shared<PreparedGearSet>(scene.gear_set, scene.solid, scene.options);
}

void PreparedGearSets::give_back(const std::string& revision, const ModelOptions& options,
                                 std::shared_ptr<PreparedGearSet> gear_set) {
  if (gear_set->grids().steps_kept() > kMostSteps) return;
  std::list<Kept> dropped;  // freed after the lock
  const std::lock_guard lock(mutex_);
  kept_.push_front({revision, options, std::move(gear_set)});
  if (kept_.size() > kMostKept) dropped.splice(dropped.end(), kept_, std::prev(kept_.end()));
}

std::size_t PreparedGearSets::size() const {
  const std::lock_guard lock(mutex_);
  return kept_.size();
}

}  // namespace tribodyn::server
