#include "core/contact/contact_sensitivity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "core/contact/contact_equations.h"

namespace tribodyn {
namespace {

constexpr int kConditions = kContactInputs - kContactParameters;

/// By all inputs; the last direction is for the unknown of root_with_slopes.
constexpr int kDirections = kContactInputs + 1;
using DualNumber = laws::Dual<double, kDirections>;

// What the contact and the stress at one temperature depend on directly is less than all inputs.
// They are evaluated with derivatives by that, and by all inputs through the chain rule.

/// By the conditions and contact_level; the last direction is for the unknown.
constexpr int kContactLevel = kDirectLevels;
constexpr int kContactDirections = kConditions + kContactLevel + 1;
using ContactNumber = laws::Dual<double, kContactDirections>;

template <class Real>
std::array<Real*, kContactLevel> contact_level(ContactParametersOf<Real>& parameters,
                                               ContactConstants<Real>& constants) {
  return {&parameters.roughness.composite_rms_height,
          &parameters.boundary.tribofilm_shear_strength,
          &parameters.boundary.asperity_friction_coefficient,
          &parameters.lubricant.thermal_conductivity,
          &constants.inlet_temperature,
          &constants.log_film,
          &constants.log_thermal_loading,
          &constants.reduced_modulus,
          &constants.asperity_load_factor,
          &constants.asperity_area_factor,
          &constants.conductance_factor_1,
          &constants.conductance_factor_2};
}

/// By temperature, logarithm of the shear rate and stress_level.
constexpr int kStressLevel = kStressLevels;
using StressNumber = laws::Dual<double, 2 + kStressLevel>;

template <class Real>
std::array<Real*, kStressLevel> stress_level(ShearLaw<Real>& law) {
  LubricantOf<Real>& oil = law.lubricant;
  return {&law.log_vogel_prefactor,
          &law.log_relaxation_time,
          &law.shift_reference,
          &oil.vogel_temperature_coefficient,
          &oil.vogel_reference_temperature,
          &oil.havriliak_negami_alpha,
          &oil.havriliak_negami_beta,
          &oil.density_at_zero_kelvin,
          &oil.density_temperature_slope};
}

/// Adds derivatives times a factor. x need not have any where the factor is 0, as those of the
/// shift of the relaxation time where F = 1.
void add(double factor, const DualNumber& x, DualNumber& sum) {
  if (factor == 0) return;
  for (int i = 0; i < kContactInputs; ++i) sum.slope[i] += factor * x.slope[i];
}

void take(const DualNumber& from, ContactDerivatives& to) {
  to.value = from.value;
  for (int i = 0; i < kContactInputs; ++i) to.by[i] = from.slope[i];
}

bool alike(double x, double y) { return std::abs(x - y) <= 1e-9 * std::abs(y); }

}  // namespace

struct ContactSensitivityModel::Constants {
  bool roelands;
  std::array<DualNumber, kContactLevel> contact;
  std::array<DualNumber, kStressLevel> stress;
  /// The arguments of MeanShearStress::by_growth by all inputs, from the second one on: the first
  /// one, L or T, depends on the contact temperature too.
  std::array<DualNumber, kGrowthArguments> growth;
  DualNumber limit_at_zero_pressure, limit_coefficient;
  ContactParametersOf<ContactNumber> parameters;
  ContactConstants<ContactNumber> constants;
  ShearLaw<StressNumber> shear;
  std::array<std::array<double, kContactParameters>, kContactLevels> levels{};

