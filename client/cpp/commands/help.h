#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// `tribodyn --help`: what it is, every command with its summary and examples.
std::string overview_text(const std::vector<Command>& commands);

/// `tribodyn lubricants --help`: the commands of a group.
std::string group_text(const std::string& group, const std::vector<Command>& commands);

enum class HelpLength {
  kShort,  ///< examples, then the flags that most calls need
  kAll,    ///< every flag, those of every command too
};

/// `tribodyn COMMAND --help` or `--help-all`: examples, then flags with unit, allowed range and
/// default. Ranges of parameters come from `schema`; without it (no server) the help says where to
/// find them.
std::string help_text(const Command& command, const FlagList& common_flags,
                      const v1::Schema* schema, HelpLength length);

/// The server's table of constraints if the help of this command shows some of it and the server
/// answers at once.
std::optional<v1::Schema> schema_for_help(const Command& command, const CommonOptions& options);

}  // namespace tribodyn::client
