// Compares EvaluateContact with contacts that were computed independently with 30 digits.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "server/application/contacts.h"
#include "tests/service/reference_data.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

v1::EvaluateContactRequest request_of(const JsonValue& input) {
  v1::EvaluateContactRequest out;
  out.set_load_newtons(number(input, "W"));
  out.set_radius_x_metres(number(input, "Rx"));
  out.set_radius_y_metres(number(input, "Ry"));
  out.set_pinion_velocity_x_metres_per_second(number(input, "u_p"));
  out.set_pinion_velocity_y_metres_per_second(number(input, "v_p"));
  out.set_gear_velocity_x_metres_per_second(number(input, "u_g"));
  out.set_gear_velocity_y_metres_per_second(number(input, "v_g"));
  const JsonValue& lub = at(input, "lub");
  v1::Lubricant* fluid = out.mutable_lubricant_parameters();
  fluid->set_vogel_viscosity_prefactor_pascal_seconds(number(lub, "eta_ref"));
  fluid->set_vogel_temperature_coefficient_kelvin(number(lub, "A1"));
  fluid->set_vogel_reference_temperature_kelvin(number(lub, "T0"));
  fluid->set_pressure_viscosity_coefficient_per_pascal(number(lub, "alpha_star"));
  fluid->set_pressure_viscosity_temperature_kelvin(number(lub, "T_alpha"));
  fluid->set_relaxation_time_seconds(number(lub, "HN_lambda"));
  fluid->set_havriliak_negami_alpha(number(lub, "HN_alpha"));
  fluid->set_havriliak_negami_beta(number(lub, "HN_beta"));
  fluid->set_rheology_reference_temperature_kelvin(number(lub, "T_ref"));
  fluid->set_limiting_shear_stress_at_zero_pressure_pascals(number(lub, "tau_L0"));
  fluid->set_limiting_shear_stress_coefficient(number(lub, "gamma_L"));
  fluid->set_density_slope_kilograms_per_cubic_metre_kelvin(number(lub, "rho_slope"));
  fluid->set_density_at_zero_kelvin_kilograms_per_cubic_metre(number(lub, "rho_0"));
  fluid->set_thermal_conductivity_watts_per_metre_kelvin(number(lub, "k_f"));
  out.set_sump_temperature_celsius(number(input, "T_bath") - 273.15);
  out.set_inlet_temperature_rise_kelvin(number(input, "dT_in"));
  out.set_youngs_modulus_pascals(number(input, "steel.E"));
  out.set_poissons_ratio(number(input, "steel.nu"));
  out.set_solid_thermal_conductivity_watts_per_metre_kelvin(number(input, "steel.k_s"));
  out.set_solid_density_kilograms_per_cubic_metre(number(input, "steel.rho_s"));
  out.set_solid_specific_heat_capacity_joules_per_kilogram_kelvin(number(input, "steel.cp_s"));
  out.set_asperity_density_per_square_metre(number(input, "rough.eta_G"));
  out.set_asperity_radius_metres(number(input, "rough.beta_G"));
  out.set_composite_rms_height_metres(number(input, "rough.sigma_G"));
  out.set_tribofilm_shear_strength_pascals(number(input, "bound.tau_0"));
  out.set_asperity_friction_coefficient(number(input, "bound.zeta"));
  v1::ModelOptions* options = out.mutable_model_options();
  options->set_preset(v1::ModelOptions::PAPER);
  options->set_isothermal(!at(input, "thermal").bool_value());
  options->set_newtonian(at(input, "rheology").string_value() == "newton");
  options->set_exact_hertz(at(input, "hertz").string_value() == "exact");
  if (at(input, "alpha_mode").string_value() == "houpert") {
    options->set_pressure_viscosity_index(v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);
  }
  return out;
}

/// Fields of the response by their names in the worked points.
const std::map<std::string, std::string> kFields = {
    {"W_EHL", "film_load_newtons"},
    {"W_asp", "asperity_load_newtons"},
    {"A_EHL", "contact_area_square_metres"},
    {"A_asp", "asperity_area_square_metres"},
    {"a_c", "semi_major_axis_metres"},
    {"b_c", "semi_minor_axis_metres"},
    {"p_max", "maximum_pressure_pascals"},
    {"theta", "entrainment_angle_radians"},
    {"R_e", "entrainment_radius_metres"},
    {"R_s", "side_leakage_radius_metres"},
    {"U_eff", "entrainment_speed_metres_per_second"},
    {"V_s", "sliding_speed_metres_per_second"},
    {"eta_in", "inlet_viscosity_pascal_seconds"},
    {"alpha_in", "inlet_pressure_viscosity_coefficient_per_pascal"},
    {"Z", "pressure_viscosity_index"},
    {"E_prime", "reduced_modulus_pascals"},
    {"h_cen", "central_film_thickness_metres"},
    {"lambda_s", "film_ratio"},
    {"gamma_dot", "shear_rate_per_second"},
    {"T_c", "contact_temperature_kelvin"},
    {"dT_flash", "flash_temperature_rise_kelvin"},
    {"dT_oil", "oil_temperature_rise_kelvin"},
    {"l_p", "pinion_active_length_metres"},
    {"l_g", "gear_active_length_metres"},
    {"R_cf", "film_thermal_resistance_kelvin_per_watt"},
    {"R_fp", "pinion_thermal_resistance_kelvin_per_watt"},
    {"R_fg", "gear_thermal_resistance_kelvin_per_watt"},
    {"a_h", "heat_partition"},
    {"tau_bar", "mean_shear_stress_pascals"},
    {"F_v", "viscous_friction_newtons"},
    {"F_b", "boundary_friction_newtons"},
    {"F_fr", "friction_newtons"},
    {"q_dot", "heat_rate_watts"},
    {"mu", "friction_coefficient"},
};

TEST(WorkedContacts, EveryIntermediateQuantityAgrees) {
  constexpr double kTolerance = 1e-9;
  Bench bench;
  Application app = bench.application();
  const JsonValue data = load_reference("worked_points.json");
  int compared = 0;
  for (const JsonValue& contact : at(data, "contacts").list_value().values()) {
    const std::string name = at(contact, "name").string_value();
    const auto outcome = evaluate_contact(app, request_of(at(contact, "input")));
    ASSERT_TRUE(outcome.ok()) << name << ": " << outcome.error().message();
    const auto& response = outcome.message();
    for (const auto& [key, expected] : at(contact, "expected").struct_value().fields()) {
      const auto field = kFields.find(key);
      if (field == kFields.end()) continue;
      const double actual = response.GetReflection()->GetDouble(
          response, response.GetDescriptor()->FindFieldByName(field->second));
      if (expected.has_null_value()) {  // infinite, or undefined because there is no heat to share
        EXPECT_FALSE(std::isnan(actual)) << name << " " << key;
        continue;
      }
      const double scale = std::max(std::abs(expected.number_value()), 1e-30);
      EXPECT_NEAR(actual / scale, expected.number_value() / scale, kTolerance)
          << name << " " << key;
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}

}  // namespace
}  // namespace tribodyn::server
