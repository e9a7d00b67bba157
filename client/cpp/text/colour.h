#pragma once

#include <string>

namespace tribodyn::client {

/// When the client colours its output.
enum class ColourChoice {
  kAuto,  ///< on a terminal, unless NO_COLOR is set (no-color.org) or TERM is "dumb"
  kAlways,
  kNever,
};

/// Decides whether standard output and standard error are coloured, for the whole process. Call it
/// before any output and before any thread starts; without a call there are no colours.
void set_colours(ColourChoice choice);

// Return the text in the colour of a heading or of a warning, for standard output. They return it
// unchanged where output is not coloured.
std::string heading(const std::string& text);
std::string caution(const std::string& text);
/// Returns the word that starts an error message, coloured for standard error.
std::string alarm(const std::string& text);

}  // namespace tribodyn::client
