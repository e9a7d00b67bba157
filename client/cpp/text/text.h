#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribodyn::client {

/// Columns that UTF-8 text takes on a terminal, one per code point.
int display_width(std::string_view text);

/// The text without control characters (they become '?'; line feeds become spaces), so that nothing
/// a server or another user wrote can steer the terminal.
std::string printable(std::string_view text);

/// Whether the text is UTF-8, as a server wants all texts.
bool is_utf8(std::string_view text);

/// Rounded to `decimals` places, never "-0.00"; "-" when not finite.
std::string fixed(double value, int decimals);

/// `digits` significant digits, e.g. 1.23e+07 or 0.0456; "-" when not finite.
std::string significant(double value, int digits = 5);

/// The shortest text that reads back as the same double; "NaN", "Infinity", "-Infinity" otherwise.
std::string shortest(double value);

/// "0.4 ms", "35 ms", "3.2 s", "2 min 05 s", "1 h 02 min".
std::string duration_text(double seconds);

/// Words broken into lines of at most `width` columns, each starting with `indent` spaces.
std::string wrapped(std::string_view text, int indent, int width = 100);

/// The parts between separators; an empty text has no parts.
std::vector<std::string> split(std::string_view text, char separator);

/// The parts with a separator between them.
std::string joined(const std::vector<std::string>& parts, std::string_view separator);

/// "lubricants/1" from "1" or "lubricants/1".
std::string resource_name(std::string_view collection, std::string_view id_or_name);

/// "1" from "lubricants/1".
std::string resource_id(std::string_view name);

}  // namespace tribodyn::client