  void set_level(int level, const DualNumber& x) {
    std::copy(x.slope, x.slope + kContactParameters, levels[level].begin());
  }
  DualNumber by_inputs(const ContactNumber& x) const {
    DualNumber out(x.value);
    for (int i = 0; i < kConditions; ++i) out.slope[kContactParameters + i] = x.slope[i];
    for (int i = 0; i < kContactLevel; ++i) add(x.slope[kConditions + i], contact[i], out);
    return out;
  }
};

ContactSensitivityModel::ContactSensitivityModel(const FlankContactModel& model) : model_(model) {
  ContactParametersOf<double> values = model.parameters();
  ContactConditions no_conditions{};
  ContactParametersOf<DualNumber> parameters;
  ContactConditionsOf<DualNumber> conditions;
  const auto from = contact_inputs(values, no_conditions);
  const auto to = contact_inputs(parameters, conditions);
  for (int i = 0; i < kContactInputs; ++i) *to[i] = DualNumber::variable(*from[i], i);
  parameters.lubricant.pressure_viscosity_law = values.lubricant.pressure_viscosity_law;
  ModelOptions options = model.options();
  if (values.lubricant.relaxation_time == 0) options.newtonian = true;
  const auto index_of = [&](const DualNumber& factor, const DualNumber& coefficient) {
    using Number = laws::Dual<double, 3>;  // by the factor, the coefficient and the unknown
    const Number l = Number::variable(factor.value, 0);
    const Number alpha = Number::variable(coefficient.value, 1);
    const Number index = laws::root_with_slopes<3>(
        model.pressure_viscosity_index(),
        [&](const Number& z) { return laws::roelands_reciprocal_asymptotic(l, z) / alpha - 1; });
    return chained(index.value, index.slope[0], factor, index.slope[1], coefficient);
  };
  ContactConstants<DualNumber> constants = contact_constants(parameters, options, index_of);

  parameters.boundary.asperity_friction_coefficient =
      parameters.boundary.asperity_friction_coefficient +
      values.boundary.coefficient_slope *
          (constants.inlet_temperature - constants.inlet_temperature.value);

  auto kept = std::make_unique<Constants>();
  const auto contact = contact_level(parameters, constants);
  const auto contact_variables = contact_level(kept->parameters, kept->constants);
  for (int i = 0; i < kContactLevel; ++i) {
    kept->contact[i] = *contact[i];
    *contact_variables[i] = ContactNumber::variable(contact[i]->value, kConditions + i);
  }
  const auto stress = stress_level(constants.shear);
  const auto stress_variables = stress_level(kept->shear);
  for (int i = 0; i < kStressLevel; ++i) {
    kept->stress[i] = *stress[i];
    *stress_variables[i] = StressNumber::variable(stress[i]->value, 2 + i);
  }
  kept->shear.newtonian = constants.shear.newtonian;
  kept->shear.roelands_misprinted = constants.shear.roelands_misprinted;
  const LubricantOf<DualNumber>& oil = parameters.lubricant;
  kept->roelands = oil.pressure_viscosity_law == PressureViscosityLaw::kRoelands;
  if (kept->roelands) {
    kept->growth[1] = constants.shear.index;
  } else {
    const auto& of_law = constants.shear.growth.parameters;
    std::copy(of_law.begin(), of_law.end(), kept->growth.begin() + 1);
  }
  kept->limit_at_zero_pressure = parameters.lubricant.limiting_shear_stress_at_zero_pressure;
  kept->limit_coefficient = parameters.lubricant.limiting_shear_stress_coefficient;

  for (int i = 0; i < kContactLevel; ++i) kept->set_level(i, kept->contact[i]);
  for (int i = 0; i < kStressLevel; ++i) {
    const int level = kDirectLevels + i;
    const bool of_viscosity = level == kLevelLogVogelPrefactor || level == kLevelVogelCoefficient ||
                              level == kLevelVogelReference;
    // The others do nothing to a Newtonian fluid; by a relaxation time of 0 they have no
    // derivatives.
    if (of_viscosity || !options.newtonian) kept->set_level(level, kept->stress[i]);
  }
  for (int i = 1; i < kGrowthArguments; ++i) {
    kept->set_level(kLevelGrowth + i - 1, kept->growth[i]);
  }
  kept->set_level(kLevelLimitAtZeroPressure, kept->limit_at_zero_pressure);
  kept->set_level(kLevelLimitCoefficient, kept->limit_coefficient);
  constants_ = std::move(kept);
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
  out = at(conditions, solution.ellipse_load, solution.contact_temperature);
  out.several_equilibria = solution.thermal_roots > 1;
  return out;
}

ContactSensitivity ContactSensitivityModel::at(const ContactConditions& k, double ellipse_load,
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
  const Constants& c = *constants_;
  const auto variable = [](double x, int i) { return ContactNumber::variable(x, i); };
  const ContactConditionsOf<ContactNumber> conditions{
      variable(k.load, 0),         variable(k.radius_x, 1),     variable(k.radius_y, 2),
      variable(k.velocity_1_x, 3), variable(k.velocity_1_y, 4), variable(k.velocity_2_x, 5),
      variable(k.velocity_2_y, 6)};
  const LoadedContact<ContactNumber> loaded =
      loaded_contact(c.parameters, c.constants, options, conditions);
  const ContactNumber log_share = laws::root_with_slopes<kContactDirections>(
      std::log(ellipse_load / k.load),
      [&](const ContactNumber& r) { return carried_share(loaded.sharing, r) - 1; });
  const SharedContact<ContactNumber> shared =
      shared_contact(c.parameters, c.constants, loaded, log_share);
  const HeatedContact<ContactNumber> heated =
      heated_contact(c.parameters, c.constants, options, conditions, shared);

  // The mean stress at a temperature: explicit_part + by_temperature (T - T_c), as a logarithm.
  const DualNumber pressure = c.by_inputs(shared.axes.maximum_pressure);
  const DualNumber log_shear_rate = c.by_inputs(laws::logarithm(heated.shear_rate));
  const ShearedFilm film{&model_.constants().shear, pressure.value, log_shear_rate.value,
                         !options.no_limiting_shear_stress, true};
  double switch_guess = 0;
  const MeanShearStress stress = mean_shear_stress(film, contact_temperature, switch_guess);
  const auto log_stress_there = log_stress(c.shear, StressNumber::variable(contact_temperature, 0),
                                           StressNumber::variable(log_shear_rate.value, 1));
  const double by_factor = c.roelands ? stress.by_growth[0] : 0;
  const auto by_stress_level = [&](int i) {
    return stress.by_base * log_stress_there.base.slope[i] +
           by_factor * log_stress_there.factor.slope[i];
  };
  const double by_temperature = by_stress_level(0) + (c.roelands ? 0 : stress.by_growth[0]);
  DualNumber explicit_part(stress.log_value);
  add(by_stress_level(1), log_shear_rate, explicit_part);
  for (int i = 0; i < kStressLevel; ++i) add(by_stress_level(2 + i), c.stress[i], explicit_part);
  for (int i = 1; i < kGrowthArguments; ++i) add(stress.by_growth[i], c.growth[i], explicit_part);
  add(stress.by_log_pressure / pressure.value, pressure, explicit_part);
  add(stress.by_limit_at_zero_pressure, c.limit_at_zero_pressure, explicit_part);
  add(stress.by_limit_coefficient, c.limit_coefficient, explicit_part);
  const auto mean_stress_at = [&](const DualNumber& temperature) {
    return laws::exponential(explicit_part + by_temperature * (temperature - contact_temperature));
  };
  const DualNumber base = c.by_inputs(heated.temperature.base);
  const DualNumber gain = c.by_inputs(heated.temperature.gain);
  const DualNumber temperature = laws::root_with_slopes<kDirections>(
      contact_temperature,
      [&](const DualNumber& t) { return t - base - gain * mean_stress_at(t); });
  const DualNumber mean_stress = mean_stress_at(temperature);

  const DualNumber boundary = c.by_inputs(heated.boundary_friction);
  const DualNumber viscous = laws::viscous_friction(c.by_inputs(heated.viscous_area), mean_stress);
  const DualNumber friction = laws::friction(viscous, boundary);
  take(friction, out.friction);
  take(viscous, out.viscous_friction);
  take(boundary, out.boundary_friction);
  const int load = static_cast<int>(ContactInput::kLoad);
  take(friction / DualNumber::variable(k.load, load), out.friction_coefficient);
  take(friction * c.by_inputs(heated.sliding_speed), out.heat_rate);
  take(c.by_inputs(shared.film_thickness), out.film_thickness);
  take(c.by_inputs(shared.film_ratio), out.film_ratio);
  take(c.by_inputs(shared.film_load / conditions.load), out.film_load_share);
  take(pressure, out.maximum_pressure);
  take(temperature, out.contact_temperature);
  take(mean_stress, out.mean_shear_stress);
  out.one_sided =
      (options.hertz_solution == HertzSolution::kSimplified && alike(k.radius_x, k.radius_y)) ||
      alike(shared.asperity_area.value, shared.contact_area.value);
  return out;
}

const std::array<std::array<double, kContactParameters>, kContactLevels>&
ContactSensitivityModel::levels_by_parameter() const {
  return constants_->levels;
}

}  // namespace tribodyn
