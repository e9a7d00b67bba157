#pragma once

#include <cstdio>
#include <string>

namespace tribodyn {

/// A number for the sentence of a Refusal: six significant digits, so that 1e-13 m2 does not read
/// "0.000000" as std::to_string has it.
inline std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace tribodyn
