#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tribodyn {

/// A property of all candidates, as numbers or as words.
struct Factor {
  std::vector<double> numbers;     ///< by candidate, finite; empty: there are words
  std::vector<std::string> words;  ///< by candidate
};

/// Why a factor has no effect.
enum class NoEffect {
  kConstant,           ///< all candidates have the same
  kTooManyWords,       ///< more than kMostWords different words
  kFollowsFromOthers,  ///< a sum of multiples of earlier factors
};

/// Largest number of different words of a factor with effects.
inline constexpr std::size_t kMostWords = 12;

/// What a factor does to a response: from its lowest number to its highest one, or from its most
/// frequent word to another one.
struct FactorEffect {
  std::size_t factor;        ///< index
  std::size_t from, to;      ///< first candidates that have these two
  double effect, low, high;  ///< in the unit of the response, with the interval of the coverage
  /// Other factors with which this one rises or falls nearly together: a correlation beyond
  /// kCollinear.
  std::vector<std::size_t> collinear = {};
};

/// Correlation of two columns from which on their effects cannot be separated.
inline constexpr double kCollinear = 0.9;

struct FactorEffects {
  std::vector<FactorEffect> effects;                       ///< largest first
  std::vector<std::pair<std::size_t, NoEffect>> left_out;  ///< factors without an effect
  int degrees_of_freedom;                                  ///< candidates less coefficients
  double residual_standard_deviation;  ///< about the model, in the unit of the response
  double explained_share;              ///< of the variance of the response, 0 to 1
};

/// Returns the main effects of factors on a response, as main_effects(); nullopt if there are too
/// few candidates. Requires as many finite responses as candidates, at least one, and 0 < coverage
/// < 1.
std::optional<FactorEffects> factor_effects(const std::vector<Factor>& factors,
                                            const std::vector<double>& response, double coverage);

}  // namespace tribodyn
