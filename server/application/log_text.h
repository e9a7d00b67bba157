#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// Returns a text of unknown origin in a form for log lines: its first `longest` bytes, with '?'
/// for each byte that is not printable ASCII.
std::string log_text(std::string_view text, std::size_t longest);

/// Returns a text of unknown origin as one word of a line of key=value pairs: its first `longest`
/// bytes, with '_' for spaces, '=' and bytes that are not printable ASCII.
std::string log_word(std::string_view text, std::size_t longest);

}  // namespace tribodyn::server
