#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {

/// The inputs of points that can err. Temperatures err by a rise above those of the condition.
struct UncertainInputs {
  v1::Lubricant lubricant;
  v1::Surface surface;
  v1::Vehicle vehicle;
  double sump_temperature_rise_kelvin = 0;   ///< error of the temperature in the sump
  double inlet_temperature_rise_kelvin = 0;  ///< error of the rise from the sump to the inlet
};

/// One source of error of the inputs.
struct InputError {
  /// Whom lubricants share an error with.
  enum class Sharing {
    kOwn,       ///< measured or stated: with no other lubricant
    kEstimate,  ///< in part with those whose value the same estimator made
    kScene,     ///< with all
  };
  /// "lubricant.relaxation_time_seconds"; several fields that err together are separated by blanks.
  std::string input;
  Sharing sharing;
  std::string estimator;  ///< of kEstimate: equal texts mean one estimator
  int deviations;         ///< number of independent standard normal deviations
  /// Sets the drawn values; with all deviations zero those that are stated.
  std::function<void(std::span<const double>, UncertainInputs&)> apply;
  double standard_uncertainty = 0;  ///< of a single field, in its unit; 0: of several fields
};

/// Sources of error, and the fields that count as exact because nobody stated an uncertainty.
struct InputErrors {
  std::vector<InputError> errors;
  std::vector<std::string> without_uncertainty;
};

/// Returns the errors of a complete lubricant: each stated standard uncertainty; those of fitted
/// Vogel parameters together by the covariance of the fit, and those of a computed density law
/// together. An estimator is a parameter that the server estimated for a class of base oil. The
/// temperatures at which parameters are stated are exact by definition.
InputErrors lubricant_errors(const v1::Lubricant& lubricant);

/// Returns the errors of a surface: each stated standard uncertainty.
InputErrors surface_errors(const v1::Surface& surface);

/// Returns the errors of what all lubricants share. Uncertainties of temperatures in K; 0: exact.
InputErrors scene_errors(const v1::Surface& surface, const v1::Vehicle& vehicle,
                         double sump_temperature_uncertainty_kelvin,
                         double inlet_temperature_rise_uncertainty_kelvin);

}  // namespace tribodyn::server
