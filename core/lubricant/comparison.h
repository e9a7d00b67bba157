#pragma once

#include <optional>
#include <vector>

#include "core/laws/lubricant.h"
#include "core/model_options.h"

namespace tribodyn {

/// The figures by which two lubricants are told apart.
struct LubricantFigures {
  double kinematic_viscosity_40, kinematic_viscosity_100;  ///< [m2/s]
  std::optional<double> viscosity_index;                   ///< ASTM D2270
  struct AtTemperature {
    double temperature;                     ///< [K]
    double viscosity;                       ///< eq 34 [Pa s]
    double viscosity_at_gigapascal;         ///< at 1 GPa [Pa s]
    double pressure_viscosity_coefficient;  ///< alpha* of eq 33 [1/Pa]
  };
  std::vector<AtTemperature> at;  ///< 40, 70, 100 C; only where the laws hold
};

/// Throws Refusal PRESSURE_VISCOSITY_INDEX if Roelands's law is to be used and has no index.
LubricantFigures lubricant_figures(const Lubricant& lubricant, const ModelOptions& options);

}  // namespace tribodyn
