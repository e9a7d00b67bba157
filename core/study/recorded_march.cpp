#include "core/study/recorded_march.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace tribodyn {

RecordedMarch::RecordedMarch(const GearPairSystem& system, ContactSolver& contacts,
                             const MarchScales& scales, const MarchOptions& options,
                             const SectionPoint& start, ExtremesPerStep extremes)
    : system_(system),
      contacts_(contacts),
      scales_(scales),
      options_(options),
      extremes_(extremes),
      torques_(start.torques),
      regime_(start.regime) {
  std::copy(start.state.begin(), start.state.end(), state_.begin());
  state_[kTime] = state_[kLossWork] = state_[kLossShareSquared] = 0;
}

void RecordedMarch::add_mesh_cycle(const MarchRecorders& recorders, SolverWork& work) {
  constexpr int kSamples = ResponseRecord::kSamples;
  ResponseRecord* const record = recorders.record;
  HistorySampler* const history = recorders.history;
  if (record != nullptr && mesh_cycles_ == 0) record->starts_in_gap = regime_.side == 0;
  Phases phases(system_, torques_, scales_, regime_, contacts_);
  std::vector<GapEvent> events;
  phases.gap_events = &events;
  std::array<Instant, kSamples> samples;
  const int count = extremes_ == ExtremesPerStep::kOfThree ? 3 : kSamples;
  double sampled_to = -1;
  ContactRegime sampled_regime;
  // Evaluates between the march's own evaluations.
  const auto evaluate = [&](double phase, const Phases::State& at, Instant& out) {
    system_.evaluate(phase, phases.interval(), phases.regime(), at.data(), contacts_, out);
  };
  const auto on_step = [&](const MarchStep<Phases::kSize>& step) {
    if (record != nullptr) {
      const bool continues = step.start == sampled_to && phases.regime() == sampled_regime;
      if (continues) samples[0] = samples[count - 1];
      for (int i = continues ? 1 : 0; i < count; ++i) {
        const double theta = static_cast<double>(i) / (count - 1);
        const auto at = i == 0 ? step.from : i + 1 == count ? step.to : step.at(theta);
        evaluate(phases.phase(step.start + theta * step.length), at, samples[i]);
      }
      if (count == 3) {
        record->add_piece(std::span(samples).first<3>(), step.to[kTime] - step.from[kTime]);
      } else {
        record->add_step(samples, step.to[kTime] - step.from[kTime]);
      }
      sampled_to = step.start + step.length;
      sampled_regime = phases.regime();
    }
    if (history == nullptr) return;
    const double end = phases.phase(step.start + step.length);
    while (history->wanted() && history->next_phase() < mesh_cycles_ + end) {
      const double inside = history->next_phase() - mesh_cycles_;
      const double theta = (phases.s_of(inside) - step.start) / step.length;
      const auto at = step.at(std::clamp(theta, 0.0, 1.0));
      Instant sample;
      evaluate(inside, at, sample);
      history->add(mesh_cycles_ + inside, at.data(), sample, torques_);
    }
  };
  DormandPrinceWithEvents<Phases> march(phases, options_);
  double phase = 0;
  march.run(phase, state_, 1.0, on_step);
  regime_ = phases.regime();
  work += march.work();
  ++work.mesh_cycles;
  if (record != nullptr) {
    for (GapEvent event : events) {
      event.phase += mesh_cycles_;
      record->gap_events.push_back(event);
    }
    std::copy(state_.begin(), state_.end(), record->integrals.begin());
  }
  ++mesh_cycles_;
}

SectionPoint RecordedMarch::point() const {
  SectionPoint out;
  std::copy_n(state_.begin(), out.state.size(), out.state.begin());
  out.regime = regime_;
  out.torques = torques_;
  return out;
}

}  // namespace tribodyn
