#pragma once

#include "core/driveline/gear_pair_system.h"
#include "core/study/history.h"

namespace tribodyn {

/// Fills a History, sample by sample.
class HistorySampler {
 public:
  explicit HistorySampler(const HistoryRequest& request);

  bool wanted() const { return !request_.columns.empty() && next_ < total_; }
  /// Mesh phase of the next sample, cycles since the start of the record.
  double next_phase() const { return static_cast<double>(next_) / request_.samples_per_mesh_cycle; }
  void add(double phase, const double* state, const Instant& at, const Torques& torques);
  /// Fills what is still wanted with copies of the first `cycles` mesh cycles, `period` [s] later
  /// each time.
  void repeat_first_cycles(int cycles, double period);
  /// Samples of the first mesh cycles still to come.
  bool wanted_in_first_cycles(int cycles) const {
    return wanted() && next_ < static_cast<long>(cycles) * request_.samples_per_mesh_cycle;
  }
  History take() { return std::move(history_); }

 private:
  HistoryRequest request_;
  long next_ = 0, total_ = 0;
  History history_;
};

}  // namespace tribodyn
