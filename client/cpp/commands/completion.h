#pragma once

#include <string>
#include <vector>

#include "client/cpp/commands/command.h"

namespace tribodyn::client {

/// The hidden command that shell scripts call with the words so far, the last one unfinished.
inline constexpr char kCompleteWord[] = "__complete";

/// What the last word may become: commands, flags, words of a choice, names of resources (fetched
/// from the server; none when it does not answer at once). A single "\\file" asks the shell for
/// file names.
std::vector<std::string> completions(const std::vector<std::string>& words,
                                     const std::vector<Command>& commands,
                                     const FlagList& common_flags, const CommonOptions& options);

}  // namespace tribodyn::client
