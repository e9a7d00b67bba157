#include "yardstick_data.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace tribodyn::yardstick {
namespace {

using nlohmann::json;

Lubricant read_lubricant(const json& values) {
  Lubricant lubricant;
  lubricant.vogel_prefactor = values.at("eta_ref");
  lubricant.vogel_temperature_parameter = values.at("A1");
  lubricant.vogel_reference_temperature = values.at("T0");
  lubricant.pressure_viscosity_coefficient = values.at("alpha_star");
  lubricant.pressure_viscosity_temperature = values.at("T_alpha");
  lubricant.relaxation_time = values.at("HN_lambda");
  lubricant.havriliak_negami_alpha = values.at("HN_alpha");
  lubricant.havriliak_negami_beta = values.at("HN_beta");
  lubricant.shear_reference_temperature = values.at("T_ref");
  lubricant.limiting_shear_stress_at_zero_pressure = values.at("tau_L0");
  lubricant.limiting_shear_stress_slope = values.at("gamma_L");
  lubricant.density_slope = values.at("rho_slope");
  lubricant.density_intercept = values.at("rho_0");
  lubricant.thermal_conductivity = values.at("k_f");
  return lubricant;
}

Solid read_solid(const json& values) {
  return {values.at("E"), values.at("nu"), values.at("k_s"), values.at("rho_s"), values.at("cp_s")};
}

Surface read_surface(const json& roughness, const json& boundary) {
  return {roughness.at("eta_G"), roughness.at("beta_G"), roughness.at("sigma_G"),
          boundary.at("tau_0"), boundary.at("zeta")};
}

FourierSeries read_series(const json& series) {
  FourierSeries result;
  result.constant = series.at("c0");
  result.sine = series.at("sin").get<std::array<double, kHarmonics>>();
  result.cosine = series.at("cos").get<std::array<double, kHarmonics>>();
  return result;
}

}  // namespace

json read_json_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path);
  std::ostringstream stream;
  stream << file.rdbuf();
  std::string text = stream.str();
  // JSON has no infinity: hand it over as a string.
  const std::string infinity = ": Infinity";
  for (std::size_t at; (at = text.find(infinity)) != std::string::npos;) {
    text.replace(at, infinity.size(), ": \"Infinity\"");
  }
  return json::parse(text);
}

ContactCase read_contact_case(const json& input, int quadrature_nodes) {
  FrictionOptions options;
  options.isothermal = !input.at("thermal").get<bool>();
  options.newtonian = input.at("rheology") == "newton";
  options.houpert_pressure_index = input.at("alpha_mode") == "houpert";
  options.elliptic_integral_hertz = input.at("hertz") == "exact";
  options.quadrature_nodes = quadrature_nodes;
  if (input.at("Fn") != "exact" || input.at("hertz_load") != "EHL" ||
      !input.at("as_published").empty()) {
    throw std::invalid_argument("the yardstick has no such friction option");
  }
  const ContactFriction friction(read_lubricant(input.at("lub")), read_solid(input.at("steel")),
                                 read_surface(input.at("rough"), input.at("bound")),
                                 input.at("T_bath"), input.at("dT_in"), options);
  return {friction,
          {input.at("W"), input.at("Rx"), input.at("Ry"), input.at("u_p"), input.at("v_p"),
           input.at("u_g"), input.at("v_g")}};
}

ContactFriction read_orbit_friction(const json& values, const FrictionOptions& options) {
  return ContactFriction(read_lubricant(values), read_solid(values), read_surface(values, values),
                         values.at("T_bath"), values.at("dT_in"), options);
}

GearPairParameters read_gear_pair(const json& gear_set) {
  GearPairParameters gear_pair;
  const json& dynamics = gear_set.at("dynamics");
  gear_pair.pinion_teeth = gear_set.at("blank_geometry").at("N_p");
  gear_pair.gear_teeth = gear_set.at("blank_geometry").at("N_g");
  gear_pair.pinion_shaft_inertia = dynamics.at("I_s");
  gear_pair.pinion_inertia = dynamics.at("I_p");
  gear_pair.gear_inertia = dynamics.at("I_g");
  gear_pair.gear_shaft_inertia = dynamics.at("I_w");
  gear_pair.pinion_shaft_stiffness = dynamics.at("k_t1");
  gear_pair.gear_shaft_stiffness = dynamics.at("k_t2");
  gear_pair.pinion_shaft_damping = dynamics.at("c_t1");
  gear_pair.gear_shaft_damping = dynamics.at("c_t2");
  gear_pair.mesh_damping = dynamics.at("c_mesh");
  gear_pair.half_backlash = dynamics.at("b");
  const json& fourier = gear_set.at("fourier");
  gear_pair.pinion_contact_radius = read_series(fourier.at("R_p"));
  gear_pair.gear_contact_radius = read_series(fourier.at("R_g"));
  gear_pair.mesh_stiffness = read_series(fourier.at("k_m"));
  gear_pair.static_transmission_error = read_series(fourier.at("e"));
  const json& tables = gear_set.at("tables");
  gear_pair.load_share = tables.at("load_share").get<SlotTable>();
  gear_pair.radius_x = tables.at("Rx").get<SlotTable>();
  gear_pair.radius_y = tables.at("Ry").get<SlotTable>();
  gear_pair.pinion_velocity_x = tables.at("A_up").get<SlotTable>();
  gear_pair.pinion_velocity_y = tables.at("A_vp").get<SlotTable>();
  gear_pair.gear_velocity_x = tables.at("A_ug").get<SlotTable>();
  gear_pair.gear_velocity_y = tables.at("A_vg").get<SlotTable>();
  gear_pair.pinion_friction_arm = tables.at("r_fr_p").get<SlotTable>();
  gear_pair.gear_friction_arm = tables.at("r_fr_g").get<SlotTable>();
  return gear_pair;
}

VehicleParameters read_vehicle(const json& gear_set) {
  const json& values = gear_set.at("vehicle");
  VehicleParameters vehicle;
  vehicle.mass = values.at("m_v");
  vehicle.rolling_resistance = values.at("f_r");
  vehicle.drag_coefficient = values.at("c_a");
  vehicle.frontal_area = values.at("A_f");
  vehicle.air_density = values.at("rho_air");
  vehicle.wheel_radius = values.at("r_w");
  vehicle.gravity = values.at("g");
  vehicle.ascent_angle = values.at("ascent_angle");
  return vehicle;
}

SectionState read_section_state(const json& section_state) {
  return {section_state.at("d_phi_sp"), section_state.at("d_phi_gw"), section_state.at("w_s"),
          section_state.at("w_p"),      section_state.at("w_g"),      section_state.at("w_w"),
          section_state.at("y")};
}

}  // namespace tribodyn::yardstick
