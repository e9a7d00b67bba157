#include "server/simulation/input_fields.h"

#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>

#include "server/contract/output_only.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;

struct InputFields {
  std::string_view message;      ///< of tribodyn.v1
  std::string_view inputs;       ///< fields that are inputs, separated by spaces
  std::string_view labels = {};  ///< fields that are labels, separated by spaces
};

// Results are cached by the hash of their inputs: an input listed as a label would make different
// inputs equal. The fields of a message listed as a label are not listed themselves.
constexpr InputFields kInputFields[] = {
    {"Lubricant",
     "vogel_viscosity_prefactor_pascal_seconds vogel_temperature_coefficient_kelvin "
     "vogel_reference_temperature_kelvin pressure_viscosity_coefficient_per_pascal "
     "pressure_viscosity_temperature_kelvin relaxation_time_seconds havriliak_negami_alpha "
     "havriliak_negami_beta rheology_reference_temperature_kelvin "
     "limiting_shear_stress_at_zero_pressure_pascals limiting_shear_stress_coefficient "
     "thermal_conductivity_watts_per_metre_kelvin density_at_zero_kelvin_kilograms_per_cubic_metre "
     "density_slope_kilograms_per_cubic_metre_kelvin improved_yasutomi "
     "asperity_friction_coefficient tribofilm_shear_strength_pascals "
     "asperity_friction_by_temperature",
     "name display_name description provenance base_oil_class measurements condition "
     "derived_from external_sample_id lims_id labels flash_point_celsius pour_point_celsius"},
    {"BoundaryFrictionAtTemperature", "temperature_celsius asperity_friction_coefficient"},
    {"ImprovedYasutomi",
     "glass_viscosity_pascal_seconds glass_temperature_rise_kelvin "
     "glass_pressure_factor_per_pascal expansivity_pressure_factor_per_pascal "
     "expansivity_exponent"},
    {"GearSet",
     "pinion_teeth gear_teeth series flank_slots dynamics series_by_torque load_share_by_torque "
     "youngs_modulus_pascals poissons_ratio solid_thermal_conductivity_watts_per_metre_kelvin "
     "solid_density_kilograms_per_cubic_metre "
     "solid_specific_heat_capacity_joules_per_kilogram_kelvin",
     "name display_name description provenance derived_from external_sample_id lims_id labels"},
    {"MeshSeries",
     "pinion_torque_newton_metres pinion_contact_radius_metres gear_contact_radius_metres "
     "mesh_stiffness_newtons_per_metre static_transmission_error_metres"},
    {"FourierSeries", "mean sine cosine"},
    {"FlankSlot",
     "load_share radius_x_metres radius_y_metres pinion_velocity_x_metres pinion_velocity_y_metres "
     "gear_velocity_x_metres gear_velocity_y_metres contact_point_velocity_x_metres "
     "contact_point_velocity_y_metres pinion_friction_arm_metres gear_friction_arm_metres"},
    {"DrivelineDynamics",
     "pinion_shaft_inertia_kilogram_square_metres pinion_inertia_kilogram_square_metres "
     "gear_inertia_kilogram_square_metres wheel_inertia_kilogram_square_metres "
     "pinion_shaft_stiffness_newton_metres_per_radian "
     "gear_shaft_stiffness_newton_metres_per_radian "
     "pinion_shaft_damping_newton_metre_seconds_per_radian "
     "gear_shaft_damping_newton_metre_seconds_per_radian "
     "mesh_damping_newton_seconds_per_metre half_backlash_metres"},
    {"LoadShareAtTorque", "pinion_torque_newton_metres slots"},
    {"LoadShareAtTorque.Slot", "load_share"},
    {"Surface",
     "asperity_density_per_square_metre asperity_radius_metres composite_rms_height_metres "
     "tribofilm_shear_strength_pascals asperity_friction_coefficient",
     "name display_name description provenance measurements derived_from "
     "external_sample_id lims_id labels"},
    {"Vehicle",
     "mass_kilograms rolling_resistance_coefficient drag_coefficient frontal_area_square_metres "
     "air_density_kilograms_per_cubic_metre wheel_radius_metres gravity_metres_per_second_squared",
     "name display_name description provenance derived_from external_sample_id lims_id labels"},
    // The lines of "state" and "progress_fraction" are constant in every simulation. They stay so
    // that the hashes of stored results stay valid.
    {"Simulation",
     "sump_temperature_celsius inlet_temperature_rise_kelvin model_options "
     "solver_options operating_point inefficiency_curve state progress_fraction",
     "display_name lubricant gear_set surface vehicle deadline_seconds labels "
     "sheared_lubricant "  // the parameters of the lubricant hold its effect
     "stated_limits"},     // they change no figure
    {"ModelOptions",
     "isothermal newtonian no_limiting_shear_stress no_boundary_friction damping_in_contact_only "
     "energy_consistent subtract_contact_point_motion load_dependent_mesh_data "
     "pressure_viscosity_index exact_hertz hertz_from_total_load as_published "
     "tabulated_friction_arms inlet_shear_heating closed_load_sharing",
     "preset"},  // the options hold its effect
    {"AsPublished",
     "eq17_atan eq20_semi_major eq22_inverted_ratio eq31_32_logarithm "
     "eq43_44_polynomials eq46_square_root_of_sum"},
    {"SolverOptions",
     "march_step_tolerance march_settling_tolerance maximum_mesh_cycles recorded_mesh_cycles "
     "tolerance method"},
    {"OperatingPointStudy",
     "cruise drive_cycle_snapshot prescribed_torque model start "
     "probe_coexisting_response history sensitivities"},
    // The conditions of a grid are hashed as conditions.
    {"CampaignRig",
     "composite_rms_height_metres radius_x_metres radius_y_metres body_1 body_2 conditions",
     "grid"},
    {"RigBody",
     "youngs_modulus_pascals poissons_ratio thermal_conductivity_watts_per_metre_kelvin "
     "density_kilograms_per_cubic_metre specific_heat_capacity_joules_per_kilogram_kelvin"},
    {"RigCondition",
     "load_newtons entrainment_speed_metres_per_second slide_roll_ratio_percent "
     "supply_temperature_celsius"},
    {"Cruise", "speed_kilometres_per_hour ascent_angle_degrees"},
    {"DriveCycleSnapshot",
     "speed_kilometres_per_hour acceleration_metres_per_second_squared ascent_angle_degrees"},
    {"PrescribedTorque", "pinion_torque_newton_metres pinion_speed_radians_per_second"},
    {"HistoryRequest", "columns mesh_cycles samples_per_mesh_cycle"},
    {"InefficiencyCurveStudy",
     "speeds_kilometres_per_hour first_speed_kilometres_per_hour "
     "last_speed_kilometres_per_hour speed_step_kilometres_per_hour direction "
     "ascent_angle_degrees model start independent_points sensitivities"},
};

std::unordered_map<const FieldDescriptor*, InputRole> roles_by_field() {
  const auto& pool = *google::protobuf::DescriptorPool::generated_pool();
  std::unordered_map<const FieldDescriptor*, InputRole> out;
  for (const InputFields& row : kInputFields) {
    const std::string message = "tribodyn.v1." + std::string(row.message);
    const auto add = [&](std::string_view fields, InputRole role) {
      std::istringstream words{std::string(fields)};
      for (std::string field; words >> field;) {
        const FieldDescriptor* found = pool.FindFieldByName(message + "." + field);
        if (found == nullptr) throw std::logic_error("no such field: " + message + "." + field);
        out.emplace(found, role);
      }
    };
    add(row.inputs, InputRole::kInput);
    add(row.labels, InputRole::kLabel);
  }
  return out;
}

}  // namespace

InputRole input_role(const FieldDescriptor& field) {
  static const std::unordered_map<const FieldDescriptor*, InputRole> roles = roles_by_field();
  const auto found = roles.find(&field);
  if (found != roles.end()) return found->second;
  return is_output_only(field) ? InputRole::kOutput : InputRole::kUnclassified;
}

}  // namespace tribodyn::server
