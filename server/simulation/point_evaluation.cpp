#include "server/simulation/point_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "core/refusal.h"
#include "core/study/warning_kinds.h"
#include "core/version.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/mapping/from_core.h"
#include "server/mapping/to_core.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/input_fields.h"
#include "server/simulation/row_warnings.h"
#include "server/simulation/solver_defaults.h"
#include "server/simulation/study_checks.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// Returns "lubricant.relaxation_time_seconds" and so on for each parameter that the model uses.
const std::map<std::string, const FieldDescriptor*>& candidate_parameters() {
  static const auto out = [] {
    std::map<std::string, const FieldDescriptor*> all;
    const auto add = [&all](const std::string& prefix, const Descriptor& resource) {
      for (int i = 0; i < resource.field_count(); ++i) {
        const FieldDescriptor* field = resource.field(i);
        if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE && !field->is_repeated() &&
            input_role(*field) == InputRole::kInput) {
          all.emplace(prefix + field->name(), field);
        }
      }
    };
    add("lubricant.", *v1::Lubricant::descriptor());
    add("lubricant.improved_yasutomi.", *v1::ImprovedYasutomi::descriptor());
    add("surface.", *v1::Surface::descriptor());
    return all;
  }();
  return out;
}

/// Checks the values of a column against the allowed range of its parameter.
void check_values(const v1::CandidateColumn& column, const FieldDescriptor& field,
                  const std::string& path, Violations& violations) {
  const Constraint* row = find_constraint(field);
  if (row == nullptr) return;  // check_message() has found that the values are finite
  int reported = 0;
  for (int k = 0; k < column.values_size() && reported < kMaximumReportedElements; ++k) {
    const double value = column.values(k);
    if (!std::isfinite(value) || row->allows(value)) continue;
    ++reported;
    violations.add(fmt::format("{}.values[{}]", path, k), out_of_range_text(*row, value));
  }
}

double sump_temperature(const v1::PointCondition& condition) {
  return condition.has_sump_temperature_celsius() ? condition.sump_temperature_celsius()
                                                  : kDefaultSumpTemperatureCelsius;
}

double inlet_rise(const v1::PointCondition& condition) {
  return condition.has_inlet_temperature_rise_kelvin() ? condition.inlet_temperature_rise_kelvin()
                                                       : kDefaultInletTemperatureRiseKelvin;
}

/// Returns the simulation of the base at a condition.
v1::Simulation simulation_of(const v1::EvaluatePointsRequest& request,
                             const v1::PointCondition& condition) {
  v1::Simulation out;
  out.set_lubricant(request.lubricant());
  out.set_gear_set(request.gear_set());
  out.set_surface(request.surface());
  out.set_vehicle(request.vehicle());
  out.set_sheared_lubricant(request.sheared_lubricant());
  if (request.has_model_options()) *out.mutable_model_options() = request.model_options();
  out.mutable_solver_options()->set_tolerance(request.tolerance());
  out.set_sump_temperature_celsius(sump_temperature(condition));
  out.set_inlet_temperature_rise_kelvin(inlet_rise(condition));
  v1::Cruise& cruise = *out.mutable_operating_point()->mutable_cruise();
  cruise.set_speed_kilometres_per_hour(condition.speed_kilometres_per_hour());
  cruise.set_ascent_angle_degrees(condition.ascent_angle_degrees());
  return out;
}

std::vector<PointEvaluation::Group> groups_of(const v1::EvaluatePointsRequest& request,
                                              SimulationInputs base) {
  std::map<std::pair<double, double>, std::size_t> positions;
  std::vector<PointEvaluation::Group> out;
  for (int k = 0; k < request.conditions_size(); ++k) {
    const v1::PointCondition& condition = request.conditions(k);
    const double sump = sump_temperature(condition), rise = inlet_rise(condition);
    const auto [at, is_new] = positions.emplace(std::pair(sump, rise), out.size());
    if (is_new) out.push_back({sump, rise, {}});
    *base.effective.mutable_operating_point()->mutable_cruise() =
        simulation_of(request, condition).operating_point().cruise();
    out[at->second].conditions.emplace_back(k, std::get<PointStudy>(study(base)).condition);
  }
  return out;
}

