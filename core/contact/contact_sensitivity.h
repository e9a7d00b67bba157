#pragma once

#include <algorithm>
#include <array>
#include <memory>

#include "core/contact/contact_level.h"
#include "core/contact/flank_contact.h"

// Derivatives of one contact by all of its scalar inputs.
//
// The equations of contact_equations.h are evaluated in dual numbers (core/numerics/dual-inl.h) at
// a solved contact. The implicit quantities are not iterated again: the implicit function theorem,
// one Newton step in dual numbers at the converged root, differentiates Z (eq 33), the film's share
// of the load (eq 41) and the contact temperature (eq 38). The mean stress is an integral
// whose derivatives are integrals; the places where the stress meets its limit do not enter,
// because there the integrand is continuous.

namespace tribodyn {

/// The scalar inputs of a contact: parameters of the model first, then the conditions of the
/// instant. Where both bodies are of one material, the derivative by a property of it is the sum of
/// the derivatives by that property of body 1 and of body 2.
enum class ContactInput {
  kVogelViscosityPrefactor,
  kVogelTemperatureCoefficient,
  kVogelReferenceTemperature,
  kPressureViscosityCoefficient,
  kPressureViscosityTemperature,
  kRelaxationTime,
  kHavriliakNegamiAlpha,
  kHavriliakNegamiBeta,
  kRheologyReferenceTemperature,
  kLimitingShearStressAtZeroPressure,
  kLimitingShearStressCoefficient,
  kThermalConductivity,
  kDensityAtZeroKelvin,
  kDensityTemperatureSlope,
  kLawParameters,  ///< the first of LubricantOf::law_parameters: without effect on Roelands's law
  kAsperityDensity = kLawParameters + kMostLawParameters,
  kAsperityRadius,
  kCompositeRmsHeight,
  kTribofilmShearStrength,
  kAsperityFrictionCoefficient,
  kBody1YoungsModulus,
  kBody1PoissonsRatio,
  kBody1ThermalConductivity,
  kBody1Density,
  kBody1SpecificHeatCapacity,
  kBody2YoungsModulus,
  kBody2PoissonsRatio,
  kBody2ThermalConductivity,
  kBody2Density,
  kBody2SpecificHeatCapacity,
  kBathTemperature,
  kInletTemperatureRise,
  kLoad,  ///< from here on conditions
  kRadiusX,
  kRadiusY,
  kVelocity1X,
  kVelocity1Y,
  kVelocity2X,
  kVelocity2Y,
};
inline constexpr int kContactParameters = static_cast<int>(ContactInput::kLoad);
inline constexpr int kContactInputs = static_cast<int>(ContactInput::kVelocity2Y) + 1;

/// Returns the address of each input, by ContactInput, so that callers can read or change it.
template <class Real>
std::array<Real*, kContactInputs> contact_inputs(ContactParametersOf<Real>& parameters,
                                                 ContactConditionsOf<Real>& conditions) {
  LubricantOf<Real>& oil = parameters.lubricant;
  SolidOf<Real>&one = parameters.solids.body_1, &two = parameters.solids.body_2;
  RoughnessOf<Real>& surface = parameters.roughness;
  const std::array first{&oil.vogel_viscosity_prefactor,
                         &oil.vogel_temperature_coefficient,
                         &oil.vogel_reference_temperature,
                         &oil.pressure_viscosity_coefficient,
                         &oil.pressure_viscosity_temperature,
                         &oil.relaxation_time,
                         &oil.havriliak_negami_alpha,
                         &oil.havriliak_negami_beta,
                         &oil.rheology_reference_temperature,
                         &oil.limiting_shear_stress_at_zero_pressure,
                         &oil.limiting_shear_stress_coefficient,
                         &oil.thermal_conductivity,
                         &oil.density_at_zero_kelvin,
                         &oil.density_temperature_slope};
  const std::array last{&surface.asperity_density,
                        &surface.asperity_radius,
                        &surface.composite_rms_height,
                        &parameters.boundary.tribofilm_shear_strength,
                        &parameters.boundary.asperity_friction_coefficient,
                        &one.youngs_modulus,
                        &one.poissons_ratio,
                        &one.thermal_conductivity,
                        &one.density,
                        &one.specific_heat_capacity,
                        &two.youngs_modulus,
                        &two.poissons_ratio,
                        &two.thermal_conductivity,
                        &two.density,
                        &two.specific_heat_capacity,
                        &parameters.bath_temperature,
                        &parameters.inlet_temperature_rise,
                        &conditions.load,
                        &conditions.radius_x,
                        &conditions.radius_y,
                        &conditions.velocity_1_x,
                        &conditions.velocity_1_y,
                        &conditions.velocity_2_x,
                        &conditions.velocity_2_y};
  static_assert(first.size() + kMostLawParameters + last.size() == kContactInputs);
  std::array<Real*, kContactInputs> out;
  auto next = std::copy(first.begin(), first.end(), out.begin());
  for (Real& each : oil.law_parameters) *next++ = &each;
  std::copy(last.begin(), last.end(), next);
  return out;
}

/// An output and its derivatives, each in the output's unit over the input's, by ContactInput.
struct ContactDerivatives {
  double value = 0;
  std::array<double, kContactInputs> by{};

