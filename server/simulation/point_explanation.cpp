#include "server/simulation/point_explanation.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "core/refusal.h"
#include "core/study/range_warnings.h"
#include "core/study/warning_kinds.h"
#include "core/uncertainty/shapley.h"
#include "core/version.h"
#include "server/contract/check_message.h"
#include "server/mapping/from_core.h"
#include "server/mapping/to_core.h"
#include "server/simulation/input_deviations.h"
#include "server/simulation/point_comparison.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::util::MessageDifferencer;

constexpr std::uint64_t kExplanationSeed = 1;  // any: equal requests give equal answers

/// Parameters that are exchanged together, by their fields.
struct Group {
  v1::ParameterGroup group;
  std::vector<const char*> lubricant_fields;
  std::vector<const char*> surface_fields;
};

constexpr std::size_t kGroups = 6;
constexpr std::size_t kCombinations = std::size_t{1} << kGroups;

const std::array<Group, kGroups>& groups() {
  static const std::array<Group, kGroups> kAll = {
      {{v1::PARAMETER_GROUP_VISCOSITY,
        {"vogel_viscosity_prefactor_pascal_seconds", "vogel_temperature_coefficient_kelvin",
         "vogel_reference_temperature_kelvin"},
        {}},
       {v1::PARAMETER_GROUP_PRESSURE_RESPONSE,
        {"pressure_viscosity_coefficient_per_pascal", "pressure_viscosity_temperature_kelvin",
         "improved_yasutomi"},
        {}},
       {v1::PARAMETER_GROUP_SHEAR_THINNING,
        {"relaxation_time_seconds", "havriliak_negami_alpha", "havriliak_negami_beta",
         "rheology_reference_temperature_kelvin"},
        {}},
       {v1::PARAMETER_GROUP_LIMITING_STRESS,
        {"limiting_shear_stress_at_zero_pressure_pascals", "limiting_shear_stress_coefficient"},
        {}},
       {v1::PARAMETER_GROUP_THERMAL_PROPERTIES,
        {"thermal_conductivity_watts_per_metre_kelvin",
         "density_at_zero_kelvin_kilograms_per_cubic_metre",
         "density_slope_kilograms_per_cubic_metre_kelvin"},
        {}},
       {v1::PARAMETER_GROUP_BOUNDARY_FILM,
        {"asperity_friction_coefficient", "tribofilm_shear_strength_pascals",
         "asperity_friction_by_temperature"},
        {"asperity_density_per_square_metre", "asperity_radius_metres",
         "composite_rms_height_metres", "tribofilm_shear_strength_pascals",
         "asperity_friction_coefficient"}}}};
  return kAll;
}

void copy_fields(const Message& from, const std::vector<const char*>& fields, Message& to) {
  const auto &of_from = *from.GetReflection(), &of_to = *to.GetReflection();
  for (const char* name : fields) {
    const FieldDescriptor* field = to.GetDescriptor()->FindFieldByName(name);
    of_to.ClearField(&to, field);
    if (field->is_repeated()) {
      for (int i = 0; i < of_from.FieldSize(from, field); ++i) {
        of_to.AddMessage(&to, field)->CopyFrom(of_from.GetRepeatedMessage(from, field, i));
      }
    } else if (!of_from.HasField(from, field)) {
      continue;
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      of_to.MutableMessage(&to, field)->CopyFrom(of_from.GetMessage(from, field));
    } else {
      of_to.SetDouble(&to, field, of_from.GetDouble(from, field));
    }
  }
}

bool are_equal(const Message& a, const Message& b, const std::vector<const char*>& fields) {
  const std::unique_ptr<Message> of_a(a.New()), of_b(b.New());
  copy_fields(a, fields, *of_a);
  copy_fields(b, fields, *of_b);
  return MessageDifferencer::Equals(*of_a, *of_b);
}

