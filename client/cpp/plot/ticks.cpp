#include <algorithm>
#include <cmath>

#include "client/cpp/plot/panel.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {

std::vector<double> nice_ticks(double low, double high, int count) {
  if (!(high > low)) {
    const double margin = low == 0 ? 1 : 0.1 * std::abs(low);
    low -= margin;
    high += margin;
  }
  const double wanted = (high - low) / std::max(1, count);
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.5, 2.0, 1.0}) {
    if (factor * power >= wanted * (1 - 1e-9)) step = factor * power;
  }
  const double first = std::floor(low / step + 1e-9);
  const double last = std::ceil(high / step - 1e-9);
  std::vector<double> ticks;
  const int steps = static_cast<int>(std::lround(last - first));
  for (int i = 0; i <= steps; ++i) ticks.push_back((first + i) * step);
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  const double largest = std::max(std::abs(ticks.front()), std::abs(ticks.back()));
  std::vector<std::string> labels;
  if (largest >= 1e6 || step < 1e-4) {
    for (const double tick : ticks) labels.push_back(significant(tick, 4));
    return labels;
  }
  int decimals = 0;
  for (double rest = step; decimals < 6 && std::abs(rest - std::round(rest)) > 1e-6; rest *= 10) {
    ++decimals;
  }
  for (const double tick : ticks) labels.push_back(fixed(tick, decimals));
  return labels;
}

std::vector<double> logarithmic_ticks(double low, double high) {
  high = std::max(high, low + 1e-9);
  const bool is_wide = high - low > 4;
  std::vector<double> ticks;
  for (int power = static_cast<int>(std::floor(low)); ticks.empty() || ticks.back() < high;
       ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = power + std::log10(factor);
      if ((is_wide && factor != 1) || (!ticks.empty() && ticks.back() >= high)) continue;
      if (!ticks.empty() && tick <= low) ticks.pop_back();  // the last one below is enough
      ticks.push_back(tick);
    }
  }
  return ticks;
}

std::vector<std::string> logarithmic_tick_labels(const std::vector<double>& ticks) {
  constexpr int kLeastPowerWithExponent = 6;
  std::vector<std::string> labels;
  for (const double tick : ticks) {
    const int power = static_cast<int>(std::floor(tick + 1e-9));
    if (power < kLeastPowerWithExponent) {
      labels.push_back(fixed(std::pow(10, tick), std::max(0, -power)));
    } else {
      labels.push_back(fixed(std::pow(10, tick - power), 0) + "e" + std::to_string(power));
    }
  }
  return labels;
}

}  // namespace tribodyn::client
