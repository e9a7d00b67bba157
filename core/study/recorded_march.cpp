#include "core/study/recorded_march.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tribodyn {

void record_response(GearPairSystem& system, const SteadyState& steady, int cycles,
                     const MarchOptions& options, const MarchScales& scales, ResponseRecord& record,
                     HistorySampler& history, SolverStatistics& statistics,
                     const std::function<bool(double)>& progress) {
  using Phases = PhaseSystem<true>;
  constexpr int kSize = Phases::kSize;
  Phases::State y{};
  std::copy(steady.state.begin(), steady.state.end(), y.begin());
  y[kTime] = y[kLossWork] = y[kLossShareSquared] = 0;
  system.regime = steady.regime;
  system.set_torques(steady.torques);
  record.starts_in_gap = system.regime.side == 0;

  GearPairSystem probe = system;  // evaluates between the march's own evaluations
  const long solved_before = probe.contact_solutions();
  std::array<Instant, ResponseRecord::kSamples> samples;
  int cycle = 0;
  bool recording = true;
  const Phases* place = nullptr;  // of the cycle that is marched
  const auto on_step = [&](const MarchStep<kSize>& step) {
    probe.regime = system.regime;
    probe.set_interval(system.interval());
    if (recording) {
      for (int i = 0; i < ResponseRecord::kSamples; ++i) {
        const double theta = static_cast<double>(i) / (ResponseRecord::kSamples - 1);
        const auto at = i == 0                              ? step.from
                        : i + 1 == ResponseRecord::kSamples ? step.to
                                                            : step.at(theta);
        probe.evaluate(place->phase(step.start + theta * step.length), at.data(), samples[i]);
      }
      record.add_step(samples);
    }
    const double end = place->phase(step.start + step.length);
    while (history.wanted() && history.next_phase() < cycle + end) {
      const double inside = history.next_phase() - cycle;
      const double theta = (place->progress(inside) - step.start) / step.length;
      const auto at = step.at(std::clamp(theta, 0.0, 1.0));
      probe.evaluate(inside, at.data(), samples[0]);
      history.add(cycle + inside, at.data(), samples[0], system.torques());
    }
  };
  for (; cycle < cycles || history.wanted(); ++cycle) {
    if (progress && !progress(1)) throw Cancelled();
    Phases phases(system, scales);
    place = &phases;
    std::vector<GapEvent> events;
    phases.gap_events = &events;
    recording = cycle < cycles;
    EventExactMarch<Phases> march(phases, options);
    double phase = 0;
    march.run(phase, y, 1.0, on_step);
    throw_if_refused(system);
    statistics.right_hand_sides += march.statistics().right_hand_sides;
    statistics.accepted_steps += march.statistics().accepted_steps;
    statistics.rejected_steps += march.statistics().rejected_steps;
    statistics.events += march.statistics().events;
    ++statistics.mesh_cycles;
    if (recording) {
      for (GapEvent event : events) {
        event.phase += cycle;
        record.gap_events.push_back(event);
      }
    }
    if (cycle + 1 == cycles) {
      std::copy(y.begin(), y.end(), record.integrals.begin());
      record.end_regime = system.regime;
    }
  }
  statistics.contact_solutions += probe.contact_solutions() - solved_before;
}

}  // namespace tribodyn
