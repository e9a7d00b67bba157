#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/contact/flank_contact.h"
#include "core/integrate/mesh_cycle_march.h"
#include "core/study/point_result.h"
#include "core/study/sampled_range.h"

namespace tribodyn {

/// Gathers a steady state while it is marched (or stepped through quasi-statically) once more:
/// integrals over time, extremes, openings of the gap; then fills in the result.
class ResponseRecord {
 public:
  static constexpr int kSamples = 5;  ///< per step, equidistant: extremes are refined by parabolas
  using Integrals = std::array<double, kRecordComponents>;

  /// Figures of a contact count towards extremes on flanks that carry at least kLeastCountedLoad of
  /// `reference_force` [N].
  /// `contacts` is the model by which the contacts were solved; it must outlive the record.
  ResponseRecord(double reference_force, const FlankContactModel& contacts)
      : load_floor_(kLeastCountedLoad * reference_force), model_(contacts) {}

  /// `duration` of the step or piece [s].
  void add_step(std::span<const Instant, kSamples> instants, double duration) {
    add(instants, duration);
  }
  /// Start, middle and end of a smooth piece.
  void add_piece(std::span<const Instant, 3> instants, double duration) { add(instants, duration); }
  void set_transmission_error_range(double minimum, double maximum);
  /// Appends what was recorded after these mesh cycles, from its own zero of phase and time.
  void append(const ResponseRecord& next, double cycles);

  Integrals integrals{};
  std::vector<GapEvent> gap_events;
  bool starts_in_gap = false;

  /// Fills everything that follows from the record. `cycles`: mesh cycles recorded.
  void fill(const Torques& torques, double cycles, bool periodic, PointResult& out) const;

 private:
  template <std::size_t kCount>
  void add(std::span<const Instant, kCount> instants, double duration);
  template <std::size_t kCount>
  void add_flank(std::span<const Instant, kCount> instants, int k);

  double load_floor_;
  const FlankContactModel& model_;
  double limited_centre_time_ = 0;  // with a centre on tau_L [s]
  SampledRange transmission_error_, mesh_force_, pinion_friction_, gear_friction_;
  std::array<SampledRange, 9> contact_;  // of figures that count on loaded flanks only
};

}  // namespace tribodyn