/// Returns the set of groups in which both differ: bit g is 1 if group g does.
std::size_t differing_groups(const UncertainInputs& first, const UncertainInputs& other) {
  std::size_t out = 0;
  for (std::size_t g = 0; g < kGroups; ++g) {
    const Group& group = groups()[g];
    if (!are_equal(first.lubricant, other.lubricant, group.lubricant_fields) ||
        !are_equal(first.surface, other.surface, group.surface_fields)) {
      out |= std::size_t{1} << g;
    }
  }
  return out;
}

/// The explained figures of a point.
enum ExplainedFigure { kInefficiency, kLossWatts, kExplainedFigures };

/// The figures of all combinations at one condition, or why one of them has none.
struct Combinations {
  std::array<std::vector<double>, kExplainedFigures> values;
  std::array<std::vector<double>, kExplainedFigures> solver_errors;
  int contact_losses = 0;
  /// Of the points of the two oils: one of each code, about the point furthest outside.
  std::vector<RangeWarning> warnings;
  std::string refusal_reason, refusal_message;

  Combinations() {
    for (auto& each : values) each.assign(kCombinations, 0.0);
    for (auto& each : solver_errors) each.assign(kCombinations, 0.0);
  }
  bool is_refused() const { return !refusal_reason.empty(); }

  void set(std::size_t combination, const EvaluatedPoint& point) {
    if (is_refused()) return;
    if (!point.figures || !point.figures->inefficiency_energy_mean) {
      refusal_reason = point.figures ? "NO_INPUT_POWER" : point.refusal_reason;
      refusal_message = point.figures ? "no power comes in, so that there is no inefficiency"
                                      : point.refusal_message;
      return;
    }
    values[kInefficiency][combination] = *point.figures->inefficiency_energy_mean;
    values[kLossWatts][combination] = point.figures->mesh_loss_power;
    for (std::size_t i = 0; i < kExplainedFigures; ++i) {
      solver_errors[i][combination] =
          point.figures->estimated_relative_error.value_or(0) * std::abs(values[i][combination]);
    }
    if (point.figures->contact_loss) ++contact_losses;
  }
};

/// By condition, and last the weighted mean.
using ExplainedConditions = std::vector<Combinations>;

void add_mean(const std::vector<double>& weights, ExplainedConditions& conditions) {
  Combinations mean;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Combinations& each = conditions[k];
    if (each.is_refused() && !mean.is_refused()) {
      mean.refusal_reason = each.refusal_reason;
      mean.refusal_message = each.refusal_message;
    }
    mean.contact_losses = std::max(mean.contact_losses, each.contact_losses);
    keep_furthest(each.warnings, mean.warnings);
    for (std::size_t i = 0; i < kExplainedFigures; ++i) {
      for (std::size_t set = 0; set < kCombinations; ++set) {
        mean.values[i][set] += weights[k] * each.values[i][set];
        mean.solver_errors[i][set] += weights[k] * each.solver_errors[i][set];
      }
    }
  }
  conditions.push_back(std::move(mean));
}

/// A source of error of one side, with its deviations.
struct ExplainedSource {
  const InputError* error;
  std::vector<Mixture> mixtures;
};

/// The inputs of one side, stated or drawn.
class DrawnSide {
 public:
  /// `shares_surface`: both lubricants run on one surface, so that its errors are common.
  DrawnSide(const PointExplanation::Side& side, bool shares_surface, Deviations& deviations) {
    const SimulationInputs& base = side.evaluation.base;
    inputs_.lubricant = *base.lubricant;
    inputs_.lubricant.clear_provenance();
    inputs_.surface = *base.surface;
    inputs_.surface.clear_provenance();
    inputs_.vehicle = *base.vehicle;
    for (const InputError& error : side.lubricant_errors.errors) {
      sources_.push_back({&error, deviations.of(error, base.effective.lubricant_revision())});
    }
    for (const InputError& error : side.scene_errors.errors) {
      InputError owned = error;
      if (!shares_surface && error.input.starts_with("surface.")) {
        owned.sharing = InputError::Sharing::kOwn;
      }
      sources_.push_back({&error, deviations.of(owned, base.effective.surface_revision())});
    }
  }

