#include "server/mapping/to_core.h"

#include <algorithm>
#include <array>
#include <optional>

namespace tribodyn::server {
namespace {

FourierSeries series(const v1::FourierSeries& message) {
  return {.mean = message.mean(),
          .sine = {message.sine().begin(), message.sine().end()},
          .cosine = {message.cosine().begin(), message.cosine().end()}};
}

MeshSeries mesh_series(const v1::MeshSeries& message) {
  return {.pinion_contact_radius = series(message.pinion_contact_radius_metres()),
          .gear_contact_radius = series(message.gear_contact_radius_metres()),
          .mesh_stiffness = series(message.mesh_stiffness_newtons_per_metre()),
          .static_transmission_error = series(message.static_transmission_error_metres())};
}

using Column = google::protobuf::RepeatedField<double>;

void copy(const Column& from, std::vector<double>& to) { to.assign(from.begin(), from.end()); }

ToothContactTables tables(const v1::GearSet& message) {
  ToothContactTables out;
  const int slots = std::min(message.flank_slots_size(), kFlankPairs);
  for (int i = 0; i < slots; ++i) {
    const v1::FlankSlot& slot = message.flank_slots(i);
    const auto k = static_cast<std::size_t>(i);
    copy(slot.load_share(), out.load_share[k]);
    copy(slot.radius_x_metres(), out.radius_x[k]);
    copy(slot.radius_y_metres(), out.radius_y[k]);
    copy(slot.pinion_velocity_x_metres(), out.pinion_velocity_x[k]);
    copy(slot.pinion_velocity_y_metres(), out.pinion_velocity_y[k]);
    copy(slot.gear_velocity_x_metres(), out.gear_velocity_x[k]);
    copy(slot.gear_velocity_y_metres(), out.gear_velocity_y[k]);
    copy(slot.contact_point_velocity_x_metres(), out.contact_point_velocity_x[k]);
    copy(slot.contact_point_velocity_y_metres(), out.contact_point_velocity_y[k]);
    copy(slot.pinion_friction_arm_metres(), out.pinion_friction_arm[k]);
    copy(slot.gear_friction_arm_metres(), out.gear_friction_arm[k]);
  }
  return out;
}

DrivelineDynamics dynamics(const v1::DrivelineDynamics& message) {
  return {.pinion_shaft_inertia = message.pinion_shaft_inertia_kilogram_square_metres(),
          .pinion_inertia = message.pinion_inertia_kilogram_square_metres(),
          .gear_inertia = message.gear_inertia_kilogram_square_metres(),
          .wheel_inertia = message.wheel_inertia_kilogram_square_metres(),
          .pinion_shaft_stiffness = message.pinion_shaft_stiffness_newton_metres_per_radian(),
          .gear_shaft_stiffness = message.gear_shaft_stiffness_newton_metres_per_radian(),
          .pinion_shaft_damping = message.pinion_shaft_damping_newton_metre_seconds_per_radian(),
          .gear_shaft_damping = message.gear_shaft_damping_newton_metre_seconds_per_radian(),
          .mesh_damping = message.mesh_damping_newton_seconds_per_metre(),
          .half_backlash = message.half_backlash_metres()};
}

PressureViscosityLaw law_of(const v1::Lubricant& message) {
  return message.has_improved_yasutomi() ? PressureViscosityLaw::kImprovedYasutomi
                                         : PressureViscosityLaw::kRoelands;
}

std::array<double, kMostLawParameters> law_parameters_of(const v1::Lubricant& message) {
  if (!message.has_improved_yasutomi()) return {};
  const v1::ImprovedYasutomi& law = message.improved_yasutomi();
  return {law.glass_viscosity_pascal_seconds(), law.glass_temperature_rise_kelvin(),
          law.glass_pressure_factor_per_pascal(), law.expansivity_pressure_factor_per_pascal(),
          law.expansivity_exponent()};
}

}  // namespace

Lubricant to_core(const v1::Lubricant& message) {
  return {.vogel_viscosity_prefactor = message.vogel_viscosity_prefactor_pascal_seconds(),
          .vogel_temperature_coefficient = message.vogel_temperature_coefficient_kelvin(),
          .vogel_reference_temperature = message.vogel_reference_temperature_kelvin(),
          .pressure_viscosity_coefficient = message.pressure_viscosity_coefficient_per_pascal(),
          .pressure_viscosity_temperature = message.pressure_viscosity_temperature_kelvin(),
          .relaxation_time = message.relaxation_time_seconds(),
          .havriliak_negami_alpha = message.havriliak_negami_alpha(),
          .havriliak_negami_beta = message.havriliak_negami_beta(),
          .rheology_reference_temperature = message.rheology_reference_temperature_kelvin(),
          .limiting_shear_stress_at_zero_pressure =
              message.limiting_shear_stress_at_zero_pressure_pascals(),
          .limiting_shear_stress_coefficient = message.limiting_shear_stress_coefficient(),
          .thermal_conductivity = message.thermal_conductivity_watts_per_metre_kelvin(),
          .density_at_zero_kelvin = message.density_at_zero_kelvin_kilograms_per_cubic_metre(),
          .density_temperature_slope = message.density_slope_kilograms_per_cubic_metre_kelvin(),
          .pressure_viscosity_law = law_of(message),
          .law_parameters = law_parameters_of(message)};
}

LubricantBoundary lubricant_boundary(const v1::Lubricant& message) {
  LubricantBoundary out;
  if (message.has_tribofilm_shear_strength_pascals()) {
    out.tribofilm_shear_strength = message.tribofilm_shear_strength_pascals();
  }
  if (message.has_asperity_friction_coefficient()) {
    out.asperity_friction_coefficient = message.asperity_friction_coefficient();
  }
  for (const v1::BoundaryFrictionAtTemperature& each : message.asperity_friction_by_temperature()) {
    out.coefficient_by_temperature.emplace_back(each.temperature_celsius() + kZeroCelsius,
                                                each.asperity_friction_coefficient());
  }
  return out;
}

template <class Message>
Roughness roughness(const Message& message) {
  return {.asperity_density = message.asperity_density_per_square_metre(),
          .asperity_radius = message.asperity_radius_metres(),
          .composite_rms_height = message.composite_rms_height_metres()};
}
template Roughness roughness(const v1::Surface&);
template Roughness roughness(const v1::EvaluateContactRequest&);

template <class Message>
BoundaryFriction boundary_friction(const Message& message) {
  return {.tribofilm_shear_strength = message.tribofilm_shear_strength_pascals(),
          .asperity_friction_coefficient = message.asperity_friction_coefficient()};
}
template BoundaryFriction boundary_friction(const v1::Surface&);
template BoundaryFriction boundary_friction(const v1::EvaluateContactRequest&);

template <class Message>
Solid solid(const Message& message) {
  return {
      .youngs_modulus = message.youngs_modulus_pascals(),
      .poissons_ratio = message.poissons_ratio(),
      .thermal_conductivity = message.solid_thermal_conductivity_watts_per_metre_kelvin(),
      .density = message.solid_density_kilograms_per_cubic_metre(),
      .specific_heat_capacity = message.solid_specific_heat_capacity_joules_per_kilogram_kelvin()};
}
template Solid solid(const v1::GearSet&);
template Solid solid(const v1::EvaluateContactRequest&);

Vehicle to_core(const v1::Vehicle& message) {
  return {.mass = message.mass_kilograms(),
          .rolling_resistance_coefficient = message.rolling_resistance_coefficient(),
          .drag_coefficient = message.drag_coefficient(),
          .frontal_area = message.frontal_area_square_metres(),
          .air_density = message.air_density_kilograms_per_cubic_metre(),
          .wheel_radius = message.wheel_radius_metres(),
          .gravity = message.gravity_metres_per_second_squared()};
}

ModelOptions to_core(const v1::ModelOptions& message) {
  const v1::AsPublished& published = message.as_published();
  const ModelOptions preset =
      message.preset() == v1::ModelOptions::PAPER ? ModelOptions{} : recommended_model();
  return {
      .isothermal = message.isothermal(),
      .newtonian = message.newtonian(),
      .no_limiting_shear_stress = message.no_limiting_shear_stress(),
      .no_boundary_friction = message.no_boundary_friction(),
      .damping_in_contact_only = message.damping_in_contact_only(),
      .energy_consistent = message.energy_consistent(),
      .subtract_contact_point_motion = message.subtract_contact_point_motion(),
      .load_dependent_mesh_data = message.load_dependent_mesh_data(),
      .tabulated_friction_arms = message.tabulated_friction_arms(),
      .inlet_shear_heating = message.has_inlet_shear_heating() ? message.inlet_shear_heating()
                                                               : preset.inlet_shear_heating,
      .closed_load_sharing = message.has_closed_load_sharing() ? message.closed_load_sharing()
                                                               : preset.closed_load_sharing,
      .pressure_viscosity_index =
          message.pressure_viscosity_index() == v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT
              ? PressureViscosityIndex::kHoupert
              : PressureViscosityIndex::kReciprocalAsymptotic,
      .hertz_solution = message.exact_hertz() ? HertzSolution::kExact : HertzSolution::kSimplified,
      .hertz_load = message.hertz_from_total_load() ? HertzLoad::kTotalLoad : HertzLoad::kFilmLoad,
      .as_published = {.eq17_atan = published.eq17_atan(),
                       .eq20_semi_major = published.eq20_semi_major(),
                       .eq22_inverted_ratio = published.eq22_inverted_ratio(),
                       .eq31_32_logarithm = published.eq31_32_logarithm(),
                       .eq43_44_polynomials = published.eq43_44_polynomials()}};
}

GearSet to_core(const v1::GearSet& message) {
  GearSet out;
  out.pinion_teeth = message.pinion_teeth();
  out.gear_teeth = message.gear_teeth();
  out.series = mesh_series(message.series());
  out.tables = tables(message);
  out.dynamics = dynamics(message.dynamics());
  for (const v1::MeshSeries& entry : message.series_by_torque()) {
    out.series_by_torque.push_back({entry.pinion_torque_newton_metres(), mesh_series(entry)});
  }
  for (const v1::LoadShareAtTorque& entry : message.load_share_by_torque()) {
    GearSet::LoadShareAtTorque at_torque{entry.pinion_torque_newton_metres(), {}};
    const int slots = std::min(entry.slots_size(), kFlankPairs);
    for (int i = 0; i < slots; ++i) {
      copy(entry.slots(i).load_share(), at_torque.load_share[static_cast<std::size_t>(i)]);
    }
    out.load_share_by_torque.push_back(std::move(at_torque));
  }
  return out;
}

ContactConditions contact_conditions(const v1::EvaluateContactRequest& message) {
  return {.load = message.load_newtons(),
          .radius_x = message.radius_x_metres(),
          .radius_y = message.radius_y_metres(),
          .velocity_1_x = message.pinion_velocity_x_metres_per_second(),
          .velocity_1_y = message.pinion_velocity_y_metres_per_second(),
          .velocity_2_x = message.gear_velocity_x_metres_per_second(),
          .velocity_2_y = message.gear_velocity_y_metres_per_second()};
}

StatedLimits to_core(const v1::StatedLimits& message) {
  const auto unless_zero = [](double value, double offset = 0) -> std::optional<double> {
    if (value == 0) return std::nullopt;
    return value + offset;
  };
  return {.film_ratio_minimum = unless_zero(message.minimum_film_ratio()),
          .pressure_maximum = unless_zero(message.pressure_limit_pascals()),
          .contact_temperature_maximum =
              unless_zero(message.contact_temperature_limit_celsius(), kZeroCelsius),
          .flash_temperature_maximum = unless_zero(message.flash_temperature_rise_limit_kelvin()),
          .source = message.limit_source()};
}

}  // namespace tribodyn::server
