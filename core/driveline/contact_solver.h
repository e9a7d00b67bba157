#pragma once

#include <array>
#include <utility>

#include "core/contact/solved_contacts.h"
#include "core/gear/mesh_data.h"

namespace tribodyn {

/// The contacts that a search or a march has solved.
struct ContactTally {
  long solutions = 0;
  long instants = 0;          ///< states evaluated by a ContactSolver, loaded or not
  long by_scalar_kernel = 0;  ///< solutions of which the batch was not certain
  ContactStatus refusal = ContactStatus::kOk;  ///< the first one since the last take_refusal()
  ContactStatus take_refusal() { return std::exchange(refusal, ContactStatus::kOk); }
};

/// Solves the contacts of one instant after another: one by one by the scalar kernel, or together
/// by the batch, which leaves out outputs that no record holds. Holds storage: one per march.
/// Allocates nothing once it is made.
class ContactSolver {
 public:
  /// Keeps the references; adds to the solutions of `tally`.
  ContactSolver(const FlankContactModel& model, ContactTally& tally);
  ContactSolver(const FlankContactBatch& batch, ContactTally& tally);

  /// Flank pairs without load have no contact: their figures are empty. Returns the first refusal,
  /// kOk if there is none.
  ContactStatus solve(const std::array<ContactConditions, kFlankPairs>& conditions,
                      std::array<ContactFigures, kFlankPairs>& out);

 private:
  void solve_together(const std::array<ContactConditions, kFlankPairs>& conditions,
                      std::array<ContactFigures, kFlankPairs>& out);

  const FlankContactModel& model_;
  const FlankContactBatch* batch_;  // null: by the scalar kernel
  ContactGeometries geometries_;
  SolvedContacts solved_;
  ContactTally& tally_;
};

}  // namespace tribodyn
