#pragma once

#include <string>

#include "client/cpp/commands/rig_map.h"
#include "client/cpp/text/flags.h"
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

/// Names and defaults of the flags that list what a rig sets, where commands differ in them.
struct RigSettingTexts {
  const char* speed_names;
  std::string load, speeds, slide_roll_ratios, temperature;  ///< defaults in words
};
/// Adds a flag for each list of settings; they write to `given`.
void add_rig_setting_flags(FlagList& list, const RigSettingTexts& texts, RigSettings& given);

/// Returns every combination of the settings.
v1::RigGrid grid_of(const RigSettings& settings);

}  // namespace tribodyn::client
