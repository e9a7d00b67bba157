#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/consistency/contact_case.h"

namespace tribodyn {
namespace {

using nlohmann::json;

/// The choice that a word stands for; an unknown word is an error, never a default.
template <class Value>
Value chosen(const std::string& key, const std::string& word,
             const std::map<std::string, Value>& known) {
  const auto found = known.find(word);
  if (found == known.end()) throw std::invalid_argument(key + ": unknown word '" + word + "'");
  return found->second;
}

void switch_misprint_on(const std::string& word, AsPublished& out) {
  *chosen<bool*>("as_published", word,
                 {{"eq17", &out.eq17_atan},
                  {"eq20", &out.eq20_semi_major},
                  {"eq22", &out.eq22_inverted_ratio},
                  {"eq31", &out.eq31_32_logarithm},
                  {"eq32", &out.eq31_32_logarithm},
                  {"eq43", &out.eq43_44_polynomials},
                  {"eq44", &out.eq43_44_polynomials},
                  {"eq46", &out.eq46_square_root_of_sum}}) = true;
}

/// Reads each key of an object once, and complains of keys that nobody asked for.
class Reader {
 public:
  Reader(const std::string& name, const json& object) : name_(name), left_(object) {}
  json take(const std::string& key) {
    json value = left_.at(key);
    left_.erase(key);
    return value;
  }
  void finish() const {
    if (!left_.empty()) {
      throw std::invalid_argument(name_ + ": unknown keys " + left_.dump());
    }
  }

