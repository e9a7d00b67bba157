#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/rig/rig.h"
#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/rigs.pb.h"

namespace tribodyn::server {

/// A rig to run: its specimens, and what an answer says of its inputs.
struct RigEvaluation {
  RigScene scene;
  std::shared_ptr<const v1::Lubricant> lubricant;
  std::string lubricant_revision;
  std::string surface_revision;  ///< empty for smooth specimens
};

/// Checks the request and finds its resources. Returns nullopt and adds all violations if the
/// request is invalid.
std::optional<RigEvaluation> read_rig(const v1::EvaluateRigRequest& request,
                                      const ResourceLookup& lookup, Violations& violations);

/// Computes all conditions. A condition that the core refuses is a refused row. Throws Cancelled
/// soon after `is_over` returns true.
v1::EvaluateRigResponse evaluate_rig(const v1::EvaluateRigRequest& request,
                                     const RigEvaluation& evaluation,
                                     const std::function<bool()>& is_over);

}  // namespace tribodyn::server
