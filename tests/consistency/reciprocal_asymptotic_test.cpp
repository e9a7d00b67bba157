#include <gtest/gtest.h>

#include <cmath>

#include "core/lubricant/viscosity.h"
#include "tests/consistency/plain_contact.h"

namespace tribodyn {
namespace {

TEST(ReciprocalAsymptotic, IsThatOfQuadratureAndGivesItsIndexBack) {
  for (double factor = 0.5; factor < 60; factor *= 1.17) {
    for (double index = 0.05; index < 3; index *= 1.13) {
      const double coefficient = laws::roelands_reciprocal_asymptotic(factor, index);
      EXPECT_NEAR(plain::reciprocal_asymptotic(factor, index) / coefficient, 1, 1e-13)
          << "L = " << factor << ", Z = " << index;
      EXPECT_NEAR(index_from_reciprocal_asymptotic(factor, coefficient) / index, 1, 1e-13)
          << "L = " << factor << ", Z = " << index;
    }
  }
}

TEST(ReciprocalAsymptotic, IsThatOfBarusWhereTheIndexIsOne) {
  for (const double factor : {0.5, 5.0, 50.0}) {
    EXPECT_NEAR(laws::roelands_reciprocal_asymptotic(factor, 1.0) /
                    (laws::kRoelandsPressureCoefficient * factor),
                1, 1e-15);
  }
}

}  // namespace
}  // namespace tribodyn
