#include "core/surface/gaussian_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr std::size_t kFewestHeights = 5;

[[noreturn]] void refuse_filter(const std::string& sentence) {
  throw Refusal("PROFILE_FILTER", sentence);
}

void check_cut_off(double cut_off, const char* name, double spacing, std::size_t samples) {
  if (!(cut_off >= 2 * spacing)) {
    refuse_filter(std::string(name) + " = " + number_text(cut_off) +
                  " m filters nothing: it must be two sample spacings or more, " +
                  number_text(2 * spacing) + " m.");
  }
  if (!(cut_off / spacing + static_cast<double>(kFewestHeights) <= static_cast<double>(samples))) {
    refuse_filter(std::string(name) + " = " + number_text(cut_off) +
                  " m leaves nothing of the profile, which is " +
                  number_text(spacing * static_cast<double>(samples - 1)) + " m long.");
  }
  const double products = static_cast<double>(samples) * (2 * cut_off / spacing + 1);
  if (products > kMostFilterProducts) {
    refuse_filter(std::string(name) + " = " + number_text(cut_off) + " m over " +
                  std::to_string(samples) + " samples takes " + number_text(products) +
                  " products; at most " + number_text(kMostFilterProducts) +
                  " are allowed: shorten the profile, or take every other sample.");
  }
}

// The mean line where every weight within half a cut-off has its height, and where it begins.
struct MeanLine {
  std::vector<double> heights;
  std::size_t begin;
};

MeanLine mean_line(std::span<const double> heights, double spacing, double cut_off) {
  const double width = std::sqrt(std::numbers::ln2 / std::numbers::pi) * cut_off;
  const auto reach = static_cast<std::size_t>(cut_off / spacing);
  std::vector<double> weights(reach + 1);
  for (std::size_t k = 0; k <= reach; ++k) {
    const double x = static_cast<double>(k) * spacing / width;
    weights[k] = std::exp(-std::numbers::pi * x * x);
  }
  MeanLine out{{}, reach / 2};
  for (std::size_t i = out.begin; i + out.begin < heights.size(); ++i) {
    const std::size_t first = i > reach ? i - reach : 0;
    const std::size_t last = std::min(i + reach, heights.size() - 1);
    double sum = 0, total = 0;
    for (std::size_t j = first; j <= last; ++j) {
      const double weight = weights[j > i ? j - i : i - j];
      sum += weight * heights[j];
      total += weight;
    }
    out.heights.push_back(sum / total);
  }
  return out;
}

}  // namespace

std::vector<double> filtered_profile(std::span<const double> heights, double spacing,
                                     const ProfileBand& band) {
  if (band.shortest != 0 && band.longest != 0 && !(band.shortest < band.longest)) {
    refuse_filter("lambda_s = " + number_text(band.shortest) +
                  " m is not below lambda_c = " + number_text(band.longest) + " m.");
  }
  std::vector<double> out(heights.begin(), heights.end());
  if (band.shortest != 0) {
    check_cut_off(band.shortest, "lambda_s", spacing, out.size());
    out = mean_line(out, spacing, band.shortest).heights;
  }
  if (band.longest != 0) {
    check_cut_off(band.longest, "lambda_c", spacing, out.size());
    const MeanLine waviness = mean_line(out, spacing, band.longest);
    std::vector<double> roughness;
    for (std::size_t i = 0; i < waviness.heights.size(); ++i) {
      roughness.push_back(out[waviness.begin + i] - waviness.heights[i]);
    }
    out = std::move(roughness);
  }
  return out;
}

}  // namespace tribodyn
