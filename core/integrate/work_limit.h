#pragma once

#include "core/driveline/contact_solver.h"
#include "core/gear/mesh_data.h"

namespace tribodyn {

/// A limit on the work of marches, in contact solutions: results do not depend on the machine.
/// Other work counts as so many contact solutions as take the same time (measured): an evaluation
/// of the equations of motion as one, or more where the mesh functions are summed order by order; a
/// contact solved by the scalar kernel as 20.
class WorkLimit {
 public:
  /// Counts from here on. Keeps the reference to the tally.
  WorkLimit(const ContactTally& tally, const MeshData& mesh, double most_contacts)
      : tally_(tally), start_(tally), per_instant_(instant_work(mesh)), most_(most_contacts) {}

  /// Share of the limit that has been spent; may exceed 1 by some thousand contacts.
  double spent_share() const {
    constexpr double kMoreByScalarKernel = 19;
    const double spent = static_cast<double>(tally_.solutions - start_.solutions) +
                         per_instant_ * static_cast<double>(tally_.instants - start_.instants) +
                         kMoreByScalarKernel *
                             static_cast<double>(tally_.by_scalar_kernel - start_.by_scalar_kernel);
    return spent / most_;
  }
  bool is_spent() const { return spent_share() >= 1; }
  double most_contacts() const { return most_; }

 private:
  static double instant_work(const MeshData& mesh) {
    constexpr double kPerOrder = 0.1;
    const bool is_summed = !(mesh.series_reach() > 0);
    return 1 + (is_summed ? kPerOrder * static_cast<double>(mesh.orders().size()) : 0);
  }

  const ContactTally& tally_;
  ContactTally start_;
  double per_instant_;
  double most_;
};

}  // namespace tribodyn
