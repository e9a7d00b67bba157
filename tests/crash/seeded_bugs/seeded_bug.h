#pragma once

#include <cstdlib>
#include <string_view>

namespace tribodyn::server {

/// Returns the bug that the environment variable TRIBODYN_SEEDED_BUG names, or null.
inline const char* chosen_seeded_bug() {
  static const char* const kChosen = std::getenv("TRIBODYN_SEEDED_BUG");
  return kChosen;
}
/// Returns true if the chosen bug has this name.
inline bool seeded_bug(std::string_view name) {
  return chosen_seeded_bug() != nullptr && name == chosen_seeded_bug();
}

}  // namespace tribodyn::server
