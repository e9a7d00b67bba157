#pragma once

#include <cmath>
#include <numbers>

#include "core/contact/contact_constants.h"
#include "core/contact/hertz.h"
#include "core/contact/load_sharing.h"
#include "core/contact/mean_shear_stress.h"
#include "core/laws/laws.h"
#include "core/laws/lubricant.h"
#include "core/lubricant/viscosity.h"
#include "core/model_options.h"
#include "core/surface/surface.h"

// The equations of one contact, in the order in which they follow from its parameters, from its
// conditions, from how film and asperities share the load and from its temperature. Real is double,
// or a dual number for the derivatives. Other files solve for the implicit quantities: Z
// (core/lubricant/viscosity.h), the share (load_sharing.h), the temperature
// (thermal_equilibrium.h).

namespace tribodyn {

/// All scalar parameters of a contact. SI units.
template <class Real>
struct ContactParametersOf {
  LubricantOf<Real> lubricant;
  SolidPairOf<Real> solids;
  RoughnessOf<Real> roughness;
  BoundaryFrictionOf<Real> boundary;
  Real bath_temperature;        ///< T_b [K]
  Real inlet_temperature_rise;  ///< of eq 14 [K]
};

/// Load, geometry and velocities of one contact at one instant. SI units. x is the direction of R_x
/// (the minor axis while R_y >= R_x), y the direction of R_y. Bodies 1 and 2 are the paper's pinion
/// (p) and gear (g), or any other two.
template <class Real>
struct ContactConditionsOf {
  Real load;          ///< W, normal load [N]
  Real radius_x;      ///< R_zx, effective radius of curvature [m]
  Real radius_y;      ///< R_zy [m]
  Real velocity_1_x;  ///< u_s,p [m/s]
  Real velocity_1_y;  ///< v_s,p [m/s]
  Real velocity_2_x;  ///< u_s,g [m/s]
  Real velocity_2_y;  ///< v_s,g [m/s]
};

/// index_of(L, alpha*) gives Z by eq 33 at the temperature where alpha* was measured.
template <class Real, class Index>
ContactConstants<Real> contact_constants(const ContactParametersOf<Real>& in,
                                         const ModelOptions& options, Index&& index_of) {
  const LubricantOf<Real>& oil = in.lubricant;
  const bool misprinted = options.as_published.eq31_32_logarithm;
  ContactConstants<Real> out;
  out.inlet_temperature = in.bath_temperature + in.inlet_temperature_rise;  // (eq 14)
  const laws::WithSlope<Real> inlet = log_ambient_viscosity_and_slope(oil, out.inlet_temperature);
  out.log_inlet_viscosity = inlet.value;
  out.log_thermal_loading =
      laws::log_thermal_loading(inlet.value, Real(-inlet.slope), oil.thermal_conductivity);

  ShearLaw<Real>& shear = out.shear;
  shear.lubricant = oil;
  shear.log_vogel_prefactor = laws::logarithm(oil.vogel_viscosity_prefactor);
  shear.newtonian = options.newtonian;
  shear.roelands_misprinted = misprinted;
  shear.log_relaxation_time = laws::logarithm(oil.relaxation_time);
  const auto heat_density = [&](const Real& temperature) {
    return temperature * density(oil, temperature);
  };
  const Real& reference = oil.rheology_reference_temperature;
  shear.shift_reference =
      log_ambient_viscosity(oil, reference) - laws::logarithm(heat_density(reference));
  shear.coarse_heat_density_slope = 1 / laws::value_of(out.inlet_temperature) +
                                    laws::value_of(oil.density_temperature_slope) *
                                        laws::value_of(out.inlet_temperature) /
                                        laws::value_of(heat_density(out.inlet_temperature));

  if (oil.pressure_viscosity_law != PressureViscosityLaw::kRoelands) {
    shear.growth = laws::growth_law(oil, shear.log_vogel_prefactor);
    shear.index = Real(0.0);
    out.pressure_viscosity_coefficient =
        reciprocal_asymptotic_of_growth(shear.growth, out.inlet_temperature);
  } else {
    const Real where_measured = roelands_factor(
        log_ambient_viscosity(oil, oil.pressure_viscosity_temperature), options.as_published);
    const Real at_inlet = roelands_factor(out.log_inlet_viscosity, options.as_published);
    if (misprinted || options.pressure_viscosity_index == PressureViscosityIndex::kHoupert) {
      shear.index = laws::houpert_index(where_measured, oil.pressure_viscosity_coefficient);
      out.pressure_viscosity_coefficient =
          shear.index * laws::kRoelandsPressureCoefficient * at_inlet;
    } else {
      shear.index = index_of(where_measured, oil.pressure_viscosity_coefficient);
      out.pressure_viscosity_coefficient =
          laws::roelands_reciprocal_asymptotic(at_inlet, shear.index);
    }
  }

  out.reduced_modulus = reduced_modulus(in.solids);
  out.log_film = laws::log_film_constant(out.log_inlet_viscosity,
                                         laws::logarithm(out.pressure_viscosity_coefficient),
                                         laws::logarithm(out.reduced_modulus));
  out.asperity_load_factor = laws::asperity_load_factor(in.roughness, out.reduced_modulus);
  out.asperity_area_factor = laws::asperity_area_factor(in.roughness);
  out.conductance_factor_1 = laws::conductance_factor(in.solids.body_1);
  out.conductance_factor_2 = laws::conductance_factor(in.solids.body_2);
  return out;
}

/// The contact if the film carried all of its load.
template <class Real>
struct LoadedContact {
  Real entrainment_speed;    ///< U_eff, eq 17 [m/s]
  Real entrainment_radius;   ///< R_e, eq 15 [m]
  Real side_leakage_radius;  ///< R_s, eq 16 [m]
  UnitLoadEllipseOf<Real> unit;
  Real film_thickness;  ///< h_cen [m]
  LoadSharingOf<Real> sharing;
};

template <class Real>
LoadedContact<Real> loaded_contact(const ContactParametersOf<Real>& in,
                                   const ContactConstants<Real>& constants,
                                   const ModelOptions& options,
                                   const ContactConditionsOf<Real>& k) {
  LoadedContact<Real> out;
  const Real mean_x2 = laws::square(0.5 * (k.velocity_1_x + k.velocity_2_x));
  const Real mean_y2 = laws::square(0.5 * (k.velocity_1_y + k.velocity_2_y));
  const Real speed2 = laws::entrainment_speed_squared(mean_x2, mean_y2);
  out.entrainment_speed = laws::root(speed2);
  const bool entrained = speed2 > 0;
  const Real cosine2 = entrained ? mean_x2 / speed2 : Real(1.0);
  const Real sine2 = entrained ? mean_y2 / speed2 : Real(0.0);
  const Real curvature_x = 1 / k.radius_x, curvature_y = 1 / k.radius_y;
  const Real along = laws::curvature_along_entrainment(cosine2, sine2, curvature_x, curvature_y);
  const Real across = laws::curvature_across_entrainment(cosine2, sine2, curvature_x, curvature_y);
  out.entrainment_radius = 1 / along;
  out.side_leakage_radius = 1 / across;

  const HertzFitOf<Real> fit =
      options.hertz_solution == HertzSolution::kExact
          ? exact_ellipticity(k.radius_x, k.radius_y)
          : simplified_ellipticity(k.radius_x, k.radius_y, options.as_published);
  out.unit = unit_load_ellipse(fit, k.radius_x, k.radius_y, constants.reduced_modulus,
                               options.as_published);
  const EllipseAxesOf<Real> axes = ellipse_axes(out.unit, k.load);
  const Real log_along = laws::logarithm(along);
  out.film_thickness =
      entrained ? laws::exponential(laws::log_film(constants.log_film, laws::logarithm(speed2),
                                                   log_along, laws::logarithm(k.load))) *
                      laws::side_leakage(log_along - laws::logarithm(across))
                : Real(0.0);
  if (options.inlet_shear_heating && entrained) {
    const Real slide2 = laws::square(k.velocity_1_x - k.velocity_2_x) +
                        laws::square(k.velocity_1_y - k.velocity_2_y);
    out.film_thickness = out.film_thickness * laws::inlet_heating_factor(
                                                  constants.log_thermal_loading,
                                                  laws::logarithm(speed2), laws::logarithm(slide2),
                                                  axes.maximum_pressure, constants.reduced_modulus);
  }
  out.sharing = {
      k.load,
      out.film_thickness / in.roughness.composite_rms_height,
      constants.asperity_load_factor * std::numbers::pi * axes.semi_major * axes.semi_minor,
      options.hertz_load == HertzLoad::kTotalLoad,
      options.as_published.eq43_44_polynomials,
      options.closed_load_sharing && !options.as_published.eq43_44_polynomials &&
          constants.asperity_load_factor > 0};
  return out;
}

/// The contact as film and asperities share its load.
template <class Real>
struct SharedContact {
  Real ellipse_load;  ///< W_EHL of eq 41, which ellipse and film follow from [N]
  Real film_load;     ///< W_EHL: the same, unless load sharing is closed [N]
  EllipseAxesOf<Real> axes;
  Real contact_area;     ///< A_EHL [m2]
  Real film_thickness;   ///< h_cen [m]
  Real film_ratio;       ///< lambda_s [-]
  Real supported_share;  ///< film_load/ellipse_load [-]
  Real asperity_load;    ///< W_asp [N]
  Real asperity_area;    ///< A_asp [m2]
};

/// log_share is ln(W_EHL/W) of eq 41. Where a film supports less than that, asperities carry the
/// rest (K. L. Johnson, J. A. Greenwood and S. Y. Poon, Wear 19, 1972, 91): the mean planes
/// approach, and may pass each other, until eq 41 gives that load.
template <class Real>
SharedContact<Real> shared_contact(const ContactParametersOf<Real>& in,
                                   const ContactConstants<Real>& constants,
                                   const LoadedContact<Real>& loaded, const Real& log_share) {
  SharedContact<Real> out;
  const Real& load = loaded.sharing.load;
  out.ellipse_load = load * laws::exponential(log_share);
  out.film_load = out.ellipse_load;
  out.axes =
      ellipse_axes(loaded.unit, loaded.sharing.ellipse_from_total_load ? load : out.ellipse_load);
  out.contact_area = std::numbers::pi * out.axes.semi_major * out.axes.semi_minor;
  out.film_thickness = loaded.film_thickness * laws::film_thinning(log_share);
  out.film_ratio = out.film_thickness / in.roughness.composite_rms_height;
  const AsperityFunctionsOf<Real> functions =
      asperity_functions(out.film_ratio, loaded.sharing.as_published_polynomials);
  out.asperity_load = constants.asperity_load_factor * out.contact_area * functions.f5_2;
  out.asperity_area = constants.asperity_area_factor * out.contact_area * functions.f2;
  out.supported_share = loaded.sharing.closed ? laws::supported_share(out.film_ratio) : Real(1.0);
  if (out.supported_share < 1) {
    out.film_load = out.supported_share * out.ellipse_load;
    out.asperity_load = load - out.film_load;
    const Real separation = separation_under_load(
        Real(out.asperity_load / (constants.asperity_load_factor * out.contact_area)),
        laws::value_of(out.film_ratio));
    out.asperity_area = laws::least(
        Real(constants.asperity_area_factor * out.contact_area * asperity_functions(separation).f2),
        out.contact_area);
  }
  return out;
}

/// V_s = |U_1 - U_2| [m/s].
template <class Real>
Real sliding_speed(const ContactConditionsOf<Real>& k) {
  const Real squared =
      laws::square(k.velocity_1_x - k.velocity_2_x) + laws::square(k.velocity_1_y - k.velocity_2_y);
  return squared > 0 ? laws::root(squared) : Real(0.0);
}

/// What heats and cools the contact.
template <class Real>
struct HeatedContact {
  Real sliding_speed;                 ///< V_s [m/s]
  Real shear_rate;                    ///< gamma_dot, eq 18 [1/s]
  Real boundary_friction;             ///< F_b [N]
  Real viscous_area;                  ///< [m2]
  Real rate_1, rate_2;                ///< U_i/l_i [1/s]
  Real film_conduction;               ///< 2 k_f A [W m/K]
  Real conductance_1, conductance_2;  ///< 1/R_f,i [W/K]
  Real flash_resistance;              ///< R_f1 a_h [K/W]
  laws::ThermalLine<Real> temperature;
};

template <class Real>
HeatedContact<Real> heated_contact(const ContactParametersOf<Real>& in,
                                   const ContactConstants<Real>& constants,
                                   const ModelOptions& options, const ContactConditionsOf<Real>& k,
                                   const SharedContact<Real>& contact) {
  HeatedContact<Real> out;
  out.sliding_speed = sliding_speed(k);
  const bool slides = out.sliding_speed > 0;
  out.shear_rate = slides ? laws::shear_rate(out.sliding_speed, contact.film_thickness) : Real(0.0);
  out.boundary_friction =
      options.no_boundary_friction
          ? Real(0.0)
          : laws::boundary_friction(in.boundary.tribofilm_shear_strength, contact.asperity_area,
                                    in.boundary.asperity_friction_coefficient,
                                    contact.asperity_load);
  out.viscous_area =
      contact.supported_share * laws::viscous_area(contact.contact_area, contact.asperity_area);

  const bool major_along_y = k.radius_y >= k.radius_x;
  const Real per_minor = 1 / contact.axes.semi_minor, per_major = 1 / contact.axes.semi_major;
  const Real& per_x = major_along_y ? per_minor : per_major;
  const Real& per_y = major_along_y ? per_major : per_minor;
  out.rate_1 = laws::speed_per_length(k.velocity_1_x, k.velocity_1_y, per_x, per_y);
  out.rate_2 = laws::speed_per_length(k.velocity_2_x, k.velocity_2_y, per_x, per_y);
  out.film_conduction = 2 * in.lubricant.thermal_conductivity * contact.contact_area;
  out.conductance_1 = laws::moving_source_conductance(constants.conductance_factor_1,
                                                      contact.contact_area, out.rate_1);
  out.conductance_2 = laws::moving_source_conductance(constants.conductance_factor_2,
                                                      contact.contact_area, out.rate_2);
  out.flash_resistance = laws::flash_resistance(out.film_conduction, contact.film_thickness,
                                                out.conductance_1, out.conductance_2);
  out.temperature = {constants.inlet_temperature, Real(0.0)};
  if (!options.isothermal && slides) {
    out.temperature = laws::contact_temperature(
        constants.inlet_temperature, out.flash_resistance * out.sliding_speed,
        out.boundary_friction, out.viscous_area,
        laws::oil_rise_per_stress(out.sliding_speed, contact.film_thickness,
                                  in.lubricant.thermal_conductivity));
  }
  return out;
}

}  // namespace tribodyn
