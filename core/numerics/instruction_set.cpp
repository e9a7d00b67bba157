#include "core/numerics/instruction_set.h"

#include <hwy/highway.h>

#include <cstdint>

namespace tribodyn {

bool has_instructions(InstructionSet instruction_set) {
  // Asking a virtual processor takes some 20 us.
  [[maybe_unused]] static const std::int64_t supported = hwy::SupportedTargets();
  switch (instruction_set) {
    case InstructionSet::kPortable:
      return true;
#if HWY_TARGETS & HWY_AVX2
    case InstructionSet::kAvx2:
      return (supported & HWY_AVX2) != 0;
#endif
#if HWY_TARGETS & HWY_AVX3
    case InstructionSet::kAvx512:
      return (supported & HWY_AVX3) != 0;
#endif
    default:
      return false;
  }
}

}  // namespace tribodyn
