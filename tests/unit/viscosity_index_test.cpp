#include "core/lubricant/viscosity_index.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/refusal.h"
#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

TEST(ViscosityIndex, MatchesPublishedOils) {
  const nlohmann::json check = load_reference("published_checks.json").at("viscosity_index");
  for (const nlohmann::json& oil : check.at("cases")) {
    EXPECT_NEAR(viscosity_index(oil.at("kv40_mm2_s"), oil.at("kv100_mm2_s")),
                oil.at("viscosity_index").get<double>(),
                check.at("absolute_tolerance").get<double>());
  }
}

TEST(ViscosityIndexReferences, MatchTheTableOfTheStandard) {
  // Y, L, H of ASTM D2270 table 1, in mm2/s: two or three rows of every piece.
  const double rows[][3] = {
      {2.0, 7.994, 6.394},  {2.5, 11.45, 9.063},  {3.5, 20.09, 15.66},  {4.1, 26.50, 20.37},
      {4.4, 30.48, 22.92},  {4.7, 35.13, 25.63},  {5.0, 40.23, 28.49},  {5.7, 52.64, 35.29},
      {6.4, 65.18, 42.14},  {6.7, 71.29, 45.33},  {7.0, 78.00, 48.57},  {7.3, 84.53, 51.78},
      {7.5, 88.85, 53.98},  {7.7, 93.20, 56.20},  {8.3, 106.9, 63.05},  {9.0, 123.3, 71.10},
      {10.5, 160.6, 88.95}, {12.0, 201.9, 108.0}, {13.5, 247.4, 128.4}, {15.0, 296.5, 149.7},
      {16.5, 350.3, 172.3}, {18.0, 408.6, 196.2}, {20.0, 493.2, 229.5}, {22.0, 585.2, 264.9},
      {25.0, 736.5, 320.9}, {28.0, 904.1, 380.6}, {34.0, 1286, 509.6},  {40.0, 1730, 651.8},
      {47.5, 2380, 849.2},  {55.0, 3126, 1066},   {62.5, 3966, 1303},   {70.0, 4905, 1558}};
  for (const auto& [y, l, h] : rows) {
    const ViscosityIndexReferences references = viscosity_index_references(y);
    EXPECT_NEAR(references.index_0 / l, 1, 0.0012) << y;
    EXPECT_NEAR(references.index_100 / h, 1, 0.0012) << y;
  }
}

TEST(ViscosityIndexReferences, AreContinuousWherePiecesJoin) {
  for (const double join :
       {3.8, 4.4, 5.0, 6.4, 7.0, 7.7, 9.0, 12.0, 15.0, 18.0, 22.0, 28.0, 40.0, 55.0, 70.0}) {
    const ViscosityIndexReferences left = viscosity_index_references(std::nextafter(join, 0.0));
    const ViscosityIndexReferences right = viscosity_index_references(join);
    EXPECT_NEAR(left.index_0 / right.index_0, 1, 0.001) << join;
    EXPECT_NEAR(left.index_100 / right.index_100, 1, 0.0018) << join;
  }
}

TEST(ViscosityIndexReferences, RiseAndNeverCross) {
  ViscosityIndexReferences last{0, 0};
  for (double y = 2; y < 200; y += 0.05) {
    const ViscosityIndexReferences references = viscosity_index_references(y);
    EXPECT_GT(references.index_0, last.index_0) << y;
    EXPECT_GT(references.index_100, last.index_100) << y;
    EXPECT_GT(references.index_0, references.index_100) << y;
    EXPECT_GT(references.index_100, y) << y;
    last = references;
  }
}

TEST(ViscosityIndex, MeetsItsDefinitionAtTheReferenceOils) {
  for (const double y : {2.0, 3.0, 5.5, 8.86, 14.0, 30.0, 90.0}) {
    const ViscosityIndexReferences references = viscosity_index_references(y);
    EXPECT_NEAR(viscosity_index(references.index_0, y), 0, 1e-11);
    EXPECT_NEAR(viscosity_index(references.index_100, y), 100, 1e-11);
    // procedures A and B meet there
    EXPECT_NEAR(viscosity_index(references.index_100 * (1 + 1e-9), y), 100, 1e-5);
    EXPECT_NEAR(viscosity_index(references.index_100 * (1 - 1e-9), y), 100, 1e-5);
  }
}

TEST(ViscosityIndex, FallsAsTheViscosityAt40Rises) {
  for (const double y : {2.5, 8.0, 15.0, 80.0}) {
    double last = INFINITY;
    for (double u = 1.2 * y; u < 120 * y; u *= 1.05) {
      const double index = viscosity_index(u, y);
      EXPECT_LT(index, last);
      last = index;
    }
    EXPECT_LT(last, 0);
  }
}

TEST(ViscosityIndex, IsRefusedWhereTheStandardIsUndefined) {
  EXPECT_THROW(viscosity_index(5, 1.99), Refusal);
  EXPECT_THROW(viscosity_index(8, 8), Refusal);
  EXPECT_THROW(viscosity_index(7, 8), Refusal);
  EXPECT_THROW(viscosity_index(-70, 8), Refusal);
  EXPECT_THROW(viscosity_index(std::nan(""), 8), Refusal);
  EXPECT_THROW(viscosity_index(70, std::nan("")), Refusal);
  EXPECT_THROW(viscosity_index(INFINITY, 8), Refusal);
  EXPECT_THROW(viscosity_index(INFINITY, INFINITY), Refusal);
}

}  // namespace
}  // namespace tribodyn
