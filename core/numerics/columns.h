#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace tribodyn {

/// Lanes that any width of vector divides.
inline constexpr std::size_t kColumnLanes = 16;

/// Rows of numbers, each as long as the next multiple of kColumnLanes, and as many may be read
/// beyond the last.
class Columns {
 public:
  Columns() = default;
  Columns(std::size_t rows, std::size_t length) { resize(rows, length); }
  /// Zero at first; with another size what is there means nothing.
  void resize(std::size_t rows, std::size_t length) {
    if (set_size(rows, length)) values_.setZero();
  }
  /// As above, but what is there at first means nothing either.
  void resize_for_overwrite(std::size_t rows, std::size_t length) { set_size(rows, length); }
  double* operator[](std::size_t row) { return values_.data() + row * stride_; }
  const double* operator[](std::size_t row) const { return values_.data() + row * stride_; }
  std::size_t stride() const { return stride_; }  ///< from row to row

 private:
  /// Returns true if the values did not fit into what there was.
  bool set_size(std::size_t rows, std::size_t length) {
    stride_ = (length + kColumnLanes - 1) / kColumnLanes * kColumnLanes;
    const auto size = static_cast<Eigen::Index>(rows * stride_ + kColumnLanes);
    if (size <= values_.size()) return false;
    values_.resize(size);
    return true;
  }

  std::size_t stride_ = 0;
  Eigen::ArrayXd values_;  // a vector would set them to 0
};

}  // namespace tribodyn