  const UncertainInputs& inputs() const { return inputs_; }
  void draw(const NormalDraws& draws, int draw) {
    for (const ExplainedSource& source : sources_) {
      std::vector<double> deviations;
      for (const Mixture& each : source.mixtures) deviations.push_back(each.at(draws, draw));
      source.error->apply(deviations, inputs_);
    }
  }

 private:
  UncertainInputs inputs_;
  std::vector<ExplainedSource> sources_;
};

/// Computes the points of all combinations.
class CombinationPoints {
 public:
  CombinationPoints(const PointExplanation& explanation,
                    const std::shared_ptr<PreparedGearSet>& gear_set,
                    const std::function<bool()>& is_over)
      : explanation_(explanation),
        gear_set_(gear_set),
        physical_(scene(explanation.first.evaluation.base)),
        options_(point_options(explanation.first.evaluation)) {
    options_.progress = [&is_over](double) { return !is_over(); };
  }

  ExplainedConditions compute(const UncertainInputs& first, const UncertainInputs& other) {
    const std::size_t differing = differing_groups(first, other);
    ExplainedConditions out(explanation_.weights.size());
    std::array<std::vector<EvaluatedPoint>, kCombinations> points;
    for (std::size_t set = 0; set < kCombinations; ++set) {
      // Exchanging an equal group changes nothing: that combination is computed already.
      const std::size_t computed = set & differing;
      if (computed == set) points[set] = evaluate(first, other, set, differing);
      for (std::size_t k = 0; k < out.size(); ++k) out[k].set(set, points[computed][k]);
    }
    for (const std::size_t of_an_oil : {std::size_t{0}, differing}) {
      for (std::size_t k = 0; k < out.size(); ++k) {
        const EvaluatedPoint& point = points[of_an_oil][k];
        if (point.figures) keep_furthest(point.figures->warnings, out[k].warnings);
      }
    }
    add_mean(explanation_.weights, out);
    return out;
  }

 private:
  std::vector<EvaluatedPoint> evaluate(const UncertainInputs& first, const UncertainInputs& other,
                                       std::size_t set, std::size_t differing) {
    // With all groups exchanged it is the other oil, with what its warnings depend on.
    v1::Lubricant lubricant = (set == differing ? other : first).lubricant;
    v1::Surface surface = first.surface;
    for (std::size_t g = 0; g < kGroups; ++g) {
      if ((set >> g & 1) == 0) continue;
      copy_fields(other.lubricant, groups()[g].lubricant_fields, lubricant);
      copy_fields(other.surface, groups()[g].surface_fields, surface);
    }
    physical_.roughness = roughness(surface);
    physical_.boundary = boundary_friction(surface);
    physical_.vehicle = to_core(first.vehicle);
    return evaluate_conditions(
        explanation_.first.evaluation, lubricant, physical_,
        {first.sump_temperature_rise_kelvin, first.inlet_temperature_rise_kelvin}, options_,
        gear_set_);
  }

  const PointExplanation& explanation_;
  std::shared_ptr<PreparedGearSet> gear_set_;
  Scene physical_;
  PointOptions options_;
};

/// Everything that is computed.
struct ComputedCombinations {
  ExplainedConditions stated;
  std::vector<ExplainedConditions> drawn;
  std::size_t differing;  // groups in which the stated inputs differ
};

/// Returns a figure with the spread of the draws. `value_of` maps Combinations to the figure.
template <class ValueOf>
v1::DrawnFigure drawn_figure(const ComputedCombinations& all, std::size_t condition,
                             double solver_error, const ValueOf& value_of) {
  v1::DrawnFigure out;
  out.set_value(value_of(all.stated[condition]));
  std::vector<double> drawn;
  for (const ExplainedConditions& draw : all.drawn) {
    if (!draw[condition].is_refused()) drawn.push_back(value_of(draw[condition]));
  }
  const Spread spread =
      spread_of_draws(std::move(drawn), static_cast<int>(all.drawn.size()), out.value());
  out.set_standard_uncertainty(spread.standard_deviation);
  out.set_interval_minimum(spread.low);
  out.set_interval_maximum(spread.high);
  out.set_solver_error(solver_error);
  return out;
}

