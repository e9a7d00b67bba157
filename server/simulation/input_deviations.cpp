#include "server/simulation/input_deviations.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

namespace tribodyn::server {
namespace {

/// Largest share of refused draws with which the others still make an interval.
constexpr double kMostRefused = 0.05;

}  // namespace

double correlation(const Mixture& a, const Mixture& b) {
  double out = 0;
  if (a.own == b.own) out += a.own_factor * b.own_factor;
  if (a.common == b.common) out += a.common_factor * b.common_factor;
  return out;
}

std::vector<Mixture> Deviations::of(const InputError& error, const std::string& owner) {
  std::vector<Mixture> out;
  for (int i = 0; i < error.deviations; ++i) {
    const std::string name = fmt::format("{} {}", error.input, i);
    switch (error.sharing) {
      case InputError::Sharing::kScene: {
        const int common = number("scene " + name);
        out.push_back({common, common, 0, 1});
        break;
      }
      case InputError::Sharing::kOwn: {
        const int own = number(owner + " " + name);
        out.push_back({own, own, 1, 0});
        break;
      }
      case InputError::Sharing::kEstimate:
        out.push_back({number(owner + " " + name), number("estimate " + error.estimator),
                       std::sqrt(1 - correlation_), std::sqrt(correlation_)});
        break;
    }
  }
  return out;
}

int Deviations::number(const std::string& name) {
  return numbers_.emplace(name, static_cast<int>(numbers_.size())).first->second;
}

Spread spread_of_draws(std::vector<double> drawn, int draws, double stated) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  if (draws == 0) return {0, stated, stated};
  const bool is_enough =
      static_cast<double>(drawn.size()) >= (1 - kMostRefused) * draws && drawn.size() >= 2;
  return is_enough ? spread_of(std::move(drawn)) : Spread{kNoNumber, kNoNumber, kNoNumber};
}

}  // namespace tribodyn::server
