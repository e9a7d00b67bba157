#include "core/rig/rig.h"

#include <cmath>
#include <limits>
#include <string>

#include "core/laws/laws.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

/// A contact needs a height by which it divides the film; without asperities it has no effect.
Roughness roughness_of(const RigScene& scene) {
  return scene.roughness.asperity_density == 0 ? Roughness{0, 1e-6, 1e-9} : scene.roughness;
}

}  // namespace

double load_of_mean_pressure(const SolidPair& solids, const EffectiveRadii& radii,
                             double mean_pressure) {
  const UnitLoadEllipse unit = unit_load_ellipse(exact_ellipticity(radii.x, radii.y), radii.x,
                                                 radii.y, reduced_modulus(solids), {});
  const double root = 1.5 * mean_pressure / unit.maximum_pressure;
  return root * root * root;
}

Rig::Rig(const RigScene& scene, double supply_temperature)
    : radii_(scene.radii),
      is_smooth_(scene.roughness.asperity_density == 0),
      contact_(scene.lubricant, scene.solids, roughness_of(scene),
               boundary_friction(scene.boundary, scene.lubricant_boundary, supply_temperature),
               supply_temperature, 0, scene.options) {}

RigPoint Rig::at(const RigCondition& condition) const {
  const double half_slide = 0.5 * condition.slide_roll_ratio * condition.entrainment_speed;
  const ContactSolution s =
      contact_.solve({condition.load, radii_.x, radii_.y, condition.entrainment_speed + half_slide,
                      0, condition.entrainment_speed - half_slide, 0});
  if (s.status != ContactStatus::kOk) {
    throw Refusal(contact_status_name(s.status), contact_status_sentence(s.status));
  }
  if (s.contact_temperature > kHottestContact) {
    throw Refusal("CONTACT_TOO_HOT", "the contact would have " +
                                         std::to_string(std::lround(s.contact_temperature)) +
                                         " K, and steel melts at about 1800 K");
  }
  const double slip = std::abs(condition.slide_roll_ratio);
  const double boundary = s.boundary_friction * slip / (slip + kBoundaryCreep);
  const double friction = s.viscous_friction + boundary;
  RigPoint out{};
  out.traction_coefficient = std::copysign(friction / condition.load, condition.slide_roll_ratio);
  out.central_film_thickness = s.central_film_thickness;
  out.minimum_film_thickness =
      s.central_film_thickness *
      laws::minimum_film_share(std::log(s.side_leakage_radius / s.entrainment_radius));
  out.film_ratio = is_smooth_ ? std::numeric_limits<double>::quiet_NaN() : s.film_ratio;
  out.mean_pressure = 2.0 / 3 * s.maximum_pressure;
  out.maximum_pressure = s.maximum_pressure;
  out.contact_temperature = s.contact_temperature;
  out.flash_temperature_rise = s.flash_temperature_rise;
  out.boundary_friction_share = friction > 0 ? boundary / friction : 0;
  out.limiting_stress_area_share = s.limiting_stress_area_share;
  out.inlet_heating_factor =
      contact_.inlet_heating_factor(s.entrainment_speed * s.entrainment_speed,
                                    s.sliding_speed * s.sliding_speed, s.maximum_pressure);
  out.inlet_viscosity = s.inlet_viscosity;
  return out;
}

}  // namespace tribodyn
