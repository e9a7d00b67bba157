#pragma once

#include "core/laws/lubricant.h"
#include "core/laws/shear_law.h"
#include "core/model_options.h"

namespace tribodyn {

/// How the viscosity of a lubricant grows with pressure, by its law: Roelands (eq 31) with the
/// index of eq 33 or eq 32, or another one. The contact has the same laws within its own solution.
class PressureResponse {
 public:
  /// Throws Refusal PRESSURE_VISCOSITY_INDEX if Roelands's law has no index.
  PressureResponse(const Lubricant& lubricant, const ModelOptions& options);

  /// Throws Refusal BELOW_VOGEL_TEMPERATURE, ROELANDS_FACTOR or PARAMETER_OUT_OF_RANGE
  /// (check_greatest_viscosity) if the law does not hold at a temperature [K].
  void check_at(double temperature) const;

  /// Returns ln(eta(p, T)/eta_0(T)) at a temperature [K] that check_at() accepts and a pressure
  /// [Pa] >= 0.
  double log_growth(double temperature, double pressure) const;

  /// Returns alpha* [1/Pa], eq 33, at a temperature [K] that check_at() accepts; with Houpert's
  /// index the slope of ln eta at ambient pressure.
  double coefficient(double temperature) const;

 private:
  double factor_at(double temperature) const;

  Lubricant lubricant_;
  AsPublished as_published_;
  bool has_houpert_index_ = false;
  double index_ = 0;            ///< Z of Roelands's law
  GrowthLaw<double> growth_{};  ///< of other laws than Roelands's
};

}  // namespace tribodyn
