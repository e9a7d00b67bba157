#include <algorithm>
#include <array>
#include <cmath>

#include "core/contact/contact_block.h"
#include "core/laws/laws.h"
#include "core/numerics/chebyshev.h"

namespace tribodyn {

// Chebyshev polynomials are orthogonal over the Chebyshev points: projections are the least
// squares.
void fit_start(InstructionSet instruction_set, ContactBlockTables& tables) {
  constexpr int kPoints = 4, kSamples = kPoints * kPoints * kPoints;
  constexpr double kLow[3] = {13.6, 0.7, 1.5}, kHigh[3] = {16.5, 1.85, 5.0};
  static_assert(kSamples % kBlockContacts == 0);
  const auto& rule = chebyshev<kPoints>();
  StartFit fit;
  for (int d = 0; d < 3; ++d) {
    fit.scale[d] = 2 / (kHigh[d] - kLow[d]);
    fit.offset[d] = -(kHigh[d] + kLow[d]) / (kHigh[d] - kLow[d]);
  }
  double shear_rate[kPoints], scaled_pressure[kPoints], most_rise[kPoints];
  for (int k = 0; k < kPoints; ++k) {
    const auto at = [&](int d) { return (rule.point[k] - fit.offset[d]) / fit.scale[d]; };
    shear_rate[k] = std::exp(at(0));
    scaled_pressure[k] = std::expm1(at(1));
    most_rise[k] = std::exp(at(2));
  }
  const double rim_limit = tables.shear.lubricant.limiting_shear_stress_at_zero_pressure;
  using Cube = std::array<std::array<std::array<double, kPoints>, kPoints>, kPoints>;
  Cube value;
  for (int start = 0; start < kSamples; start += kBlockContacts) {
    StartSamples samples;
    alignas(64) ContactLanes rise;
    for (int n = 0; n < kBlockContacts; ++n) {
      const int i = start + n;
      const double scaled = scaled_pressure[i / kPoints % kPoints];
      const double limit = rim_limit + tables.limit_slope * 2 / 3 * scaled;
      samples.shear_rate[n] = shear_rate[i / (kPoints * kPoints)];
      samples.pressure[n] = scaled / laws::kRoelandsPressureCoefficient;
      samples.gain[n] = most_rise[i % kPoints] / limit;
    }
    sample_rises(instruction_set, tables, samples, rise);
    for (int n = 0; n < kBlockContacts; ++n) {
      const int i = start + n, c = i % kPoints;
      const double share = std::clamp(rise[n] / most_rise[c], 1e-3, 0.99);
      value[i / (kPoints * kPoints)][i / kPoints % kPoints][c] = std::log(1 / share - 1);
    }
  }
  // One variable after the other.
  const auto& to_coefficients = rule.to_coefficients;
  Cube in_z{}, in_yz{};
  for (int a = 0; a < kPoints; ++a) {
    for (int b = 0; b < kPoints; ++b) {
      for (int c = 0; c < kPoints; ++c) {
        for (int k = 0; k < kPoints; ++k) in_z[a][b][c] += to_coefficients[c][k] * value[a][b][k];
      }
    }
    for (int b = 0; b < kPoints; ++b) {
      for (int c = 0; b + c < kPoints; ++c) {
        for (int k = 0; k < kPoints; ++k) in_yz[a][b][c] += to_coefficients[b][k] * in_z[a][k][c];
      }
    }
  }
  int term = 0;
  for (int a = 0; a < kPoints; ++a) {
    for (int b = 0; a + b < kPoints; ++b) {
      for (int c = 0; a + b + c < kPoints; ++c, ++term) {
        for (int k = 0; k < kPoints; ++k) {
          fit.coefficients[term] += to_coefficients[a][k] * in_yz[k][b][c];
        }
      }
    }
  }
  tables.start = fit;
  tables.start_fitted = std::all_of(fit.coefficients.begin(), fit.coefficients.end(),
                                    [](double c) { return std::isfinite(c); });
}

}  // namespace tribodyn
