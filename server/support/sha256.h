#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace tribodyn::server {

/// Computes a SHA-256 hash piece by piece. A copy continues from the state of the original. Not
/// safe for concurrent access.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256& other);
  Sha256& operator=(const Sha256&) = delete;

  /// Appends bytes to the hashed data.
  void add(std::string_view bytes);
  /// Returns the hash of all added bytes as 64 hexadecimal digits. The object must not be used
  /// afterwards.
  std::string finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Returns the SHA-256 hash of `bytes` as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// Returns the HMAC with SHA-256 of `bytes` under a key as 64 hexadecimal digits (RFC 2104).
std::string hmac_sha256(std::string_view key, std::string_view bytes);

}  // namespace tribodyn::server
