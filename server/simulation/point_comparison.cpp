#include "server/simulation/point_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/numerics/square.h"
#include "core/study/operating_target.h"
#include "core/study/warning_kinds.h"
#include "core/uncertainty/normal_draws.h"
#include "core/uncertainty/spread.h"
#include "core/version.h"
#include "server/contract/check_message.h"
#include "server/mapping/from_core.h"
#include "server/simulation/compared_fluid.h"
#include "server/simulation/drawn_figures.h"

namespace tribodyn::server {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kSeed = 1;  // any: equal requests give equal answers
constexpr double kDefaultTolerance = 1e-3, kLeastTolerance = 1e-8;
constexpr double kNormalQuantile = 1.959964;  // of a normal interval of 95 %
/// Tolerance of points with contact figures, relative to that of the request [-]: the uncertainty
/// of the inputs moves the extremes of the transmission error by as little as 0.1 %, the default
/// tolerance.
constexpr double kContactTolerance = 0.1;

/// Sets standard uncertainty and interval from the draws that the model did not refuse.
void set_spread(std::vector<double> drawn, int draws, double widening, v1::UncertainFigure& out) {
  const Spread spread = spread_of_draws(std::move(drawn), draws, out.value());
  out.set_standard_uncertainty(spread.standard_deviation);
  out.set_interval_minimum(spread.low - widening);
  out.set_interval_maximum(spread.high + widening);
}

v1::UncertainFigure figure_message(const ComputedFluid& fluid, std::size_t condition,
                                   ComparedFigure figure) {
  v1::UncertainFigure out;
  const StatedFigures& stated = *fluid.stated[condition];
  out.set_value(stated.value[figure]);
  out.set_solver_error(stated.solver_error[figure]);
  double variance = 0;
  for (const ErrorSource& source : fluid.sources)
    variance += source.squared_effect(condition, figure);
  out.set_linear_standard_uncertainty(std::sqrt(variance));
  std::vector<double> drawn;
  for (const ValuesByCondition& draw : fluid.drawn) {
    if (draw[condition]) drawn.push_back((*draw[condition])[figure]);
  }
  set_spread(std::move(drawn), static_cast<int>(fluid.drawn.size()), 0, out);
  return out;
}

/// Makes shares of the variances that `shares` holds, and sorts them.
template <class Shares>
void finish_shares(double variance, Shares& shares) {
  for (v1::InputShare& each : shares) {
    each.set_variance_share(variance > 0 ? each.variance_share() / variance : 0);
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const v1::InputShare& a, const v1::InputShare& b) {
                     return a.variance_share() > b.variance_share();
                   });
}

template <class Shares>
void add_shares(const ComputedFluid& fluid, std::size_t condition, Shares& out) {
  double variance = 0;
  for (const ErrorSource& source : fluid.sources) {
    const double part = source.squared_effect(condition, kEnergyMean);
    variance += part;
    v1::InputShare& share = *out.Add();
    share.set_input(source.error->input);
    share.set_variance_share(part);
    share.set_effect(source.effects.size() == 1 ? source.effects[0][condition][kEnergyMean]
                                                : std::sqrt(part));
  }
  finish_shares(variance, out);
}

/// The source of a fluid whose deviations are correlated with those of `source`; null if there is
/// none.
const ErrorSource* counterpart(const ErrorSource& source, const ComputedFluid& fluid) {
  for (const ErrorSource& each : fluid.sources) {
    if (each.error->input == source.error->input &&
        correlation(each.mixtures[0], source.mixtures[0]) > 0) {
      return &each;
    }
  }
  return nullptr;
}

/// The part of one input in the variance of a difference, and what it would be if the input were
/// measured of each lubricant, with the same uncertainty.
struct InputPart {
  const InputError* error;
  std::string revision;
  double variance, measured_variance;
};

