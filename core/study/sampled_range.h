#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/study/point_result.h"

namespace tribodyn {

/// The extremes of a function of time, from its samples.
struct SampledRange {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// A smooth function, sampled at even distances: extremes between samples are those of the
  /// parabola through the extreme sample and its neighbours.
  template <std::size_t kCount>
  void add(const std::array<double, kCount>& samples) {
    double lowest = samples[0], highest = samples[0];
    for (const double value : samples) {
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    const double beyond = 0.25 * (highest - lowest);  // at most
    if (!(lowest - beyond >= low && highest + beyond <= high)) add_vertices(samples);
  }
  void add(const SampledRange& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
  /// 0 where nothing was added.
  Extremes with_mean(double mean) const {
    return low <= high ? Extremes{low, mean, high} : Extremes{0, mean, 0};
  }

 private:
  template <std::size_t kCount>
  void add_vertices(const std::array<double, kCount>& samples);
};

/// Figures of a contact count towards extremes under at least this part of the mean mesh force.
inline constexpr double kLeastCountedLoad = 0.01;

/// Adds the figures of one flank's contact, sampled at even distances with its load, where the load
/// is at least `load_floor` [N]; from or up to the place where the load crosses it. `value(figure,
/// sample)` is only called for samples under load.
template <std::size_t kFigures, std::size_t kCount, class Value>
void add_counted(const std::array<double, kCount>& load, double load_floor, Value&& value,
                 std::array<SampledRange, kFigures>& ranges) {
  const auto counts = [&](std::size_t n) { return load[n] > 0 && load[n] >= load_floor; };
  std::size_t counted = 0;
  for (std::size_t n = 0; n < kCount; ++n) counted += counts(n) ? 1 : 0;
  if (counted == 0) return;
  if (counted == kCount) {
    for (std::size_t c = 0; c < kFigures; ++c) {
      std::array<double, kCount> samples;
      for (std::size_t n = 0; n < kCount; ++n) samples[n] = value(c, n);
      ranges[c].add(samples);
    }
    return;
  }
  for (std::size_t n = 0; n < kCount; ++n) {
    if (counts(n)) {
      for (std::size_t c = 0; c < kFigures; ++c) ranges[c].add(value(c, n));
    }
    if (n == 0 || counts(n) == counts(n - 1)) continue;
    if (!(load[n] > 0 && load[n - 1] > 0)) continue;
    // Film, pressure and temperature go like powers of a small load.
    const double t = std::log(load_floor / load[n - 1]) / std::log(load[n] / load[n - 1]);
    for (std::size_t c = 0; c < kFigures; ++c) {
      const double a = value(c, n - 1), b = value(c, n);
      ranges[c].add(a > 0 && b > 0 ? a * std::pow(b / a, t) : a + t * (b - a));
    }
  }
}

/// Vertex of the parabola through a sample and its neighbours where it lies less than a step from
/// the sample; else the sample itself.
template <std::size_t kCount>
double parabola_vertex(const std::array<double, kCount>& v, std::ptrdiff_t at) {
  const auto middle = std::clamp<std::ptrdiff_t>(at, 1, kCount - 2);
  const double fall = v[middle - 1] - v[middle + 1];
  const double shift = 0.5 * fall / (v[middle - 1] - 2 * v[middle] + v[middle + 1]);
  return std::abs(shift) < 1 ? v[middle] - 0.25 * fall * shift : v[middle];
}

template <std::size_t kCount>
void SampledRange::add_vertices(const std::array<double, kCount>& v) {
  const auto lowest = std::min_element(v.begin(), v.end());
  const auto highest = std::max_element(v.begin(), v.end());
  low = std::min({low, *lowest, parabola_vertex(v, lowest - v.begin())});
  high = std::max({high, *highest, parabola_vertex(v, highest - v.begin())});
}

}  // namespace tribodyn
