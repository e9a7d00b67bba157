#include "server/simulation/simulation_inputs.h"

#include <numbers>
#include <utility>

#include "server/contract/check_message.h"
#include "server/contract/labels.h"
#include "server/contract/output_only.h"
#include "server/mapping/history_columns.h"
#include "server/mapping/to_core.h"
#include "server/resources/sheared_lubricant.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/solver_defaults.h"
#include "server/simulation/study_checks.h"
#include "server/support/value_of.h"

namespace tribodyn::server {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

}  // namespace

void fill_model_options(v1::ModelOptions& options) {
  if (options.as_published().eq31_32_logarithm()) {
    options.set_pressure_viscosity_index(
        v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT);  // the misprint is in eq 32
  } else if (options.pressure_viscosity_index() ==
             v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_UNSPECIFIED) {
    options.set_pressure_viscosity_index(
        v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_RECIPROCAL_ASYMPTOTIC);
  }
  options.mutable_as_published();
  const ModelOptions effective = to_core(options);
  options.set_preset(options.preset() == v1::ModelOptions::PAPER ? v1::ModelOptions::PAPER
                                                                 : v1::ModelOptions::RECOMMENDED);
  options.set_inlet_shear_heating(effective.inlet_shear_heating);
  options.set_closed_load_sharing(effective.closed_load_sharing);
}

