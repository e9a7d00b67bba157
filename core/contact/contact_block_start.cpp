#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/contact/contact_block.h"
#include "core/lubricant/viscosity.h"

namespace tribodyn {

// Chebyshev polynomials are orthogonal over the Chebyshev points: projections are the least
// squares.
void fit_start(InstructionSet instruction_set, ContactBlockTables& tables) {
  constexpr int kPoints = 4, kSamples = kPoints * kPoints * kPoints;
  constexpr double kLow[3] = {13.6, 0.7, 1.5}, kHigh[3] = {16.5, 1.85, 5.0};
  static_assert(kSamples % kBlockContacts == 0);
  double point[kPoints], polynomial[kPoints][kPoints];
  for (int k = 0; k < kPoints; ++k) {
    const double angle = std::numbers::pi * (k + 0.5) / kPoints;
    point[k] = std::cos(angle);
    for (int m = 0; m < kPoints; ++m) polynomial[m][k] = std::cos(m * angle);
  }
  StartFit fit;
  for (int d = 0; d < 3; ++d) {
    fit.scale[d] = 2 / (kHigh[d] - kLow[d]);
    fit.offset[d] = -(kHigh[d] + kLow[d]) / (kHigh[d] - kLow[d]);
  }
  const auto at = [&](int d, int k) { return kLow[d] + (kHigh[d] - kLow[d]) / 2 * (1 + point[k]); };
  const double rim_limit = tables.lubricant.limiting_shear_stress_at_zero_pressure;
  double value[kSamples];
  for (int start = 0; start < kSamples; start += kBlockContacts) {
    StartSamples samples;
    ContactLanes most;
    alignas(64) ContactLanes rise;
    for (int n = 0; n < kBlockContacts; ++n) {
      const int i = start + n;
      samples.shear_rate[n] = std::exp(at(0, i / (kPoints * kPoints)));
      const double scaled = std::expm1(at(1, i / kPoints % kPoints));
      samples.pressure[n] = scaled / kRoelandsPressureCoefficient;
      const double limit = rim_limit + tables.limit_slope * 2 / 3 * scaled;
      most[n] = std::exp(at(2, i % kPoints));
      samples.gain[n] = most[n] / limit;
    }
    sample_rises(instruction_set, tables, samples, rise);
    for (int n = 0; n < kBlockContacts; ++n) {
      const double share = std::clamp(rise[n] / most[n], 1e-3, 0.99);
      value[start + n] = std::log(1 / share - 1);
    }
  }
  int term = 0;
  for (int a = 0; a < kPoints; ++a) {
    for (int b = 0; a + b < kPoints; ++b) {
      for (int c = 0; a + b + c < kPoints; ++c) {
        double sum = 0;
        for (int i = 0; i < kSamples; ++i) {
          sum += value[i] * polynomial[a][i / (kPoints * kPoints)] *
                 polynomial[b][i / kPoints % kPoints] * polynomial[c][i % kPoints];
        }
        fit.coefficients[term++] =
            sum * (a > 0 ? 2 : 1) * (b > 0 ? 2 : 1) * (c > 0 ? 2 : 1) / kSamples;
      }
    }
  }
  tables.start = fit;
  tables.start_fitted = std::all_of(fit.coefficients.begin(), fit.coefficients.end(),
                                    [](double c) { return std::isfinite(c); });
}

}  // namespace tribodyn