/// The attribution of one figure to one group. `shapley` has the Shapley values of each draw.
v1::Attribution attribution(const ComputedCombinations& all, std::size_t condition,
                            ExplainedFigure figure, std::size_t group) {
  const std::vector<double>& values = all.stated[condition].values[figure];
  const std::vector<double>& errors = all.stated[condition].solver_errors[figure];
  const std::size_t bit = std::size_t{1} << group;
  // Every difference errs by at most both errors.
  const double bound =
      (all.differing & bit) == 0 ? 0 : 2 * *std::max_element(errors.begin(), errors.end());
  v1::Attribution out;
  *out.mutable_shapley_value() =
      drawn_figure(all, condition, bound, [&](const Combinations& combinations) {
        return shapley_values(combinations.values[figure])[group];
      });
  out.set_first_effect(values[bit] - values.front());
  out.set_last_effect(values.back() - values[kCombinations - 1 - bit]);
  return out;
}

struct FigureSet {
  v1::DrawnFigure first, other, difference;
};

FigureSet figures_of_both(const ComputedCombinations& all, std::size_t condition,
                          ExplainedFigure figure) {
  const std::vector<double>& errors = all.stated[condition].solver_errors[figure];
  return {drawn_figure(all, condition, errors.front(),
                       [&](const Combinations& each) { return each.values[figure].front(); }),
          drawn_figure(all, condition, errors.back(),
                       [&](const Combinations& each) { return each.values[figure].back(); }),
          drawn_figure(all, condition, all.differing == 0 ? 0 : errors.front() + errors.back(),
                       [&](const Combinations& each) {
                         return each.values[figure].back() - each.values[figure].front();
                       })};
}

v1::DifferenceExplanation explanation_message(const ComputedCombinations& all,
                                              std::size_t condition) {
  v1::DifferenceExplanation out;
  const Combinations& stated = all.stated[condition];
  if (stated.is_refused()) {
    out.set_refusal_reason(stated.refusal_reason);
    out.set_refusal_message(stated.refusal_message);
    return out;
  }
  FigureSet percent = figures_of_both(all, condition, kInefficiency);
  *out.mutable_inefficiency_percent() = std::move(percent.first);
  *out.mutable_other_inefficiency_percent() = std::move(percent.other);
  *out.mutable_inefficiency_difference_percent() = std::move(percent.difference);
  FigureSet watts = figures_of_both(all, condition, kLossWatts);
  *out.mutable_mesh_loss_power_watts() = std::move(watts.first);
  *out.mutable_other_mesh_loss_power_watts() = std::move(watts.other);
  *out.mutable_mesh_loss_power_difference_watts() = std::move(watts.difference);
  for (std::size_t g = 0; g < kGroups; ++g) {
    v1::DifferenceCause& cause = *out.add_causes();
    cause.set_group(groups()[g].group);
    cause.set_is_equal((all.differing >> g & 1) == 0);
    *cause.mutable_inefficiency_percent() = attribution(all, condition, kInefficiency, g);
    *cause.mutable_mesh_loss_power_watts() = attribution(all, condition, kLossWatts, g);
  }
  const std::vector<double> in_percent = shapley_interactions(stated.values[kInefficiency]);
  const std::vector<double> in_watts = shapley_interactions(stated.values[kLossWatts]);
  std::size_t pair = 0;
  for (std::size_t i = 0; i < kGroups; ++i) {
    for (std::size_t j = i + 1; j < kGroups; ++j, ++pair) {
      v1::CauseInteraction& interaction = *out.add_interactions();
      interaction.set_group(groups()[i].group);
      interaction.set_other_group(groups()[j].group);
      interaction.set_inefficiency_percent(in_percent[pair]);
      interaction.set_mesh_loss_power_watts(in_watts[pair]);
    }
  }
  out.set_contact_loss_combinations(stated.contact_losses);
  add_warnings(stated.warnings, out.mutable_warnings());
  for (const ExplainedConditions& draw : all.drawn) {
    if (draw[condition].is_refused()) out.set_refused_draws(out.refused_draws() + 1);
  }
  return out;
}

