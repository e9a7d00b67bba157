#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/rigs.pb.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn::server {

/// A rig to run: its specimens, and what an answer says of its inputs.
struct RigEvaluation {
  RigScene scene;
  std::shared_ptr<const v1::Lubricant> lubricant;
  std::shared_ptr<const v1::Surface> surface;  ///< null for smooth specimens
  double composite_rms_height = 0;             ///< replaces that of the surface [m]; 0: it stays
  std::string lubricant_revision;
  std::string surface_revision;  ///< empty for smooth specimens
};

inline constexpr int kMaximumRigConditions = 5000;  ///< of one EvaluateRig

/// One column of the answer and the figure that it holds. Databases hold the columns of campaigns
/// in this order: a further one comes last.
struct RigColumn {
  const char* name;
  google::protobuf::RepeatedField<double>* (v1::EvaluateRigResponse::*column)();
  double RigPoint::*figure;
};
std::span<const RigColumn> rig_columns();

/// The warnings of a point of a rig; `grounds` are those of its lubricant.
std::vector<RangeWarning> rig_warnings(const RigScene& scene, const FluidGrounds& grounds,
                                       double supply_temperature_celsius, const RigPoint& point,
                                       bool with_sentences = true);

/// Sets roughness and boundary friction of the specimens. A height other than 0 replaces that of
/// the surface.
void set_surface(const v1::Surface& surface, double composite_rms_height, RigScene& scene);

/// Checks the request and finds its resources. Returns nullopt and adds all violations if the
/// request is invalid, or has more than `most` conditions.
std::optional<RigEvaluation> read_rig(const v1::EvaluateRigRequest& request,
                                      const ResourceLookup& lookup, Violations& violations,
                                      int most = kMaximumRigConditions);

/// Returns the number of conditions of a request, valid or not.
double rig_condition_count(const v1::EvaluateRigRequest& request);

/// Returns the conditions of a request, those of a grid in the order of nested loops.
std::vector<v1::RigCondition> rig_conditions(const v1::EvaluateRigRequest& request);

/// Computes all conditions, with the uncertainty of their figures if the request has draws. A
/// condition that the core refuses is a refused row. Throws Cancelled soon after `is_over` returns
/// true.
v1::EvaluateRigResponse evaluate_rig(const v1::EvaluateRigRequest& request,
                                     const RigEvaluation& evaluation,
                                     const std::function<bool()>& is_over);

}  // namespace tribodyn::server
