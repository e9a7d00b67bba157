#pragma once

#include <string>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// The configuration file: TRIBODYN_CONFIG, else $XDG_CONFIG_HOME/tribodyn/config, else
/// ~/.config/tribodyn/config; empty when none of them can be named.
std::string settings_path();

/// Reads what the configuration file and the environment (TRIBODYN_SERVER,
/// TRIBODYN_TIMEOUT_SECONDS, ...) say of the common flags; the environment wins, and flags that are
/// read later win over both. Keys of the file are names of flags without dashes in front. A file
/// that is not there is no mistake, unless TRIBODYN_CONFIG names it.
void apply_settings(const FlagList& common_flags, Complaints& complaints);

}  // namespace tribodyn::client
