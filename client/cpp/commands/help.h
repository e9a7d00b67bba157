#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// `tribodyn --help`: what it is, every command with its summary and an example.
std::string overview_text(const std::vector<Command>& commands);

/// `tribodyn COMMAND --help`: every flag with unit, legal range and default, then examples.
std::string help_text(const Command& command, const FlagList& common_flags);

/// The known name nearest to a mistyped one, if it is near enough to be meant.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

}  // namespace tribodyn::client
