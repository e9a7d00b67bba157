#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace tribodyn {

/// A column of numbers as a combination of base columns.
struct ColumnFit {
  Eigen::VectorXd weights;  ///< of the base columns
  /// Given less predicted number of each row, each predicted by the fit to all other rows, in the
  /// unit of the column. Source: D. M. Allen, Technometrics 16 (1974) 125-127.
  Eigen::VectorXd left_out_errors;
};

/// Expresses columns of numbers by a few base columns, from the rows in which all are given: least
/// squares, with weights held small enough that noise and more columns than rows do no harm.
/// The figures of one lubricant at many conditions are such columns, with one row for each draw of
/// its inputs: because the same properties act at all conditions, they follow from a few columns to
/// within some hundredths of their spread.
/// Source: pseudo-skeleton approximation, S. A. Goreinov, E. E. Tyrtyshnikov and
/// N. L. Zamarashkin, Linear Algebra and its Applications 261 (1997) 1-21.
class ColumnBase {
 public:
  /// Requires at least two rows and one column.
  explicit ColumnBase(const Eigen::MatrixXd& base);

  /// Requires as many rows as the base has.
  ColumnFit fit(const Eigen::VectorXd& column) const;

 private:
  Eigen::VectorXd sizes_;               // root mean square of each column, 1 if that is 0
  Eigen::MatrixXd scaled_;              // each column divided by its size
  Eigen::LLT<Eigen::MatrixXd> normal_;  // normal matrix with the penalty of weights
  Eigen::VectorXd kept_;                // by row: share of its error that remains in the fit
};

}  // namespace tribodyn
