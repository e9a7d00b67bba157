#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// What a command line asks for.
struct Parsed {
  const Command* command = nullptr;  ///< null: none named
  bool wants_help = false;
  bool wants_version = false;
  Complaints complaints;
};

/// Reads argv[1..] and writes every flag's value to its target. Collects all complaints before it
/// gives up. The only user of CLI11 (which costs ten seconds to compile).
Parsed parse_arguments(const std::vector<std::string>& arguments,
                       const std::vector<Command>& commands, const FlagList& common_flags);

}  // namespace tribodyn::client
