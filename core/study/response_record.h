#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/integrate/mesh_cycle_march.h"
#include "core/study/point_result.h"

namespace tribodyn {

/// Gathers a steady state while it is marched (or stepped through quasi-statically) once more:
/// integrals over time, extremes, openings of the gap; then fills in the result.
class ResponseRecord {
 public:
  static constexpr int kSamples = 5;  ///< per step, equidistant: extremes are refined by parabolas
  using Integrals = std::array<double, kRecordComponents>;

  /// Figures of a contact count towards extremes on flanks that carry at least 1 % of
  /// `reference_force` [N].
  explicit ResponseRecord(double reference_force) : load_floor_(0.01 * reference_force) {}

  void add_step(std::span<const Instant, kSamples> instants) { add(instants); }
  /// Start, middle and end of a smooth piece.
  void add_piece(std::span<const Instant, 3> instants) { add(instants); }
  void set_transmission_error_range(double minimum, double maximum);

  Integrals integrals{};
  std::vector<GapEvent> gap_events;
  bool starts_in_gap = false;

  /// Fills everything that follows from the record. `cycles`: mesh cycles recorded.
  void fill(const Torques& torques, double cycles, bool periodic, PointResult& out) const;

 private:
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double value);
    /// A smooth function, sampled at even distances.
    template <std::size_t kCount>
    void add(const std::array<double, kCount>& samples);
    /// 0 where nothing was added.
    Extremes with_mean(double mean) const;
  };
  template <std::size_t kCount>
  void add(std::span<const Instant, kCount> instants);
  template <std::size_t kCount>
  void add_flank(std::span<const Instant, kCount> instants, int k);
  bool counts(const Instant& instant, int flank) const {
    return instant.load[flank] > 0 && instant.load[flank] >= load_floor_;
  }

  double load_floor_;
  Range transmission_error_, mesh_force_, pinion_friction_, gear_friction_;
  std::array<Range, 9> contact_;  // of figures that count on loaded flanks only
};

}  // namespace tribodyn
