#include "core/contact/contact_sensitivity.h"

#include <cmath>

#include "core/contact/contact_equations.h"

namespace tribodyn {
namespace {

/// One derivative per input; the last is for the unknown of root_with_slopes, the one before pads
/// to a whole number of vectors.
constexpr int kDirections = kContactInputs + 2;
using Number = laws::Dual<double, kDirections>;

/// The structures with a variable in place of each input.
struct Seeded {
  ContactParametersOf<Number> parameters;
  ContactConditionsOf<Number> conditions;

  Seeded(ContactParametersOf<double> from, ContactConditions k) {
    const auto values = contact_inputs(from, k);
    const auto numbers = contact_inputs(parameters, conditions);
    for (int i = 0; i < kContactInputs; ++i) *numbers[i] = Number::variable(*values[i], i);
  }
};

/// ln tau_bar at a temperature from its derivatives by what it is an integral of.
Number log_mean_stress(const MeanShearStress& stress, const ShearLaw<Number>& law,
                       const laws::LogStress<Number>& at, const Number& pressure) {
  Number out;
  out.value = stress.log_value;
  const LubricantOf<Number>& oil = law.lubricant;
  const double by_pressure = stress.by_log_pressure / pressure.value;
  for (int i = 0; i < kDirections; ++i) {
    out.slope[i] =
        stress.by_base * at.base.slope[i] + stress.by_factor * at.factor.slope[i] +
        stress.by_index * law.index.slope[i] + by_pressure * pressure.slope[i] +
        stress.by_limit_at_zero_pressure * oil.limiting_shear_stress_at_zero_pressure.slope[i] +
        stress.by_limit_coefficient * oil.limiting_shear_stress_coefficient.slope[i];
  }
  return out;
}

void take(const Number& from, ContactDerivatives& to) {
  to.value = from.value;
  for (int i = 0; i < kContactInputs; ++i) to.by[i] = from.slope[i];
}

bool alike(double x, double y) { return std::abs(x - y) <= 1e-9 * std::abs(y); }

}  // namespace

struct ContactSensitivityModel::Constants {
  ContactParametersOf<Number> parameters;
  ContactConstants<Number> constants;
};

ContactSensitivityModel::ContactSensitivityModel(const FlankContactModel& model) : model_(model) {
  auto constants = std::make_unique<Constants>();
  constants->parameters = Seeded(model.parameters(), ContactConditions{}).parameters;
  ModelOptions options = model.options();
  if (model.parameters().lubricant.relaxation_time == 0) options.newtonian = true;
  const auto index_of = [&](const Number& factor, const Number& coefficient) {
    return laws::root_with_slopes<kDirections>(
        model.pressure_viscosity_index(), [&](const Number& index) {
          return laws::roelands_reciprocal_asymptotic(factor, index) / coefficient - 1;
        });
  };
  constants->constants = contact_constants(constants->parameters, options, index_of);
  constants_ = std::move(constants);
}

ContactSensitivityModel::~ContactSensitivityModel() = default;
ContactSensitivityModel::ContactSensitivityModel(ContactSensitivityModel&&) noexcept = default;
ContactSensitivityModel& ContactSensitivityModel::operator=(ContactSensitivityModel&&) noexcept =
    default;

ContactSensitivity ContactSensitivityModel::at(const ContactConditions& conditions) const {
  const ContactSolution solution = model_.solve(conditions);
  ContactSensitivity out;
  if (solution.status == ContactStatus::kNoLoad) return out;
  if (solution.status != ContactStatus::kOk) {
    out.status = SensitivityStatus::kNotSolved;
    return out;
  }
  out = at(conditions, solution.film_load, solution.contact_temperature);
  out.several_equilibria = solution.thermal_roots > 1;
  return out;
}

ContactSensitivity ContactSensitivityModel::at(const ContactConditions& k, double film_load,
                                               double contact_temperature) const {
  ContactSensitivity out;
  if (!(k.load > 0)) return out;
  const auto refused = [&out](SensitivityStatus status) {
    out.status = status;
    return out;
  };
  const auto moves = [](double x, double y) { return x != 0 || y != 0; };
  if (!moves(k.velocity_1_x + k.velocity_2_x, k.velocity_1_y + k.velocity_2_y)) {
    return refused(SensitivityStatus::kNoEntrainment);
  }
  if (!moves(k.velocity_1_x - k.velocity_2_x, k.velocity_1_y - k.velocity_2_y)) {
    return refused(SensitivityStatus::kNoSliding);
  }
  if (!moves(k.velocity_1_x, k.velocity_1_y) || !moves(k.velocity_2_x, k.velocity_2_y)) {
    return refused(SensitivityStatus::kSurfaceAtRest);
  }
  out.status = SensitivityStatus::kOk;

  const ModelOptions& options = model_.options();
  const ContactParametersOf<Number>& parameters = constants_->parameters;
  const ContactConstants<Number>& constants = constants_->constants;
  const ContactConditionsOf<Number> conditions = Seeded(model_.parameters(), k).conditions;

  const LoadedContact<Number> loaded = loaded_contact(parameters, constants, options, conditions);
  const Number log_share = laws::root_with_slopes<kDirections>(
      std::log(film_load / k.load),
      [&](const Number& r) { return carried_share(loaded.sharing, r) - 1; });
  const SharedContact<Number> shared = shared_contact(parameters, constants, loaded, log_share);
  const HeatedContact<Number> heated =
      heated_contact(parameters, constants, options, conditions, shared);

  const Number& pressure = shared.axes.maximum_pressure;
  const Number log_shear_rate = laws::logarithm(heated.shear_rate);
  const bool limited = !options.no_limiting_shear_stress;
  const ShearedFilm film{&model_.constants().shear, pressure.value, log_shear_rate.value, limited};
  double switch_guess = 0;
  const MeanShearStress stress = mean_shear_stress(film, contact_temperature, switch_guess);
  Number mean_stress;
  const auto mean_stress_at = [&](const Number& temperature) {
    return laws::exponential(
        log_mean_stress(stress, constants.shear,
                        log_stress(constants.shear, temperature, log_shear_rate), pressure));
  };
  const Number temperature =
      laws::root_with_slopes<kDirections>(contact_temperature, [&](const Number& t) {
        return t - heated.temperature.base - heated.temperature.gain * mean_stress_at(t);
      });
  mean_stress = mean_stress_at(temperature);

  const Number viscous = laws::viscous_friction(heated.viscous_area, mean_stress);
  const Number friction = laws::friction(viscous, heated.boundary_friction);
  take(friction, out.friction);
  take(viscous, out.viscous_friction);
  take(heated.boundary_friction, out.boundary_friction);
  take(friction / conditions.load, out.friction_coefficient);
  take(friction * heated.sliding_speed, out.heat_rate);
  take(shared.film_thickness, out.film_thickness);
  take(shared.film_ratio, out.film_ratio);
  take(laws::exponential(log_share), out.film_load_share);
  take(pressure, out.maximum_pressure);
  take(temperature, out.contact_temperature);
  take(mean_stress, out.mean_shear_stress);
  out.one_sided =
      (options.hertz_solution == HertzSolution::kSimplified && alike(k.radius_x, k.radius_y)) ||
      alike(shared.asperity_area.value, shared.contact_area.value);
  return out;
}

const std::array<ContactInputName, kContactInputs>& contact_input_names() {
  static const std::array<ContactInputName, kContactInputs> names{{
      {"lubricant.vogel_viscosity_prefactor", "Pa s"},
      {"lubricant.vogel_temperature_coefficient", "K"},
      {"lubricant.vogel_reference_temperature", "K"},
      {"lubricant.pressure_viscosity_coefficient", "1/Pa"},
      {"lubricant.pressure_viscosity_temperature", "K"},
      {"lubricant.relaxation_time", "s"},
      {"lubricant.havriliak_negami_alpha", "1"},
      {"lubricant.havriliak_negami_beta", "1"},
      {"lubricant.rheology_reference_temperature", "K"},
      {"lubricant.limiting_shear_stress_at_zero_pressure", "Pa"},
      {"lubricant.limiting_shear_stress_coefficient", "1"},
      {"lubricant.thermal_conductivity", "W/(m K)"},
      {"lubricant.density_at_zero_kelvin", "kg/m3"},
      {"lubricant.density_temperature_slope", "kg/(m3 K)"},
      {"roughness.asperity_density", "1/m2"},
      {"roughness.asperity_radius", "m"},
      {"roughness.composite_rms_height", "m"},
      {"boundary.tribofilm_shear_strength", "Pa"},
      {"boundary.asperity_friction_coefficient", "1"},
      {"body_1.youngs_modulus", "Pa"},
      {"body_1.poissons_ratio", "1"},
      {"body_1.thermal_conductivity", "W/(m K)"},
      {"body_1.density", "kg/m3"},
      {"body_1.specific_heat_capacity", "J/(kg K)"},
      {"body_2.youngs_modulus", "Pa"},
      {"body_2.poissons_ratio", "1"},
      {"body_2.thermal_conductivity", "W/(m K)"},
      {"body_2.density", "kg/m3"},
      {"body_2.specific_heat_capacity", "J/(kg K)"},
      {"bath_temperature", "K"},
      {"inlet_temperature_rise", "K"},
      {"conditions.load", "N"},
      {"conditions.radius_x", "m"},
      {"conditions.radius_y", "m"},
      {"conditions.velocity_1_x", "m/s"},
      {"conditions.velocity_1_y", "m/s"},
      {"conditions.velocity_2_x", "m/s"},
      {"conditions.velocity_2_y", "m/s"},
  }};
  return names;
}

}  // namespace tribodyn
