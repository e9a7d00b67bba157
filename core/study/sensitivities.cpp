#include "core/study/sensitivities.h"

#include <string>

#include "core/study/point_options.h"
#include "core/vehicle/vehicle.h"

namespace tribodyn {
namespace {

using Figures = std::array<double, kOrbitFigures>;

/// A parameter of the scene, and the inputs of a contact that it is.
struct SceneParameter {
  std::string name;
  const char* unit;
  double value;
  std::vector<ContactInput> inputs;
};

/// Parameters of the pressure-viscosity law that the lubricant follows.
std::vector<SceneParameter> of_pressure_response(const Lubricant& l) {
  using enum ContactInput;
  if (l.pressure_viscosity_law == PressureViscosityLaw::kRoelands) {
    return {{"lubricant.pressure_viscosity_coefficient",
             "1/Pa",
             l.pressure_viscosity_coefficient,
             {kPressureViscosityCoefficient}},
            {"lubricant.pressure_viscosity_temperature",
             "K",
             l.pressure_viscosity_temperature,
             {kPressureViscosityTemperature}}};
  }
  std::vector<SceneParameter> out;
  for (const LawDescription& each : kLawDescriptions) {
    if (each.law != l.pressure_viscosity_law) continue;
    for (std::size_t k = 0; k < each.parameters.size() && each.parameters[k].name; ++k) {
      out.push_back({std::string("lubricant.") + each.name + "." + each.parameters[k].name,
                     each.parameters[k].unit,
                     l.law_parameters[k],
                     {static_cast<ContactInput>(static_cast<int>(kLawParameters) + k)}});
    }
  }
  return out;
}

std::vector<SceneParameter> scene_parameters(const Scene& s) {
  using enum ContactInput;
  const Lubricant& l = s.lubricant;
  const BoundaryFriction boundary = boundary_friction(s);
  const LubricantBoundary& of_lubricant = s.lubricant_boundary;
  std::vector<SceneParameter> out = {
      {"lubricant.vogel_viscosity_prefactor",
       "Pa s",
       l.vogel_viscosity_prefactor,
       {kVogelViscosityPrefactor}},
      {"lubricant.vogel_temperature_coefficient",
       "K",
       l.vogel_temperature_coefficient,
       {kVogelTemperatureCoefficient}},
      {"lubricant.vogel_reference_temperature",
       "K",
       l.vogel_reference_temperature,
       {kVogelReferenceTemperature}},
      {"lubricant.relaxation_time", "s", l.relaxation_time, {kRelaxationTime}},
      {"lubricant.havriliak_negami_alpha", "1", l.havriliak_negami_alpha, {kHavriliakNegamiAlpha}},
      {"lubricant.havriliak_negami_beta", "1", l.havriliak_negami_beta, {kHavriliakNegamiBeta}},
      {"lubricant.rheology_reference_temperature",
       "K",
       l.rheology_reference_temperature,
       {kRheologyReferenceTemperature}},
      {"lubricant.limiting_shear_stress_at_zero_pressure",
       "Pa",
       l.limiting_shear_stress_at_zero_pressure,
       {kLimitingShearStressAtZeroPressure}},
      {"lubricant.limiting_shear_stress_coefficient",
       "1",
       l.limiting_shear_stress_coefficient,
       {kLimitingShearStressCoefficient}},
      {"lubricant.thermal_conductivity", "W/(m K)", l.thermal_conductivity, {kThermalConductivity}},
      {"lubricant.density_at_zero_kelvin",
       "kg/m3",
       l.density_at_zero_kelvin,
       {kDensityAtZeroKelvin}},
      {"lubricant.density_temperature_slope",
       "kg/(m3 K)",
       l.density_temperature_slope,
       {kDensityTemperatureSlope}},
      {"roughness.asperity_density", "1/m2", s.roughness.asperity_density, {kAsperityDensity}},
      {"roughness.asperity_radius", "m", s.roughness.asperity_radius, {kAsperityRadius}},
      {"roughness.composite_rms_height",
       "m",
       s.roughness.composite_rms_height,
       {kCompositeRmsHeight}},
      {of_lubricant.tribofilm_shear_strength ? "lubricant.tribofilm_shear_strength"
                                             : "boundary.tribofilm_shear_strength",
       "Pa",
       boundary.tribofilm_shear_strength,
       {kTribofilmShearStrength}},
      {of_lubricant.asperity_friction_coefficient ? "lubricant.asperity_friction_coefficient"
       : of_lubricant.coefficient_by_temperature.empty()
           ? "boundary.asperity_friction_coefficient"
           : "lubricant.asperity_friction_by_temperature",
       "1",
       boundary.asperity_friction_coefficient,
       {kAsperityFrictionCoefficient}},
      {"solid.youngs_modulus",
       "Pa",
       s.solid.youngs_modulus,
       {kBody1YoungsModulus, kBody2YoungsModulus}},
      {"solid.poissons_ratio",
       "1",
       s.solid.poissons_ratio,
       {kBody1PoissonsRatio, kBody2PoissonsRatio}},
      {"solid.thermal_conductivity",
       "W/(m K)",
       s.solid.thermal_conductivity,
       {kBody1ThermalConductivity, kBody2ThermalConductivity}},
      {"solid.density", "kg/m3", s.solid.density, {kBody1Density, kBody2Density}},
      {"solid.specific_heat_capacity",
       "J/(kg K)",
       s.solid.specific_heat_capacity,
       {kBody1SpecificHeatCapacity, kBody2SpecificHeatCapacity}},
      {"sump_temperature", "K", s.sump_temperature, {kBathTemperature}},
      {"inlet_temperature_rise", "K", s.inlet_temperature_rise, {kInletTemperatureRise}}};
  const std::vector<SceneParameter> pressure_response = of_pressure_response(l);
  out.insert(out.begin() + 3, pressure_response.begin(), pressure_response.end());
  return out;
}

/// dT_w/du_v of eq 7 [N m s/m]. T_w is a parabola in u_v, so the difference is exact.
double wheel_torque_by_speed(const Scene& scene, const OperatingCondition& c) {
  const double step = 1e-3 * c.vehicle_speed;
  const double acceleration =
      c.kind == OperatingCondition::Kind::kDriveCycleSnapshot ? c.acceleration : 0;
  const auto torque = [&](double speed) {
    return wheel_torque(scene.vehicle, speed, c.ascent_angle, acceleration);
  };
  return (torque(c.vehicle_speed + step) - torque(c.vehicle_speed - step)) / (2 * step);
}

}  // namespace

PointSensitivities point_sensitivities(const Scene& scene, const OperatingCondition& condition,
                                       const Torques& torques, const OrbitSensitivity& orbit) {
  PointSensitivities out{orbit.figure, {}, orbit.one_sided};
  const auto of_column = [&](int column) {
    Figures by;
    for (int f = 0; f < kOrbitFigures; ++f) by[f] = orbit.derivative[f][column];
    return by;
  };
  for (const SceneParameter& each : scene_parameters(scene)) {
    Figures by{};
    for (const ContactInput input : each.inputs) {
      const Figures column = of_column(static_cast<int>(input));
      for (int f = 0; f < kOrbitFigures; ++f) by[f] += column[f];
    }
    out.parameters.push_back({each.name, each.unit, each.value, by});
  }
  Figures by_speed = of_column(kMeanSpeedParameter);
  const Figures by_torque = of_column(kKnownTorqueParameter);
  if (condition.kind == OperatingCondition::Kind::kPrescribedTorque) {
    out.parameters.push_back({"pinion_speed", "rad/s", condition.pinion_speed, by_speed});
    out.parameters.push_back({"pinion_torque", "N m", torques.pinion, by_torque});
    return out;
  }
  const double turns = static_cast<double>(scene.gear_set.gear_teeth) /
                       (scene.gear_set.pinion_teeth * scene.vehicle.wheel_radius);
  const double torque = wheel_torque_by_speed(scene, condition);
  for (int f = 0; f < kOrbitFigures; ++f) by_speed[f] = turns * by_speed[f] + torque * by_torque[f];
  out.parameters.push_back({"vehicle_speed", "m/s", condition.vehicle_speed, by_speed});
  out.parameters.push_back({"wheel_torque", "N m", torques.wheel, by_torque});
  return out;
}

}  // namespace tribodyn
