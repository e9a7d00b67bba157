#include "server/application/log_text.h"

#include <algorithm>

namespace tribodyn::server {

std::string log_text(std::string_view text, std::size_t longest) {
  std::string out(text.substr(0, longest));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

std::string log_word(std::string_view text, std::size_t longest) {
  std::string out(text.substr(0, longest));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c <= ' ' || c > '~' || c == '='; }, '_');
  return out;
}

}  // namespace tribodyn::server
