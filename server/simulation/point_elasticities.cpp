#include "server/simulation/point_elasticities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "server/contract/constraints.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

using Strings = google::protobuf::RepeatedPtrField<std::string>;

const std::map<std::string_view, OrbitFigure>& differentiated_figures() {
  static const std::map<std::string_view, OrbitFigure> out = {
      {"inefficiency_rms_percent", OrbitFigure::kInefficiencyRms},
      {kDefaultElasticityFigure, OrbitFigure::kInefficiencyEnergyMean},
      {"mesh_loss_power_watts", OrbitFigure::kMeshLossPower},
      {"mesh_loss_torque_newton_metres", OrbitFigure::kMeshLossTorque},
      {"pinion_friction_torque_mean_newton_metres", OrbitFigure::kPinionFrictionTorque},
      {"film_ratio_mean", OrbitFigure::kFilmRatio},
      {"contact_temperature_mean_kelvin", OrbitFigure::kContactTemperature},
      {"dynamic_transmission_error_minimum_metres", OrbitFigure::kTransmissionErrorMinimum},
      {"dynamic_transmission_error_maximum_metres", OrbitFigure::kTransmissionErrorMaximum}};
  return out;
}

/// Returns the names of PointSensitivities for parameters of candidates, gear set and conditions.
const std::map<std::string_view, std::string_view>& scene_parameter_names() {
  static const std::map<std::string_view, std::string_view> out = {
      {"lubricant.vogel_viscosity_prefactor_pascal_seconds", "lubricant.vogel_viscosity_prefactor"},
      {"lubricant.vogel_temperature_coefficient_kelvin", "lubricant.vogel_temperature_coefficient"},
      {"lubricant.vogel_reference_temperature_kelvin", "lubricant.vogel_reference_temperature"},
      {"lubricant.pressure_viscosity_coefficient_per_pascal",
       "lubricant.pressure_viscosity_coefficient"},
      {"lubricant.pressure_viscosity_temperature_kelvin",
       "lubricant.pressure_viscosity_temperature"},
      {"lubricant.relaxation_time_seconds", "lubricant.relaxation_time"},
      {"lubricant.havriliak_negami_alpha", "lubricant.havriliak_negami_alpha"},
      {"lubricant.havriliak_negami_beta", "lubricant.havriliak_negami_beta"},
      {"lubricant.rheology_reference_temperature_kelvin",
       "lubricant.rheology_reference_temperature"},
      {"lubricant.limiting_shear_stress_at_zero_pressure_pascals",
       "lubricant.limiting_shear_stress_at_zero_pressure"},
      {"lubricant.limiting_shear_stress_coefficient",
       "lubricant.limiting_shear_stress_coefficient"},
      {"lubricant.thermal_conductivity_watts_per_metre_kelvin", "lubricant.thermal_conductivity"},
      {"lubricant.density_at_zero_kelvin_kilograms_per_cubic_metre",
       "lubricant.density_at_zero_kelvin"},
      {"lubricant.density_slope_kilograms_per_cubic_metre_kelvin",
       "lubricant.density_temperature_slope"},
      {"lubricant.improved_yasutomi.glass_viscosity_pascal_seconds",
       "lubricant.improved_yasutomi.glass_viscosity"},
      {"lubricant.improved_yasutomi.glass_temperature_rise_kelvin",
       "lubricant.improved_yasutomi.glass_temperature_rise"},
      {"lubricant.improved_yasutomi.glass_pressure_factor_per_pascal",
       "lubricant.improved_yasutomi.glass_pressure_factor"},
      {"lubricant.improved_yasutomi.expansivity_pressure_factor_per_pascal",
       "lubricant.improved_yasutomi.expansivity_pressure_factor"},
      {"lubricant.improved_yasutomi.expansivity_exponent",
       "lubricant.improved_yasutomi.expansivity_exponent"},
      {"surface.asperity_density_per_square_metre", "roughness.asperity_density"},
      {"surface.asperity_radius_metres", "roughness.asperity_radius"},
      {"surface.composite_rms_height_metres", "roughness.composite_rms_height"},
      {"lubricant.tribofilm_shear_strength_pascals", "lubricant.tribofilm_shear_strength"},
      {"lubricant.asperity_friction_coefficient", "lubricant.asperity_friction_coefficient"},
      {"surface.tribofilm_shear_strength_pascals", "boundary.tribofilm_shear_strength"},
      {"surface.asperity_friction_coefficient", "boundary.asperity_friction_coefficient"},
      {"gear_set.youngs_modulus_pascals", "solid.youngs_modulus"},
      {"gear_set.poissons_ratio", "solid.poissons_ratio"},
      {"gear_set.solid_thermal_conductivity_watts_per_metre_kelvin", "solid.thermal_conductivity"},
      {"gear_set.solid_density_kilograms_per_cubic_metre", "solid.density"},
      {"gear_set.solid_specific_heat_capacity_joules_per_kilogram_kelvin",
       "solid.specific_heat_capacity"},
      {"sump_temperature_celsius", "sump_temperature"},
      {"inlet_temperature_rise_kelvin", "inlet_temperature_rise"},
      {"speed_kilometres_per_hour", "vehicle_speed"},
      {"wheel_torque_newton_metres", "wheel_torque"}};
  return out;
}

