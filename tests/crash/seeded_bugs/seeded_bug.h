#pragma once

#include <cstdlib>
#include <string_view>

namespace tribodyn::server {

/// The bug that the environment variable TRIBODYN_SEEDED_BUG names; null: none.
inline const char* chosen_seeded_bug() {
  static const char* const kChosen = std::getenv("TRIBODYN_SEEDED_BUG");
  return kChosen;
}
/// Whether that is the bug of this name.
inline bool seeded_bug(std::string_view name) {
  return chosen_seeded_bug() != nullptr && name == chosen_seeded_bug();
}

}  // namespace tribodyn::server
