#include "core/surface/spectral_moments.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr std::size_t kFewestSamples = 5;

void refuse_unusable_profile(std::span<const double> heights, double spacing) {
  std::string wrong;
  if (heights.size() < kFewestSamples) {
    wrong += " It has " + std::to_string(heights.size()) + " heights; at least " +
             std::to_string(kFewestSamples) + " are needed (eq 45).";
  }
  std::size_t not_finite = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!std::isfinite(heights[i]) && not_finite++ == 0) first = i;
  }
  if (not_finite > 0) {
    wrong += " Heights that are not finite: " + std::to_string(not_finite) +
             ", the first at index " + std::to_string(first) + ".";
  }
  if (!(spacing > 0 && std::isfinite(spacing))) {
    wrong += " Its sample spacing is " + number_text(spacing) + " m; it must be above 0 m.";
  }
  if (!wrong.empty()) throw Refusal("PROFILE_UNUSABLE", "The profile cannot be used." + wrong);
}

}  // namespace

std::vector<double> levelled_profile(std::span<const double> heights, Levelling levelling) {
  const double count = static_cast<double>(heights.size());
  double mean = 0;
  for (const double z : heights) mean += z / count;
  double slope = 0;  // per sample
  const double middle = (count - 1) / 2;
  if (levelling == Levelling::kLeastSquaresLine) {
    for (std::size_t i = 0; i < heights.size(); ++i) {
      slope += (static_cast<double>(i) - middle) * (heights[i] - mean);
    }
    slope /= count * (count * count - 1) / 12;
  }
  std::vector<double> result(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    result[i] = heights[i] - mean - slope * (static_cast<double>(i) - middle);
  }
  return result;
}

SpectralMoments spectral_moments(std::span<const double> heights, double spacing,
                                 Levelling levelling) {
  refuse_unusable_profile(heights, spacing);
  const std::vector<double> z = levelled_profile(heights, levelling);
  double squared_heights = 0;
  for (const double height : z) squared_heights += height * height;
  double squared_slopes = 0;
  double squared_curvatures = 0;
  for (std::size_t i = 1; i + 1 < z.size(); ++i) {
    const double slope = (z[i + 1] - z[i - 1]) / (2 * spacing);
    const double curvature = ((z[i + 1] - z[i]) - (z[i] - z[i - 1])) / (spacing * spacing);
    squared_slopes += slope * slope;
    squared_curvatures += curvature * curvature;
  }
  const double interior = static_cast<double>(z.size() - 2);
  const SpectralMoments moments{squared_heights / static_cast<double>(z.size()),
                                squared_slopes / interior,
                                squared_curvatures / interior};  // (eq 45)
  if (!std::isfinite(moments.m0 + moments.m2 + moments.m4)) {
    throw Refusal("PROFILE_UNUSABLE",
                  "The profile cannot be used. Its heights are so large, or its spacing so small, "
                  "that a spectral moment is not finite.");
  }
  return moments;
}

SpectralMoments sampled_moments(std::span<const double> heights, double spacing, int step,
                                Levelling levelling) {
  SpectralMoments mean{};
  for (int first = 0; first < step; ++first) {
    std::vector<double> samples;
    for (std::size_t i = static_cast<std::size_t>(first); i < heights.size();
         i += static_cast<std::size_t>(step)) {
      samples.push_back(heights[i]);
    }
    const SpectralMoments moments = spectral_moments(samples, step * spacing, levelling);
    mean.m0 += moments.m0 / step;
    mean.m2 += moments.m2 / step;
    mean.m4 += moments.m4 / step;
  }
  return mean;
}

double wave_length_in_spacings(const SpectralMoments& moments, double spacing) {
  const double half_angle = std::atan(0.5 * spacing * std::sqrt(moments.m4 / moments.m2));
  return std::numbers::pi / half_angle;
}

SpectralMoments equivalent_isotropic_moments(const SpectralMoments& axial,
                                             const SpectralMoments& radial,
                                             const AsPublished& as_published) {
  const auto equivalent = [&](double a, double r) {
    return as_published.eq46_square_root_of_sum ? std::sqrt(a + r) : std::sqrt(a * r);  // (eq 46)
  };
  return {0.5 * (axial.m0 + radial.m0), equivalent(axial.m2, radial.m2),
          equivalent(axial.m4, radial.m4)};
}

SpectralMoments composite_moments(const SpectralMoments& pinion, const SpectralMoments& gear) {
  return {pinion.m0 + gear.m0, pinion.m2 + gear.m2, pinion.m4 + gear.m4};  // (eq 47)
}

Roughness greenwood_tripp_roughness(const SpectralMoments& composite) {
  const auto usable = [](double moment) { return moment > 0 && std::isfinite(moment); };
  if (!usable(composite.m0) || !usable(composite.m2) || !usable(composite.m4)) {
    throw Refusal("SURFACE_WITHOUT_ROUGHNESS",
                  "Spectral moments m0 = " + number_text(composite.m0) + " m2, m2 = " +
                      number_text(composite.m2) + ", m4 = " + number_text(composite.m4) +
                      " 1/m2: each must be above 0 and finite (eq 48).");
  }
  Roughness roughness;
  roughness.asperity_density =
      composite.m4 / composite.m2 / (6 * std::numbers::pi * std::numbers::sqrt3);  // (eq 48)
  roughness.asperity_radius = 0.375 * std::sqrt(std::numbers::pi / composite.m4);
  roughness.composite_rms_height = std::sqrt(composite.m0);
  return roughness;
}

}  // namespace tribodyn
