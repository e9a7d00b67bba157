#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/lubricant/viscosity.h"
#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

TEST(PublishedViscosity, HoupertsIndexIsThatOfTheTextbookTable) {
  const nlohmann::json block = load_reference("published_checks.json").at("roelands_houpert");
  const double tolerance = block.at("absolute_tolerance_Z");
  ASSERT_FALSE(block.at("oils").empty());
  for (const nlohmann::json& oil : block.at("oils")) {
    const std::vector<double> viscosity = oil.at("eta"), alpha = oil.at("alpha"), z = oil.at("Z");
    ASSERT_EQ(viscosity.size(), z.size());
    ASSERT_EQ(alpha.size(), z.size());
    for (std::size_t i = 0; i < z.size(); ++i) {
      SCOPED_TRACE(oil.at("name").get<std::string>() + " " + std::to_string(i));
      const double factor = roelands_factor(std::log(viscosity[i]), {});
      EXPECT_NEAR(laws::houpert_index(factor, alpha[i]), z[i], tolerance);
    }
  }
}

// What tells the corrected factor from the printed one: Z is nearly a constant of the oil.
TEST(PublishedViscosity, IndexOfAnOilHardlyDependsOnTemperatureUnlessTheLogarithmIsMisprinted) {
  const nlohmann::json block = load_reference("published_checks.json").at("roelands_houpert");
  AsPublished misprint;
  misprint.eq31_32_logarithm = true;
  const auto spread = [&](const nlohmann::json& oil, const AsPublished& as_published) {
    const std::vector<double> viscosity = oil.at("eta"), alpha = oil.at("alpha");
    double low = 1e9, high = 0;
    for (std::size_t i = 0; i < alpha.size(); ++i) {
      const double index =
          laws::houpert_index(roelands_factor(std::log(viscosity[i]), as_published), alpha[i]);
      low = std::min(low, index);
      high = std::max(high, index);
    }
    return high / low;
  };
  for (const nlohmann::json& oil : block.at("oils")) {
    SCOPED_TRACE(oil.at("name").get<std::string>());
    EXPECT_LT(spread(oil, {}), 1.11);
    EXPECT_GT(spread(oil, misprint), 1.35);
  }
}

}  // namespace
}  // namespace tribodyn
