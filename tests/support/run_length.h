#pragma once

#include <cstdlib>

namespace tribodyn {

#ifdef TRIBODYN_UNDER_ADDRESS_SANITIZER  // defined by tests/CMakeLists.txt
inline constexpr bool kUnderAddressSanitizer = true;
#else
inline constexpr bool kUnderAddressSanitizer = false;
#endif
#ifdef TRIBODYN_UNDER_SANITIZER
inline constexpr bool kUnderSanitizer = true;
#else
inline constexpr bool kUnderSanitizer = false;
#endif

/// AddressSanitizer slows the model ten times: sweeps use few of their scenes there. The release
/// stage runs all of them.
inline constexpr bool kShortRun = kUnderAddressSanitizer;

/// Returns true if the environment has TRIBODYN_FULL=1: then sweeps use more scenes than CI has
/// time for.
inline bool full_run() {
  const char* value = std::getenv("TRIBODYN_FULL");
  return value != nullptr && value[0] == '1';
}

}  // namespace tribodyn
