#pragma once

#include <algorithm>

#include "core/driveline/contact_solver.h"

namespace tribodyn {

/// A limit on the work of marches, in contact solutions: results do not depend on the machine.
/// Where flanks carry no load, an instant counts as one; a contact that the batch leaves to the
/// scalar kernel counts as eleven, by its time.
class WorkLimit {
 public:
  /// Counts from here on. Keeps the reference.
  WorkLimit(const ContactTally& tally, double most_contacts)
      : tally_(tally), start_(tally), most_(most_contacts) {}

  /// Share of the limit that has been spent; may exceed 1 by some thousand contacts.
  double spent_share() const {
    constexpr long kMoreByScalarKernel = 10;
    const long spent =
        std::max(tally_.solutions - start_.solutions, tally_.instants - start_.instants) +
        kMoreByScalarKernel * (tally_.handed_back - start_.handed_back);
    return static_cast<double>(spent) / most_;
  }
  bool is_spent() const { return spent_share() >= 1; }
  double most_contacts() const { return most_; }

 private:
  const ContactTally& tally_;
  ContactTally start_;
  double most_;
};

}  // namespace tribodyn
