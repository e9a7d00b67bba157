#pragma once

// For the part under HWY_ONCE of files that are compiled once per instruction set
// (foreach_target.h).

#include <hwy/highway.h>

#include "core/numerics/instruction_set.h"

// NOLINTBEGIN(cppcoreguidelines-macro-usage)
#if HWY_TARGETS & HWY_AVX3
#define TRIBODYN_CASE_AVX512(function, ...) \
  case InstructionSet::kAvx512:             \
    return N_AVX3::function(__VA_ARGS__);
#else
#define TRIBODYN_CASE_AVX512(function, ...)
#endif
#if HWY_TARGETS & HWY_AVX2
#define TRIBODYN_CASE_AVX2(function, ...) \
  case InstructionSet::kAvx2:             \
    return N_AVX2::function(__VA_ARGS__);
#else
#define TRIBODYN_CASE_AVX2(function, ...)
#endif

/// Returns from the function that it stands in with what `function` of that set's namespace
/// returns.
#define TRIBODYN_RETURN_WITH(instruction_set, function, ...) \
  switch (instruction_set) {                                 \
    TRIBODYN_CASE_AVX512(function, __VA_ARGS__)              \
    TRIBODYN_CASE_AVX2(function, __VA_ARGS__)                \
    default:                                                 \
      return HWY_STATIC_DISPATCH(function)(__VA_ARGS__);     \
  }
// NOLINTEND(cppcoreguidelines-macro-usage)
