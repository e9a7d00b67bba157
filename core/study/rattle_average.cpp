#include "core/study/rattle_average.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/numerics/batch_means.h"
#include "core/periodic/period_correction.h"
#include "core/refusal.h"
#include "core/study/recorded_march.h"

namespace tribodyn {
namespace {

constexpr int kRattleBlockCycles = 6;

struct RattleBlock {
  ResponseRecord record;
  int mesh_cycles;
  Torques applied;
  Torques needed;  ///< to end as fast as it began
  double stored;   ///< change of the stored energy [J]

  double duration() const { return record.integrals[kTime]; }
};

/// The torques with the mean of what the blocks needed.
Torques mean_needed(std::span<const RattleBlock> blocks) {
  double time = 0, pinion = 0, wheel = 0;
  for (const RattleBlock& block : blocks) {
    time += block.duration();
    pinion += block.duration() * block.needed.pinion;
    wheel += block.duration() * block.needed.wheel;
  }
  return {pinion / time, wheel / time};
}

/// What the error is estimated of, as means over a block.
struct RattleFigures {
  double loss_share_squared;  ///< [(N m)^2]
  double loss;                ///< [W]
  double input_torque;        ///< [N m]
  double input;               ///< [W]
  double torque;              ///< the unknown one [N m]
};

RattleFigures figures_of(const RattleBlock& block, bool solve_wheel_torque) {
  const ResponseRecord::Integrals& y = block.record.integrals;
  const double time = block.duration();
  const double torque = input_torque(block.needed, y[kWheelAngle] / y[kPinionShaftAngle]);
  return {y[kLossShareSquared] / time, y[kLossWork] / time, torque,
          torque * y[kPinionShaftAngle] / time,
          solve_wheel_torque ? block.needed.wheel : block.needed.pinion};
}

/// The blocks of a march, as figures.
class RattleSeries {
 public:
  void add(const RattleFigures& figures) { blocks_.push_back(figures); }

  /// The number of first blocks in which the transient lasts.
  std::size_t transient() const {
    std::size_t out = 0;
    std::vector<double> series(blocks_.size());
    for (const auto figure :
         {&RattleFigures::loss_share_squared, &RattleFigures::loss, &RattleFigures::torque}) {
      for (std::size_t i = 0; i < series.size(); ++i) series[i] = blocks_[i].*figure;
      out = std::max(out, initial_transient(series));
    }
    return out;
  }

  /// Of the mean over the blocks from `first` on; absent if it is not known.
  std::optional<double> relative_error(std::size_t first) const {
    const std::span<const RattleFigures> kept(blocks_.begin() + static_cast<std::ptrdiff_t>(first),
                                              blocks_.end());
    RattleFigures mean{};
    for (const RattleFigures& each : kept) {
      for (const auto figure : kAll)
        mean.*figure += each.*figure / static_cast<double>(kept.size());
    }
    if (std::any_of(std::begin(kAll), std::end(kAll),
                    [&](const auto figure) { return mean.*figure == 0; })) {
      return std::nullopt;
    }
    constexpr auto kInefficiencyRms = [](const RattleFigures& relative) {
      return 0.5 * relative.loss_share_squared - relative.input_torque;
    };
    constexpr auto kInefficiencyEnergyMean = [](const RattleFigures& relative) {
      return relative.loss - relative.input;
    };
    constexpr auto kTorque = [](const RattleFigures& relative) { return relative.torque; };
    double out = 0;
    std::vector<double> deviations(kept.size());
    for (double (*figure)(const RattleFigures&) :
         {+kInefficiencyRms, +kInefficiencyEnergyMean, +kTorque}) {
      for (std::size_t i = 0; i < kept.size(); ++i) {
        RattleFigures relative = kept[i];
        for (const auto each : kAll) relative.*each /= mean.*each;
        deviations[i] = figure(relative);
      }
      const std::optional<double> error = half_width_of_mean(deviations, kRattleCoverage);
      if (!error) return std::nullopt;
      out = std::max(out, *error);
    }
    return out;
  }

