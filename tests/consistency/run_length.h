#pragma once

#include <cstdlib>

namespace tribodyn {

/// Sanitizers make the model ten times slower: there, tests do a part of their work only.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kShortRun = true;
#else
inline constexpr bool kShortRun = false;
#endif

/// TRIBODYN_FULL=1 asks for everything.
inline bool full_run() {
  const char* value = std::getenv("TRIBODYN_FULL");
  return value != nullptr && value[0] == '1';
}

}  // namespace tribodyn
