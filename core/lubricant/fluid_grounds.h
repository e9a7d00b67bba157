#pragma once

#include <optional>

namespace tribodyn {

/// What the laws of a fluid rest on. It changes no figure; results are warned by it where they
/// leave what was measured.
struct FluidGrounds {
  struct TemperatureRange {
    double lowest, highest;  ///< [K]
    bool operator==(const TemperatureRange&) const = default;
  };
  enum class LimitingStress {
    kStated,           ///< by a client who did not say where it was measured
    kMeasuredAtForty,  ///< of the paper: PAO at 40 C (Hoglund and Jacobson)
    kEstimated,        ///< from the class of base oil
  };

  /// At which the viscosities were measured that the Vogel law was fitted to; absent: not known.
  std::optional<TemperatureRange> viscosity_measured;
  LimitingStress limiting_stress = LimitingStress::kStated;

  bool operator==(const FluidGrounds&) const = default;
};

}  // namespace tribodyn
