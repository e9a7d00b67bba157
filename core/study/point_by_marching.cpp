#include "core/study/point_by_marching.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/number_text.h"
#include "core/periodic/steady_state.h"
#include "core/periodic/tapping_start.h"
#include "core/refusal.h"
#include "core/study/history_sampler.h"
#include "core/study/point_start.h"
#include "core/study/rattle_average.h"
#include "core/study/recorded_march.h"
#include "core/study/response_warnings.h"

namespace tribodyn {
namespace {

// Of each limit of work; the rest is for the average, if no period is found. The second where none
// is to be expected.
constexpr double kShareOfSearch = 0.5, kShareOfDoubtfulSearch = 0.25;

// Tolerance of the steps of a response without a period, of which only statistics count. At a
// torque of 0.1 N m the RMS inefficiencies of 8,000 mesh cycles with steps of 1e-7, 1e-5, 1e-4 and
// 1e-3 agree to 1 %, the error of such an average; at the rippled stiffness of rattle_test.cpp
// those of 4,000 mesh cycles agree to 1e-4.
constexpr double kRattleStep = 1e-4;

// Mesh cycles of the search where shooting has found that no response of one or two mesh cycles
// attracts, or flanks tap: of nine random gear sets and fluids three settle after 24 to 26 all the
// same, and six do not in 60.
constexpr int kRattleSearchCycles = 32;

/// How a point is marched.
struct MarchPlan {
  SectionPoint start;
  int first_period = 1;
  int search_cycles = 0;                     ///< mesh cycles of the search for a period at most
  std::optional<SectionPoint> average_from;  ///< in place of where the search ends
  double share_of_search = kShareOfSearch;   ///< of the limit of contacts
  bool floats = false;                       ///< no flank ever carries a load
  std::optional<RangeWarning> why_no_period;
};

bool is_automatic(const PointOptions& options) {
  return options.method == SteadyStateMethod::kAutomatic;
}

Refusal too_slow_to_march(const PointProblem& problem, const WorkLimit& limit) {
  const PointOptions& options = problem.options;
  const double speed = problem.target.mean_pinion_speed;
  return Refusal(
      "TOO_SLOW_TO_MARCH",
      "at a mean pinion speed of " + number_text(speed) + " rad/s the mesh may oscillate " +
          number_text(mesh_oscillations(problem.system(), speed), 2) +
          " times in a mesh cycle: the march ended after work worth " +
          number_text(limit.most_contacts(), 2) + " contact solutions (" +
          (is_automatic(options)
               ? std::string("method = AUTOMATIC takes no more; method = MARCH does")
               : "maximum_mesh_cycles = " + std::to_string(options.maximum_mesh_cycles) +
                     " allows no more") +
          "), before there was anything to average. A larger tolerance than " +
          number_text(options.tolerance) +
          " may let the quasi-static model answer; model = QUASI_STATIC does whatever its error");
}

/// The search takes its share of the limit, and leaves what is to be recorded.
int most_search_cycles(const PointOptions& options) {
  return std::max(0, std::min(options.maximum_mesh_cycles - options.recorded_mesh_cycles,
                              static_cast<int>(kShareOfSearch * options.maximum_mesh_cycles)));
}

constexpr int kFloatSteps = 96;  // a mesh cycle; 48 do the same at the light points

/// Where flanks that no torque holds together float, if that is prescribed.
std::optional<SectionPoint> floating_flanks(const PointProblem& problem) {
  const OperatingTarget& target = problem.target;
  if (!target.solve_wheel_torque || target.torques.pinion != 0) return std::nullopt;
  const auto start = floating_start(
      problem.system(), problem.gear_set.grids().with_steps(kFloatSteps), target.mean_pinion_speed);
  if (!start) return std::nullopt;
  return problem.system().at_section(*start, {});
}

/// Where flanks tap each other under hardly any load.
std::optional<SectionPoint> tapping_flanks(const PointProblem& problem) {
  const OperatingTarget& target = problem.target;
  const auto start =
      tapping_start(problem.system(), target.torques,
                    problem.gear_set.grids().with_steps(kFloatSteps), target.mean_pinion_speed);
  if (!start) return std::nullopt;
  return problem.system().at_section(*start, target.torques);
}

MarchPlan plan_march(const PointProblem& problem, PointStart start,
                     const std::optional<CarriedState>& from,
                     const std::optional<SectionPoint>& aperiodic) {
  const bool may_shorten = is_automatic(problem.options);
  MarchPlan out;
  out.search_cycles = most_search_cycles(problem.options);
  if (from) {
    out.start = problem.system().at_section(carried_start(problem.system(), *from, problem.target),
                                            problem.target.torques);
    out.first_period = std::max(1, from->period);
  } else if (const auto floating = may_shorten ? floating_flanks(problem) : std::nullopt) {
    out.start = *floating;
    out.search_cycles = 0;
    out.floats = true;
    out.why_no_period = RangeWarning{"FLANKS_FLOAT",
                                     "no pinion torque holds the flanks together: they float in "
                                     "the backlash, wherever they are, and lose nothing"};
  } else if (const auto tapping = may_shorten && start == PointStart::kQuasiStatic
                                      ? tapping_flanks(problem)
                                      : std::nullopt) {
    out.start = *tapping;
    out.search_cycles = std::min(out.search_cycles, kRattleSearchCycles);
    out.share_of_search = kShareOfDoubtfulSearch;
    out.why_no_period =
        RangeWarning{"RATTLES",
                     "under so light a load the flanks tap each other in the backlash, and no "
                     "period of that was found soon. method = MARCH searches on"};
  } else {
    out.start = point_start(problem, start);
  }
  if (may_shorten && aperiodic) {
    out.search_cycles = std::min(out.search_cycles, kRattleSearchCycles);
    out.share_of_search = kShareOfDoubtfulSearch;
    out.average_from = aperiodic;
    out.why_no_period =
        RangeWarning{"RATTLES",
                     "responses that repeat after one and two mesh cycles were found, and both "
                     "repel: the flanks rattle without a period. method = MARCH searches on"};
  }
  return out;
}

/// Marches one point: in search of a period, and then over what is recorded.
class MarchedPoint {
 public:
  /// Keeps the references.
  MarchedPoint(const PointProblem& problem, const HistoryRequest& history)
      : problem_(problem),
        options_(problem.options),
        system_(problem.system()),
        contacts_(march_step_tolerance(options_) >= kAccuracyOfBatch
                      ? ContactSolver(problem.contacts, problem.tally)
                      : ContactSolver(problem.contacts.model(), problem.tally)),
        limit_(problem.tally, system_.mesh(), most_contacts_of_march(options_)),
        history_(history),
        out_(empty_result(problem.target, PointModel::kFull)) {
    steps_.relative_tolerance = march_step_tolerance(options_);
    steps_.maximum_steps = std::numeric_limits<long>::max();  // the limit of work ends a run
    if (options_.progress) {
      steps_.interrupted = [this] { return !options_.progress(reported_); };
    }
  }
  MarchedPoint(const MarchedPoint&) = delete;
  MarchedPoint& operator=(const MarchedPoint&) = delete;

