#pragma once

#include <string>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// Returns the path of the configuration file: TRIBODYN_CONFIG, else
/// $XDG_CONFIG_HOME/tribodyn/config, else ~/.config/tribodyn/config; empty if no home folder is
/// set.
std::string settings_path();

/// Sets the common flags from the configuration file and from environment variables
/// (TRIBODYN_SERVER, TRIBODYN_TIMEOUT_SECONDS, ...). The environment overrides the file; flags that
/// are read later override both. A key of the file is the name of a flag without its dashes. A
/// missing file is an error only if TRIBODYN_CONFIG names it.
void apply_settings(const FlagList& common_flags, Complaints& complaints);

}  // namespace tribodyn::client
