#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "core/study/operating_point.h"
#include "core/study/scene.h"
#include "core/study/speed_sweep.h"
#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

/// Inputs of a simulation: the request, the request with every default written out (explicit speeds
/// in ascending order, no zero that means a default, names with revisions), and the resources,
/// which other simulations share (see parse_resource).
struct SimulationInputs {
  v1::Simulation requested;
  v1::Simulation effective;
  std::shared_ptr<const v1::Lubricant> lubricant;
  std::shared_ptr<const v1::GearSet> gear_set;
  std::shared_ptr<const v1::Surface> surface;
  std::shared_ptr<const v1::Vehicle> vehicle;
};

/// Resources of a simulation. Two tuples are equal if they hold the same objects.
using Resources =
    std::tuple<std::shared_ptr<const v1::Lubricant>, std::shared_ptr<const v1::GearSet>,
               std::shared_ptr<const v1::Surface>, std::shared_ptr<const v1::Vehicle>>;
inline Resources resources(const SimulationInputs& inputs) {
  return {inputs.lubricant, inputs.gear_set, inputs.surface, inputs.vehicle};
}

/// Returns the request without output-only and unknown fields.
v1::Simulation client_part(const v1::Simulation& simulation);

/// Checks the request, finds its resources and fills in defaults. Returns nullopt and adds all
/// violations if the request is invalid; their paths start with `path`.
std::optional<SimulationInputs> read_simulation(const v1::Simulation& request,
                                                const ResourceLookup& lookup,
                                                const std::string& path, Violations& violations);

/// Writes out what unset options mean.
void fill_model_options(v1::ModelOptions& options);

/// Returns the physical inputs for the core.
Scene scene(const SimulationInputs& inputs);

struct PointStudy {
  OperatingCondition condition;
  PointOptions options;
};

struct CurveStudy {
  std::vector<double> vehicle_speeds;  ///< ascending [m/s]
  double ascent_angle = 0;             ///< [rad]
  SweepOptions options;
};

using Study = std::variant<PointStudy, CurveStudy>;

/// Returns the study for the core, without progress callbacks.
Study study(const SimulationInputs& inputs);

}  // namespace tribodyn::server