 private:
  static constexpr double RattleFigures::*kAll[] = {
      &RattleFigures::loss_share_squared, &RattleFigures::loss, &RattleFigures::input_torque,
      &RattleFigures::input, &RattleFigures::torque};
  std::vector<RattleFigures> blocks_;
};

RattleAverage average_of(std::span<const RattleBlock> blocks) {
  RattleAverage out{.record = blocks.front().record, .torques = mean_needed(blocks)};
  for (const RattleBlock& block : blocks) {
    if (&block != &blocks.front()) out.record.append(block.record, out.mesh_cycles);
    out.mesh_cycles += block.mesh_cycles;
    out.input += block.applied.pinion * block.record.integrals[kPinionShaftAngle];
    out.output += block.applied.wheel * block.record.integrals[kWheelAngle];
    out.stored += block.stored;
  }
  return out;
}

/// Marches block by block.
class RattleMarch {
 public:
  /// Keeps the references.
  RattleMarch(const PointProblem& problem, ContactSolver& contacts, const SectionPoint& start,
              const MarchOptions& march, SolverWork& work)
      : problem_(problem),
        system_(problem.system()),
        contacts_(contacts),
        march_(march),
        work_(work),
        scales_(march_scales(system_, start.torques, problem.target.mean_pinion_speed)),
        at_(start) {}

  /// Marches at constant torques. `report` is called before each mesh cycle.
  RattleBlock march(int mesh_cycles, const std::function<void()>& report) {
    RattleBlock out{ResponseRecord(scales_.torque / system_.mesh().mean_pinion_contact_radius(),
                                   problem_.contacts.model()),
                    mesh_cycles, at_.torques, at_.torques, 0};
    RecordedMarch march(system_, contacts_, scales_, march_, at_, ExtremesPerStep::kOfThree);
    for (int i = 0; i < mesh_cycles; ++i) {
      report();
      march.add_mesh_cycle({&out.record, nullptr}, work_);
    }
    const SectionPoint end = march.point();
    MarchState unused{};
    lower_torque(system_, accelerating_torque(system_, at_.state, end.state),
                 problem_.target.solve_wheel_torque, out.needed, unused);
    out.stored = system_.stored_energy(0, end.regime, end.state.data()) -
                 system_.stored_energy(0, at_.regime, at_.state.data());
    at_ = end;
    return out;
  }

  /// Sets the torques of the next block, and restores the mean speed after one of so many cycles.
  void correct(const Torques& wanted, int mesh_cycles) {
    const MeshData& mesh = system_.mesh();
    const double ratio = mesh.mean_pinion_contact_radius() / mesh.mean_gear_contact_radius();
    const double by =
        at_.torques.pinion - wanted.pinion + ratio * (wanted.wheel - at_.torques.wheel);
    lower_torque(system_, by, problem_.target.solve_wheel_torque, at_.torques, at_.state);
    restore_mean_speed(system_, mesh_cycles, problem_.target.mean_pinion_speed, at_.state);
    const ContactRegime corrected = system_.regime_of(0, at_.state.data());
    if (corrected.side != at_.regime.side) at_.regime = corrected;
  }

  const SectionPoint& at() const { return at_; }

 private:
  const PointProblem& problem_;
  const GearPairSystem& system_;
  ContactSolver& contacts_;
  const MarchOptions& march_;
  SolverWork& work_;
  MarchScales scales_;
  SectionPoint at_;
};

}  // namespace

RattleAverage average_rattle(const PointProblem& problem, ContactSolver& contacts,
                             const SectionPoint& start, const RattleOptions& options,
                             const WorkLimit& limit, SolverWork& work) {
  RattleMarch march(problem, contacts, start, options.march, work);
  std::vector<RattleBlock> blocks;
  RattleSeries series;
  std::size_t transient = 0;
  std::optional<double> error;
  int marched = 0;
  const auto report = [&] {
    if (!options.progress) return;
    const double cycles = static_cast<double>(marched) / options.most_mesh_cycles;
    if (!options.progress(std::min(1.0, std::max(cycles, limit.spent_share())))) throw Cancelled();
  };
  do {
    const int cycles = std::min(kRattleBlockCycles, options.most_mesh_cycles - marched);
    if (cycles < kRattleBlockCycles && !blocks.empty()) break;
    try {
      blocks.push_back(march.march(cycles, report));
    } catch (const Refusal& refusal) {
      if (blocks.empty() || refusal.reason() != "WORK_LIMIT") throw;
      break;
    }
    marched += cycles;
    series.add(figures_of(blocks.back(), problem.target.solve_wheel_torque));
    march.correct(mean_needed(std::span(blocks).subspan(blocks.size() / 2)), cycles);
    transient = series.transient();
    error = series.relative_error(transient);
    const bool is_enough =
        marched - kRattleBlockCycles * static_cast<int>(transient) >= options.least_mesh_cycles;
    if (is_enough && error && *error <= options.tolerance) break;
  } while (!limit.is_spent());

  RattleAverage out = average_of(std::span(blocks).subspan(transient));
  out.relative_error = error;
  out.end = march.at();
  return out;
}

}  // namespace tribodyn
