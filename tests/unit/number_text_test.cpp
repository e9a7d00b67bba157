#include "core/number_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

namespace tribodyn {
namespace {

TEST(NumberText, KeepsAsManyDigitsAsAreKnown) {
  EXPECT_EQ(within_text(0.637864, 0.0956795), "0.638 within 0.096");
  EXPECT_EQ(within_text(17.34561, 2.6), "17.3 within 2.6");
  EXPECT_EQ(within_text(880, 44), "880 within 44");
  EXPECT_EQ(within_text(-0.63512, 0.0127), "-0.635 within 0.013");
  EXPECT_EQ(within_text(160, 15), "160 within 15");
  EXPECT_EQ(within_text(1234567, 34567), "1235000 within 35000");
  EXPECT_EQ(within_text(4, 40), "4 within 40");
  EXPECT_EQ(within_text(1.6e-4, 2.4e-4), "0.00016 within 0.00024");
}

TEST(NumberText, WithoutAnUncertaintyIsSixDigits) {
  EXPECT_EQ(known_text(1.0 / 3, 0), "0.333333");
  EXPECT_EQ(known_text(1.0 / 3, std::numeric_limits<double>::quiet_NaN()), "0.333333");
  EXPECT_EQ(known_text(0, 0.1), "0");
  EXPECT_EQ(known_text(1.0 / 3, 1e-12), "0.333333");
}

TEST(NumberText, IsWhatPrintfWrites) {
  std::mt19937_64 random(3);
  const auto printed = [](double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return std::string(text);
  };
  for (int i = 0; i < 20'000; ++i) {
    const auto value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
    if (std::isnan(value)) continue;
    const int digits = 1 + static_cast<int>(random() % 17);
    ASSERT_EQ(general_text(value, digits), printed(value, digits));
    ASSERT_EQ(number_text(value), printed(value, 6));
    if (std::abs(value) > 1e300) continue;  // may overflow when it is rounded
    char rounded[64];
    std::snprintf(rounded, sizeof rounded, "%.*e", std::min(digits, 10) - 1, value);
    ASSERT_EQ(number_text(value, std::min(digits, 10)), printed(std::strtod(rounded, nullptr), 10));
  }
  for (const double value : {0.0, -0.0, 1e6, 999999.5, 123456.5, 1e-5, 0.00012345650,
                             std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(number_text(value), printed(value, 6));
  }
}

}  // namespace
}  // namespace tribodyn
