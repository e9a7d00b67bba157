#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribodyn::client {

/// Returns the number of terminal columns of a UTF-8 text, one per code point.
int display_width(std::string_view text);

/// Returns the text without control characters: line feeds become spaces, others '?'. A text from
/// the server or from another user then cannot control the terminal.
std::string printable(std::string_view text);

/// Whether the text is UTF-8, the only encoding that the server accepts.
bool is_utf8(std::string_view text);

/// Returns the value rounded to `decimals` places, never "-0.00"; "-" if it is not finite.
std::string fixed(double value, int decimals);
/// Returns the same text, with '+' before a value that is positive after rounding.
std::string signed_fixed(double value, int decimals);

/// Returns the value with `digits` significant digits, e.g. 1.23e+07 or 0.0456; "-" if it is not
/// finite.
std::string significant(double value, int digits = 5);

/// Returns the shortest text that reads back as the same double, or "NaN", "Infinity", "-Infinity".
std::string shortest(double value);

/// Returns e.g. "0.4 ms", "35 ms", "3.2 s", "2 min 05 s" or "1 h 02 min".
std::string duration_text(double seconds);

/// Breaks the text into lines of at most `width` columns that start with `indent` spaces.
std::string wrapped(std::string_view text, int indent, int width = 100);

/// Returns the parts between separators; none for an empty text.
std::vector<std::string> split(std::string_view text, char separator);

/// Returns the parts with the separator between them.
std::string joined(const std::vector<std::string>& parts, std::string_view separator);

/// Returns "lubricants/my-oil" for "my-oil" and for "lubricants/my-oil".
std::string resource_name(std::string_view collection, std::string_view id_or_name);

/// Returns "my-oil" for "lubricants/my-oil" and for "projects/p/lubricants/my-oil". Any other text
/// stays as it is: "75W/90" is no name, and the server says so.
std::string resource_id(std::string_view name);

}  // namespace tribodyn::client