using MutableColumn = google::protobuf::RepeatedField<double>* (v1::EvaluatePointsResponse::*)();

/// The columns that contact_figures adds.
constexpr std::pair<MutableColumn, double ContactSummary::*> kContactColumns[] = {
    {&v1::EvaluatePointsResponse::mutable_film_ratio_minimum, &ContactSummary::film_ratio_minimum},
    {&v1::EvaluatePointsResponse::mutable_film_ratio_mean, &ContactSummary::film_ratio_mean},
    {&v1::EvaluatePointsResponse::mutable_contact_temperature_maximum_kelvin,
     &ContactSummary::contact_temperature_maximum},
    {&v1::EvaluatePointsResponse::mutable_contact_temperature_mean_kelvin,
     &ContactSummary::contact_temperature_mean},
    {&v1::EvaluatePointsResponse::mutable_viscous_loss_power_watts,
     &ContactSummary::viscous_loss_power},
    {&v1::EvaluatePointsResponse::mutable_boundary_loss_power_watts,
     &ContactSummary::boundary_loss_power},
    {&v1::EvaluatePointsResponse::mutable_mean_friction_coefficient,
     &ContactSummary::friction_coefficient_mean},
    {&v1::EvaluatePointsResponse::mutable_maximum_pressure_maximum_pascals,
     &ContactSummary::pressure_maximum},
    {&v1::EvaluatePointsResponse::mutable_flash_temperature_rise_maximum_kelvin,
     &ContactSummary::flash_temperature_rise_maximum}};

/// The rows of the answer.
class Rows {
 public:
  explicit Rows(const PointEvaluation& evaluation) {
    const int rows = evaluation.candidates * evaluation.conditions;
    for (auto* column :
         {out_.mutable_pinion_torque_newton_metres(), out_.mutable_wheel_torque_newton_metres(),
          out_.mutable_inefficiency_rms_percent(), out_.mutable_inefficiency_energy_mean_percent(),
          out_.mutable_mesh_loss_power_watts(),
          out_.mutable_dynamic_transmission_error_minimum_metres(),
          out_.mutable_dynamic_transmission_error_maximum_metres(),
          out_.mutable_estimated_relative_error()}) {
      column->Resize(rows, kAbsent);
    }
    out_.mutable_refusal_numbers()->Resize(rows, 0);
    out_.mutable_contact_loss()->Resize(rows, false);
    out_.mutable_settled()->Resize(rows, false);
    out_.mutable_responses_coexist()->Resize(rows, false);
    out_.mutable_verdict_withheld()->Resize(rows, false);
    out_.mutable_period_in_mesh_cycles()->Resize(rows, 0);
    out_.mutable_model()->Resize(rows, v1::POINT_MODEL_UNSPECIFIED);
    if (evaluation.with_contact) {
      for (const auto& [mutable_column, member] : kContactColumns) {
        (out_.*mutable_column)()->Resize(rows, kAbsent);
      }
    }
    for (const Elasticity& each : evaluation.elasticities) {
      v1::ElasticityColumn& column = *out_.add_elasticities();
      column.set_figure(each.figure);
      column.set_parameter(each.parameter);
      column.mutable_values()->Resize(rows, kAbsent);
    }
    if (!evaluation.elasticities.empty()) {
      out_.mutable_elasticities_one_sided()->Resize(rows, false);
    }
  }

