#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// A hash in the making. A copy goes on from where the original stands. Not safe for concurrent
/// access.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256& other);
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view bytes);
  /// Of all that was added, as 64 hex digits; the end of the object's use.
  std::string finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// SHA-256 of bytes, as 64 hex digits.
std::string sha256(std::string_view bytes);

}  // namespace tribodyn::server