/// Checks that each name is one of the allowed ones, and is there once. `what` says what the
/// allowed ones are.
template <class Value>
void check_names(const Strings& names, const std::map<std::string_view, Value>& allowed,
                 const std::string& path, const char* what, Violations& violations) {
  std::set<std::string> found;
  for (int i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    const std::string at = fmt::format("{}[{}]", path, i);
    if (!allowed.contains(name)) {
      std::vector<std::string> all;
      for (const auto& [each, value] : allowed) all.emplace_back(each);
      violations.add(at, "\"{}\" is no {}{}", plain_excerpt(name), what, meant_text(name, all));
    } else if (!found.insert(name).second) {
      violations.add(at, "\"{}\" is listed twice; allowed: once", name);
    }
  }
}

}  // namespace

std::vector<Elasticity> read_elasticities(const v1::EvaluatePointsRequest& request,
                                          Violations& violations) {
  const std::size_t before = violations.size();
  check_names(request.elasticity_parameters(), scene_parameter_names(), "elasticity_parameters",
              "parameter by which figures are differentiated", violations);
  check_names(request.elasticity_figures(), differentiated_figures(), "elasticity_figures",
              "figure that is differentiated", violations);
  if (request.elasticity_parameters().empty() && !request.elasticity_figures().empty()) {
    violations.add("elasticity_parameters",
                   "not set; allowed: at least one with elasticity_figures");
  }
  if (violations.size() > before) return {};
  Strings figures = request.elasticity_figures();
  if (figures.empty()) *figures.Add() = kDefaultElasticityFigure;
  std::vector<Elasticity> out;
  for (const std::string& figure : figures) {
    for (const std::string& parameter : request.elasticity_parameters()) {
      out.push_back({figure, parameter, differentiated_figures().at(figure),
                     scene_parameter_names().at(parameter)});
    }
  }
  return out;
}

std::vector<double> elasticity_values(const std::optional<PointSensitivities>& sensitivities,
                                      const std::vector<Elasticity>& elasticities) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> out(elasticities.size(), kNone);
  if (!sensitivities) return out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& all = sensitivities->parameters;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) {
      return each.parameter == elasticities[i].scene_parameter;
    });
    if (found == all.end()) {
      out[i] = 0;  // a parameter that the point does not have: of another law, or overridden
      continue;
    }
    const double value = sensitivities->elasticity(*found, elasticities[i].orbit_figure);
    if (std::isfinite(value)) out[i] = value;
  }
  return out;
}

}  // namespace tribodyn::server
