#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/study/sensitivities.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// A figure, and a parameter by which it is differentiated.
struct Elasticity {
  std::string figure;     ///< as in EvaluatePointsRequest
  std::string parameter;  ///< likewise
  OrbitFigure orbit_figure;
  std::string_view scene_parameter;  ///< its name in PointSensitivities
};

/// Figure that is differentiated if a request names none.
inline constexpr char kDefaultElasticityFigure[] = "inefficiency_energy_mean_percent";

/// Returns the elasticities of a request, by figure. Adds all violations; then the elasticities
/// mean nothing.
std::vector<Elasticity> read_elasticities(const v1::EvaluatePointsRequest& request,
                                          Violations& violations);

/// Returns the values of the elasticities; NaN where there is none.
std::vector<double> elasticity_values(const std::optional<PointSensitivities>& sensitivities,
                                      const std::vector<Elasticity>& elasticities);

}  // namespace tribodyn::server
