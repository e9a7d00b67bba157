#include "core/study/model_choice.h"

#include <utility>

namespace tribodyn {

QuasiStaticRequest quasi_static_request(const OperatingTarget& target,
                                        const PointOptions& options) {
  constexpr double kGridShare = 0.5;  // of the tolerance; the rest is the model's
  QuasiStaticRequest out;
  out.mean_pinion_speed = target.mean_pinion_speed;
  out.solve_wheel_torque = target.solve_wheel_torque;
  out.tolerance = kGridShare * options.tolerance;
  if (options.progress) out.interrupted = [&options] { return !options.progress(0); };
  return out;
}

std::optional<QuasiStaticAnswer> answer_quasi_statically(GearPairSystem& system,
                                                         const FlankContactBatch& contacts,
                                                         MeshGrids& grids,
                                                         const OperatingTarget& target,
                                                         const PointOptions& options) {
  const QuasiStaticRequest request = quasi_static_request(target, options);
  std::optional<QuasiStatic> solution = solve_quasi_static(system, contacts, grids, request);
  if (!solution) return std::nullopt;
  const double model = quasi_static_model_error(system, contacts, grids, request, *solution);
  const double error = solution->discretisation_error + model;
  return QuasiStaticAnswer{*std::move(solution), error};
}

bool may_choose(const PointOptions& options, const std::optional<CarriedState>& from) {
  return options.model == PointModel::kAutomatic &&
         options.method == SteadyStateMethod::kAutomatic &&
         options.start == PointStart::kQuasiStatic && !from && !options.probe_coexisting_response &&
         options.history.columns.empty() && !options.sensitivities;
}

std::optional<QuasiStaticAnswer> choose_quasi_static(GearPairSystem& system,
                                                     const FlankContactBatch& contacts,
                                                     PreparedGearSet& gear_set,
                                                     const OperatingTarget& target,
                                                     const PointOptions& options) {
  MeshGrids& grids = gear_set.grids();
  if (!gear_set.quasi_static_chances().may_do(system, grids,
                                              quasi_static_request(target, options))) {
    return std::nullopt;
  }
  auto answer = answer_quasi_statically(system, contacts, grids, target, options);
  if (answer && answer->estimated_error <= options.tolerance) return answer;
  system.take_refusal();
  system.set_torques(target.torques);
  return std::nullopt;
}

}  // namespace tribodyn
