#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// Text of unknown origin as part of one log line: every byte that is not printable ASCII becomes
/// '?', and what lies beyond `longest` bytes is cut off.
std::string log_text(std::string_view text, std::size_t longest);

/// The same as one word, so that a line of key=value pairs stays readable: spaces and '=' become
/// '_' too.
std::string log_word(std::string_view text, std::size_t longest);

}  // namespace tribodyn::server
