#pragma once

#include <istream>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/commands/flag_errors.h"

namespace tribodyn::client {

/// What a command line asks for.
struct Parsed {
  const Command* command = nullptr;  ///< null: none named
  std::string group;                 ///< of several commands, e.g. "jobs", when only it is named
  bool wants_help = false;
  bool wants_all_help = false;  ///< every option; then wants_help is true as well
  bool wants_version = false;
  Complaints complaints;
  TypedFlags typed_flags;
};

/// "server = HOST:PORT" lines of a configuration file, '#' comments; complaints name `path`.
std::vector<std::pair<std::string, std::string>> parse_settings(std::istream& in,
                                                                const std::string& path,
                                                                Complaints& complaints);

/// Reads argv[1..] and writes every flag's value to its target. Collects all complaints before it
/// gives up. The only user of CLI11 (which costs ten seconds to compile).
Parsed parse_arguments(const std::vector<std::string>& arguments,
                       const std::vector<Command>& commands, const FlagList& common_flags);

}  // namespace tribodyn::client
