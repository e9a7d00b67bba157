#include "core/study/march_plan.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/steady_state.h"
#include "core/dynamics/tapping_start.h"
#include "core/number_text.h"
#include "core/refusal.h"
#include "core/study/model_choice.h"
#include "core/study/quasi_static.h"

namespace tribodyn {
namespace {

/// Right-hand sides that a march takes where it has to follow the mesh through many oscillations in
/// a mesh cycle: measured between 0.05 and 0.3 rad/s, at steps of 1e-7 and 1e-11.
double expected_right_hand_sides(double mesh_oscillations, double relative_tolerance) {
  constexpr double kMeshCycles = 25, kPerOscillation = 17, kOrder = 0.16;
  return kMeshCycles * kPerOscillation * mesh_oscillations *
         std::pow(1e-7 / relative_tolerance, kOrder);
}

void refuse_what_is_too_slow(const GearPairSystem& system, const OperatingTarget& target,
                             const PointOptions& options) {
  constexpr double kMost = 1e6;  // one to two seconds
  const double oscillations = mesh_oscillations(system, target.mean_pinion_speed);
  if (!oscillates_too_often(oscillations)) return;
  const double work = expected_right_hand_sides(oscillations, march_tolerance(options));
  if (work <= kMost) return;
  throw Refusal("TOO_SLOW_TO_MARCH",
                "at a mean pinion speed of " + number_text(target.mean_pinion_speed) +
                    " rad/s the mesh may oscillate " + number_text(oscillations, 2) +
                    " times in a mesh cycle: too often for shooting, and a march would take " +
                    number_text(work, 2) + " right-hand sides (method = AUTOMATIC takes up to " +
                    number_text(kMost) + "). A larger tolerance than " +
                    number_text(options.tolerance) +
                    " may let the quasi-static model answer; model = QUASI_STATIC does whatever "
                    "its error, and method = MARCH marches however long");
}

}  // namespace

double march_tolerance(const PointOptions& options) {
  return std::clamp(1e-3 * options.tolerance, 1e-11, options.march_step_tolerance);
}

MarchState point_start(GearPairSystem& system, const FlankContactBatch& contacts, MeshGrids& grids,
                       const OperatingTarget& target, const PointOptions& options,
                       PointStart from) {
  const double offset = from == PointStart::kLargeVibration ? kLargeVibrationDeflection : 0;
  QuasiStaticRequest request = quasi_static_request(target, options);
  request.tolerance = 1e-3;
  FrictionPerLoad friction;
  if (auto start = solve_quasi_static(system, contacts, grids, request)) {
    friction = start->orbit.friction.at(0);
  } else {
    throw_if_refused(system);
    system.set_torques(target.torques);
  }
  const double load =
      std::abs(system.torques().pinion) / system.mesh().functions(0, 0).pinion_contact_radius;
  // Under hardly any load friction may be anything: a start needs none.
  if (!(std::abs(friction.pinion) * load < 0.5 * std::abs(system.torques().pinion))) friction = {};
  return static_start(system, target.mean_pinion_speed, friction.pinion * load,
                      friction.gear * load, offset);
}

MarchState carried_start(const GearPairSystem& system, const CarriedState& from,
                         double mean_pinion_speed) {
  const MeshData& mesh = system.mesh();
  const DrivelineDynamics& d = system.dynamics();
  const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
  SectionState section = from.section_state;
  const double pinion = system.torques().pinion - from.pinion_torque;
  const double wheel = system.torques().wheel - from.wheel_torque;
  section.pinion_shaft_twist += pinion / d.pinion_shaft_stiffness;
  section.gear_shaft_twist += wheel / d.gear_shaft_stiffness;
  section.mesh_deflection +=
      pinion / (mesh.mean_pinion_contact_radius() * mesh.mean_mesh_stiffness());
  const double speed = mean_pinion_speed - from.mean_pinion_speed;
  section.pinion_shaft_speed += speed;
  section.pinion_speed += speed;
  section.gear_speed += ratio * speed;
  section.wheel_speed += ratio * speed;
  MarchState state{};
  system.to_march(section, state.data());
  return state;
}

MarchPlan plan_march(GearPairSystem& system, const FlankContactBatch& contacts, MeshGrids& grids,
                     const OperatingTarget& target, const PointOptions& options, PointStart start,
                     const std::optional<CarriedState>& from, const std::optional<Rattle>& rattle) {
  constexpr int kRattleCycles = 60;  // to leave the response that repels
  constexpr int kTapCycles = 150;    // from a start that is near a response, if there is one
  constexpr int kFloatSteps = 96;    // a mesh cycle
  MarchPlan out;
  out.maximum_mesh_cycles = options.maximum_mesh_cycles;
  const bool may_shorten = options.method == SteadyStateMethod::kAutomatic;
  if (may_shorten) refuse_what_is_too_slow(system, target, options);
  if (may_shorten && rattle) {
    system.set_torques(rattle->torques);
    out.start = rattle->start;
    out.maximum_mesh_cycles = std::min(out.maximum_mesh_cycles, kRattleCycles);
    out.why_so_short =
        RangeWarning{"RATTLES",
                     "responses that repeat after one and two mesh cycles were found, "
                     "and both repel: the flanks rattle without a period. method = "
                     "MARCH searches on"};
    return out;
  }
  if (may_shorten && !from && target.solve_wheel_torque && target.torques.pinion == 0) {
    if (const auto floating =
            floating_start(system, grids.with_steps(kFloatSteps), target.mean_pinion_speed)) {
      out.start = *floating;
      out.maximum_mesh_cycles = 0;
      out.why_so_short = RangeWarning{"FLANKS_FLOAT",
                                      "no pinion torque holds the flanks together: they float in "
                                      "the backlash, wherever they are, and lose nothing"};
      return out;
    }
  }
  system.set_torques(target.torques);
  if (from) {
    out.start = carried_start(system, *from, target.mean_pinion_speed);
    out.first_period = std::max(1, from->period);
    return out;
  }
  if (may_shorten && start == PointStart::kQuasiStatic) {
    if (const auto tapping =
            tapping_start(system, grids.with_steps(kFloatSteps), target.mean_pinion_speed)) {
      out.start = *tapping;
      out.maximum_mesh_cycles = std::min(out.maximum_mesh_cycles, kTapCycles);
      out.why_so_short =
          RangeWarning{"RATTLES",
                       "under so light a load the flanks tap each other in the backlash, "
                       "and no period of that was found soon. method = MARCH searches "
                       "on"};
      return out;
    }
  }
  out.start = point_start(system, contacts, grids, target, options, start);
  return out;
}

}  // namespace tribodyn