/// Adds the shares of `fluid` less `first`, and returns their parts in the variance of the linear
/// model.
std::vector<InputPart> add_difference_shares(const ComputedFluid& fluid, const ComputedFluid& first,
                                             std::size_t condition, v1::ComparedDifference& out) {
  double variance = 0;
  std::vector<InputPart> parts;
  const auto add = [&](const ErrorSource& source, const std::string& revision, double part,
                       double effect, double measured) {
    variance += part;
    parts.push_back({source.error, revision, part, measured});
    v1::InputShare& share = *out.add_shares();
    share.set_input(source.error->input);
    share.set_lubricant_revision(revision);
    share.set_variance_share(part);
    share.set_effect(effect);
  };
  for (const ErrorSource& source : fluid.sources) {
    const ErrorSource* other = counterpart(source, first);
    if (other == nullptr) {
      const double part = source.squared_effect(condition, kEnergyMean);
      add(source, fluid.revision, part, std::sqrt(part), part);
      continue;
    }
    double part = 0;
    for (std::size_t i = 0; i < source.effects.size(); ++i) {
      const double a = source.effects[i][condition][kEnergyMean];
      const double b = other->effects[i][condition][kEnergyMean];
      part +=
          square(a) + square(b) - 2 * correlation(source.mixtures[i], other->mixtures[i]) * a * b;
    }
    part = std::max(0.0, part);
    const bool is_estimate = source.error->sharing == InputError::Sharing::kEstimate;
    add(source, "", part, std::sqrt(part),
        is_estimate ? source.squared_effect(condition, kEnergyMean) +
                          other->squared_effect(condition, kEnergyMean)
                    : part);
  }
  for (const ErrorSource& source : first.sources) {
    if (counterpart(source, fluid) != nullptr) continue;
    const double part = source.squared_effect(condition, kEnergyMean);
    add(source, first.revision, part, std::sqrt(part), part);
  }
  finish_shares(variance, *out.mutable_shares());
  return parts;
}

double variance_of(const std::vector<InputPart>& parts) {
  return std::accumulate(parts.begin(), parts.end(), 0.0,
                         [](double sum, const InputPart& each) { return sum + each.variance; });
}

/// Adds what would tell two lubricants apart, by the linear model, scaled to the draws where their
/// interval is wider: inputs known so much better that the interval leaves out 0.
void add_deciding_inputs(const std::vector<InputPart>& parts, v1::ComparedDifference& out) {
  constexpr double kLeastFactor = 0.05;  // nobody measures twenty times better
  constexpr std::size_t kMostNamed = 3;
  const v1::UncertainFigure& figure = out.difference_percent();
  const double room = std::abs(figure.value()) - figure.solver_error();
  const double all = variance_of(parts);
  const double to_zero =
      std::abs(figure.value() -
               (figure.value() > 0 ? figure.interval_minimum() : figure.interval_maximum()));
  const double scale = std::max(1.0, square(to_zero / kNormalQuantile) / all);
  const double allowed = square(std::max(0.0, room) / kNormalQuantile) / scale;
  if (!(allowed < all)) return;
  const auto add = [&out](const InputPart& part, double factor) {
    v1::DecidingInput& added = *out.add_deciding_inputs();
    added.set_input(part.error->input);
    added.set_lubricant_revision(part.revision);
    added.set_standard_uncertainty(factor * part.error->standard_uncertainty);
    added.set_factor(factor);
  };
  std::vector<std::pair<double, const InputPart*>> found;  // by factor
  for (const InputPart& each : parts) {
    const double left = allowed - (all - each.variance);
    if (!(left > 0) || !(each.measured_variance > 0)) continue;
    const double factor = std::sqrt(left / each.measured_variance);
    if (factor >= kLeastFactor && factor < 1) found.emplace_back(factor, &each);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  found.resize(std::min(found.size(), kMostNamed));
  for (const auto& [factor, part] : found) add(*part, factor);
  if (!found.empty()) return;
  // No single input would do: the largest together, until the others leave enough room.
  std::vector<InputPart> sorted = parts;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const InputPart& a, const InputPart& b) { return a.variance > b.variance; });
  double rest = all, measured = 0;
  for (std::size_t count = 1; count <= std::min(kMostNamed, sorted.size()); ++count) {
    rest -= sorted[count - 1].variance;
    measured += sorted[count - 1].measured_variance;
    const double factor = std::sqrt(std::max(0.0, allowed - rest) / measured);
    if (!(factor >= kLeastFactor && factor < 1)) continue;
    for (std::size_t i = 0; i < count; ++i) add(sorted[i], factor);
    out.set_all_needed(count > 1);
    return;
  }
}

