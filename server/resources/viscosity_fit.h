#pragma once

#include <optional>

#include "core/lubricant/vogel_fit.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::server {

/// Returns the fit that the Vogel parameters come from; nullopt if a client stated them, or if the
/// measurements are refused today. Requires a complete lubricant.
std::optional<VogelFit> viscosity_fit(const v1::Lubricant& lubricant);

}  // namespace tribodyn::server