  void set(int row, const EvaluatedPoint& point) {
    if (!point.figures) return refuse(row, point.refusal_reason, point.refusal_message);
    const PointFigures& figures = *point.figures;
    out_.set_pinion_torque_newton_metres(row, figures.pinion_torque);
    out_.set_wheel_torque_newton_metres(row, figures.wheel_torque);
    out_.set_inefficiency_rms_percent(row, figures.inefficiency_rms.value_or(kAbsent));
    out_.set_inefficiency_energy_mean_percent(row,
                                              figures.inefficiency_energy_mean.value_or(kAbsent));
    out_.set_mesh_loss_power_watts(row, figures.mesh_loss_power);
    out_.set_dynamic_transmission_error_minimum_metres(row, figures.dte_minimum);
    out_.set_dynamic_transmission_error_maximum_metres(row, figures.dte_maximum);
    out_.set_contact_loss(row, figures.contact_loss);
    out_.set_settled(row, figures.settled);
    out_.set_period_in_mesh_cycles(row, figures.period_in_mesh_cycles);
    out_.set_estimated_relative_error(row, figures.estimated_relative_error.value_or(kAbsent));
    out_.set_model(row, to_message(figures.model));
    out_.set_responses_coexist(row, responses_coexist(figures));
    if (figures.contact && !out_.film_ratio_mean().empty()) {
      for (const auto& [mutable_column, member] : kContactColumns) {
        (out_.*mutable_column)()->Set(row, (*figures.contact).*member);
      }
    }
    for (std::size_t i = 0; i < point.elasticities.size(); ++i) {
      out_.mutable_elasticities(static_cast<int>(i))->set_values(row, point.elasticities[i]);
    }
    if (point.is_one_sided) out_.set_elasticities_one_sided(row, true);
    warnings_.add(row, figures.warnings, *out_.mutable_warnings());
    out_.set_verdict_withheld(row, any_withholds_verdict(figures.warnings));
  }

  void refuse(int row, const std::string& reason, const std::string& message) {
    const auto [at, is_new] =
        numbers_.emplace(std::pair(reason, message), out_.refusals_size() + 1);
    if (is_new) {
      v1::PointRefusal& refusal = *out_.add_refusals();
      refusal.set_reason(reason);
      refusal.set_message(message);
    }
    out_.set_refusal_numbers(row, at->second);
  }

  v1::EvaluatePointsResponse take() { return std::move(out_); }

 private:
  v1::EvaluatePointsResponse out_;
  std::map<std::pair<std::string, std::string>, int> numbers_;  // of refusals, from 1
  RowWarnings warnings_;
};

bool is_finite(const PointFigures& figures) {
  for (const double each :
       {figures.pinion_torque, figures.wheel_torque, figures.inefficiency_rms.value_or(0),
        figures.inefficiency_energy_mean.value_or(0), figures.mesh_loss_power, figures.dte_minimum,
        figures.dte_maximum}) {
    if (!std::isfinite(each)) return false;
  }
  return true;
}

EvaluatedPoint refused_point(std::string reason, std::string message) {
  EvaluatedPoint out;
  out.refusal_reason = std::move(reason);
  out.refusal_message = std::move(message);
  return out;
}

EvaluatedPoint computed_point(PreparedScene& prepared, const OperatingCondition& condition,
                              const PointOptions& options, const PointEvaluation& evaluation) {
  const std::vector<Elasticity>& elasticities = evaluation.elasticities;
  EvaluatedPoint out;
  out.figures = evaluation.shares_orbits ? screen_point(prepared, condition, options)
                                         : solve_point_figures(prepared, condition, options);
  if (!is_finite(*out.figures)) {
    return refused_point("RESULT_NOT_FINITE", "a figure of the point is not finite");
  }
  if (elasticities.empty()) return out;
  const auto& sensitivities = out.figures->sensitivities;
  out.elasticities = elasticity_values(sensitivities, elasticities);
  out.is_one_sided = sensitivities && sensitivities->one_sided;
  out.figures->sensitivities.reset();
  return out;
}

