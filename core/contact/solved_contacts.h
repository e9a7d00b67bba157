#pragma once

#include <cstddef>
#include <memory>

#include "core/contact/flank_contact_batch.h"
#include "core/numerics/columns.h"

namespace tribodyn {

/// The outputs of contacts that a batch has solved, such as an orbit's in the order of its instants
/// and of their flank pairs.
class SolvedContacts {
 public:
  /// Discards all outputs; they are 0 afterwards.
  void resize(std::size_t count);
  /// Discards all outputs and leaves them uninitialised.
  void resize_for_overwrite(std::size_t count);
  /// The arrays into which a batch writes, all but the status.
  FlankContactBatchResults results();
  const double* friction() const { return rows_[0]; }
  /// One figure of all contacts, such as column(&ContactFigures::film_ratio). Requires a figure
  /// that copy() sets.
  const double* column(double ContactFigures::*figure) const;
  /// Sets the figures that are kept; those that FlankContactModel::complete() fills in are left.
  void copy(std::size_t i, ContactFigures& to) const;
  double ellipse_load(std::size_t i) const;  ///< W_EHL of eq 41 [N]
  std::size_t size() const { return size_; }
  /// Returns true if FlankContactModel solved the contact, and not the vector code.
  bool by_scalar_kernel(std::size_t i) const { return by_scalar_kernel_[i]; }

 private:
  Columns rows_;
  std::unique_ptr<bool[]> limiting_stress_at_centre_, by_scalar_kernel_;
  std::size_t size_ = 0, room_ = 0;
};

}  // namespace tribodyn
