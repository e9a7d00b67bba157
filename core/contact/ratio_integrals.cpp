// Compiled once per instruction set by foreach_target.h, each time inside a namespace of its own.
// NOLINTBEGIN(bugprone-suspicious-include,misc-redundant-expression)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/contact/ratio_integrals.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#include "core/laws/pressure_growth-inl.h"
#include "core/laws/viscosity-inl.h"
#include "core/numerics/dispatch.h"
#include "core/numerics/pack-inl.h"
// NOLINTEND(bugprone-suspicious-include,misc-redundant-expression)

#include <concepts>

#include "core/contact/ratio_integrals.h"
#include "core/numerics/columns.h"

HWY_BEFORE_NAMESPACE();
namespace tribodyn {
namespace HWY_NAMESPACE {
namespace {

constexpr int kNodes = RatioRule::kNodes;

using NodeNumbers = std::array<double, kRatioTerms * kNodes>;

/// What the integrals have in common for every law.
struct alignas(64) Rule {
  RatioLanes per_square;  // 2/(c p)^2 at the ends of the intervals
  NodeNumbers weight;     // c^2 p dp/ds times that of the rule, at the nodes between
};

void prepare(const RatioRule& rule, double maximum_log_pressure, Rule& out) {
  static_assert(kRatioTerms * kNodes % kColumnLanes == 0);
  for (std::size_t i = 0; i < rule.end.size(); i += pack_lanes()) {
    const Pack s = maximum_log_pressure * load_any(rule.end.data() + i);
    store(2 / square(exponential_less_one(s)), out.per_square.data() + i);
  }
  for (std::size_t i = 0; i < rule.node.size(); i += pack_lanes()) {
    const Pack q = exponential_less_one(maximum_log_pressure * load_any(rule.node.data() + i));
    store(maximum_log_pressure * load_any(rule.weight.data() + i) * fused(q, q, q),
          out.weight.data() + i);
  }
}

/// x(s) at the ends of the intervals and at the nodes between.
struct alignas(64) AtDepths {
  RatioLanes end;
  NodeNumbers node;

  template <class Function>
  AtDepths(const RatioRule& rule, double maximum_log_pressure, Function&& x) {
    for (std::size_t i = 0; i < end.size(); i += pack_lanes()) {
      store(x(maximum_log_pressure * load_any(rule.end.data() + i)), end.data() + i);
    }
    for (std::size_t i = 0; i < node.size(); i += pack_lanes()) {
      store(x(maximum_log_pressure * load_any(rule.node.data() + i)), node.data() + i);
    }
  }
};

/// The growths of ln eta under a pressure-viscosity law in a pack of lanes, from the end of one
/// section of depths to the next end or to a node in between.
template <class G>
concept LogGrowth = requires(G& growth, const G& at_end, int j) {
  { growth.next_end(j) } -> std::same_as<Pack>;
  { at_end.node(j) } -> std::same_as<Pack>;
};

struct RoelandsLogGrowth {
  const AtDepths& growth;  // (1 + c p)^Z - 1
  Pack factor;
  double end = 0;

  HWY_INLINE Pack next_end(int j) {
    const double before = end;
    end = growth.end[j];
    return factor * (before - end);
  }
  HWY_INLINE Pack node(int n) const { return factor * (growth.node[n] - end); }
};

struct LawLogGrowth {
  const AtDepths& pressure;  // [Pa]
  const GrowthLaw<double>& law;
  Pack temperature;
  Pack end = 0;

  HWY_INLINE Pack next_end(int j) {
    const Pack before = end;
    end = pressure_growth(law, temperature, Pack(pressure.end[j]));
    return before - end;
  }
  HWY_INLINE Pack node(int n) const {
    return pressure_growth(law, temperature, Pack(pressure.node[n])) - end;
  }
};

/// log_growth_at(lane) gives the growths in the pack that begins there.
template <class LogGrowthAt>
void integrate(const Rule& rule, LogGrowthAt&& log_growth_at, RatioSquare& values) {
  for (std::size_t lane = 0; lane < values[0].size(); lane += pack_lanes()) {
    LogGrowth auto log_growth = log_growth_at(lane);
    Pack integral = 0;
    for (int j = 0; j < kRatioTerms; ++j) {
      integral = integral * exponential(log_growth.next_end(j));
      for (int n = j * kNodes; n < (j + 1) * kNodes; ++n) {
        integral = fused(rule.weight[n], exponential(log_growth.node(n)), integral);
      }
      store_any(rule.per_square[j] * integral, values[j].data() + lane);
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

void take_coefficients(const RatioRule& rule, const RatioLanes& factor, double maximum_log_pressure,
                       const ShearLaw<double>& law, RatioSquare& coefficients) {
  Rule prepared;
  prepare(rule, maximum_log_pressure, prepared);
  alignas(64) RatioSquare values, in_s;
  if (law.lubricant.pressure_viscosity_law == PressureViscosityLaw::kRoelands) {
    const AtDepths growth(rule, maximum_log_pressure,
                          [&](Pack s) HWY_ATTR { return exponential_less_one(law.index * s); });
    integrate(
        prepared,
        [&](std::size_t lane) HWY_ATTR {
          return RoelandsLogGrowth{growth, load_any(factor.data() + lane)};
        },
        values);
  } else {
    const AtDepths pressure(rule, maximum_log_pressure, [](Pack s) HWY_ATTR {
      return exponential_less_one(s) * (1 / kRoelandsPressureCoefficient);
    });
    const double at_zero_factor = kRoelandsLogViscosity + law.log_vogel_prefactor;
    integrate(
        prepared,
        [&](std::size_t lane) HWY_ATTR {
          const Pack temperature =
              vogel_temperature(law.lubricant.vogel_temperature_coefficient,
                                law.lubricant.vogel_reference_temperature,
                                load_any(factor.data() + lane) - at_zero_factor);
          return LawLogGrowth{pressure, law.growth, temperature};
        },
        values);
  }
  multiply(values, rule.transposed, in_s);
  multiply(rule.to_coefficients, in_s, coefficients);
}

}  // namespace HWY_NAMESPACE
}  // namespace tribodyn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tribodyn {

void ratio_coefficients(InstructionSet instruction_set, const RatioRule& rule,
                        const RatioLanes& factor, double maximum_log_pressure,
                        const ShearLaw<double>& law, RatioSquare& coefficients) {
  TRIBODYN_RETURN_WITH(instruction_set, take_coefficients, rule, factor, maximum_log_pressure, law,
                       coefficients)
}

}  // namespace tribodyn
#endif
