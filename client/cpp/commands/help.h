#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// Returns the text of `tribodyn --help`: purpose, commands with summaries, examples.
std::string overview_text(const std::vector<Command>& commands);

/// Returns the text of `tribodyn lubricants --help` for a group of commands.
std::string group_text(const std::string& group, const std::vector<Command>& commands);

enum class HelpLength {
  kShort,  ///< examples, then the flags that most calls need
  kAll,    ///< every flag, including those of all commands
};

/// Returns the text of `tribodyn COMMAND --help` or `--help-all`: examples, then flags with unit,
/// allowed range and default. The ranges of parameters come from `schema`; if it is null (no
/// server), the help refers to `tribodyn schema`.
std::string help_text(const Command& command, const FlagList& common_flags,
                      const v1::Schema* schema, HelpLength length);

/// Returns the server's table of constraints if the help of this command shows a part of it and the
/// server answers at once.
std::optional<v1::Schema> schema_for_help(const Command& command, const CommonOptions& options);

}  // namespace tribodyn::client