/// Returns the inefficiency of a fluid in a draw. A fluid without errors has no draws: its stated
/// values stand for each of them.
std::optional<double> drawn_inefficiency(const ComputedFluid& fluid, std::size_t condition,
                                         std::size_t draw) {
  if (!fluid.drawn.empty()) {
    const std::optional<FigureValues>& values = fluid.drawn[draw][condition];
    return values ? std::optional((*values)[kEnergyMean]) : std::nullopt;
  }
  const std::optional<StatedFigures>& stated = fluid.stated[condition];
  return stated ? std::optional(stated->value[kEnergyMean]) : std::nullopt;
}

v1::ComparedDifference difference(const ComputedFluid& fluid, const ComputedFluid& first,
                                  std::size_t condition) {
  v1::ComparedDifference out;
  if (!fluid.stated[condition] || !first.stated[condition]) return out;
  v1::UncertainFigure& figure = *out.mutable_difference_percent();
  const StatedFigures &a = *fluid.stated[condition], &b = *first.stated[condition];
  figure.set_value(a.value[kEnergyMean] - b.value[kEnergyMean]);
  figure.set_solver_error(a.solver_error[kEnergyMean] + b.solver_error[kEnergyMean]);
  const std::vector<InputPart> parts = add_difference_shares(fluid, first, condition, out);
  figure.set_linear_standard_uncertainty(std::sqrt(variance_of(parts)));
  const std::size_t draws = std::max(fluid.drawn.size(), first.drawn.size());
  std::vector<double> drawn;
  for (std::size_t n = 0; n < draws; ++n) {
    const auto of_fluid = drawn_inefficiency(fluid, condition, n);
    const auto of_first = drawn_inefficiency(first, condition, n);
    if (of_fluid && of_first) drawn.push_back(*of_fluid - *of_first);
  }
  set_spread(drawn, static_cast<int>(draws), figure.solver_error(), figure);
  if (drawn.empty()) drawn.push_back(figure.value());
  out.set_lower_probability(kNoNumber);
  if (fluid.is_withheld(condition) || first.is_withheld(condition)) {
    out.set_verdict(v1::ComparedDifference::WITHHELD);
    return out;
  }
  if (!fluid.is_uncertainty_stated || !first.is_uncertainty_stated) {
    out.set_verdict(v1::ComparedDifference::UNCERTAINTY_NOT_STATED);
    return out;
  }
  out.set_lower_probability(share_below_zero(drawn));
  if (figure.interval_maximum() < 0) {
    out.set_verdict(v1::ComparedDifference::LOWER);
  } else if (figure.interval_minimum() > 0) {
    out.set_verdict(v1::ComparedDifference::HIGHER);
  } else if (std::isfinite(figure.interval_minimum())) {
    out.set_verdict(v1::ComparedDifference::CANNOT_BE_TOLD_APART);
    add_deciding_inputs(parts, out);
  }
  return out;
}

