#include "core/study/point_by_marching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/number_text.h"
#include "core/periodic/steady_state.h"
#include "core/periodic/tapping_start.h"
#include "core/refusal.h"
#include "core/study/history_sampler.h"
#include "core/study/point_start.h"
#include "core/study/response_record.h"

namespace tribodyn {
namespace {

/// How a point is marched.
struct MarchPlan {
  SectionPoint start;
  int first_period = 1;
  int maximum_mesh_cycles = 0;               ///< of the search for the steady state
  std::optional<RangeWarning> why_so_short;  ///< why that is less than the options say
};

/// Of the march's steps; no looser than the figures' tolerance allows.
double march_tolerance(const PointOptions& options) {
  return std::clamp(1e-3 * options.tolerance, 1e-11, options.march_step_tolerance);
}

/// Right-hand sides that a march takes where it has to follow the mesh through many oscillations in
/// a mesh cycle: measured between 0.05 and 0.3 rad/s, at steps of 1e-7 and 1e-11.
double expected_right_hand_sides(double mesh_oscillations, double relative_tolerance) {
  constexpr double kMeshCycles = 25, kPerOscillation = 17, kOrder = 0.16;
  return kMeshCycles * kPerOscillation * mesh_oscillations *
         std::pow(1e-7 / relative_tolerance, kOrder);
}

void refuse_what_is_too_slow(const GearPairSystem& system, const OperatingTarget& target,
                             const PointOptions& options) {
  constexpr double kMostRightHandSides = 1e6;  // one to two seconds
  const double oscillations = mesh_oscillations(system, target.mean_pinion_speed);
  if (!oscillates_too_often(oscillations)) return;
  const double work = expected_right_hand_sides(oscillations, march_tolerance(options));
  if (work <= kMostRightHandSides) return;
  throw Refusal("TOO_SLOW_TO_MARCH",
                "at a mean pinion speed of " + number_text(target.mean_pinion_speed) +
                    " rad/s the mesh may oscillate " + number_text(oscillations, 2) +
                    " times in a mesh cycle: too often for shooting, and a march would take " +
                    number_text(work, 2) + " right-hand sides (method = AUTOMATIC takes up to " +
                    number_text(kMostRightHandSides) + "). A larger tolerance than " +
                    number_text(options.tolerance) +
                    " may let the quasi-static model answer; model = QUASI_STATIC does whatever "
                    "its error, and method = MARCH marches however long");
}

MarchPlan plan_march(const PointProblem& problem, PointStart start,
                     const std::optional<CarriedState>& from,
                     const std::optional<SectionPoint>& aperiodic) {
  // Mesh cycles to leave the response that repels: a guess that no test has contradicted.
  constexpr int kRattleCycles = 60;
  // Mesh cycles from a start that is near a response, if there is one: none of the nine light
  // points of core/README.md that are marched settles in 600 either, for 1.9 times the work.
  constexpr int kTapCycles = 150;
  constexpr int kFloatSteps = 96;  // a mesh cycle; 48 do the same at the light points
  const GearPairSystem& system = problem.system();
  const OperatingTarget& target = problem.target;
  const PointOptions& options = problem.options;
  MarchPlan out;
  out.maximum_mesh_cycles = options.maximum_mesh_cycles;
  const bool may_shorten = options.method == SteadyStateMethod::kAutomatic;
  if (may_shorten) refuse_what_is_too_slow(system, target, options);
  if (may_shorten && aperiodic) {
    out.start = *aperiodic;
    out.maximum_mesh_cycles = std::min(out.maximum_mesh_cycles, kRattleCycles);
    out.why_so_short =
        RangeWarning{"RATTLES",
                     "responses that repeat after one and two mesh cycles were found, "
                     "and both repel: the flanks rattle without a period. method = "
                     "MARCH searches on"};
    return out;
  }
  if (may_shorten && !from && target.solve_wheel_torque && target.torques.pinion == 0) {
    if (const auto floating = floating_start(
            system, problem.gear_set.grids().with_steps(kFloatSteps), target.mean_pinion_speed)) {
      out.start = system.at_section(*floating, {});
      out.maximum_mesh_cycles = 0;
      out.why_so_short = RangeWarning{"FLANKS_FLOAT",
                                      "no pinion torque holds the flanks together: they float in "
                                      "the backlash, wherever they are, and lose nothing"};
      return out;
    }
  }
  if (from) {
    out.start = system.at_section(carried_start(system, *from, target), target.torques);
    out.first_period = std::max(1, from->period);
    return out;
  }
  if (may_shorten && start == PointStart::kQuasiStatic) {
    if (const auto tapping =
            tapping_start(system, target.torques, problem.gear_set.grids().with_steps(kFloatSteps),
                          target.mean_pinion_speed)) {
      out.start = system.at_section(*tapping, target.torques);
      out.maximum_mesh_cycles = std::min(out.maximum_mesh_cycles, kTapCycles);
      out.why_so_short =
          RangeWarning{"RATTLES",
                       "under so light a load the flanks tap each other in the backlash, "
                       "and no period of that was found soon. method = MARCH searches "
                       "on"};
      return out;
    }
  }
  out.start = point_start(problem, start);
  return out;
}

/// Marches a steady state once more over `cycles` mesh cycles and records it; goes on beyond them
/// if the history is longer. Returns the regime at the end of the record. Throws as
/// march_mesh_cycle does, and Cancelled when `progress` returns false.
ContactRegime record_response(const GearPairSystem& system, ContactSolver& contacts,
                              const SteadyState& steady, int cycles, const MarchOptions& options,
                              const MarchScales& scales, ResponseRecord& record,
                              HistorySampler& history, SolverWork& work,
                              const std::function<bool(double)>& progress) {
  using Phases = MeshCycleSystem<true>;
  constexpr int kSize = Phases::kSize;
  Phases::State y{};
  std::copy(steady.state.begin(), steady.state.end(), y.begin());
  y[kTime] = y[kLossWork] = y[kLossShareSquared] = 0;
  ContactRegime regime = steady.regime, end_regime = regime;
  record.starts_in_gap = regime.side == 0;

  std::array<Instant, ResponseRecord::kSamples> samples;
  int cycle = 0;
  bool recording = true;
  const Phases* place = nullptr;  // of the cycle that is marched
  const auto on_step = [&](const MarchStep<kSize>& step) {
    // Evaluates between the march's own evaluations.
    const auto evaluate = [&](double phase, const Phases::State& at, Instant& out) {
      system.evaluate(phase, place->interval(), place->regime(), at.data(), contacts, out);
    };
    if (recording) {
      for (int i = 0; i < ResponseRecord::kSamples; ++i) {
        const double theta = static_cast<double>(i) / (ResponseRecord::kSamples - 1);
        const auto at = i == 0                              ? step.from
                        : i + 1 == ResponseRecord::kSamples ? step.to
                                                            : step.at(theta);
        evaluate(place->phase(step.start + theta * step.length), at, samples[i]);
      }
      record.add_step(samples, step.to[kTime] - step.from[kTime]);
    }
    const double end = place->phase(step.start + step.length);
    while (history.wanted() && history.next_phase() < cycle + end) {
      const double inside = history.next_phase() - cycle;
      const double theta = (place->s_of(inside) - step.start) / step.length;
      const auto at = step.at(std::clamp(theta, 0.0, 1.0));
      evaluate(inside, at, samples[0]);
      history.add(cycle + inside, at.data(), samples[0], steady.torques);
    }
  };
  for (; cycle < cycles || history.wanted(); ++cycle) {
    if (progress && !progress(1)) throw Cancelled();
    Phases phases(system, steady.torques, scales, regime, contacts);
    place = &phases;
    std::vector<GapEvent> events;
    phases.gap_events = &events;
    recording = cycle < cycles;
    DormandPrinceWithEvents<Phases> march(phases, options);
    double phase = 0;
    march.run(phase, y, 1.0, on_step);
    regime = phases.regime();
    work += march.work();
    ++work.mesh_cycles;
    if (recording) {
      for (GapEvent event : events) {
        event.phase += cycle;
        record.gap_events.push_back(event);
      }
    }
    if (cycle + 1 == cycles) {
      std::copy(y.begin(), y.end(), record.integrals.begin());
      end_regime = regime;
    }
  }
  return end_regime;
}

}  // namespace

PointResult solve_by_marching(const PointProblem& problem, PointStart start,
                              const std::optional<CarriedState>& from,
                              const HistoryRequest& history_request,
                              const std::optional<SectionPoint>& aperiodic) {
  constexpr double kAccuracyOfBatch = 1e-9;  // contacts solved together agree to 1e-10
  const GearPairSystem& system = problem.system();
  const OperatingTarget& target = problem.target;
  const PointOptions& options = problem.options;
  ContactSolver contacts = march_tolerance(options) >= kAccuracyOfBatch
                               ? ContactSolver(problem.contacts, problem.tally)
                               : ContactSolver(problem.contacts.model(), problem.tally);
  const MarchPlan plan = plan_march(problem, start, from, aperiodic);
  const PeriodicProblem periodic =
      problem.periodic(std::min(0.1 * options.tolerance, options.march_settling_tolerance));
  SteadyStateOptions march;
  march.first_period = plan.first_period;
  march.march.relative_tolerance = march_tolerance(options);
  march.maximum_mesh_cycles = plan.maximum_mesh_cycles;
  double reported = 0;
  if (options.progress) {
    march.progress = [&](double fraction) {
      reported = fraction;
      return options.progress(fraction);
    };
    march.march.interrupted = [&] { return !options.progress(reported); };
  }
  const SteadyState steady = solve_steady_state(periodic, contacts, plan.start, march);

  PointResult out = empty_result(target, PointModel::kFull);
  out.settled = steady.settled;
  // Of both by experience: their errors are some ten times smaller.
  if (steady.settled) {
    out.estimated_relative_error = 3 * periodic.tolerance + 300 * march.march.relative_tolerance;
  }
  out.period_in_mesh_cycles = steady.period;
  static_cast<SolverWork&>(out.statistics) = steady.work;
  out.statistics.accelerations = steady.accelerations;
  out.statistics.periodicity_defect = steady.defect;
  out.statistics.largest_multiplier = steady.largest_multiplier;
  out.recorded_mesh_cycles = steady.settled ? steady.period : options.recorded_mesh_cycles;
  const MarchScales scales = march_scales(system, steady.torques, target.mean_pinion_speed);
  ResponseRecord record(scales.torque / system.mesh().mean_pinion_contact_radius(),
                        problem.contacts.model());
  HistorySampler history(history_request);
  // A speed that is wrong within its tolerance counts I omega times in the energy balance.
  MarchOptions sharper = march.march;
  sharper.relative_tolerance = std::max(0.01 * march.march.relative_tolerance, 1e-12);
  const ContactRegime end_regime =
      record_response(system, contacts, steady, out.recorded_mesh_cycles, sharper, scales, record,
                      history, out.statistics, options.progress);
  out.statistics.contact_solutions = problem.tally.solutions;
  record.fill(steady.torques, out.recorded_mesh_cycles, steady.settled, out);
  out.power_balance.stored = system.stored_energy(0, end_regime, record.integrals.data()) -
                             system.stored_energy(0, steady.regime, steady.state.data());
  out.section_state = system.to_section(steady.state.data());
  out.history = history.take();
  if (plan.why_so_short && !steady.settled) out.warnings.push_back(*plan.why_so_short);
  return out;
}

}  // namespace tribodyn
