#include "server/simulation/golden_case.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "server/simulation/compute_task.h"
#include "server/simulation/input_hash.h"
#include "server/storage/seeds.h"

namespace tribodyn::server {
namespace {

constexpr double kSolverTolerance = 1e-6;
/// Relative. Far above round-off and the error of the march, far below the effect of a wrong law.
constexpr double kRelativeTolerance = 1e-4;

struct GoldenFigure {
  const char* name;
  double expected;
  double (*value)(const v1::PointResult&);
};

/// Paper fluid 1 in the reference axle with the run-in surface at 72.5 km/h. At this speed, the
/// first resonance, the teeth separate, so that dynamics, film, heat and friction all matter. The
/// values are those of tribodyn-model-2 by the march, which is independent of shooting.
constexpr GoldenFigure kGoldenFigures[] = {
    {"pinion_torque_newton_metres", 33.15439064,
     [](const v1::PointResult& point) { return point.pinion_torque_newton_metres(); }},
    {"inefficiency_energy_mean_percent", 1.384566506,
     [](const v1::PointResult& point) { return point.inefficiency_energy_mean_percent(); }},
    {"viscous_loss_power_watts", 89.64757038,
     [](const v1::PointResult& point) { return point.viscous_loss_power_watts(); }},
    {"boundary_loss_power_watts", 1.783013767,
     [](const v1::PointResult& point) { return point.boundary_loss_power_watts(); }},
    {"contact_temperature_kelvin.maximum", 368.3391248,
     [](const v1::PointResult& point) { return point.contact_temperature_kelvin().maximum(); }},
    {"mesh_force_newtons.maximum", 3956.958836,
     [](const v1::PointResult& point) { return point.mesh_force_newtons().maximum(); }},
};

ResourceLookup seeds() {
  return {[all = seed_resources()](const RevisionName& name) -> std::optional<FoundResource> {
            for (const NewResource& each : all) {
              if (each.name == name.name) return FoundResource{1, false, each.body};
            }
            return std::nullopt;
          },
          [](const std::string&) { return std::vector<std::string>(); }};
}

}  // namespace

internal::v1::ComputeTask golden_task() {
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/paper-fluid-1");
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(72.5);
  simulation.mutable_model_options()->set_preset(v1::ModelOptions::PAPER);
  simulation.mutable_solver_options()->set_tolerance(kSolverTolerance);
  Violations violations;
  const auto inputs = read_simulation(simulation, seeds(), "simulation", violations);
  if (!inputs) throw std::logic_error("golden case: " + violations.front().description);
  return compute_task(*inputs, 0, 1, input_hash(*inputs), false);
}

std::string check_golden_result(const internal::v1::ComputeResult& result) {
  if (result.has_refusal()) return "golden case: " + result.refusal().message();
  v1::SimulationResult computed;
  if (!result.has_result() || !computed.ParseFromString(result.result()) ||
      computed.points_size() != 1) {
    return "golden case: no result; " + result.defect();
  }
  for (const GoldenFigure& figure : kGoldenFigures) {
    const double value = figure.value(computed.points(0).result());
    if (std::abs(value - figure.expected) <= kRelativeTolerance * figure.expected) continue;
    return fmt::format("golden case: {} is {}; expected {}", figure.name, value, figure.expected);
  }
  return {};
}

std::string check_golden_case(const StudyFunctions& studies) {
  PreparedGearSets gear_sets;
  return check_golden_result(
      compute(golden_task(), studies, gear_sets, [](double, const StageText&) { return true; }));
}

}  // namespace tribodyn::server
