#pragma once

#include <cstddef>
#include <vector>

namespace tribodyn {

/// Lanes that any width of vector divides.
inline constexpr std::size_t kColumnLanes = 16;

/// Rows of numbers, each as long as the next multiple of kColumnLanes, and as many may be read
/// beyond the last. Zero at
/// first; with another size what is there means nothing.
class Columns {
 public:
  Columns() = default;
  Columns(std::size_t rows, std::size_t length) { resize(rows, length); }
  void resize(std::size_t rows, std::size_t length) {
    stride_ = (length + kColumnLanes - 1) / kColumnLanes * kColumnLanes;
    values_.resize(rows * stride_ + kColumnLanes);
  }
  double* operator[](std::size_t row) { return values_.data() + row * stride_; }
  const double* operator[](std::size_t row) const { return values_.data() + row * stride_; }
  std::size_t stride() const { return stride_; }  ///< from row to row

 private:
  std::size_t stride_ = 0;
  std::vector<double> values_;
};

}  // namespace tribodyn
