#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// The hidden command that shell scripts call with the words of the line; the last word is
/// unfinished.
inline constexpr char kCompleteWord[] = "__complete";

/// Returns the completions of the last word: commands, flags, values of a choice, names of
/// resources (none if the server does not answer at once). A single "\\file" makes the shell
/// complete file names.
std::vector<std::string> completions(const std::vector<std::string>& words,
                                     const std::vector<Command>& commands,
                                     const FlagList& common_flags, const CommonOptions& options);

}  // namespace tribodyn::client