v1::ComparedPoint point_message(const ComputedFluid& fluid, std::size_t condition) {
  v1::ComparedPoint out;
  if (!fluid.stated[condition]) {
    const EvaluatedPoint& point = fluid.points[condition];
    out.set_refusal_reason(point.figures ? "NO_INPUT_POWER" : point.refusal_reason);
    out.set_refusal_message(point.figures ? "no power comes in, so that there is no inefficiency"
                                          : point.refusal_message);
    return out;
  }
  *out.mutable_inefficiency_energy_mean_percent() = figure_message(fluid, condition, kEnergyMean);
  *out.mutable_inefficiency_rms_percent() = figure_message(fluid, condition, kRms);
  *out.mutable_mesh_loss_power_watts() = figure_message(fluid, condition, kLossPower);
  *out.mutable_pinion_torque_newton_metres() = figure_message(fluid, condition, kPinionTorque);
  *out.mutable_dynamic_transmission_error_minimum_metres() =
      figure_message(fluid, condition, kDteMinimum);
  *out.mutable_dynamic_transmission_error_maximum_metres() =
      figure_message(fluid, condition, kDteMaximum);
  if (fluid.points[condition].figures->contact) {
    *out.mutable_film_ratio_minimum() = figure_message(fluid, condition, kFilmRatio);
    *out.mutable_contact_temperature_maximum_kelvin() =
        figure_message(fluid, condition, kContactTemperature);
    *out.mutable_mesh_friction_coefficient() =
        figure_message(fluid, condition, kFrictionCoefficient);
    *out.mutable_maximum_pressure_maximum_pascals() = figure_message(fluid, condition, kPressure);
    *out.mutable_flash_temperature_rise_maximum_kelvin() =
        figure_message(fluid, condition, kFlashTemperature);
  }
  out.set_contact_loss(fluid.stated[condition]->contact_loss);
  add_warnings(fluid.points[condition].figures->warnings, out.mutable_warnings());
  out.set_solved_draws(fluid.solved_draws[condition]);
  for (const ValuesByCondition& draw : fluid.drawn) {
    if (!draw[condition]) out.set_refused_draws(out.refused_draws() + 1);
  }
  add_shares(fluid, condition, *out.mutable_shares());
  return out;
}

v1::ComparedLubricant lubricant_message(const ComputedFluid& fluid, const ComputedFluid& first,
                                        const InputErrors& errors) {
  v1::ComparedLubricant out;
  out.set_lubricant_revision(fluid.revision);
  out.set_uncertainty_stated(fluid.is_uncertainty_stated);
  const std::size_t conditions = fluid.points.size();
  const bool is_first = &fluid == &first;
  for (std::size_t k = 0; k < conditions; ++k) {
    *out.add_points() = point_message(fluid, k);
    if (!is_first) *out.add_differences() = difference(fluid, first, k);
  }
  if (fluid.stated[conditions]) {
    *out.mutable_mean_inefficiency_percent() = figure_message(fluid, conditions, kEnergyMean);
    add_shares(fluid, conditions, *out.mutable_mean_shares());
  }
  if (!is_first) *out.mutable_mean_difference() = difference(fluid, first, conditions);
  for (const std::string& each : errors.without_uncertainty) {
    out.add_inputs_without_uncertainty(each);
  }
  return out;
}

/// Whether a fluid takes part in a ranking: its mean exists, and nothing withholds the verdict.
bool is_ranked(const ComputedFluid& fluid) {
  return fluid.stated.back() && !fluid.is_withheld(fluid.points.size());
}

/// Returns for each fluid the share of draws in which its mean is the least of all that are ranked
/// and state an uncertainty; equal ones share a draw. NaN for others. Draws in which one has no
/// mean are left out.
std::vector<double> best_probabilities(const std::vector<ComputedFluid>& fluids) {
  std::vector<double> out(fluids.size(), kNoNumber);
  std::vector<std::size_t> members;
  std::size_t draws = 1;
  for (std::size_t i = 0; i < fluids.size(); ++i) {
    if (!is_ranked(fluids[i]) || !fluids[i].is_uncertainty_stated) continue;
    members.push_back(i);
    out[i] = 0;
    draws = std::max(draws, fluids[i].drawn.size());
  }
  if (members.size() < 2 && fluids.size() > 1) return std::vector<double>(fluids.size(), kNoNumber);
  double counted = 0;
  for (std::size_t n = 0; n < draws; ++n) {
    std::vector<double> means;
    for (const std::size_t i : members) {
      if (const auto mean = drawn_inefficiency(fluids[i], fluids[i].points.size(), n)) {
        means.push_back(*mean);
      }
    }
    if (means.empty() || means.size() < members.size()) continue;
    ++counted;
    const double least = *std::min_element(means.begin(), means.end());
    const auto equal = static_cast<double>(std::count(means.begin(), means.end(), least));
    for (std::size_t k = 0; k < means.size(); ++k) {
      if (means[k] == least) out[members[k]] += 1 / equal;
    }
  }
  for (const std::size_t i : members) out[i] = counted > 0 ? out[i] / counted : kNoNumber;
  return out;
}

