#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/uncertainty/normal_draws.h"
#include "core/uncertainty/spread.h"
#include "server/simulation/input_errors.h"

namespace tribodyn::server {

/// A standard normal deviation as a sum of independent ones: an own part and a common part.
struct Mixture {
  int own, common;
  double own_factor, common_factor;

  double at(const NormalDraws& draws, int draw) const {
    return own_factor * draws.at(draw, own) + common_factor * draws.at(draw, common);
  }
};

/// Correlation of two deviations.
double correlation(const Mixture& a, const Mixture& b);

/// Numbers the independent deviations behind the errors: equal names mean one deviation.
class Deviations {
 public:
  /// Estimates by one estimator are correlated by `estimate_correlation` (0 to 1).
  explicit Deviations(double estimate_correlation) : correlation_(estimate_correlation) {}

  /// Returns the deviations of an error. Errors that are not shared are those of `owner`.
  std::vector<Mixture> of(const InputError& error, const std::string& owner);
  int count() const { return static_cast<int>(numbers_.size()); }

 private:
  int number(const std::string& name);

  double correlation_;
  std::map<std::string, int> numbers_;
};

/// Returns the spread of those of `draws` draws that the model did not refuse: NaN if it refused
/// more than 5 %; without draws none about `stated`.
Spread spread_of_draws(std::vector<double> drawn, int draws, double stated);

}  // namespace tribodyn::server
