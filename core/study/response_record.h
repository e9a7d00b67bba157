#pragma once

#include <array>
#include <vector>

#include "core/dynamics/mesh_cycle_march.h"
#include "core/study/operating_point.h"

namespace tribodyn {

/// Gathers a steady state while it is marched (or stepped through quasi-statically) once more:
/// integrals over time, extremes, openings of the gap; then fills in the result.
class ResponseRecord {
 public:
  static constexpr int kSamples = 5;  ///< per step, equidistant: extremes are refined by parabolas
  using Integrals = std::array<double, kRecordComponents>;

  /// Film, temperature, pressure and shear rate count towards extremes on flanks that carry at
  /// least 1 % of `reference_force` [N].
  explicit ResponseRecord(double reference_force) : load_floor_(0.01 * reference_force) {}

  void add_step(const std::array<Instant, kSamples>& instants);
  void add_instant(const Instant& instant);
  /// Start, middle and end of a smooth piece.
  void add_piece(const std::array<Instant, 3>& instants);
  void set_transmission_error_range(double minimum, double maximum);

  Integrals integrals{};
  std::vector<GapEvent> gap_events;
  bool starts_in_gap = false;
  ContactRegime end_regime;

  /// Fills everything that follows from the record. `cycles`: mesh cycles recorded.
  void fill(const Torques& torques, double cycles, bool periodic, PointResult& out) const;

 private:
  struct Range {
    double low = 0, high = 0;
    bool seen = false;
    void add(double low_value, double high_value);
  };
  static Extremes extremes(const Range& range, double mean);
  template <std::size_t kCount, class Value>
  static void add_samples(const std::array<Instant, kCount>& instants, Range& range, Value value);
  template <std::size_t kCount>
  void add_all(const std::array<Instant, kCount>& instants);
  bool counts(const Instant& instant, int flank) const {
    return instant.load[flank] > 0 && instant.load[flank] >= load_floor_;
  }

  double load_floor_;
  Range transmission_error_, mesh_force_, pinion_friction_, gear_friction_;
  Range film_, film_ratio_, temperature_, pressure_, shear_rate_;
};

}  // namespace tribodyn