namespace {

void fill_solver(v1::SolverOptions* solver) {
  const PointOptions defaults;
  if (solver->march_step_tolerance() == 0) {
    solver->set_march_step_tolerance(defaults.march_step_tolerance);
  }
  if (solver->march_settling_tolerance() == 0) {
    solver->set_march_settling_tolerance(defaults.march_settling_tolerance);
  }
  if (solver->tolerance() == 0) solver->set_tolerance(defaults.tolerance);
  if (solver->method() == v1::STEADY_STATE_METHOD_UNSPECIFIED)
    solver->set_method(v1::STEADY_STATE_METHOD_AUTOMATIC);
  if (solver->maximum_mesh_cycles() == 0) {
    solver->set_maximum_mesh_cycles(defaults.maximum_mesh_cycles);
  }
  if (solver->recorded_mesh_cycles() == 0) {
    solver->set_recorded_mesh_cycles(defaults.recorded_mesh_cycles);
  }
}

template <class StudyMessage>
void fill_common_fields(StudyMessage* study) {
  if (study->model() == v1::POINT_MODEL_UNSPECIFIED) {
    study->set_model(v1::POINT_MODEL_AUTOMATIC);
  }
  if (study->start() == v1::POINT_START_UNSPECIFIED) {
    study->set_start(v1::POINT_START_QUASI_STATIC_EQUILIBRIUM);
  }
  if (!study->sensitivities()) study->clear_sensitivities();  // false and unset: one request
}

void fill_operating_point(v1::OperatingPointStudy* study) {
  fill_common_fields(study);
  if (!study->has_history()) return;
  v1::HistoryRequest* history = study->mutable_history();
  if (history->mesh_cycles() == 0) history->set_mesh_cycles(kDefaultHistoryCycles);
  if (history->samples_per_mesh_cycle() == 0) {
    history->set_samples_per_mesh_cycle(kDefaultHistorySamples);
  }
}

void fill_curve(v1::InefficiencyCurveStudy* study) {
  fill_common_fields(study);
  if (study->direction() == v1::SWEEP_DIRECTION_UNSPECIFIED && !study->independent_points()) {
    study->set_direction(v1::SWEEP_DIRECTION_UP);
  }
  const std::vector<double> speeds = curve_speeds(*study);
  *study->mutable_speeds_kilometres_per_hour() = {speeds.begin(), speeds.end()};
  study->clear_first_speed_kilometres_per_hour();
  study->clear_last_speed_kilometres_per_hour();
  study->clear_speed_step_kilometres_per_hour();
}

v1::Simulation with_defaults(v1::Simulation simulation) {
  if (simulation.gear_set().empty()) simulation.set_gear_set(kDefaultGearSet);
  if (simulation.surface().empty()) simulation.set_surface(kDefaultSurface);
  if (simulation.vehicle().empty()) simulation.set_vehicle(kDefaultVehicle);
  if (!simulation.has_sump_temperature_celsius()) {
    simulation.set_sump_temperature_celsius(kDefaultSumpTemperatureCelsius);
  }
  if (!simulation.has_inlet_temperature_rise_kelvin()) {
    simulation.set_inlet_temperature_rise_kelvin(kDefaultInletTemperatureRiseKelvin);
  }
  fill_model_options(*simulation.mutable_model_options());
  fill_solver(simulation.mutable_solver_options());
  if (simulation.has_operating_point()) fill_operating_point(simulation.mutable_operating_point());
  if (simulation.has_inefficiency_curve()) fill_curve(simulation.mutable_inefficiency_curve());
  return simulation;
}

void check_study(const v1::Simulation& request, const std::string& path, Violations& violations) {
  check_march_tolerances(request.solver_options(),
                         request.has_inefficiency_curve() ? request.inefficiency_curve().model()
                                                          : request.operating_point().model(),
                         join_path(path, "solver_options"), violations);
  if (request.has_operating_point()) {
    check_operating_point(request.operating_point(), join_path(path, "operating_point"),
                          violations);
  } else if (request.has_inefficiency_curve()) {
    check_curve(request.inefficiency_curve(), request.solver_options(),
                join_path(path, "inefficiency_curve"), violations);
  } else {
    violations.add(join_path(path, "study"),
                   "not set; allowed: operating_point or inefficiency_curve");
  }
}

OperatingCondition condition(const v1::OperatingPointStudy& study) {
  OperatingCondition out;
  if (study.has_cruise()) {
    out.kind = OperatingCondition::Kind::kCruise;
    out.vehicle_speed = study.cruise().speed_kilometres_per_hour() / 3.6;
    out.ascent_angle = study.cruise().ascent_angle_degrees() * kRadiansPerDegree;
  } else if (study.has_drive_cycle_snapshot()) {
    const v1::DriveCycleSnapshot& snapshot = study.drive_cycle_snapshot();
    out.kind = OperatingCondition::Kind::kDriveCycleSnapshot;
    out.vehicle_speed = snapshot.speed_kilometres_per_hour() / 3.6;
    out.acceleration = snapshot.acceleration_metres_per_second_squared();
    out.ascent_angle = snapshot.ascent_angle_degrees() * kRadiansPerDegree;
  } else {
    out.kind = OperatingCondition::Kind::kPrescribedTorque;
    out.pinion_torque = study.prescribed_torque().pinion_torque_newton_metres();
    out.pinion_speed = study.prescribed_torque().pinion_speed_radians_per_second();
  }
  return out;
}

constexpr std::pair<v1::PointModel, PointModel> kModels[] = {
    {v1::POINT_MODEL_FULL, PointModel::kFull},
    {v1::POINT_MODEL_QUASI_STATIC, PointModel::kQuasiStatic}};
constexpr std::pair<v1::SteadyStateMethod, SteadyStateMethod> kMethods[] = {
    {v1::STEADY_STATE_METHOD_SHOOTING, SteadyStateMethod::kShooting},
    {v1::STEADY_STATE_METHOD_MARCH, SteadyStateMethod::kMarch}};

PointOptions point_options(const v1::SolverOptions& solver, v1::PointModel model,
                           v1::PointStart start) {
  PointOptions out;
  out.model = value_of(kModels, model, PointModel::kAutomatic);
  out.start = start == v1::POINT_START_LARGE_VIBRATION ? PointStart::kLargeVibration
                                                       : PointStart::kQuasiStatic;
  out.method = value_of(kMethods, solver.method(), SteadyStateMethod::kAutomatic);
  out.tolerance = solver.tolerance();
  out.march_step_tolerance = solver.march_step_tolerance();
  out.march_settling_tolerance = solver.march_settling_tolerance();
  out.maximum_mesh_cycles = solver.maximum_mesh_cycles();
  out.recorded_mesh_cycles = solver.recorded_mesh_cycles();
  return out;
}

HistoryRequest history_request(const v1::HistoryRequest& message) {
  HistoryRequest out;
  for (const std::string& name : message.columns()) {
    if (const auto column = history_column(name)) out.columns.push_back(*column);
  }
  out.mesh_cycles = message.mesh_cycles();
  out.samples_per_mesh_cycle = message.samples_per_mesh_cycle();
  return out;
}

}  // namespace

v1::Simulation client_part(const v1::Simulation& simulation) {
  v1::Simulation out = simulation;
  keep_client_part(out);
  return out;
}

