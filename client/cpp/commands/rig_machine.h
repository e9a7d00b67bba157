#pragma once

#include <string>

#include "client/cpp/commands/rig_map.h"
#include "tribodyn/v1/rigs.pb.h"

namespace tribodyn::client {

/// A rig with its specimens, and what it sets, before flags change them.
struct RigMachine {
  v1::EvaluateRigRequest request;  ///< without lubricant and conditions
  RigSettings settings;
};

/// Returns the machine of a command: "traction", "film" or "stribeck".
RigMachine rig_machine(const std::string& command);

/// Makes the disc one of "steel" or "glass".
void set_disc(const std::string& material, v1::EvaluateRigRequest& request);

/// Returns every combination of the settings.
v1::RigGrid grid_of(const RigSettings& settings);

}  // namespace tribodyn::client
