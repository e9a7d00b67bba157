#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// How many digits of a result a table may print: those that its estimated error bears. JSON and
/// CSV have every digit and the estimate beside them.
class Precision {
 public:
  /// `result`: a point of the simulation.
  Precision(const v1::Simulation& simulation, const v1::PointResult& result);

  bool is_estimated() const { return is_estimated_; }
  /// The solver's relative error, e.g. "0.02" of 0.02 %; "-" when it is not estimated.
  std::string error_percent() const;
  /// The solver's error of a figure, in the unit of the figure: "+/- 0.0006"; "-" as above.
  std::string error_of(double value) const;

  /// A figure that the estimate speaks of. Half a unit of its last digit is at least its error; at
  /// most `decimals` places, else at least two significant digits. Three of what is not estimated.
  std::string estimated(double value, int decimals) const { return part(value, value, decimals); }
  /// The same to the last place of a larger one: a part of it, or one measured by it.
  std::string part(double value, double whole, int decimals) const;
  /// Any other figure: three significant digits, or `decimals` places if the solver was asked for
  /// so small an error that they mean something.
  std::string other(double value, int decimals) const;

 private:
  bool is_estimated_;
  double relative_error_;
  bool is_fine_;
};

}  // namespace tribodyn::client
