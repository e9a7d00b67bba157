#include "client/cpp/report/precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kDefaultTolerance = 1e-3;  // default of the server
constexpr double kFineTolerance = 1e-5;
constexpr int kUnestimatedDigits = 3;
constexpr int kLeastDigits = 2;

std::string scientific(double value, int digits) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.*e", digits - 1, value);
  return text.data();
}

/// Returns the number of decimals that show `digits` significant digits of the value. Rounding may
/// carry into one more place. A negative result means that the last digit counts tens, hundreds,
/// ...
int decimals_of(double value, int digits) {
  const std::string text = scientific(value, digits);
  return digits - 1 - std::atoi(text.c_str() + text.find('e') + 1);
}

/// Like fixed(), but negative `decimals` round to tens, hundreds, ... and are filled with zeros:
/// tables show no exponents.
std::string rounded(double value, int decimals) {
  if (decimals >= 0 || value == 0) return fixed(value, std::max(decimals, 0));
  const double place = std::pow(10, -decimals);
  return fixed(std::round(value / place) * place, 0);
}

}  // namespace

Precision::Precision(const v1::Simulation& simulation, const v1::PointResult& result)
    : is_estimated_(result.has_estimated_relative_error()),
      relative_error_(result.estimated_relative_error()) {
  const double asked = simulation.solver_options().tolerance();
  is_fine_ = is_estimated_ && (asked > 0 ? asked : kDefaultTolerance) <= kFineTolerance;
}

std::string Precision::error_percent() const {
  return is_estimated_ ? significant(100 * relative_error_, 2) : "-";
}

std::string Precision::error_of(double value) const {
  if (!is_estimated_ || !std::isfinite(value)) return "-";
  const double error = relative_error_ * std::abs(value);
  return error == 0 ? "0" : fixed(error, std::max(0, decimals_of(error, 1)));
}

std::string Precision::part(double value, double whole, int decimals) const {
  if (!std::isfinite(value) || !std::isfinite(whole) || whole == 0) return fixed(value, decimals);
  if (!is_estimated_) {
    return rounded(value, std::min(decimals, decimals_of(whole, kUnestimatedDigits)));
  }
  const double error = relative_error_ * std::abs(whole);
  // The place whose half unit is the error. 1e-9 allows equality: 0.5 for an error of 0.5.
  const double justified = error > 0 ? std::floor(std::log10(0.5 / error) + 1e-9) : decimals;
  const int minimum = decimals_of(whole, kLeastDigits);
  const int places = static_cast<int>(std::clamp<double>(justified, -300, decimals));
  return rounded(value, std::min(decimals, std::max(places, minimum)));
}

std::string Precision::other(double value, int decimals) const {
  if (is_fine_ || !std::isfinite(value)) return fixed(value, decimals);
  if (value == 0) return fixed(value, std::min(decimals, kUnestimatedDigits - 1));
  return rounded(value, std::min(decimals, decimals_of(value, kUnestimatedDigits)));
}

}  // namespace tribodyn::client
