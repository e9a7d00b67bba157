#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Decides how many digits of a result a table prints: as many as its estimated error justifies.
/// JSON and CSV have every digit and the estimate.
class Precision {
 public:
  /// `result`: a point of the simulation.
  Precision(const v1::Simulation& simulation, const v1::PointResult& result);

  bool is_estimated() const { return is_estimated_; }
  /// Returns the solver's relative error in percent, e.g. "0.02"; "-" if it is not estimated.
  std::string error_percent() const;
  /// Returns the solver's error of a figure in the unit of the figure, e.g. "0.0006"; "-" if it
  /// is not estimated.
  std::string error_of(double value) const;

  /// Formats a figure to which the estimate applies, with at most `decimals` places but at least
  /// two significant digits. Half a unit of its last digit is at least its error. A figure without
  /// an estimate has three digits.
  std::string estimated(double value, int decimals) const { return part(value, value, decimals); }
  /// Formats `value` with as many decimals as `whole` has, e.g. a component beside its total.
  std::string part(double value, double whole, int decimals) const;
  /// Formats any other figure with three significant digits, or with `decimals` places if the
  /// solver's tolerance is so small that they are meaningful.
  std::string other(double value, int decimals) const;

 private:
  bool is_estimated_;
  double relative_error_;
  bool is_fine_;
};

}  // namespace tribodyn::client
