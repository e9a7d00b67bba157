#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/viscosities.pb.h"

namespace tribodyn::server {

/// Largest number of combinations of temperatures and pressures.
inline constexpr int kMaximumViscosities = 100'000;

/// The lubricant of a request, and what an answer says of it.
struct ViscosityEvaluation {
  std::shared_ptr<const v1::Lubricant> lubricant;
  std::string lubricant_revision;  ///< empty: explicit
};

/// Checks the request and finds its lubricant. Returns nullopt and adds all violations if the
/// request is invalid.
std::optional<ViscosityEvaluation> read_viscosity(const v1::EvaluateViscosityRequest& request,
                                                  const ResourceLookup& lookup,
                                                  Violations& violations);

/// Evaluates the laws. A temperature at which a law does not hold is refused. Throws Refusal if the
/// lubricant has no pressure-viscosity index, and Cancelled soon after `is_over` returns true.
v1::EvaluateViscosityResponse evaluate_viscosity(const v1::EvaluateViscosityRequest& request,
                                                 const ViscosityEvaluation& evaluation,
                                                 const std::function<bool()>& is_over);

}  // namespace tribodyn::server
