#pragma once

#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/support/paths.h"

namespace tribodyn {

/// Replaces Infinity, -Infinity and NaN, which Python writes and JSON forbids, by null.
inline std::string without_python_numbers(const std::string& text) {
  std::string result;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && (i == 0 || text[i - 1] != '\\')) in_string = !in_string;
    const bool minus_infinity = c == '-' && text.compare(i + 1, 8, "Infinity") == 0;
    if (!in_string && (minus_infinity || c == 'I' || c == 'N')) {
      result += "null";
      ++i;
      while (i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]))) ++i;
      --i;
      continue;
    }
    result += c;
  }
  return result;
}

/// Reads a file of tests/data.
inline nlohmann::json load_reference(const std::string& file) {
  const std::string path = test_data_file(file);
  std::ifstream stream(path);
  if (!stream) throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << stream.rdbuf();
  return nlohmann::json::parse(without_python_numbers(text.str()));
}

}  // namespace tribodyn