  PointResult solve(const MarchPlan& plan) {
    try {
      const SteadyState steady = search(plan);
      static_cast<SolverWork&>(out_.statistics) = steady.work;
      out_.statistics.accelerations = steady.accelerations;
      out_.statistics.periodicity_defect = steady.defect;
      if (plan.floats) {
        out_.recorded_mesh_cycles =
            std::min(options_.recorded_mesh_cycles, options_.maximum_mesh_cycles);
        record(plan.start);
      } else if (steady.settled) {
        describe(steady);
        record(steady);
      } else {
        average(plan.average_from ? *plan.average_from : steady);
      }
    } catch (const Refusal& refusal) {
      if (refusal.reason() != "WORK_LIMIT") throw;
      throw too_slow_to_march(problem_, limit_);
    }
    out_.statistics.contact_solutions = problem_.tally.solutions;
    out_.history = history_.take();
    if (plan.why_no_period && !out_.settled) out_.warnings.push_back(*plan.why_no_period);
    return std::move(out_);
  }

 private:
  static constexpr double kAccuracyOfBatch = 1e-9;  // contacts solved together agree to 1e-10

  MarchOptions steps_within_the_limit() const {
    MarchOptions out = steps_;
    out.is_out_of_work = [this] { return limit_.is_spent(); };
    return out;
  }

  SteadyState search(const MarchPlan& plan) {
    SteadyStateOptions search;
    search.first_period = plan.first_period;
    search.march = steps_within_the_limit();
    search.maximum_mesh_cycles = plan.search_cycles;
    search.is_over = [this, &plan] { return limit_.spent_share() >= plan.share_of_search; };
    if (options_.progress) search.progress = [this](double fraction) { return report(fraction); };
    const PeriodicProblem periodic = problem_.periodic(march_settling_tolerance(options_));
    return solve_steady_state(periodic, contacts_, plan.start, search);
  }