/// Computes the points of a scene at one group of conditions.
void compute_group(const Scene& scene, const PointEvaluation::Group& group,
                   const PointEvaluation& evaluation, const PointOptions& options,
                   const std::shared_ptr<PreparedGearSet>& gear_set,
                   std::vector<EvaluatedPoint>& out) {
  const auto at = [&out](int position) -> EvaluatedPoint& {
    return out[static_cast<std::size_t>(position)];
  };
  std::optional<PreparedScene> prepared;
  try {
    prepared.emplace(scene, gear_set);
  } catch (const Refusal& refusal) {
    for (const auto& [position, condition] : group.conditions) {
      at(position) = refused_point(refusal.reason(), refusal.what());
    }
    return;
  }
  for (const auto& [position, condition] : group.conditions) {
    if (!options.progress(0)) throw Cancelled();
    try {
      at(position) = computed_point(*prepared, condition, options, evaluation);
    } catch (const Refusal& refusal) {
      at(position) = refused_point(refusal.reason(), refusal.what());
    }
  }
}

/// Computes the points of a lubricant at one group of conditions, and writes them to their
/// positions in `out`. `physical` is the scene, whose lubricant must be this one and whose
/// temperatures are set here. Throws Cancelled as soon as `options.progress` returns false.
void evaluate_group(const PointEvaluation::Group& group, const PointEvaluation& evaluation,
                    const v1::Lubricant& lubricant, Scene& physical,
                    const TemperatureErrors& errors, const PointOptions& options,
                    const std::shared_ptr<PreparedGearSet>& gear_set,
                    std::vector<EvaluatedPoint>& out) {
  const double sump = group.sump_temperature_celsius + errors.sump_kelvin;
  const double rise = std::max(0.0, group.inlet_temperature_rise_kelvin + errors.inlet_rise_kelvin);
  if (const auto [reason, message] = refusal_at_inlet(lubricant, sump, rise); !reason.empty()) {
    for (const auto& [position, condition] : group.conditions) {
      out[static_cast<std::size_t>(position)] = refused_point(reason, message);
    }
    return;
  }
  physical.sump_temperature = sump + kZeroCelsius;
  physical.inlet_temperature_rise = rise;
  compute_group(physical, group, evaluation, options, gear_set, out);
}

}  // namespace

std::vector<std::string> candidate_parameter_names() {
  std::vector<std::string> out;
  for (const auto& [name, field] : candidate_parameters()) out.push_back(name);
  return out;
}

const FieldDescriptor* find_candidate_parameter(const std::string& path) {
  const auto found = candidate_parameters().find(path);
  return found == candidate_parameters().end() ? nullptr : found->second;
}

std::string unknown_parameter_text(const std::string& path) {
  return fmt::format("\"{}\" is no parameter of a lubricant or surface that the model uses{}",
                     plain_excerpt(path), meant_text(path, candidate_parameter_names()));
}

std::vector<PointEvaluation::Column> read_columns(const v1::EvaluatePointsRequest& request,
                                                  Violations& violations) {
  std::vector<PointEvaluation::Column> out;
  std::set<std::string> paths;
  for (int i = 0; i < request.candidate_columns_size(); ++i) {
    const v1::CandidateColumn& column = request.candidate_columns(i);
    const std::string path = fmt::format("candidate_columns[{}]", i);
    const auto found = candidate_parameters().find(column.path());
    if (found == candidate_parameters().end()) {
      violations.add(path + ".path", unknown_parameter_text(column.path()));
      continue;
    }
    if (!paths.insert(column.path()).second) {
      violations.add(path + ".path", "\"{}\" is listed twice; allowed: once", column.path());
    }
    const int rows = request.candidate_columns(0).values_size();
    if (column.values_size() != rows || rows == 0) {
      violations.add(path + ".values",
                     "{} values; allowed: one for each candidate, at least one and as many as in "
                     "candidate_columns[0], which has {}",
                     column.values_size(), rows);
    }
    check_values(column, *found->second, path, violations);
    out.push_back({found->second, {column.values().begin(), column.values().end()}});
  }
  return out;
}

