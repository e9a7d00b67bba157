// core/SENSITIVITIES.md states what the core computes; TRIBODYN_RENEW_SENSITIVITIES=1 writes it
// anew.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/study/operating_point.h"
#include "tests/support/cruise.h"
#include "tests/support/paths.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

constexpr double kSpeeds[] = {20, 40, 60, 75, 100, 140};  // [km/h]; at 75 the flanks part

struct Row {
  const char* parameter;
  const char* words;
};
constexpr Row kRows[] = {
    {"lubricant.vogel_viscosity_prefactor", "viscosity at all temperatures"},
    {"lubricant.pressure_viscosity_coefficient", "pressure-viscosity coefficient"},
    {"lubricant.relaxation_time", "relaxation time"},
    {"lubricant.limiting_shear_stress_coefficient", "limiting shear stress over pressure"},
    {"lubricant.thermal_conductivity", "thermal conductivity"},
    {"boundary.asperity_friction_coefficient", "friction coefficient of asperities"},
    {"sump_temperature", "sump temperature, from 0 K"},
};

constexpr char kHead[] = R"(# What moves the inefficiency

Elasticities of the energy-mean inefficiency: a parameter that rises by 1 % moves it by so many percent.
Fluid 1 of the paper in the reference axle, run-in surface, sump at 40 C, cruise on the level, recommended
model. At 75 km/h the flanks part. They are exact derivatives (`tribodyn sensitivities`); a test computes
this table.

| parameter | 20 km/h | 40 km/h | 60 km/h | 75 km/h | 100 km/h | 140 km/h |
|---|---:|---:|---:|---:|---:|---:|
)";

/// By row of kRows and speed.
std::vector<std::vector<double>> elasticities() {
  std::vector<std::vector<double>> out(std::size(kRows));
  Scene scene = reference_scene();
  scene.options = recommended_model();
  PointOptions options;
  options.tolerance = 1e-5;
  options.model = PointModel::kFull;
  options.sensitivities = true;
  for (const double speed : kSpeeds) {
    const PointResult point = solve_operating_point(scene, cruise(speed), options);
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (const ParameterSensitivity& each : point.sensitivities.value().parameters) {
        if (each.parameter != kRows[i].parameter) continue;
        out[i].push_back(
            point.sensitivities->elasticity(each, OrbitFigure::kInefficiencyEnergyMean));
      }
    }
  }
  return out;
}

std::string document(const std::vector<std::vector<double>>& values) {
  std::string out = kHead;
  for (std::size_t i = 0; i < values.size(); ++i) {
    out += std::string("| ") + kRows[i].words + " |";
    for (const double each : values[i]) {
      char cell[32];
      std::snprintf(cell, sizeof cell, " %.3f |", each);
      out += cell;
    }
    out += "\n";
  }
  return out;
}

/// The numbers of the rows of the table.
std::vector<std::vector<double>> numbers_in(const std::string& text) {
  std::vector<std::vector<double>> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ") || line.starts_with("| parameter")) continue;
    std::istringstream cells(line.substr(line.find('|', 2) + 1));
    out.emplace_back();
    for (std::string cell; std::getline(cells, cell, '|');) {
      if (cell.find_first_of("0123456789") != std::string::npos) {
        out.back().push_back(std::stod(cell));
      }
    }
  }
  return out;
}

TEST(SensitivitiesDocument, StatesWhatTheCoreComputes) {
  const auto found = elasticities();
  const std::string path = test_data_file("../../core/SENSITIVITIES.md");
  if (std::getenv("TRIBODYN_RENEW_SENSITIVITIES") != nullptr) {
    std::ofstream(path) << document(found);
  }
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  const auto stated = numbers_in(text.str());
  EXPECT_TRUE(text.str().starts_with(kHead));
  ASSERT_EQ(stated.size(), std::size(kRows));
  for (std::size_t i = 0; i < stated.size(); ++i) {
    ASSERT_EQ(found[i].size(), std::size(kSpeeds)) << kRows[i].parameter;
    ASSERT_EQ(stated[i].size(), std::size(kSpeeds)) << kRows[i].parameter;
    for (std::size_t k = 0; k < std::size(kSpeeds); ++k) {
      EXPECT_NEAR(stated[i][k], found[i][k], 0.001) << kRows[i].parameter << ", " << kSpeeds[k];
    }
  }
}

}  // namespace
}  // namespace tribodyn
