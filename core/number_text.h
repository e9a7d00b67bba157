#pragma once

#include <charconv>
#include <cmath>
#include <string>

#include "core/celsius.h"

namespace tribodyn {

/// Returns what printf writes for "%.*g" in the C locale. `digits`: 1 to 17.
inline std::string general_text(double value, int digits) {
  char text[32];
  return {text,
          std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}

/// A number for the sentence of a Refusal: six significant digits, so that 1e-13 m2 does not read
/// "0.000000" as std::to_string has it.
inline std::string number_text(double value) { return general_text(value, 6); }

/// A number rounded to so many significant digits, and no more of them printed.
inline std::string number_text(double value, int digits) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1).ptr;
  std::from_chars(text, end, value);  // `value` stays as it is if the rounded number overflows
  return general_text(value, 10);
}

/// "12.5 C" for a temperature [K].
inline std::string celsius_text(double temperature) {
  return number_text(temperature - kZeroCelsius) + " C";
}

/// A number to the second digit of its standard uncertainty: 0.637864 known to 0.0956795 is
/// "0.638".
inline std::string known_text(double value, double uncertainty) {
  if (!(uncertainty > 0) || !std::isfinite(uncertainty) || value == 0) return number_text(value);
  const double digits =
      std::floor(std::log10(std::abs(value))) - std::floor(std::log10(uncertainty)) + 2;
  return number_text(value, digits < 1 ? 1 : digits > 6 ? 6 : static_cast<int>(digits));
}

/// "0.638 within 0.096".
inline std::string within_text(double value, double uncertainty) {
  return known_text(value, uncertainty) + " within " + number_text(uncertainty, 2);
}

}  // namespace tribodyn
