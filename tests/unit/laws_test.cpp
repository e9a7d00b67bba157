#include "core/laws/laws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/numerics/pack-inl.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

template <class Parameter>
ShearLaw<Parameter> reference_law() {
  const Lubricant oil = reference_lubricant();
  ShearLaw<Parameter> law{};
  law.lubricant.vogel_temperature_coefficient = oil.vogel_temperature_coefficient;
  law.lubricant.vogel_reference_temperature = oil.vogel_reference_temperature;
  law.lubricant.havriliak_negami_alpha = oil.havriliak_negami_alpha;
  law.lubricant.havriliak_negami_beta = oil.havriliak_negami_beta;
  law.lubricant.density_at_zero_kelvin = oil.density_at_zero_kelvin;
  law.lubricant.density_temperature_slope = oil.density_temperature_slope;
  law.log_vogel_prefactor = std::log(oil.vogel_viscosity_prefactor);
  law.log_relaxation_time = std::log(oil.relaxation_time);
  law.shift_reference = -16.6;
  return law;
}

// One formula: the same digits and derivatives from each number type.
TEST(Laws, AgreeOnEveryNumberType) {
  using Dual = laws::Dual<double, 1>;
  using DualPack = laws::Dual<laws::Pack, 1>;
  const auto law = reference_law<double>();
  for (double temperature = 270; temperature < 480; temperature += 7) {
    for (const double log_rate : {0.0, 8.0, 14.0, 18.0}) {
      const auto plain = laws::log_stress<Digits::kFull>(law, temperature, log_rate);
      const auto dual = laws::log_stress<Digits::kFull>(
          reference_law<Dual>(), Dual::variable(temperature, 0), Dual(log_rate));
      const auto pack =
          laws::log_stress<Digits::kFull>(law, laws::Pack(temperature), laws::Pack(log_rate));
      const auto dual_pack = laws::log_stress<Digits::kFull>(
          reference_law<DualPack>(), DualPack::variable(temperature, 0), DualPack(log_rate));
      const auto first = [](laws::Pack x) {
        alignas(64) double lanes[16];
        laws::store(x, lanes);
        return lanes[0];
      };
      EXPECT_NEAR(dual.base.value, plain.base, 1e-14 * std::abs(plain.base));
      EXPECT_NEAR(first(pack.base), plain.base, 1e-14 * std::abs(plain.base) + 1e-15);
      EXPECT_NEAR(first(dual_pack.base.value), plain.base, 1e-14 * std::abs(plain.base) + 1e-15);
      // By temperature, as written out for Newton's method.
      EXPECT_NEAR(dual.base.slope[0], plain.base_slope, 1e-12 * std::abs(plain.base_slope));
      EXPECT_NEAR(first(pack.base_slope), plain.base_slope, 1e-12 * std::abs(plain.base_slope));
      EXPECT_NEAR(first(dual_pack.base.slope[0]), plain.base_slope,
                  1e-12 * std::abs(plain.base_slope));
      EXPECT_NEAR(dual.factor.slope[0], plain.factor_slope, 1e-14);
    }
  }
}

TEST(Laws, RootsHaveTheSlopesOfTheImplicitFunctionTheorem) {
  // x^3 = a b: x = (a b)^(1/3).
  using Number = laws::Dual<double, 3>;
  const Number a = Number::variable(4, 0), b = Number::variable(2, 1);
  const Number x =
      laws::root_with_slopes<3>(2.0, [&](const Number& at) { return at * at * at - a * b; });
  EXPECT_EQ(x.value, 2);
  EXPECT_NEAR(x.slope[0], 2.0 / 3 / 4, 1e-15);
  EXPECT_NEAR(x.slope[1], 2.0 / 3 / 2, 1e-15);
  EXPECT_EQ(x.slope[2], 0);
}

}  // namespace
}  // namespace tribodyn