  /// Sets what follows from the search for a steady state.
  void describe(const SteadyState& steady) {
    out_.settled = true;
    // A heuristic bound: measured errors are about a tenth of it.
    out_.estimated_relative_error =
        3 * march_settling_tolerance(options_) + 300 * steps_.relative_tolerance;
    out_.period_in_mesh_cycles = out_.recorded_mesh_cycles = steady.period;
    out_.statistics.largest_multiplier = steady.largest_multiplier;
    if (auto warning =
            barely_attracts_warning(steady.largest_multiplier, kDoubtOfMarchedMultiplier)) {
      out_.warnings.push_back(*std::move(warning));
    }
  }

  /// Records `recorded_mesh_cycles` of the result, and the history.
  void record(const SectionPoint& start) {
    const MarchScales scales = scales_of(start);
    ResponseRecord record(scales.torque / system_.mesh().mean_pinion_contact_radius(),
                          problem_.contacts.model());
    // A speed that is wrong within its tolerance counts I omega times in the energy balance.
    MarchOptions sharper = steps_;
    sharper.relative_tolerance = std::max(0.01 * steps_.relative_tolerance, 1e-12);
    RecordedMarch march(system_, contacts_, scales, sharper, start, ExtremesPerStep::kOfFive);
    for (int i = 0; i < out_.recorded_mesh_cycles; ++i) add_mesh_cycle(march, {&record, &history_});
    const SectionPoint end = march.point();
    while (history_.wanted()) add_mesh_cycle(march, {nullptr, &history_});
    record.fill(start.torques, out_.recorded_mesh_cycles, out_.settled, out_);
    out_.power_balance.stored = system_.stored_energy(0, end.regime, end.state.data()) -
                                system_.stored_energy(0, start.regime, start.state.data());
    out_.section_state = system_.to_section(start.state.data());
  }

  /// Averages a response without a period, and records the history that follows.
  void average(const SectionPoint& start) {
    RattleOptions rattle;
    rattle.march = steps_within_the_limit();
    rattle.march.relative_tolerance =
        std::max(steps_.relative_tolerance, std::min(kRattleStep, 0.1 * options_.tolerance));
    rattle.tolerance = options_.tolerance;
    rattle.least_mesh_cycles = options_.recorded_mesh_cycles;
    rattle.most_mesh_cycles =
        std::max(1, options_.maximum_mesh_cycles - static_cast<int>(out_.statistics.mesh_cycles));
    if (options_.progress) rattle.progress = [this](double fraction) { return report(fraction); };
    const RattleAverage average =
        average_rattle(problem_, contacts_, start, rattle, limit_, out_.statistics);
    out_.recorded_mesh_cycles = average.mesh_cycles;
    out_.estimated_relative_error = average.relative_error;
    average.record.fill(average.torques, average.mesh_cycles, false, out_);
    out_.power_balance.input = average.input;
    out_.power_balance.output = average.output;
    out_.power_balance.stored = average.stored;
    out_.section_state = system_.to_section(average.end.state.data());
    const MarchScales scales = scales_of(average.end);
    RecordedMarch march(system_, contacts_, scales, steps_, average.end, ExtremesPerStep::kOfFive);
    while (history_.wanted()) add_mesh_cycle(march, {nullptr, &history_});
  }

  void add_mesh_cycle(RecordedMarch& march, const MarchRecorders& recorders) {
    if (!report(1)) throw Cancelled();
    march.add_mesh_cycle(recorders, out_.statistics);
  }

  bool report(double fraction) {
    reported_ = std::max(reported_, fraction);
    return !options_.progress || options_.progress(reported_);
  }

  MarchScales scales_of(const SectionPoint& at) const {
    return march_scales(system_, at.torques, problem_.target.mean_pinion_speed);
  }

  const PointProblem& problem_;
  const PointOptions& options_;
  const GearPairSystem& system_;
  ContactSolver contacts_;
  WorkLimit limit_;
  HistorySampler history_;
  PointResult out_;
  MarchOptions steps_;  // without a limit of work
  double reported_ = 0;
};

}  // namespace

double march_step_tolerance(const PointOptions& options) {
  return std::clamp(1e-3 * options.tolerance, 1e-11, options.march_step_tolerance);
}

double march_settling_tolerance(const PointOptions& options) {
  return std::min(0.1 * options.tolerance, options.march_settling_tolerance);
}

double most_contacts_of_march(const PointOptions& options) {
  return is_automatic(options) ? kMostContactsOfAutomaticMarch
                               : kMostContactsPerMeshCycle * options.maximum_mesh_cycles;
}

PointResult solve_by_marching(const PointProblem& problem, PointStart start,
                              const std::optional<CarriedState>& from,
                              const HistoryRequest& history,
                              const std::optional<SectionPoint>& aperiodic) {
  return MarchedPoint(problem, history).solve(plan_march(problem, start, from, aperiodic));
}

}  // namespace tribodyn
