// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmark/vector_exponential.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "core/numerics/dispatch.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include "tests/benchmark/vector_exponential.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void exponentials(const double* x, double* y, std::size_t n) {
  const hn::ScalableTag<double> tag;
  for (std::size_t i = 0; i < n; i += hn::Lanes(tag)) {
    hn::Store(hn::Exp(tag, hn::Load(tag, x + i)), tag, y + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void vector_exponential(InstructionSet instruction_set, const double* x, double* y, std::size_t n) {
  TRIBODYN_RETURN_WITH(instruction_set, exponentials, x, y, n)
}

}  // namespace tribodyn
#endif