/// Adds what each mean differs by from the least, and how probable it is the least.
void add_ranking(const std::vector<ComputedFluid>& fluids, v1::ComparePointsResponse& out) {
  const ComputedFluid* best = nullptr;
  const auto mean = [](const ComputedFluid& fluid) {
    return fluid.stated.back()->value[kEnergyMean];
  };
  for (const ComputedFluid& fluid : fluids) {
    if (is_ranked(fluid) && (best == nullptr || mean(fluid) < mean(*best))) best = &fluid;
  }
  const std::vector<double> probabilities = best_probabilities(fluids);
  for (std::size_t i = 0; i < fluids.size(); ++i) {
    v1::ComparedLubricant& lubricant = *out.mutable_lubricants(static_cast<int>(i));
    lubricant.set_best_probability(probabilities[i]);
    if (best == nullptr || best == &fluids[i]) continue;
    *lubricant.mutable_mean_difference_from_best() =
        difference(fluids[i], *best, best->stated.size() - 1);
  }
}

/// Returns the mean speed of the pinion at each condition [rad/s].
std::vector<double> pinion_speeds(const Scene& scene, const PointEvaluation& evaluation) {
  std::vector<double> out(static_cast<std::size_t>(evaluation.conditions));
  for (const PointEvaluation::Group& group : evaluation.groups) {
    for (const auto& [position, condition] : group.conditions) {
      out[static_cast<std::size_t>(position)] = target_of(scene, condition).mean_pinion_speed;
    }
  }
  return out;
}

/// Returns the request for the points of one lubricant.
v1::EvaluatePointsRequest points_of(const v1::ComparePointsRequest& request,
                                    const std::string& lubricant) {
  v1::EvaluatePointsRequest out;
  out.set_lubricant(lubricant);
  out.set_gear_set(request.gear_set());
  out.set_surface(request.surface());
  out.set_vehicle(request.vehicle());
  out.set_sheared_lubricant(request.sheared_lubricant());
  if (request.has_model_options()) *out.mutable_model_options() = request.model_options();
  out.set_tolerance(request.tolerance());
  if (request.contact_figures()) {
    const double tolerance = request.tolerance() > 0 ? request.tolerance() : kDefaultTolerance;
    out.set_tolerance(std::max(kLeastTolerance, kContactTolerance * tolerance));
  }
  *out.mutable_conditions() = request.conditions();
  return out;
}

void check_counts(const v1::ComparePointsRequest& request, int draws, Violations& violations) {
  const int lubricants = request.lubricants_size(), conditions = request.conditions_size();
  if (lubricants == 0 || lubricants > kMostComparedLubricants) {
    violations.add("lubricants", "{} lubricants; allowed: 1 to {}", lubricants,
                   kMostComparedLubricants);
  }
  const int weights = request.condition_weights_size();
  if (weights != 0 && weights != conditions) {
    violations.add("condition_weights",
                   "{} weights of {} conditions; allowed: one for each condition, or none", weights,
                   conditions);
  }
  const long points = static_cast<long>(lubricants) * conditions * (draws + 1L);
  if (points > kMaximumComparedPoints) {
    violations.add("conditions",
                   "{} lubricants at {} conditions with {} draws are {} points; allowed: at "
                   "most {} in one request; send several, or take fewer draws",
                   lubricants, conditions, draws, points, kMaximumComparedPoints);
  }
}

}  // namespace

