#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/simulation/input_deviations.h"
#include "server/simulation/input_errors.h"
#include "server/simulation/point_evaluation.h"

namespace tribodyn::server {

/// The figures of a point that a comparison states.
enum ComparedFigure : std::size_t {
  kEnergyMean,
  kRms,
  kLossPower,
  kPinionTorque,
  kDteMinimum,
  kDteMaximum,
  kFilmRatio,  // NaN unless the request has contact_figures, as are the next ones
  kContactTemperature,
  kFrictionCoefficient,
  kPressure,
  kFlashTemperature,
  kComparedFigures
};

/// By ComparedFigure, in the units of v1::ComparedPoint.
using FigureValues = std::array<double, kComparedFigures>;
/// By condition, and last the weighted mean of all conditions; nullopt: no figures.
using ValuesByCondition = std::vector<std::optional<FigureValues>>;

/// The figures of a point with the stated inputs.
struct StatedFigures {
  FigureValues value;
  FigureValues solver_error;  ///< NaN where nobody estimates it
  bool contact_loss;
};

/// Returns nullopt if the point was refused or has no inefficiency.
std::optional<StatedFigures> stated_figures(const EvaluatedPoint& point);

/// A source of error of one fluid, and what it does to the figures.
struct ErrorSource {
  const InputError* error;
  std::vector<Mixture> mixtures;  ///< one for each deviation
  /// By deviation, condition and figure: half the difference between the deviations 1 and -1.
  std::vector<std::vector<FigureValues>> effects;

  /// Variance of a figure that the source makes in the linear model.
  double squared_effect(std::size_t condition, ComparedFigure figure) const;
};

/// Everything that is computed of one fluid.
struct ComputedFluid {
  std::string revision;
  std::vector<EvaluatedPoint> points;  ///< with the stated inputs
  /// By condition, and last the weighted mean of all conditions; nullopt: no figures.
  std::vector<std::optional<StatedFigures>> stated;
  std::vector<ValuesByCondition> drawn;  ///< by draw; empty if no input has an uncertainty
  std::vector<int> solved_draws;         ///< by condition
  std::vector<ErrorSource> sources;
  bool is_uncertainty_stated = true;  ///< of one of its own parameters at least

  /// Whether a warning of a condition withholds the verdict; of one of them for the mean.
  bool is_withheld(std::size_t condition) const;
};

}  // namespace tribodyn::server
