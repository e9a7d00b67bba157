#include "core/driveline/contact_solver.h"

namespace tribodyn {

ContactSolver::ContactSolver(const FlankContactModel& model, ContactTally& tally)
    : model_(model),
      batch_(nullptr),
      geometries_(model.reduced_modulus(), model.options()),
      tally_(tally) {}

ContactSolver::ContactSolver(const FlankContactBatch& batch, ContactTally& tally)
    : model_(batch.model()),
      batch_(&batch),
      geometries_(model_.reduced_modulus(), model_.options(), kFlankPairs),
      tally_(tally) {
  solved_.resize_for_overwrite(kFlankPairs);
}

ContactStatus ContactSolver::solve(const std::array<ContactConditions, kFlankPairs>& conditions,
                                   std::array<ContactFigures, kFlankPairs>& out) {
  if (batch_ != nullptr) solve_together(conditions, out);
  ++tally_.instants;
  ContactStatus refusal = ContactStatus::kOk;
  for (int k = 0; k < kFlankPairs; ++k) {
    if (!(conditions[k].load > 0)) {
      out[k] = ContactFigures{};
      continue;
    }
    if (batch_ == nullptr) out[k] = model_.solve(conditions[k]);
    ++tally_.solutions;
    if (refusal == ContactStatus::kOk) refusal = out[k].status;
  }
  return refusal;
}

void ContactSolver::solve_together(const std::array<ContactConditions, kFlankPairs>& conditions,
                                   std::array<ContactFigures, kFlankPairs>& out) {
  using Column = std::array<double, kFlankPairs>;
  Column load, pinion_x, pinion_y, gear_x, gear_y;
  for (int k = 0; k < kFlankPairs; ++k) {
    const ContactConditions& c = conditions[k];
    load[k] = c.load;
    pinion_x[k] = c.velocity_1_x;
    pinion_y[k] = c.velocity_1_y;
    gear_x[k] = c.velocity_2_x;
    gear_y[k] = c.velocity_2_y;
    if (c.load > 0) geometries_.set(k, c.radius_x, c.radius_y);
  }
  std::array<ContactStatus, kFlankPairs> status;
  std::array<bool, kFlankPairs> by_scalar_kernel;
  FlankContactBatchResults results = solved_.results();
  results.status = status.data();
  results.by_scalar_kernel = by_scalar_kernel.data();
  batch_->solve(geometries_, 0, kFlankPairs,
                {load.data(), pinion_x.data(), pinion_y.data(), gear_x.data(), gear_y.data()},
                results);
  for (int k = 0; k < kFlankPairs; ++k) {
    if (!(load[k] > 0)) continue;
    tally_.by_scalar_kernel += by_scalar_kernel[k] ? 1 : 0;
    out[k] = {};
    solved_.copy(k, out[k]);
    out[k].status = status[k];
    model_.complete(conditions[k], out[k]);
  }
}

}  // namespace tribodyn
