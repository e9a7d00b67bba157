#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace tribodyn::server {

/// One violation: the path of the field and a sentence with its value, unit, allowed range and the
/// equation that needs it. The client receives it as google.rpc.BadRequest.FieldViolation.
struct Violation {
  std::string field;
  std::string description;
};

/// The violations of one request. The list keeps the first kMostKept of them and counts the others,
/// so that no request can fill the memory with violations. size() is the number of all of them;
/// begin() to end() iterate over the kept ones.
class Violations {
 public:
  using value_type = Violation;
  using iterator = std::vector<Violation>::iterator;
  using const_iterator = std::vector<Violation>::const_iterator;

  /// Number of kept violations: five times as many as fit into the 5.5 kB of an error.
  static constexpr std::size_t kMostKept = 200;

  Violations() = default;
  Violations(std::initializer_list<Violation> all) {
    for (const Violation& each : all) push_back(each);
  }

  void push_back(Violation violation) {
    if (kept_.size() < kMostKept) kept_.push_back(std::move(violation));
    ++size_;
  }
  void add(std::string field, std::string description) {
    push_back({std::move(field), std::move(description)});
  }
  /// Adds a violation whose description is fmt::format(format, first, others...).
  template <class First, class... Others>
  void add(std::string field, fmt::format_string<First, Others...> format, First&& first,
           Others&&... others) {
    add(std::move(field),
        fmt::format(format, std::forward<First>(first), std::forward<Others>(others)...));
  }
  /// Adds the kept violations of `others`, and the number of those that it did not keep.
  void append(const Violations& others) {
    for (const Violation& each : others) push_back(each);
    size_ += others.size_ - others.kept_.size();
  }
  void clear() { *this = {}; }

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  iterator begin() { return kept_.begin(); }
  iterator end() { return kept_.end(); }
  const_iterator begin() const { return kept_.begin(); }
  const_iterator end() const { return kept_.end(); }
  const Violation& front() const { return kept_.front(); }
  const Violation& operator[](std::size_t index) const { return kept_[index]; }

 private:
  std::vector<Violation> kept_;
  std::size_t size_ = 0;
};

/// Returns "prefix.field", or "field" if the prefix is empty.
inline std::string join_path(const std::string& prefix, const std::string& field) {
  return prefix.empty() ? field : prefix + "." + field;
}

}  // namespace tribodyn::server
