#pragma once

#include <cstddef>
#include <memory>

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
    if (set_size(rows, length)) values_ = std::make_unique<double[]>(capacity_);
  }
  /// As above, but what is there at first means nothing either.
  void resize_for_overwrite(std::size_t rows, std::size_t length) {
    if (set_size(rows, length)) values_ = std::make_unique_for_overwrite<double[]>(capacity_);
  }
  double* operator[](std::size_t row) { return values_.get() + row * stride_; }
  const double* operator[](std::size_t row) const { return values_.get() + row * stride_; }
  std::size_t stride() const { return stride_; }  ///< from row to row

 private:
  /// Returns true if the values do not fit into what there is.
  bool set_size(std::size_t rows, std::size_t length) {
    stride_ = (length + kColumnLanes - 1) / kColumnLanes * kColumnLanes;
    const std::size_t size = rows * stride_ + kColumnLanes;
    if (size <= capacity_) return false;
    capacity_ = size;
    return true;
  }

  std::size_t stride_ = 0;
  std::size_t capacity_ = 0;
  std::unique_ptr<double[]> values_;
};

}  // namespace tribodyn
