#pragma once

#include <array>

namespace tribodyn {

/// Eqs 8, 9, 10 and 11 without their means as power series in theta around one angle. Of eq 8 and
/// the integral theta is the pinion's, of the gear's two the gear's. Up to |x| = kReach / harmonics
/// the terms left out are below 1e-14 of the highest harmonic.
struct MeshExpansion {
  static constexpr int kTerms = 12;
  static constexpr double kReach = 0.35;
  enum Function {
    kPinionRadius,    ///< R_p [m]
    kPinionIntegral,  ///< pinion's part of int R_p dphi_p - int R_g dphi_g [m]
    kStiffness,       ///< k_m [N/m]
    kStiffnessSlope,  ///< dk_m/dphi_p [N/m/rad]
    kError,           ///< e [m]
    kErrorSlope,      ///< de/dphi_p [m/rad]
    kGearRadius,      ///< R_g [m]
    kGearIntegral,    ///< the gear's part [m]
    kFunctions
  };
  std::array<std::array<double, kFunctions>, kTerms> term{};

  /// `Count` functions from `First` at a distance x from the angle [rad]; Estrin's way, so that no
  /// term waits for all the others.
  template <int First, int Count>
  std::array<double, Count> at(double x) const {
    const double x2 = x * x, x4 = x2 * x2;
    std::array<double, Count> out;
    for (int i = 0; i < Count; ++i) {
      const auto four = [&](int k) {
        return (term[k][First + i] + term[k + 1][First + i] * x) +
               (term[k + 2][First + i] + term[k + 3][First + i] * x) * x2;
      };
      out[i] = four(0) + (four(4) + four(8) * x4) * x4;
    }
    return out;
  }

  /// d function/dx at a distance x from the angle.
  double slope_at(Function function, double x) const {
    const double x2 = x * x, x4 = x2 * x2;
    const auto at = [&](int power) { return (power + 1) * term[power + 1][function]; };
    const auto four = [&](int power) {
      return (at(power) + at(power + 1) * x) + (at(power + 2) + at(power + 3) * x) * x2;
    };
    return four(0) + (four(4) + (at(8) + at(9) * x + at(10) * x2) * x4) * x4;
  }
};

}  // namespace tribodyn
