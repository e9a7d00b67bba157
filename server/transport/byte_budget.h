#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

namespace tribodyn::server {

/// Bytes of large requests that the server works on at a time. Safe for concurrent access.
class ByteBudget {
 public:
  /// Requests up to `free_bytes` need no part of the budget.
  ByteBudget(std::size_t bytes, std::size_t free_bytes) : left_(bytes), free_bytes_(free_bytes) {}

  /// A part of the budget, given back when the object goes.
  class Lease {
   public:
    Lease(ByteBudget* budget, std::size_t bytes) : budget_(budget), bytes_(bytes) {}
    Lease(Lease&& other) noexcept : budget_(other.budget_), bytes_(other.bytes_) {
      other.budget_ = nullptr;
    }
    Lease& operator=(Lease&&) = delete;
    ~Lease() {
      if (budget_ != nullptr) budget_->left_ += bytes_;
    }

   private:
    ByteBudget* budget_;
    std::size_t bytes_;
  };

  /// Returns nullopt if that much is not left.
  std::optional<Lease> take(std::size_t bytes) {
    if (bytes <= free_bytes_) return Lease(nullptr, 0);
    std::size_t left = left_;
    do {
      if (left < bytes) return std::nullopt;
    } while (!left_.compare_exchange_weak(left, left - bytes));
    return Lease(this, bytes);
  }

 private:
  std::atomic<std::size_t> left_;
  const std::size_t free_bytes_;
};

}  // namespace tribodyn::server