std::optional<PointComparison> read_comparison(const v1::ComparePointsRequest& request,
                                               const ResourceLookup& lookup,
                                               Violations& violations) {
  const std::size_t before = violations.size();
  PointComparison out;
  if (request.draws() != 0) out.draws = request.draws();
  if (request.has_estimate_correlation()) {
    out.estimate_correlation = request.estimate_correlation();
  }
  check_message(request, "", violations);
  check_counts(request, out.draws, violations);
  if (violations.size() > before) return std::nullopt;
  for (int i = 0; i < request.lubricants_size(); ++i) {
    Violations found;
    auto evaluation = read_points(points_of(request, request.lubricants(i)), lookup, found);
    for (Violation each : found) {
      const bool is_about_lubricant = each.field.starts_with("lubricant");
      if (is_about_lubricant) {
        each.field = fmt::format("lubricants[{}]{}", i, each.field.substr(9));
      }
      if (i == 0 || is_about_lubricant || each.field == "sheared_lubricant") {
        violations.push_back(std::move(each));
      }
    }
    if (!evaluation) continue;
    evaluation->with_contact = request.contact_figures();
    InputErrors errors = lubricant_errors(*evaluation->base.lubricant);
    out.fluids.push_back({std::move(*evaluation), std::move(errors)});
  }
  if (violations.size() > before) return std::nullopt;
  const SimulationInputs& base = out.fluids.front().evaluation.base;
  out.scene_errors =
      scene_errors(*base.surface, *base.vehicle, request.sump_temperature_uncertainty_kelvin(),
                   request.inlet_temperature_rise_uncertainty_kelvin());
  out.weights = {request.condition_weights().begin(), request.condition_weights().end()};
  if (out.weights.empty()) {
    out.weights.assign(static_cast<std::size_t>(request.conditions_size()), 1.0);
  }
  const double sum = std::accumulate(out.weights.begin(), out.weights.end(), 0.0);
  for (double& weight : out.weights) weight /= sum;
  return out;
}

v1::ComparePointsResponse compare_points(const PointComparison& comparison,
                                         PreparedGearSets& gear_sets,
                                         const std::function<bool()>& is_over) {
  Deviations deviations(comparison.estimate_correlation);
  std::vector<ComputedFluid> fluids(comparison.fluids.size());
  for (std::size_t i = 0; i < fluids.size(); ++i) {
    const PointComparison::Fluid& fluid = comparison.fluids[i];
    fluids[i].revision = fluid.evaluation.base.effective.lubricant_revision();
    fluids[i].is_uncertainty_stated = !fluid.errors.errors.empty();
    for (const InputErrors* errors : {&fluid.errors, &comparison.scene_errors}) {
      for (const InputError& error : errors->errors) {
        fluids[i].sources.push_back({&error, deviations.of(error, fluids[i].revision), {}});
      }
    }
  }
  const NormalDraws draws(comparison.draws, deviations.count(), kSeed);
  const SimulationInputs& base = comparison.fluids.front().evaluation.base;
  const Scene physical = scene(base);
  const std::shared_ptr<PreparedGearSet> gear_set = gear_sets.take(base.gear_set, physical);
  compute_drawn_figures(comparison, draws, gear_set, is_over, fluids);
  gear_sets.give_back(base.gear_set, physical.options, gear_set);

  v1::ComparePointsResponse out;
  for (std::size_t i = 0; i < fluids.size(); ++i) {
    *out.add_lubricants() =
        lubricant_message(fluids[i], fluids.front(), comparison.fluids[i].errors);
  }
  add_ranking(fluids, out);
  const std::vector<double> speeds = pinion_speeds(physical, comparison.fluids.front().evaluation);
  *out.mutable_mean_pinion_speed_radians_per_second() = {speeds.begin(), speeds.end()};
  out.set_draws(comparison.draws);
  out.set_estimate_correlation(comparison.estimate_correlation);
  for (const std::string& each : comparison.scene_errors.without_uncertainty) {
    out.add_inputs_without_uncertainty(each);
  }
  out.set_gear_set_revision(base.effective.gear_set_revision());
  out.set_surface_revision(base.effective.surface_revision());
  out.set_vehicle_revision(base.effective.vehicle_revision());
  out.set_model_version(kModelVersion);
  out.set_not_included(kToothContactOnly);
  return out;
}

}  // namespace tribodyn::server
