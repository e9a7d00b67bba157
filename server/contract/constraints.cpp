#include "server/contract/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "proto/field_behavior.h"
#include "proto/resource_kinds.h"
#include "server/support/text.h"

namespace tribodyn::server {
namespace {

/// The batches of a kind of resource.
#define TRIBODYN_BATCHES(Resource, field, collection, seed) \
  "BatchCreate" #Resource "sRequest BatchUpdate" #Resource "sRequest "

/// A row whose first column names several messages, separated by spaces, is a row of each of them.
constexpr Constraint kTable[] = {
    // message or messages, field, unit, minimum, maximum, equation, reason, zero
    {"Lubricant", "vogel_viscosity_prefactor_pascal_seconds", "Pa s", 1e-12, 1e3, "eq 34, eta_ref"},
    {"Lubricant", "vogel_temperature_coefficient_kelvin", "K", 1, 1e5, "eq 34, A_1"},
    {"Lubricant", "vogel_reference_temperature_kelvin", "K", 0, 400, "eq 34, T_0,ref"},
    {"Lubricant", "pressure_viscosity_coefficient_per_pascal", "1/Pa", 1e-10, 1e-6,
     "eq 33, alpha*"},
    {"Lubricant", "pressure_viscosity_temperature_kelvin", "K", 150, 600, "eq 33",
     "where alpha* was measured"},
    {"Lubricant", "relaxation_time_seconds", "s", 0, 10, "eq 24, lambda"},
    {"Lubricant", "havriliak_negami_alpha", "", 0.01, 5, "eq 24, alpha"},
    {"Lubricant", "havriliak_negami_beta", "", 0, 5, "eq 24, beta"},
    {"Lubricant", "rheology_reference_temperature_kelvin", "K", 150, 600, "eq 25, T_ref"},
    {"Lubricant", "limiting_shear_stress_at_zero_pressure_pascals", "Pa", 0, 1e10, "eq 23, tau_L0"},
    {"Lubricant", "limiting_shear_stress_coefficient", "", 0, 10, "eq 23, gamma_L"},
    {"Lubricant", "thermal_conductivity_watts_per_metre_kelvin", "W/(m K)", 1e-3, 100,
     "eq 35, k_f"},
    {"Lubricant", "density_at_zero_kelvin_kilograms_per_cubic_metre", "kg/m3", 100, 1e5, "eq 26"},
    {"Lubricant", "density_slope_kilograms_per_cubic_metre_kelvin", "kg/(m3 K)", -100, 100,
     "eq 26"},
    {"Lubricant EvaluateContactRequest Surface", "tribofilm_shear_strength_pascals", "Pa", 0, 1e9,
     "eq 40, tau_0"},
    {"Lubricant EvaluateContactRequest Surface BoundaryFrictionAtTemperature",
     "asperity_friction_coefficient", "", 0, 2, "eq 40, zeta"},
    {"BoundaryFrictionAtTemperature", "temperature_celsius", "C", -70, 500, "eq 40"},
    {"Lubricant", "flash_point_celsius", "C", 0, 600, "ASTM D92"},
    {"Lubricant", "pour_point_celsius", "C", -120, 100, "ASTM D97"},
    {"ImprovedYasutomi", "glass_viscosity_pascal_seconds", "Pa s", 1e9, 1e16,
     "improved Yasutomi, eta_g"},
    {"ImprovedYasutomi", "glass_temperature_rise_kelvin", "K", 0, 2000, "improved Yasutomi, A_1"},
    {"ImprovedYasutomi", "glass_pressure_factor_per_pascal", "1/Pa", 0, 1e-7,
     "improved Yasutomi, A_2"},
    {"ImprovedYasutomi", "expansivity_pressure_factor_per_pascal", "1/Pa", 0, 1e-6,
     "improved Yasutomi, b_1"},
    {"ImprovedYasutomi", "expansivity_exponent", "", -1, 0, "improved Yasutomi, b_2"},
    {"LubricantMeasurements", "kinematic_viscosity_40_celsius_square_millimetres_per_second",
     "mm2/s", 1, 1e5, "eq 34, KV40", "ASTM D341 and D2270 begin at 2 mm2/s", Zero::kUnset},
    {"LubricantMeasurements", "kinematic_viscosity_100_celsius_square_millimetres_per_second",
     "mm2/s", 0.5, 1e4, "eq 34, KV100", "", Zero::kUnset},
    {"LubricantMeasurements",
     "sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second", "mm2/s", 0.5, 1e4,
     "SAE J306-2019", "CEC L-45-A-99", Zero::kUnset},
    {"LubricantMeasurements", "density_15_celsius_kilograms_per_cubic_metre", "kg/m3", 500, 2000,
     "eq 26", "", Zero::kUnset},
    {"BrookfieldViscosity", "temperature_celsius", "C", -70, 20, "SAE J306-2019", "ASTM D2983"},
    {"BrookfieldViscosity", "dynamic_viscosity_millipascal_seconds", "mPa s", 10, 1e7,
     "SAE J306-2019", "ASTM D2983"},
    {"ViscosityMeasurement", "temperature_celsius", "C", -70, 250, "eq 34"},
    {"ViscosityMeasurement", "kinematic_viscosity_square_millimetres_per_second", "mm2/s", 0.1, 1e7,
     "eq 34"},
    {"ViscosityMeasurement", "dynamic_viscosity_millipascal_seconds", "mPa s", 0.1, 1e7, "eq 34"},
    {"ViscosityMeasurement", "relative_standard_uncertainty", "", 0, 1, "eq 34",
     "0 means not stated"},
    {"DensityMeasurement", "temperature_celsius", "C", -70, 250, "eq 26"},
    {"DensityMeasurement", "density_kilograms_per_cubic_metre", "kg/m3", 500, 2000, "eq 26"},
    {"ParameterProvenance", "standard_uncertainty", "", 0, 1e16, "",
     "in the unit of the parameter; 0 means not known"},
    {"Surface EvaluateContactRequest", "asperity_density_per_square_metre", "1/m2", 1e3, 1e16,
     "eq 41, eta_G"},
    {"Surface EvaluateContactRequest", "asperity_radius_metres", "m", 1e-9, 1, "eq 41, beta_G"},
    {"Surface EvaluateContactRequest", "composite_rms_height_metres", "m", 1e-10, 1e-2,
     "eq 41, sigma_G", "the film ratio divides by it"},
    {"SurfaceMeasurement", "samples", "", 5, 1000000, "eq 45"},
    {"SurfaceMeasurement", "spacing_metres", "m", 1e-10, 1e-2, "eq 45"},
    {"SurfaceMeasurement ImportSurfaceProfilesRequest EvaluateProfilesRequest",
     "short_wave_cut_off_metres", "m", 1e-9, 1e-2, "eq 45, lambda_s", "ISO 16610-21", Zero::kUnset},
    {"SurfaceMeasurement ImportSurfaceProfilesRequest EvaluateProfilesRequest",
     "long_wave_cut_off_metres", "m", 1e-9, 1, "eq 45, lambda_c", "ISO 16610-21", Zero::kUnset},
    {"SurfaceMeasurement", "mean_square_height_square_metres", "m2", 1e-24, 1e-4, "eq 45, m0"},
    {"SurfaceMeasurement", "mean_square_slope", "", 1e-16, 1e4, "eq 45, m2"},
    {"SurfaceMeasurement", "mean_square_curvature_per_square_metre", "1/m2", 1e-8, 1e20,
     "eq 45, m4"},
    {"Vehicle", "mass_kilograms", "kg", 1, 1e6, "eq 7, m_v"},
    {"Vehicle", "rolling_resistance_coefficient", "", 0, 1, "eq 7, f_r"},
    {"Vehicle", "drag_coefficient", "", 0, 10, "eq 7, c_a"},
    {"Vehicle", "frontal_area_square_metres", "m2", 0, 1e3, "eq 7, A_f"},
    {"Vehicle", "air_density_kilograms_per_cubic_metre", "kg/m3", 0, 10, "eq 7, rho_air"},
    {"Vehicle", "wheel_radius_metres", "m", 0.01, 10, "eq 7, r_w"},
    {"Vehicle", "gravity_metres_per_second_squared", "m/s2", 0, 100, "eq 7, g"},
    {"GearSet", "pinion_teeth", "", 2, 1000, "eqs 8-11, N_p"},
    {"GearSet", "gear_teeth", "", 2, 1000, "eqs 8-11, N_g"},
    {"GearSet EvaluateContactRequest RigBody", "youngs_modulus_pascals", "Pa", 1e6, 1e13,
     "eq 13, E"},
    {"GearSet EvaluateContactRequest RigBody", "poissons_ratio", "", -0.99, 0.5, "eq 13, nu"},
    {"GearSet EvaluateContactRequest", "solid_thermal_conductivity_watts_per_metre_kelvin",
     "W/(m K)", 1e-3, 1e4, "eq 35, k_s"},
    {"GearSet EvaluateContactRequest", "solid_density_kilograms_per_cubic_metre", "kg/m3", 1, 1e5,
     "eq 35, rho_s"},
    {"GearSet EvaluateContactRequest", "solid_specific_heat_capacity_joules_per_kilogram_kelvin",
     "J/(kg K)", 1, 1e5, "eq 35, c_p"},
    {"DrivelineDynamics", "pinion_shaft_inertia_kilogram_square_metres", "kg m2", 1e-9, 1e6,
     "eq 1, I_s"},
    {"DrivelineDynamics", "pinion_inertia_kilogram_square_metres", "kg m2", 1e-9, 1e6, "eq 2, I_p"},
    {"DrivelineDynamics", "gear_inertia_kilogram_square_metres", "kg m2", 1e-9, 1e6, "eq 3, I_g"},
    {"DrivelineDynamics", "wheel_inertia_kilogram_square_metres", "kg m2", 1e-9, 1e6, "eq 4, I_w"},
    {"DrivelineDynamics", "pinion_shaft_stiffness_newton_metres_per_radian", "N m/rad", 1e-3, 1e12,
     "eqs 1, 2, k_t1"},
    {"DrivelineDynamics", "gear_shaft_stiffness_newton_metres_per_radian", "N m/rad", 1e-3, 1e12,
     "eqs 3, 4, k_t2"},
    {"DrivelineDynamics", "pinion_shaft_damping_newton_metre_seconds_per_radian", "N m s/rad", 0,
     1e9, "eqs 1, 2, c_t1"},
    {"DrivelineDynamics", "gear_shaft_damping_newton_metre_seconds_per_radian", "N m s/rad", 0, 1e9,
     "eqs 3, 4, c_t2"},
    {"DrivelineDynamics", "mesh_damping_newton_seconds_per_metre", "N s/m", 0, 1e9, "eqs 2, 3, c"},
    {"DrivelineDynamics", "half_backlash_metres", "m", 0, 1e-2, "eq 5, b"},
    {"MeshSeries", "pinion_torque_newton_metres", "N m", 0, 1e5, "eqs 8-11"},
    {"FourierSeries", "mean", "", -1e12, 1e12, "eqs 8-11", "in the unit of the series"},
    {"FourierSeries", "sine", "", -1e12, 1e12, "eqs 8-11", "in the unit of the series"},
    {"FourierSeries", "cosine", "", -1e12, 1e12, "eqs 8-11", "in the unit of the series"},
    {"FlankSlot LoadShareAtTorque.Slot", "load_share", "", 0, 1.001, "eq 29",
     "a share of the mesh force"},
    {"FlankSlot EvaluateContactRequest EvaluateRigRequest CampaignRig", "radius_x_metres", "m",
     1e-5, 1e4, "eqs 15, 20, R_zx"},
    {"FlankSlot EvaluateContactRequest", "radius_y_metres", "m", 1e-5, 1e4, "eqs 15, 20, R_zy"},
    {"FlankSlot", "pinion_velocity_x_metres", "m", -10, 10, "eq 17, A_up"},
    {"FlankSlot", "pinion_velocity_y_metres", "m", -10, 10, "eq 17, A_vp"},
    {"FlankSlot", "gear_velocity_x_metres", "m", -10, 10, "eq 17, A_ug"},
    {"FlankSlot", "gear_velocity_y_metres", "m", -10, 10, "eq 17, A_vg"},
    {"FlankSlot", "contact_point_velocity_x_metres", "m", -10, 10, "eq 17"},
    {"FlankSlot", "contact_point_velocity_y_metres", "m", -10, 10, "eq 17"},
    {"FlankSlot", "pinion_friction_arm_metres", "m", -10, 10, "eq 2, r_fr,p"},
    {"FlankSlot", "gear_friction_arm_metres", "m", -10, 10, "eq 3, r_fr,g"},
    {"LoadShareAtTorque", "pinion_torque_newton_metres", "N m", 0, 1e5, "eq 29"},
    {"EvaluateContactRequest", "load_newtons", "N", 0, 1e6, "eq 41, W"},
    {"EvaluateContactRequest", "pinion_velocity_x_metres_per_second", "m/s", -1e3, 1e3,
     "eq 17, u_s,p"},
    {"EvaluateContactRequest", "pinion_velocity_y_metres_per_second", "m/s", -1e3, 1e3,
     "eq 17, v_s,p"},
    {"EvaluateContactRequest", "gear_velocity_x_metres_per_second", "m/s", -1e3, 1e3,
     "eq 17, u_s,g"},
    {"EvaluateContactRequest", "gear_velocity_y_metres_per_second", "m/s", -1e3, 1e3,
     "eq 17, v_s,g"},
    {"EvaluateContactRequest Simulation PointCondition EvaluateCycleRequest CyclePlace",
     "sump_temperature_celsius", "C", -70, 200, "eq 14"},
    {"EvaluateContactRequest Simulation PointCondition EvaluateCycleRequest",
     "inlet_temperature_rise_kelvin", "K", 0, 300, "eq 14"},
    {"EvaluateContactRequest EvaluateRigRequest ComparePointsRequest ExplainPointsRequest", "draws",
     "", 19, 1999, "work limit", "39 draws or more hold a 95 % interval", Zero::kUnset},
    {"Simulation", "deadline_seconds", "s", 0.001, 31'622'400, "work limit", "at most a year"},
    {"StatedLimits", "minimum_film_ratio", "", 1e-3, 1e3, "lambda_s", "", Zero::kUnset},
    {"StatedLimits", "pressure_limit_pascals", "Pa", 1e6, 1e11, "eq 19, p_max", "", Zero::kUnset},
    {"StatedLimits", "contact_temperature_limit_celsius", "C", 1, 1500, "eq 38, T_c", "",
     Zero::kUnset},
    {"StatedLimits", "flash_temperature_rise_limit_kelvin", "K", 0.1, 1500, "eq 39", "",
     Zero::kUnset},
    {"Cruise PointCondition DriveCycleSnapshot", "speed_kilometres_per_hour", "km/h", 0.1, 400,
     "eq 7"},
    {"Cruise PointCondition DriveCycleSnapshot InefficiencyCurveStudy CyclePlace",
     "ascent_angle_degrees", "degrees", -45, 45, "eq 7"},
    {"DriveCycleSnapshot", "acceleration_metres_per_second_squared", "m/s2", -50, 50, "eq 7"},
    {"PrescribedTorque", "pinion_torque_newton_metres", "N m", -1e5, 1e5, "eq 1, T_s"},
    {"PrescribedTorque", "pinion_speed_radians_per_second", "rad/s", 0.01, 1e4, "eq 1, phidot_s",
     "the model needs forward rotation"},
    {"HistoryRequest", "mesh_cycles", "", 1, 1000, "work limit", "", Zero::kUnset},
    {"HistoryRequest", "samples_per_mesh_cycle", "", 2, 100000, "work limit", "", Zero::kUnset},
    {"InefficiencyCurveStudy", "speeds_kilometres_per_hour", "km/h", 0.1, 400, "eq 7"},
    {"InefficiencyCurveStudy", "first_speed_kilometres_per_hour", "km/h", 0.1, 400, "eq 7", "",
     Zero::kUnset},
    {"InefficiencyCurveStudy", "last_speed_kilometres_per_hour", "km/h", 0.1, 400, "eq 7", "",
     Zero::kUnset},
    {"InefficiencyCurveStudy", "speed_step_kilometres_per_hour", "km/h", 1e-3, 400, "eq 7", "",
     Zero::kUnset},
    {"SolverOptions", "march_step_tolerance", "", 1e-11, 1e-3, "eqs 1-6",
     "below it lies round-off, above it no steady state", Zero::kUnset},
    {"SolverOptions EvaluatePointsRequest EvaluateCycleRequest ComparePointsRequest "
     "ExplainPointsRequest Campaign",
     "tolerance", "", 1e-8, 1e-2, "eq 30", "what shooting can estimate and keep", Zero::kUnset},
    {"SolverOptions", "march_settling_tolerance", "", 1e-12, 1e-1, "eq 30", "", Zero::kUnset},
    {"SolverOptions", "maximum_mesh_cycles", "", 1, 100000, "work limit", "", Zero::kUnset},
    {"SolverOptions", "recorded_mesh_cycles", "", 1, 1000, "work limit", "", Zero::kUnset},
    {"EvaluateCycleRequest", "map_tolerance", "", 1e-5, 0.1, "energy lost",
     "below it the map has too many points", Zero::kUnset},
    {"CyclePlace", "time_seconds", "s", 0, 1e6, "cycle"},
    {"CyclePlace", "speed_kilometres_per_hour", "km/h", 0, 400, "eq 7",
     "the vehicle does not drive backwards"},
    {"EvaluateRigRequest CampaignRig", "composite_rms_height_metres", "m", 1e-10, 1e-2,
     "eq 41, sigma_G", "the film ratio divides by it", Zero::kUnset},
    {"EvaluateRigRequest CampaignRig", "radius_y_metres", "m", 1e-5, 1e4, "eqs 15, 20, R_zy", "",
     Zero::kUnset},
    {"RigBody", "thermal_conductivity_watts_per_metre_kelvin", "W/(m K)", 1e-3, 1e4, "eq 35, k_s"},
    {"RigBody", "density_kilograms_per_cubic_metre", "kg/m3", 1, 1e5, "eq 35, rho_s"},
    {"RigBody", "specific_heat_capacity_joules_per_kilogram_kelvin", "J/(kg K)", 1, 1e5,
     "eq 35, c_p"},
    {"RigCondition", "load_newtons", "N", 1e-6, 1e6, "eq 41, W"},
    {"RigCondition", "entrainment_speed_metres_per_second", "m/s", 1e-6, 1e3, "eq 17, U"},
    {"RigCondition", "slide_roll_ratio_percent", "%", -200, 200, "eq 18",
     "beyond it the surfaces move against each other"},
    {"RigCondition", "supply_temperature_celsius", "C", -70, 200, "eq 14, T_in"},
    {"RigGrid", "supply_temperatures_celsius", "C", -70, 200, "eq 14, T_in"},
    {"RigGrid", "loads_newtons", "N", 1e-6, 1e6, "eq 41, W"},
    {"RigGrid", "mean_pressures_pascals", "Pa", 1e4, 1e11, "eq 19", "2/3 of p_max"},
    {"RigGrid", "entrainment_speeds_metres_per_second", "m/s", 1e-6, 1e3, "eq 17, U"},
    {"RigGrid", "slide_roll_ratios_percent", "%", -200, 200, "eq 18",
     "beyond it the surfaces move against each other"},
    {"EvaluateViscosityRequest", "temperatures_celsius", "C", -100, 400, "eq 34"},
    {"EvaluateViscosityRequest", "pressures_pascals", "Pa", 0, 1e10, "eq 31", "above ambient"},
    {"ReadSpectrumRequest", "maximum_order", "", 0.001, 50000, "half the samples of a mesh cycle",
     "an order is a multiple of the mesh frequency", Zero::kUnset},
    {"ComparePointsRequest ExplainPointsRequest Campaign RankCandidatesRequest "
     "FindParetoCandidatesRequest EstimateCandidateEffectsRequest",
     "condition_weights", "", 1e-9, 1e9, "mean over conditions"},
    {"ComparePointsRequest ExplainPointsRequest", "sump_temperature_uncertainty_kelvin", "K", 0,
     100, "eq 14", "standard uncertainty"},
    {"ComparePointsRequest ExplainPointsRequest", "inlet_temperature_rise_uncertainty_kelvin", "K",
     0, 100, "eq 14", "standard uncertainty"},
    {"ComparePointsRequest ExplainPointsRequest", "estimate_correlation", "", 0, 1,
     "correlation of estimates"},
    {"RankCandidatesRequest", "count", "", 1, 10000, "answer limit", "", Zero::kUnset},
    {"RankCandidatesRequest", "confidence", "", 0.5, 0.9999, "probability",
     "below one half no candidate is worse", Zero::kUnset},
    {"FindParetoCandidatesRequest", "beaten_count", "", 1, 10000, "answer limit", "", Zero::kUnset},
    {"EstimateCandidateEffectsRequest", "coverage", "", 0.5, 0.9999, "probability", "",
     Zero::kUnset},
    {"CampaignBudget", "processor_seconds", "s", 0, 1e9, "work limit"},
    {"CampaignBudget", "points", "", 0, 20'000'000, "work limit"},
    {TRIBODYN_RESOURCE_KINDS(TRIBODYN_BATCHES), "requests", "", 1, kMaximumBatchSize, "work limit",
     "requests of one transaction"}};
#undef TRIBODYN_BATCHES

/// A unit that clients often use instead of the contract's unit, and the usual range of the
/// quantity. A number outside the allowed range that is usual in this unit was probably written in
/// it.
struct UnitSlip {
  std::string_view message;  ///< message whose fields the row applies to; empty: all messages
  std::string_view unit;     ///< unit of the contract
  std::string_view written;
  double factor;
  double offset;
  double least_usual, most_usual;  ///< in the contract's unit
};

constexpr UnitSlip kUnitSlips[] = {
    // The density of lubricants is 780 to 1150 kg/m3 at 15 C.
    {"", "kg/m3", "g/cm3", 1e3, 0, 700, 1300},
    {"", "kg/m3", "g/cm3 with its decimal point one place off", 1e2, 0, 700, 1300},
    // The viscosity of gear oils is 3 to 50 mm2/s at 100 C and 15 to 1000 mm2/s at 40 C.
    {"", "mm2/s", "m2/s", 1e6, 0, 2, 5000},
    {"", "mm2/s", "St", 1e2, 0, 2, 5000},
    // Brookfield viscosities are 3000 to 300 000 mPa s.
    {"", "mPa s", "Pa s", 1e3, 0, 1, 1e6},
    {"", "mPa s", "uPa s", 1e-3, 0, 1, 1e6},
    // Factors of the pressure in the improved Yasutomi law are 0.1 to 20 1/GPa.
    {"ImprovedYasutomi", "1/Pa", "1/GPa", 1e-9, 0, 1e-11, 1e-7},
    // alpha* of oils is 8 to 40 1/GPa.
    {"", "1/Pa", "1/GPa", 1e-9, 0, 4e-9, 1e-7},
    {"", "1/Pa", "mm2/N", 1e-6, 0, 4e-9, 1e-7},
    {"Lubricant", "K", "C", 1, 273.15, 200, 420},
    // The radius of asperities is 1 to 1000 um, the height of flanks 0.05 to 5 um.
    {"Surface", "m", "um", 1e-6, 0, 1e-8, 1e-3},
    {"Surface", "Pa", "MPa", 1e6, 0, 1e4, 1e9}};

/// Returns a hint such as "; 0.895 looks like g/cm3: did you mean 895 kg/m3?", or an empty string.
std::string slip_text(const Constraint& row, double value) {
  for (const UnitSlip& slip : kUnitSlips) {
    if (slip.unit != row.unit || !(slip.message.empty() || slip.message == row.message)) continue;
    const double meant = value * slip.factor + slip.offset;
    if (!(meant >= slip.least_usual && meant <= slip.most_usual)) continue;
    if (!row.allows(meant)) continue;
    return fmt::format("; {} looks like {}: did you mean {:.6g} {}?", value, slip.written, meant,
                       row.unit);
  }
  return "";
}

/// Returns e.g. "allowed: 1e-05 to 10000 m (eq 15, R_zx: ...)".
std::string allowed_text(const Constraint& row) {
  return fmt::format("allowed: {} to {} ({}{}{})", number_text(row.minimum),
                     quantity_text(row.maximum, row.unit), row.equation,
                     row.equation.empty() || row.reason.empty() ? "" : ": ", row.reason);
}

/// Returns the rows of kTable, one for each message, in the order of the first row of each message.
std::vector<Constraint> rows_by_message() {
  std::vector<Constraint> out;
  std::map<std::string_view, std::size_t> places;
  for (const Constraint& row : kTable) {
    for (std::string_view messages = row.message; !messages.empty();) {
      out.push_back(row);
      out.back().message = take_part(messages, ' ');
      places.emplace(out.back().message, places.size());
    }
  }
  std::stable_sort(out.begin(), out.end(), [&](const Constraint& a, const Constraint& b) {
    return places.at(a.message) < places.at(b.message);
  });
  return out;
}

}  // namespace

std::span<const Constraint> constraints() {
  static const std::vector<Constraint> kRows = rows_by_message();
  return kRows;
}

bool is_required(const Constraint& row) {
#define TRIBODYN_IS_OF(Resource, field, collection, seed) row.message == #Resource ||
  const bool has_parameters =
      TRIBODYN_RESOURCE_KINDS(TRIBODYN_IS_OF) row.message == "ImprovedYasutomi" ||
      row.message == "DrivelineDynamics";
#undef TRIBODYN_IS_OF
  if (!has_parameters) return false;
  return !may_be_unset(*google::protobuf::DescriptorPool::generated_pool()
                            ->FindMessageTypeByName("tribodyn.v1." + std::string(row.message))
                            ->FindFieldByName(std::string(row.field)));
}

const Constraint* find_constraint(std::string_view message, std::string_view field) {
  for (const Constraint& row : constraints()) {
    if (row.message == message && row.field == field) return &row;
  }
  return nullptr;
}

const Constraint* find_constraint(const google::protobuf::FieldDescriptor& field) {
  return find_constraint(field.containing_type()->name(), field.name());
}

std::string number_text(double value) { return fmt::format("{}", value); }

std::string quantity_text(double value, std::string_view unit) {
  return unit.empty() ? number_text(value) : fmt::format("{} {}", value, unit);
}

std::string out_of_range_text(const Constraint& row, double value) {
  return fmt::format("{} = {}; {}{}", row.field, quantity_text(value, row.unit), allowed_text(row),
                     slip_text(row, value));
}

std::string not_set_text(const Constraint& row) {
  return fmt::format("{} is not set; {}", row.field, allowed_text(row));
}

}  // namespace tribodyn::server
