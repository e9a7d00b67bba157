#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/contact/hertz.h"

namespace tribodyn {

/// Contacts as arrays, with memory for every figure of a batch.
class ContactArrays {
 public:
  ContactArrays(const std::vector<ContactConditions>& conditions, const Solid& solid,
                const ModelOptions& options)
      : geometries_(reduced_modulus(solid.youngs_modulus, solid.poissons_ratio), options,
                    conditions.size()) {
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const ContactConditions& k = conditions[i];
      geometries_.set(i, k.radius_x, k.radius_y);
      const double row[kInputs] = {k.load, k.velocity_1_x, k.velocity_1_y, k.velocity_2_x,
                                   k.velocity_2_y};
      for (int c = 0; c < kInputs; ++c) in_[c].push_back(row[c]);
    }
    for (auto& column : out_) column.resize(conditions.size());
    centre_ = std::shared_ptr<bool[]>(new bool[conditions.size()]());
    status_.resize(conditions.size());
  }

  std::size_t size() const { return status_.size(); }
  const ContactGeometries& geometries() const { return geometries_; }
  FlankContactBatchConditions conditions(std::size_t first = 0) const {
    return {in_[0].data() + first, in_[1].data() + first,
            in_[2].data() + first, in_[3].data() + first,
            in_[4].data() + first, start_.empty() ? nullptr : start_.data() + first};
  }
  FlankContactBatchResults results(std::size_t first = 0) {
    const auto at = [&](int c) { return out_[c].data() + first; };
    return {at(0),
            at(1),
            at(2),
            at(3),
            at(4),
            at(5),
            at(6),
            at(7),
            at(8),
            at(9),
            at(10),
            at(11),
            at(12),
            centre_.get() + first,
            status_.data() + first};
  }
  /// Returns the arrays for friction only.
  FlankContactBatchResults friction(std::size_t first = 0) {
    FlankContactBatchResults only;
    only.friction = out_[0].data() + first;
    return only;
  }
  /// Makes contacts start at their last temperature times `factor`.
  void start_from_last_temperature(double factor) {
    start_.resize(size());
    for (std::size_t i = 0; i < size(); ++i) start_[i] = factor * out_[3][i];
  }
  /// Solves all contacts. Returns the number of contacts that the reference solved.
  std::size_t solve(const FlankContactBatch& batch, Digits digits = Digits::kFull) {
    return batch.solve(geometries_, 0, size(), conditions(), results(), digits);
  }
  /// Returns the figures of one contact under the names of the reference; other members are 0.
  ContactSolution solution(std::size_t i) const {
    ContactSolution s;
    s.status = status_[i];
    double* const members[kFigures] = {&s.friction,
                                       &s.viscous_friction,
                                       &s.boundary_friction,
                                       &s.contact_temperature,
                                       &s.central_film_thickness,
                                       &s.film_ratio,
                                       &s.maximum_pressure,
                                       &s.ellipse_load,
                                       &s.asperity_load,
                                       &s.sliding_speed,
                                       &s.shear_rate,
                                       &s.mean_shear_stress,
                                       &s.limiting_stress_area_share};
    for (int c = 0; c < kFigures; ++c) *members[c] = out_[c][i];
    s.limiting_stress_at_centre = centre_[i];
    return s;
  }

 private:
  static constexpr int kInputs = 5, kFigures = 13;
  ContactGeometries geometries_;
  std::vector<double> in_[kInputs], start_, out_[kFigures];
  std::shared_ptr<bool[]> centre_;  // std::vector<bool> has no data()
  std::vector<ContactStatus> status_;
};

inline std::vector<InstructionSet> supported_instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set :
       {InstructionSet::kPortable, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (FlankContactBatch::supported(set)) sets.push_back(set);
  }
  return sets;
}

}  // namespace tribodyn