 private:
  std::string name_;
  json left_;
};

ContactCase read_case(const json& input) {
  ContactCase c;
  Reader in("input", input);
  c.conditions = {in.take("W"),   in.take("Rx"),  in.take("Ry"), in.take("u_p"),
                  in.take("v_p"), in.take("u_g"), in.take("v_g")};
  Reader oil("lub", in.take("lub"));
  Lubricant& l = c.lubricant;
  l.vogel_viscosity_prefactor = oil.take("eta_ref");
  l.vogel_temperature_coefficient = oil.take("A1");
  l.vogel_reference_temperature = oil.take("T0");
  l.pressure_viscosity_coefficient = oil.take("alpha_star");
  l.pressure_viscosity_temperature = oil.take("T_alpha");
  l.relaxation_time = oil.take("HN_lambda");
  l.havriliak_negami_alpha = oil.take("HN_alpha");
  l.havriliak_negami_beta = oil.take("HN_beta");
  l.rheology_reference_temperature = oil.take("T_ref");
  l.limiting_shear_stress_at_zero_pressure = oil.take("tau_L0");
  l.limiting_shear_stress_coefficient = oil.take("gamma_L");
  l.thermal_conductivity = oil.take("k_f");
  l.density_at_zero_kelvin = oil.take("rho_0");
  l.density_temperature_slope = oil.take("rho_slope");
  oil.finish();
  Reader steel("steel", in.take("steel"));
  c.solid = {steel.take("E"), steel.take("nu"), steel.take("k_s"), steel.take("rho_s"),
             steel.take("cp_s")};
  steel.finish();
  Reader rough("rough", in.take("rough"));
  c.roughness = {rough.take("eta_G"), rough.take("beta_G"), rough.take("sigma_G")};
  rough.finish();
  Reader bound("bound", in.take("bound"));
  c.boundary = {bound.take("tau_0"), bound.take("zeta")};
  bound.finish();
  c.sump_temperature = in.take("T_bath");
  c.inlet_temperature_rise = in.take("dT_in");

  ModelOptions& o = c.options;
  o.isothermal = !in.take("thermal").get<bool>();
  o.newtonian = chosen<bool>("rheology", in.take("rheology"), {{"HN", false}, {"newton", true}});
  o.as_published.eq43_44_polynomials = chosen<bool>(
      "Fn", in.take("Fn"), {{"exact", false}, {"polynomial", true}, {"published", true}});
  o.hertz_solution = chosen<HertzSolution>(
      "hertz", in.take("hertz"),
      {{"simplified", HertzSolution::kSimplified}, {"exact", HertzSolution::kExact}});
  o.hertz_load =
      chosen<HertzLoad>("hertz_load", in.take("hertz_load"),
                        {{"EHL", HertzLoad::kFilmLoad}, {"total", HertzLoad::kTotalLoad}});
  o.pressure_viscosity_index = chosen<PressureViscosityIndex>(
      "alpha_mode", in.take("alpha_mode"),
      {{"reciprocal_asymptotic", PressureViscosityIndex::kReciprocalAsymptotic},
       {"houpert", PressureViscosityIndex::kHoupert}});
  for (const std::string word : in.take("as_published")) switch_misprint_on(word, o.as_published);
  in.finish();
  return c;
}

/// The solution under the names of the file.
std::map<std::string, double> leaves_of(const ContactSolution& s) {
  return {{"W_EHL", s.film_load},
          {"W_asp", s.asperity_load},
          {"A_EHL", s.contact_area},
          {"A_asp", s.asperity_area},
          {"a_c", s.semi_major_axis},
          {"b_c", s.semi_minor_axis},
          {"p_max", s.maximum_pressure},
          {"theta", s.entrainment_angle},
          {"R_e", s.entrainment_radius},
          {"R_s", s.side_leakage_radius},
          {"U_eff", s.entrainment_speed},
          {"V_s", s.sliding_speed},
          {"eta_in", s.inlet_viscosity},
          {"alpha_in", s.inlet_pressure_viscosity_coefficient},
          {"Z", s.pressure_viscosity_index},
          {"E_prime", s.reduced_modulus},
          {"h_cen", s.central_film_thickness},
          {"lambda_s", s.film_ratio},
          {"gamma_dot", s.shear_rate},
          {"T_c", s.contact_temperature},
          {"dT_flash", s.flash_temperature_rise},
          {"dT_oil", s.oil_temperature_rise},
          {"l_p", s.active_length_1},
          {"l_g", s.active_length_2},
          {"R_cf", s.film_thermal_resistance},
          {"R_fp", s.thermal_resistance_1},
          {"R_fg", s.thermal_resistance_2},
          {"a_h", s.heat_partition},
          {"tau_bar", s.mean_shear_stress},
          {"F_v", s.viscous_friction},
          {"F_b", s.boundary_friction},
          {"F_fr", s.friction},
          {"q_dot", s.heat_rate},
          {"mu", s.friction_coefficient},
          {"n_clip_switches", static_cast<double>(s.limiting_stress_switches)}};
}

TEST(WorkedContacts, EveryLeafAgreesTo1em9) {
  const json file = load_reference("worked_points.json");
  const double tolerance = file.at("suggested_tolerance").at("contacts_relative");
  ASSERT_LE(tolerance, 1e-9);
  ASSERT_EQ(file.at("contacts").size(), 12u);
  double worst = 0;
  std::string worst_leaf;
  for (const json& contact : file.at("contacts")) {
    const std::string name = contact.at("name");
    SCOPED_TRACE(name);
    const ContactSolution solution = read_case(contact.at("input")).solve();
    const std::map<std::string, double> found = leaves_of(solution);
    for (const auto& [leaf, expected] : contact.at("expected").items()) {
      if (leaf == "status") {
        EXPECT_EQ(expected.get<std::string>(), "ok");
        EXPECT_STREQ(contact_status_name(solution.status), "OK");
        continue;
      }
      ASSERT_TRUE(found.contains(leaf)) << "no such leaf: " << leaf;
      const double value = found.at(leaf);
      if (expected.is_null()) {  // the file's Infinity
        EXPECT_TRUE(std::isinf(value)) << leaf;
        continue;
      }
      const double wanted = expected;
      EXPECT_NEAR(value, wanted, tolerance * std::abs(wanted)) << leaf;
      const double error = wanted != 0 ? std::abs(value / wanted - 1) : 0;
      if (error > worst) {
        worst = error;
        worst_leaf = name + "." + leaf;
      }
    }
  }
  std::cout << "worst leaf: " << worst_leaf << ", " << worst << " off\n";
}

TEST(WorkedContacts, UnknownWordsAreNotTakenForDefaults) {
  const json file = load_reference("worked_points.json");
  const json known = file.at("contacts").at(0).at("input");
  ASSERT_NO_THROW(read_case(known));
  for (const char* key : {"rheology", "Fn", "hertz", "hertz_load", "alpha_mode"}) {
    json changed = known;
    changed[key] = "something else";
    EXPECT_THROW(read_case(changed), std::invalid_argument) << key;
  }
  json misprint = known;
  misprint["as_published"] = {"eq17", "eq99"};
  EXPECT_THROW(read_case(misprint), std::invalid_argument);
  json extra = known;
  extra["drift"] = 1.0;
  EXPECT_THROW(read_case(extra), std::invalid_argument);
}

TEST(WorkedContacts, MisprintsAreReadByTheirEquation) {
  const json file = load_reference("worked_points.json");
  json input = file.at("contacts").at(0).at("input");
  input["as_published"] = {"eq17", "eq20", "eq22", "eq31", "eq43"};
  const AsPublished all = read_case(input).options.as_published;
  EXPECT_TRUE(all.eq17_atan && all.eq20_semi_major && all.eq22_inverted_ratio &&
              all.eq31_32_logarithm && all.eq43_44_polynomials);
  EXPECT_FALSE(all.eq46_square_root_of_sum);
  input["as_published"] = {"eq32", "eq44"};
  const AsPublished twins = read_case(input).options.as_published;
  EXPECT_TRUE(twins.eq31_32_logarithm && twins.eq43_44_polynomials);
  EXPECT_FALSE(twins.eq17_atan || twins.eq20_semi_major || twins.eq22_inverted_ratio);
}

}  // namespace
}  // namespace tribodyn