void check_columns_of_base(const v1::EvaluatePointsRequest& request, const v1::Lubricant& base,
                           Violations& violations) {
  const bool follows_law = base.has_improved_yasutomi();
  const bool has_table = base.asperity_friction_by_temperature_size() > 0;
  std::set<std::string> stated;
  for (const v1::CandidateColumn& each : request.candidate_columns()) stated.insert(each.path());
  if (has_table || base.has_asperity_friction_coefficient()) {
    stated.insert("lubricant.asperity_friction_coefficient");
  }
  if (base.has_tribofilm_shear_strength_pascals()) {
    stated.insert("lubricant.tribofilm_shear_strength_pascals");
  }
  for (int i = 0; i < request.candidate_columns_size(); ++i) {
    const std::string& path = request.candidate_columns(i).path();
    std::string cause;
    if (path.starts_with(follows_law ? "lubricant.pressure_viscosity_"
                                     : "lubricant.improved_yasutomi.")) {
      cause = std::string(follows_law ? "follows" : "does not follow") + " improved_yasutomi";
    } else if (path == "lubricant.asperity_friction_coefficient" && has_table) {
      cause = "has asperity_friction_by_temperature";
    } else if (path.starts_with("surface.") && stated.contains("lubricant." + path.substr(8))) {
      cause = "states its own; use \"lubricant." + path.substr(8) + "\"";
    }
    if (cause.empty()) continue;
    violations.add(fmt::format("candidate_columns[{}].path", i), "\"{}\" has no effect: {} {}",
                   path, request.lubricant(), cause);
  }
}

std::optional<PointEvaluation> read_points(const v1::EvaluatePointsRequest& request,
                                           const ResourceLookup& lookup, Violations& violations,
                                           int most, const char* remedy) {
  const std::size_t before = violations.size();
  check_message(request, "", violations);
  PointEvaluation out;
  out.columns = read_columns(request, violations);
  out.with_contact = request.contact_figures();
  out.elasticities = read_elasticities(request, violations);
  if (!out.columns.empty()) out.candidates = static_cast<int>(out.columns.front().values.size());
  out.conditions = request.conditions_size();
  if (out.conditions == 0) {
    violations.add("conditions", "not set; allowed: at least one");
  } else if (out.candidates > most / out.conditions) {
    violations.add("conditions",
                   "{} candidates at {} conditions are {} points; allowed: at most {} {}",
                   out.candidates, out.conditions,
                   static_cast<long>(out.candidates) * out.conditions, most, remedy);
  }
  // The conditions are valid by now, so that what the base adds is about the base.
  const v1::PointCondition usual = [] {
    v1::PointCondition condition;
    condition.set_speed_kilometres_per_hour(50);
    return condition;
  }();
  const bool is_valid = violations.size() == before;
  auto base = read_simulation(simulation_of(request, is_valid ? request.conditions(0) : usual),
                              lookup, "", violations);
  if (base) check_columns_of_base(request, *base->lubricant, violations);
  if (!base || violations.size() > before) return std::nullopt;
  out.base = std::move(*base);
  out.groups = groups_of(request, out.base);
  return out;
}

PointOptions point_options(const PointEvaluation& evaluation) {
  PointOptions out = std::get<PointStudy>(study(evaluation.base)).options;
  out.contact_summary = evaluation.with_contact;
  out.sensitivities = !evaluation.elasticities.empty();
  out.warning_sentences = evaluation.with_sentences;
  return out;
}

std::vector<EvaluatedPoint> evaluate_conditions(const PointEvaluation& evaluation,
                                                const v1::Lubricant& lubricant, Scene& physical,
                                                const TemperatureErrors& errors,
                                                const PointOptions& options,
                                                const std::shared_ptr<PreparedGearSet>& gear_set,
                                                const std::vector<bool>* wanted) {
  std::vector<EvaluatedPoint> out(static_cast<std::size_t>(evaluation.conditions));
  set_lubricant(lubricant, physical);
  for (PointEvaluation::Group group : evaluation.groups) {
    if (wanted != nullptr) {
      std::erase_if(group.conditions, [wanted](const auto& each) {
        return !(*wanted)[static_cast<std::size_t>(each.first)];
      });
    }
    if (group.conditions.empty()) continue;
    evaluate_group(group, evaluation, lubricant, physical, errors, options, gear_set, out);
  }
  return out;
}