/// Without a stated uncertainty of both oils nobody knows how sure their difference is.
void clear_uncertainties(v1::DifferenceExplanation& explanation) {
  const auto clear = [](v1::DrawnFigure& figure) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    figure.set_standard_uncertainty(kUnknown);
    figure.set_interval_minimum(kUnknown);
    figure.set_interval_maximum(kUnknown);
  };
  if (!explanation.refusal_reason().empty()) return;
  clear(*explanation.mutable_inefficiency_percent());
  clear(*explanation.mutable_other_inefficiency_percent());
  clear(*explanation.mutable_inefficiency_difference_percent());
  clear(*explanation.mutable_mesh_loss_power_watts());
  clear(*explanation.mutable_other_mesh_loss_power_watts());
  clear(*explanation.mutable_mesh_loss_power_difference_watts());
  for (v1::DifferenceCause& cause : *explanation.mutable_causes()) {
    clear(*cause.mutable_inefficiency_percent()->mutable_shapley_value());
    clear(*cause.mutable_mesh_loss_power_watts()->mutable_shapley_value());
  }
}

/// Returns the request for the points of one lubricant on its surface.
v1::EvaluatePointsRequest points_of_side(const v1::ExplainPointsRequest& request,
                                         const std::string& lubricant, const std::string& surface,
                                         bool is_sheared) {
  v1::EvaluatePointsRequest out;
  out.set_sheared_lubricant(is_sheared);
  out.set_lubricant(lubricant);
  out.set_gear_set(request.gear_set());
  out.set_surface(surface);
  out.set_vehicle(request.vehicle());
  if (request.has_model_options()) *out.mutable_model_options() = request.model_options();
  out.set_tolerance(request.tolerance() == 0 ? kDefaultExplanationTolerance : request.tolerance());
  *out.mutable_conditions() = request.conditions();
  return out;
}

PointExplanation::Side side_of(const v1::ExplainPointsRequest& request,
                               PointEvaluation evaluation) {
  InputErrors lubricant = lubricant_errors(*evaluation.base.lubricant);
  InputErrors scene = scene_errors(*evaluation.base.surface, *evaluation.base.vehicle,
                                   request.sump_temperature_uncertainty_kelvin(),
                                   request.inlet_temperature_rise_uncertainty_kelvin());
  return {std::move(evaluation), std::move(lubricant), std::move(scene)};
}

void check_explanation_counts(const v1::ExplainPointsRequest& request, int draws,
                              Violations& violations) {
  const int conditions = request.conditions_size(), weights = request.condition_weights_size();
  if (weights != 0 && weights != conditions) {
    violations.push_back(
        {"condition_weights",
         fmt::format("{} weights of {} conditions; allowed: one for each condition, or none",
                     weights, conditions)});
  }
  const long points = static_cast<long>(kCombinations) * conditions * (draws + 1L);
  if (points > kMaximumExplainedPoints) {
    violations.push_back(
        {"conditions",
         fmt::format("{} combinations at {} conditions with {} draws are {} points; allowed: at "
                     "most {} in one request; send several, or take fewer draws",
                     kCombinations, conditions, draws, points, kMaximumExplainedPoints)});
  }
}

}  // namespace

