#include "server/simulation/rig_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/celsius.h"
#include "core/refusal.h"
#include "core/uncertainty/normal_draws.h"
#include "server/mapping/to_core.h"
#include "server/simulation/input_deviations.h"
#include "server/simulation/input_errors.h"

namespace tribodyn::server {
namespace {

constexpr std::uint64_t kRigSeed = 1;  // any: equal requests give equal answers

/// Returns the errors of lubricant and specimens. A height that the request states in place of that
/// of the surface is exact.
InputErrors errors_of(const RigEvaluation& evaluation) {
  InputErrors out = lubricant_errors(*evaluation.lubricant);
  if (!evaluation.surface) return out;
  InputErrors specimens = surface_errors(*evaluation.surface);
  if (evaluation.composite_rms_height != 0) {
    const std::string replaced = "surface.composite_rms_height_metres";
    std::erase_if(specimens.errors,
                  [&replaced](const InputError& each) { return each.input == replaced; });
    std::erase(specimens.without_uncertainty, replaced);
    specimens.without_uncertainty.emplace_back("composite_rms_height_metres");
  }
  std::move(specimens.errors.begin(), specimens.errors.end(), std::back_inserter(out.errors));
  std::move(specimens.without_uncertainty.begin(), specimens.without_uncertainty.end(),
            std::back_inserter(out.without_uncertainty));
  return out;
}

/// Returns the scene with the inputs of each draw.
std::vector<RigScene> drawn_scenes(const RigEvaluation& evaluation, const InputErrors& errors,
                                   int draws) {
  UncertainInputs inputs;
  inputs.lubricant = *evaluation.lubricant;
  if (evaluation.surface) inputs.surface = *evaluation.surface;
  Deviations deviations(0);  // of one lubricant alone: nothing is correlated
  std::vector<std::vector<Mixture>> mixtures;
  for (const InputError& error : errors.errors) mixtures.push_back(deviations.of(error, ""));
  const NormalDraws normal(draws, deviations.count(), kRigSeed);
  std::vector<RigScene> out;
  for (int n = 0; n < draws; ++n) {
    for (std::size_t e = 0; e < errors.errors.size(); ++e) {
      std::vector<double> drawn;
      for (const Mixture& each : mixtures[e]) drawn.push_back(each.at(normal, n));
      errors.errors[e].apply(drawn, inputs);
    }
    RigScene& scene = out.emplace_back(evaluation.scene);
    set_lubricant(inputs.lubricant, scene);
    if (evaluation.surface) set_surface(inputs.surface, evaluation.composite_rms_height, scene);
  }
  return out;
}

/// The rigs of all draws at one temperature of the inlet; null where the model refuses the inputs.
using DrawnRigs = std::vector<std::optional<Rig>>;

DrawnRigs drawn_rigs(const std::vector<RigScene>& scenes, double inlet_temperature) {
  DrawnRigs out;
  for (const RigScene& scene : scenes) {
    try {
      out.emplace_back(Rig(scene, inlet_temperature));
    } catch (const Refusal&) {
      out.emplace_back(std::nullopt);
    }
  }
  return out;
}

/// The figures of one row by the draws that the model does not refuse.
std::vector<RigPoint> drawn_points(const DrawnRigs& rigs, const v1::RigCondition& condition,
                                   const std::function<bool()>& is_over) {
  const RigCondition at{condition.load_newtons(), condition.entrainment_speed_metres_per_second(),
                        0.01 * condition.slide_roll_ratio_percent()};
  std::vector<RigPoint> out;
  out.reserve(rigs.size());
  for (const std::optional<Rig>& rig : rigs) {
    if (is_over()) throw Cancelled();
    if (!rig) continue;
    try {
      out.push_back(rig->at(at));
    } catch (const Refusal&) {
      continue;
    }
  }
  return out;
}

/// The columns of all figures while they are filled in.
class UncertainColumns {
 public:
  UncertainColumns(int rows, int draws)
      : draws_(draws), columns_(rig_columns().size()), is_moved_(rig_columns().size(), false) {
    constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t f = 0; f < columns_.size(); ++f) {
      columns_[f].set_figure(rig_columns()[f].name);
      columns_[f].mutable_standard_uncertainty()->Resize(rows, kNoFigure);
      columns_[f].mutable_interval_minimum()->Resize(rows, kNoFigure);
      columns_[f].mutable_interval_maximum()->Resize(rows, kNoFigure);
    }
  }

  /// `answer` has the figures of the row by the stated inputs.
  void set(int row, const std::vector<RigPoint>& points, v1::EvaluateRigResponse& answer) {
    for (std::size_t f = 0; f < columns_.size(); ++f) {
      const RigColumn& column = rig_columns()[f];
      const double stated = (answer.*column.column)()->Get(row);
      if (!std::isfinite(stated)) continue;
      std::vector<double> drawn;
      drawn.reserve(points.size());
      for (const RigPoint& point : points) drawn.push_back(point.*column.figure);
      const Spread spread = spread_of_draws(std::move(drawn), draws_, stated);
      columns_[f].set_standard_uncertainty(row, spread.standard_deviation);
      columns_[f].set_interval_minimum(row, spread.low);
      columns_[f].set_interval_maximum(row, spread.high);
      if (spread.standard_deviation != 0) is_moved_[f] = true;
    }
  }

  void move_into(v1::EvaluateRigResponse& answer) && {
    for (std::size_t f = 0; f < columns_.size(); ++f) {
      if (is_moved_[f]) *answer.add_uncertainties() = std::move(columns_[f]);
    }
  }

 private:
  int draws_;
  std::vector<v1::UncertainRigFigure> columns_;
  std::vector<bool> is_moved_;
};

}  // namespace

void add_rig_uncertainties(const RigEvaluation& evaluation,
                           const std::vector<v1::RigCondition>& conditions, int draws,
                           const std::function<bool()>& is_over, v1::EvaluateRigResponse& answer) {
  const int rows = static_cast<int>(conditions.size());
  answer.mutable_refused_draws()->Resize(rows, 0);
  const InputErrors errors = errors_of(evaluation);
  for (const std::string& each : errors.without_uncertainty) {
    answer.add_inputs_without_uncertainty(each);
  }
  if (errors.errors.empty()) return;
  std::map<double, std::vector<int>> rows_at;  // by temperature, so that rigs of one are kept only
  for (int i = 0; i < rows; ++i) {
    if (answer.refusal_numbers(i) != 0) continue;
    rows_at[conditions[static_cast<std::size_t>(i)].supply_temperature_celsius()].push_back(i);
  }
  const std::vector<RigScene> scenes = drawn_scenes(evaluation, errors, draws);
  UncertainColumns columns(rows, draws);
  for (const auto& [celsius, of_temperature] : rows_at) {
    const DrawnRigs rigs = drawn_rigs(scenes, celsius + kZeroCelsius);
    for (const int row : of_temperature) {
      const std::vector<RigPoint> points =
          drawn_points(rigs, conditions[static_cast<std::size_t>(row)], is_over);
      answer.set_refused_draws(row, draws - static_cast<int>(points.size()));
      columns.set(row, points, answer);
    }
  }
  std::move(columns).move_into(answer);
}

}  // namespace tribodyn::server