CandidateScene::CandidateScene(const PointEvaluation& evaluation, std::function<bool()> goes_on)
    : evaluation_(evaluation),
      options_(point_options(evaluation)),
      physical_(server::scene(evaluation.base)),
      resources_{*evaluation.base.lubricant, *evaluation.base.surface} {
  options_.progress = [keep = std::move(goes_on)](double) { return keep(); };
}

void CandidateResources::set(const PointEvaluation& evaluation, int candidate) {
  if (!evaluation.lubricants.empty()) {
    lubricant = *evaluation.lubricants[static_cast<std::size_t>(candidate)];
    return;
  }
  for (const PointEvaluation::Column& column : evaluation.columns) {
    const Descriptor* type = column.field->containing_type();
    google::protobuf::Message* holder = &lubricant;
    if (type == v1::Surface::descriptor()) holder = &surface;
    if (type == v1::ImprovedYasutomi::descriptor()) holder = lubricant.mutable_improved_yasutomi();
    holder->GetReflection()->SetDouble(holder, column.field,
                                       column.values[static_cast<std::size_t>(candidate)]);
  }
}

void CandidateScene::set_candidate(int candidate) {
  resources_.set(evaluation_, candidate);
  set_scene();
}

void CandidateScene::set_resources(const v1::Lubricant& lubricant, const v1::Surface& surface) {
  resources_ = {lubricant, surface};
  set_scene();
}

void CandidateScene::set_scene() {
  set_lubricant(resources_.lubricant, physical_);
  physical_.fluid_grounds = fluid_grounds(resources_.lubricant);
  physical_.roughness = roughness(resources_.surface);
  physical_.boundary = boundary_friction(resources_.surface);
}

void CandidateScene::evaluate(const PointEvaluation::Group& group,
                              const std::shared_ptr<PreparedGearSet>& gear_set,
                              std::vector<EvaluatedPoint>& out) {
  evaluate_group(group, evaluation_, resources_.lubricant, physical_, {}, options_, gear_set, out);
}

v1::EvaluatePointsResponse evaluate_points(const PointEvaluation& evaluation,
                                           PreparedGearSets& gear_sets,
                                           const std::function<bool()>& is_over) {
  Rows rows(evaluation);
  CandidateScene candidate(evaluation, [&is_over] { return !is_over(); });
  const std::shared_ptr<PreparedGearSet> gear_set =
      gear_sets.take(evaluation.base.gear_set, candidate.scene());
  std::vector<EvaluatedPoint> points(static_cast<std::size_t>(evaluation.conditions));
  for (int i = 0; i < evaluation.candidates; ++i) {
    candidate.set_candidate(i);
    for (const PointEvaluation::Group& group : evaluation.groups) {
      candidate.evaluate(group, gear_set, points);
    }
    for (int k = 0; k < evaluation.conditions; ++k) {
      rows.set(i * evaluation.conditions + k, points[static_cast<std::size_t>(k)]);
    }
  }
  // An exception that ends the study may leave the gear set half prepared: then it is not given
  // back. A refused point does not end it, nor does one in a speed sweep.
  gear_sets.give_back(evaluation.base.gear_set, candidate.scene().options, gear_set);

  v1::EvaluatePointsResponse out = rows.take();
  out.set_not_included(kToothContactOnly);
  out.set_candidates(evaluation.candidates);
  out.set_conditions(evaluation.conditions);
  const v1::Simulation& effective = evaluation.base.effective;
  out.set_lubricant_revision(effective.lubricant_revision());
  out.set_gear_set_revision(effective.gear_set_revision());
  out.set_surface_revision(effective.surface_revision());
  out.set_vehicle_revision(effective.vehicle_revision());
  out.set_model_version(kModelVersion);
  return out;
}

}  // namespace tribodyn::server