  double by_input(ContactInput input) const { return by[static_cast<int>(input)]; }
};

enum class SensitivityStatus {
  kOk,
  kNoLoad,         ///< W <= 0: all outputs and derivatives are zero
  kNotSolved,      ///< the contact is refused; see ContactSolution::status
  kNoEntrainment,  ///< no film, of which eq 12 has no finite derivative
  kNoSliding,      ///< V_s = |u_1 - u_2| has no derivative at 0
  kSurfaceAtRest,  ///< its conductance, proportional to the root of its speed, has none either
};

/// Where the derivatives exist, and from which side:
/// - Where stress meets its limit, at the onset of limiting and where asperities begin to touch
///   outputs have continuous first derivatives; only the second ones jump.
/// - `one_sided` is true within 1e-9 (relative) of R_x = R_y with the simplified Hertz fits, which
///   jump there, and of A_asp = A_EHL, where the area that shears lubricant ends. The derivatives
///   are those of the side on which the contact is.
/// - With several thermal equilibria they are those of the coldest; `several_equilibria` is true.
/// - A relaxation time of 0 stands for F = 1: derivatives by it and by the exponents are 0.
struct ContactSensitivity {
  SensitivityStatus status = SensitivityStatus::kNoLoad;
  bool one_sided = false;
  bool several_equilibria = false;
  ContactDerivatives friction;              ///< F_fr [N]
  ContactDerivatives viscous_friction;      ///< F_v [N]
  ContactDerivatives boundary_friction;     ///< F_b [N]
  ContactDerivatives friction_coefficient;  ///< F_fr/W [-]
  ContactDerivatives heat_rate;             ///< F_fr V_s [W]
  ContactDerivatives film_thickness;        ///< h_cen [m]
  ContactDerivatives film_ratio;            ///< lambda_s [-]
  ContactDerivatives film_load_share;       ///< W_EHL/W [-]
  ContactDerivatives maximum_pressure;      ///< p_max [Pa]
  ContactDerivatives contact_temperature;   ///< T_c [K]
  ContactDerivatives mean_shear_stress;     ///< tau_bar [Pa]
};

/// Derivatives of the contacts of one model. Immutable after construction, safe for concurrent use;
/// allocates nothing per contact, never throws after construction.
class ContactSensitivityModel {
 public:
  explicit ContactSensitivityModel(const FlankContactModel& model);
  ~ContactSensitivityModel();
  ContactSensitivityModel(ContactSensitivityModel&&) noexcept;
  ContactSensitivityModel& operator=(ContactSensitivityModel&&) noexcept;

  /// Solves the contact, then differentiates.
  ContactSensitivity at(const ContactConditions& conditions) const;

  /// Differentiates a contact that has been solved, by FlankContactModel or FlankContactBatch, with
  /// the load of the ellipse [N] and contact temperature [K] found. An error of either enters the
  /// derivatives in the first order.
  ContactSensitivity at(const ContactConditions& conditions, double ellipse_load,
                        double contact_temperature) const;

  /// Derivatives of each ContactLevel by the parameters of the model: what takes those of
  /// FlankContactBatch::differentiate() to the parameters.
  const std::array<std::array<double, kContactParameters>, kContactLevels>& levels_by_parameter()
      const;

 private:
  struct Constants;

  FlankContactModel model_;
  std::unique_ptr<const Constants> constants_;
};

}  // namespace tribodyn
