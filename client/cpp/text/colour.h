#pragma once

#include <string>

namespace tribodyn::client {

/// When colours are used.
enum class ColourChoice {
  kAuto,  ///< on a terminal, unless NO_COLOR is set (no-color.org) or TERM is "dumb"
  kAlways,
  kNever,
};

/// Decides for standard output and standard error, for the whole process. Before any output and
/// any thread; until then there are no colours.
void set_colours(ColourChoice choice);

// The text, on standard output, as a heading or as something to look at twice; unchanged without
// colours.
std::string heading(const std::string& text);
std::string caution(const std::string& text);
/// The start of a complaint on standard error.
std::string alarm(const std::string& text);

}  // namespace tribodyn::client
