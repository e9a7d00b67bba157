#pragma once

#include <istream>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/commands/flag_errors.h"

namespace tribodyn::client {

/// A command line that was split into a command and its flags.
struct Parsed {
  const Command* command = nullptr;  ///< null if none is named
  std::string group;  ///< e.g. "jobs", if only the group of several commands is named
  bool wants_help = false;
  bool wants_all_help = false;  ///< all options; wants_help is true as well
  bool wants_version = false;
  Complaints complaints;
  TypedFlags typed_flags;
};

/// Returns the keys and values of a configuration file with lines such as "server = HOST:PORT" and
/// comments that begin with '#'. Complaints contain `path`.
std::vector<std::pair<std::string, std::string>> parse_settings(std::istream& in,
                                                                const std::string& path,
                                                                Complaints& complaints);

/// Reads argv[1..] and writes the value of every flag to its target. Returns all complaints, not
/// only the first. Only this file uses CLI11, which takes ten seconds to compile.
Parsed parse_arguments(const std::vector<std::string>& arguments,
                       const std::vector<Command>& commands, const FlagList& common_flags);

}  // namespace tribodyn::client
