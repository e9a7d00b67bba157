#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tribodyn::server {

/// A limited number of places, of which neither one principal nor one project may take more than
/// three quarters. Safe for concurrent access.
class SharedPlaces {
 public:
  explicit SharedPlaces(std::size_t places) : state_(std::make_shared<State>()), places_(places) {}

  /// Returns a place, which is free again when the last copy is destroyed; null if there is none.
  std::shared_ptr<void> take(const std::string& principal, const std::string& project) const {
    const std::vector<std::string> keys = {kAll, "principal " + principal, "project " + project};
    const std::lock_guard lock(state_->mutex);
    for (const std::string& key : keys) {
      if (state_->count(key) >= (key == kAll ? places_ : places_ * 3 / 4)) return nullptr;
    }
    for (const std::string& key : keys) ++state_->taken[key];
    return {state_.get(), [state = state_, keys](void*) {
              const std::lock_guard inner(state->mutex);
              for (const std::string& key : keys) {
                if (--state->taken[key] == 0) state->taken.erase(key);
              }
            }};
  }

  std::size_t taken() const {
    const std::lock_guard lock(state_->mutex);
    return state_->count(kAll);
  }

 private:
  struct State {
    std::mutex mutex;
    std::map<std::string, std::size_t> taken;  // guarded by mutex
    std::size_t count(const std::string& key) const {
      const auto found = taken.find(key);
      return found == taken.end() ? 0 : found->second;
    }
  };
  static constexpr char kAll[] = "";
  std::shared_ptr<State> state_;  ///< shared by copies and places
  std::size_t places_;
};

}  // namespace tribodyn::server
