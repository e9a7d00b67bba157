#pragma once

#include <optional>
#include <vector>

#include "core/periodic/periodic_orbit.h"
#include "core/study/point_result.h"
#include "core/study/prepared_scene.h"

namespace tribodyn {

/// The figures of a point that can leave the ranges of the laws. Zeros where no flank carries load.
struct RangeFigures {
  double maximum_pressure = 0;            ///< largest p_max [Pa]
  double film_ratio = 0;                  ///< least lambda_s [-]
  double film_thickness = 0;              ///< mean h_cen, weighted with the load [m]
  double contact_temperature = 0;         ///< highest T_c [K]
  double friction_coefficient = 0;        ///< of a contact alone [-]
  double limiting_stress_area_share = 0;  ///< as in PointResult [-]
  double inlet_heating_factor = 1;        ///< least phi_T, whether the model has it or not [-]
  double inlet_viscosity = 0;             ///< [Pa s]
  double radius_ratio = 1;                ///< as in FlankExtremes [-]
  bool settled = true;
  int period_in_mesh_cycles = 1;
  long mesh_cycles = 0;  ///< searched and averaged, without a period
  int recorded_mesh_cycles = 0;
  std::optional<double> estimated_relative_error;
  PointModel model = PointModel::kFull;
};

RangeFigures range_figures(PreparedScene& prepared, const PointResult& result);

/// The same of an orbit whose contacts are solved, for a microsecond: extremes are those of the
/// contacts solved, and lie as close to those of the result.
RangeFigures range_figures(PreparedScene& prepared, const PeriodicOrbit& orbit, PointModel model,
                           double mean_pinion_speed);

/// Of a contact alone, e.g. of a rig.
RangeFigures range_figures(const ContactSolution& contact, double inlet_heating_factor);

/// What of a scene has a range: of an axle, a rig or a contact.
struct RangeGrounds {
  FluidGrounds fluid;
  ModelOptions options;
  Roughness roughness;
  double inlet_temperature;  ///< [K]
};

/// Where figures leave the range in which a law was checked, or need a word of caution. Warnings of
/// how the response was found are not among them (response_warnings.h). Without sentences, which
/// take a microsecond each, there are only the codes.
std::vector<RangeWarning> range_warnings(const RangeGrounds& grounds, const RangeFigures& figures,
                                         bool with_sentences = true);
std::vector<RangeWarning> range_warnings(const Scene& scene, const RangeFigures& figures,
                                         bool with_sentences = true);

/// Adds warnings to others, of which one of each code is kept: that with the greatest excess.
void keep_furthest(const std::vector<RangeWarning>& warnings, std::vector<RangeWarning>& kept);

}  // namespace tribodyn
