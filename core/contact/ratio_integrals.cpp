// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/ratio_integrals.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/numerics/dispatch.h"
#include "core/numerics/pack-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include "core/contact/ratio_integrals.h"
#include "core/numerics/columns.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

constexpr int kNodes = RatioRule::kNodes;

/// At the ends of the intervals and at the nodes between.
struct alignas(64) Integrand {
  RatioLanes end_growth;                            // (1 + c p)^Z - 1
  RatioLanes per_square;                            // 2/(c p)^2
  std::array<double, kRatioTerms * kNodes> growth;  // (1 + c p)^Z - 1
  std::array<double, kRatioTerms * kNodes> weight;  // c^2 p dp/ds times that of the rule
};

void prepare(const RatioRule& rule, double deepest, double index, Integrand& out) {
  static_assert(kRatioTerms * kNodes % kColumnLanes == 0);
  for (std::size_t i = 0; i < rule.end.size(); i += pack_lanes()) {
    const Pack s = deepest * load_any(rule.end.data() + i);
    store(exponential_less_one(index * s), out.end_growth.data() + i);
    store(2 / square(exponential_less_one(s)), out.per_square.data() + i);
  }
  for (std::size_t i = 0; i < rule.node.size(); i += pack_lanes()) {
    const Pack s = deepest * load_any(rule.node.data() + i);
    const Pack q = exponential_less_one(s);
    store(exponential_less_one(index * s), out.growth.data() + i);
    store(deepest * load_any(rule.weight.data() + i) * fused(q, q, q), out.weight.data() + i);
  }
}

void integrate(const Integrand& integrand, const RatioLanes& factor, RatioSquare& values) {
  for (std::size_t lane = 0; lane < factor.size(); lane += pack_lanes()) {
    const Pack l = load_any(factor.data() + lane);
    Pack integral = 0;
    double before = 0;
    for (int j = 0; j < kRatioTerms; ++j) {
      const double end = integrand.end_growth[j];
      integral = integral * exponential(l * (before - end));
      for (int n = j * kNodes; n < (j + 1) * kNodes; ++n) {
        integral =
            fused(integrand.weight[n], exponential(l * (integrand.growth[n] - end)), integral);
      }
      store_any(integrand.per_square[j] * integral, values[j].data() + lane);
      before = end;
    }
  }
}

/// Rows together, so that their sums overlap.
void multiply(const RatioSquare& left, const RatioSquare& right, RatioSquare& product) {
  constexpr int kTogether = 4;
  static_assert(kRatioTerms % kTogether == 0);
  for (std::size_t lane = 0; lane < right[0].size(); lane += pack_lanes()) {
    for (int row = 0; row < kRatioTerms; row += kTogether) {
      Pack sum[kTogether] = {0, 0, 0, 0};
      for (int k = 0; k < kRatioTerms; ++k) {
        const Pack x = load_any(right[k].data() + lane);
        for (int n = 0; n < kTogether; ++n) sum[n] = fused(left[row + n][k], x, sum[n]);
      }
      for (int n = 0; n < kTogether; ++n) store_any(sum[n], product[row + n].data() + lane);
    }
  }
}

}  // namespace

void take_coefficients(const RatioRule& rule, const RatioLanes& factor, double deepest,
                       double index, RatioSquare& coefficients) {
  Integrand integrand;
  prepare(rule, deepest, index, integrand);
  alignas(64) RatioSquare values, in_s;
  integrate(integrand, factor, values);
  multiply(values, rule.transposed, in_s);
  multiply(rule.to_coefficients, in_s, coefficients);
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void ratio_coefficients(InstructionSet instruction_set, const RatioRule& rule,
                        const RatioLanes& factor, double deepest, double index,
                        RatioSquare& coefficients) {
  TRIBODYN_RETURN_WITH(instruction_set, take_coefficients, rule, factor, deepest, index,
                       coefficients)
}

}  // namespace tribodyn
#endif
