#pragma once

#include <cstdint>

namespace tribodyn {

/// Random words of 64 bits. SplitMix64: G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014, 453-472.
/// The standard library's distributions and std::shuffle differ from platform to platform.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }

 private:
  std::uint64_t state_;
};

}  // namespace tribodyn
