#include "server/simulation/fluid_grounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "server/mapping/to_core.h"
#include "server/resources/provenance.h"

namespace tribodyn::server {
namespace {

/// Range of the paper's measurements: 10 to 140 C (section 2.3).
constexpr FluidGrounds::TemperatureRange kMeasuredInThePaper = {10 + kZeroCelsius,
                                                                140 + kZeroCelsius};

v1::Provenance provenance_of(const v1::Lubricant& lubricant, const char* field) {
  const v1::ParameterProvenance* entry = find_provenance(lubricant.provenance(), field);
  return entry == nullptr ? v1::PROVENANCE_UNSPECIFIED : entry->provenance();
}

std::optional<FluidGrounds::TemperatureRange> measured_range(
    const v1::LubricantMeasurements& measured) {
  std::vector<double> celsius;
  if (measured.kinematic_viscosity_40_celsius_square_millimetres_per_second() != 0) {
    celsius.push_back(40);
  }
  if (measured.kinematic_viscosity_100_celsius_square_millimetres_per_second() != 0) {
    celsius.push_back(100);
  }
  for (const auto& row : measured.viscosities()) celsius.push_back(row.temperature_celsius());
  for (const auto& row : measured.brookfield_viscosities()) {
    celsius.push_back(row.temperature_celsius());
  }
  if (celsius.empty()) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(celsius.begin(), celsius.end());
  return FluidGrounds::TemperatureRange{*lowest + kZeroCelsius, *highest + kZeroCelsius};
}

}  // namespace

FluidGrounds fluid_grounds(const v1::Lubricant& lubricant) {
  FluidGrounds out;
  switch (provenance_of(lubricant, "vogel_viscosity_prefactor_pascal_seconds")) {
    case v1::PROVENANCE_PUBLISHED:
      out.viscosity_measured = kMeasuredInThePaper;
      break;
    case v1::PROVENANCE_FITTED:
      out.viscosity_measured = measured_range(lubricant.measurements());
      break;
    default:
      break;
  }
  switch (provenance_of(lubricant, "limiting_shear_stress_coefficient")) {
    case v1::PROVENANCE_PUBLISHED:
      out.limiting_stress = FluidGrounds::LimitingStress::kMeasuredAtForty;
      break;
    case v1::PROVENANCE_ASSUMED:
      out.limiting_stress = FluidGrounds::LimitingStress::kEstimated;
      break;
    default:
      break;
  }
  return out;
}

std::string text_of(const FluidGrounds& grounds) {
  const auto& range = grounds.viscosity_measured;
  return fmt::format("fluid_grounds={} {}\n",
                     range ? fmt::format("{} {}", range->lowest, range->highest) : "unknown",
                     static_cast<int>(grounds.limiting_stress));
}

}  // namespace tribodyn::server