std::optional<PointExplanation> read_explanation(const v1::ExplainPointsRequest& request,
                                                 const ResourceLookup& lookup,
                                                 Violations& violations) {
  const std::size_t before = violations.size();
  const int draws = request.draws() == 0 ? kDefaultExplanationDraws : request.draws();
  check_message(request, "", violations);
  check_explanation_counts(request, draws, violations);
  if (violations.size() > before) return std::nullopt;
  auto first = read_points(
      points_of_side(request, request.lubricant(), request.surface(), request.sheared_lubricant()),
      lookup, violations);
  const bool has_other_surface = !request.other_surface().empty();
  Violations found;
  auto other =
      read_points(points_of_side(request, request.other_lubricant(),
                                 has_other_surface ? request.other_surface() : request.surface(),
                                 request.other_sheared_lubricant()),
                  lookup, found);
  for (Violation each : found) {
    // The first lubricant has the same violations of what both share.
    const bool is_own = each.field.starts_with("lubricant") || each.field == "sheared_lubricant" ||
                        (has_other_surface && each.field.starts_with("surface"));
    if (is_own) {
      each.field = "other_" + each.field;
      violations.push_back(std::move(each));
    }
  }
  if (!first || !other || violations.size() > before) return std::nullopt;
  PointExplanation out{side_of(request, std::move(*first)),
                       side_of(request, std::move(*other)),
                       {request.condition_weights().begin(), request.condition_weights().end()},
                       draws,
                       request.has_estimate_correlation() ? request.estimate_correlation()
                                                          : kDefaultEstimateCorrelation};
  if (out.first.lubricant_errors.errors.empty() && out.first.scene_errors.errors.empty() &&
      out.other.lubricant_errors.errors.empty() && out.other.scene_errors.errors.empty()) {
    out.draws = 0;
  }
  if (out.weights.empty()) {
    out.weights.assign(static_cast<std::size_t>(request.conditions_size()), 1.0);
  }
  const double sum = std::accumulate(out.weights.begin(), out.weights.end(), 0.0);
  for (double& weight : out.weights) weight /= sum;
  return out;
}

v1::ExplainPointsResponse explain_points(const PointExplanation& explanation,
                                         PreparedGearSets& gear_sets,
                                         const std::function<bool()>& is_over) {
  const SimulationInputs& base = explanation.first.evaluation.base;
  const SimulationInputs& other_base = explanation.other.evaluation.base;
  const v1::Simulation &effective = base.effective, &other_effective = other_base.effective;
  const Scene physical = scene(base);
  const std::shared_ptr<PreparedGearSet> gear_set = gear_sets.take(base.gear_set, physical);

  Deviations deviations(explanation.estimate_correlation);
  const bool shares_surface = effective.surface_revision() == other_effective.surface_revision();
  DrawnSide first(explanation.first, shares_surface, deviations);
  DrawnSide other(explanation.other, shares_surface, deviations);
  CombinationPoints points(explanation, gear_set, is_over);
  ComputedCombinations all;
  all.differing = differing_groups(first.inputs(), other.inputs());
  all.stated = points.compute(first.inputs(), other.inputs());
  if (explanation.draws > 0) {
    const NormalDraws draws(explanation.draws, deviations.count(), kExplanationSeed);
    for (int n = 0; n < explanation.draws; ++n) {
      first.draw(draws, n);
      other.draw(draws, n);
      all.drawn.push_back(points.compute(first.inputs(), other.inputs()));
    }
  }
  gear_sets.give_back(base.gear_set, physical.options, gear_set);

  v1::ExplainPointsResponse out;
  const std::size_t conditions = explanation.weights.size();
  const bool is_stated = !explanation.first.lubricant_errors.errors.empty() &&
                         !explanation.other.lubricant_errors.errors.empty();
  for (std::size_t k = 0; k <= conditions; ++k) {
    v1::DifferenceExplanation& each = k < conditions ? *out.add_points() : *out.mutable_mean();
    each = explanation_message(all, k);
    if (!is_stated) clear_uncertainties(each);
  }
  out.set_draws(explanation.draws);
  out.set_estimate_correlation(explanation.estimate_correlation);
  out.set_lubricant_revision(effective.lubricant_revision());
  out.set_other_lubricant_revision(other_effective.lubricant_revision());
  out.set_gear_set_revision(effective.gear_set_revision());
  out.set_surface_revision(effective.surface_revision());
  out.set_other_surface_revision(other_effective.surface_revision());
  out.set_vehicle_revision(effective.vehicle_revision());
  out.set_not_included(kToothContactOnly);
  out.set_model_version(kModelVersion);
  return out;
}

}  // namespace tribodyn::server