std::optional<SimulationInputs> read_simulation(const v1::Simulation& request,
                                                const ResourceLookup& lookup,
                                                const std::string& path, Violations& violations) {
  const std::size_t before = violations.size();
  SimulationInputs inputs;
  inputs.requested = client_part(request);
  sort_labels(*inputs.requested.mutable_labels());
  const v1::Simulation& asked = inputs.requested;
  check_message(asked, path, violations);
  check_study(asked, path, violations);
  check_model_options(asked.model_options(), join_path(path, "model_options"), violations);
  if (asked.labels_size() > kMaximumLabels) {
    violations.add(join_path(path, "labels"), "more than 64 entries");
  } else {
    check_labels(asked.labels(), join_path(path, "labels"), violations);
  }

  const auto find = [&]<class Resource>(std::shared_ptr<const Resource>* out,
                                        const std::string& name, const std::string& fallback,
                                        const char* collection, const char* field) {
    auto found = find_resource<Resource>(lookup, name.empty() ? fallback : name, collection,
                                         join_path(path, field), violations);
    if (!found) return std::string();
    *out = found->resource;
    return found->revision_name;
  };
  const std::string lubricant =
      find(&inputs.lubricant, asked.lubricant(), "", kLubricants, "lubricant");
  const std::string gear_set =
      find(&inputs.gear_set, asked.gear_set(), kDefaultGearSet, kGearSets, "gear_set");
  const std::string surface =
      find(&inputs.surface, asked.surface(), kDefaultSurface, kSurfaces, "surface");
  const std::string vehicle =
      find(&inputs.vehicle, asked.vehicle(), kDefaultVehicle, kVehicles, "vehicle");
  if (!lubricant.empty() && asked.sheared_lubricant()) {
    if (auto sheared = sheared_lubricant(*inputs.lubricant)) {
      inputs.lubricant = std::make_shared<const v1::Lubricant>(*std::move(sheared));
    } else {
      violations.add(join_path(path, "sheared_lubricant"),
                     "{} states no viscosity after the shear test; needs its measurements."
                     "sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second",
                     lubricant);
    }
  }
  if (!lubricant.empty()) {
    const double sump = asked.has_sump_temperature_celsius() ? asked.sump_temperature_celsius()
                                                             : kDefaultSumpTemperatureCelsius;
    const double rise = asked.has_inlet_temperature_rise_kelvin()
                            ? asked.inlet_temperature_rise_kelvin()
                            : kDefaultInletTemperatureRiseKelvin;
    check_law_options(*inputs.lubricant, asked.model_options(), join_path(path, "model_options"),
                      violations);
    check_fluid_at_inlet(*inputs.lubricant, sump, rise, join_path(path, "lubricant"), violations);
  }
  if (!gear_set.empty()) {
    check_mesh_data(*inputs.gear_set, asked.model_options(),
                    join_path(path, "model_options.load_dependent_mesh_data"), violations);
  }
  if (violations.size() > before) return std::nullopt;
  inputs.effective = with_defaults(inputs.requested);
  inputs.effective.set_lubricant_revision(lubricant);
  inputs.effective.set_gear_set_revision(gear_set);
  inputs.effective.set_surface_revision(surface);
  inputs.effective.set_vehicle_revision(vehicle);
  return inputs;
}

Scene scene(const SimulationInputs& inputs) {
  return {.lubricant = to_core(*inputs.lubricant),
          .gear_set = to_core(*inputs.gear_set),
          .roughness = roughness(*inputs.surface),
          .boundary = boundary_friction(*inputs.surface),
          .solid = solid(*inputs.gear_set),
          .vehicle = to_core(*inputs.vehicle),
          .sump_temperature = inputs.effective.sump_temperature_celsius() + kZeroCelsius,
          .inlet_temperature_rise = inputs.effective.inlet_temperature_rise_kelvin(),
          .options = to_core(inputs.effective.model_options()),
          .fluid_grounds = fluid_grounds(*inputs.lubricant),
          .lubricant_boundary = lubricant_boundary(*inputs.lubricant)};
}

Study study(const SimulationInputs& inputs) {
  const v1::SolverOptions& solver = inputs.effective.solver_options();
  if (inputs.effective.has_operating_point()) {
    const v1::OperatingPointStudy& message = inputs.effective.operating_point();
    PointStudy out{condition(message), point_options(solver, message.model(), message.start())};
    out.options.probe_coexisting_response = message.probe_coexisting_response();
    out.options.sensitivities = message.sensitivities();
    if (message.has_history()) out.options.history = history_request(message.history());
    return out;
  }
  const v1::InefficiencyCurveStudy& message = inputs.effective.inefficiency_curve();
  CurveStudy out;
  for (const double speed : message.speeds_kilometres_per_hour()) {
    out.vehicle_speeds.push_back(speed / 3.6);
  }
  out.ascent_angle = message.ascent_angle_degrees() * kRadiansPerDegree;
  out.options.direction =
      message.direction() == v1::SWEEP_DIRECTION_DOWN ? SweepDirection::kDown : SweepDirection::kUp;
  out.options.point = point_options(solver, message.model(), message.start());
  out.options.point.sensitivities = message.sensitivities();
  out.options.independent_points = message.independent_points();
  return out;
}

}  // namespace tribodyn::server
