#include "server/simulation/result_key.h"

#include <gnu/libc-version.h>

#include "core/version.h"
#include "server/simulation/input_hash.h"

namespace tribodyn::server {
namespace {

std::string instruction_set() {
#if defined(__x86_64__)
  std::string out = "x86-64";
  if (__builtin_cpu_supports("avx512f") > 0) out += " avx512f";
  if (__builtin_cpu_supports("avx2") > 0) out += " avx2";
  if (__builtin_cpu_supports("fma") > 0) out += " fma";
  return out;
#elif defined(__aarch64__)
  return "aarch64";
#else
  return "unknown";
#endif
}

}  // namespace

const std::string& platform() {
  static const std::string kPlatform = instruction_set() + ", glibc " + gnu_get_libc_version();
  return kPlatform;
}

ResultKey result_key(const SimulationInputs& inputs) {
  return {input_hash(inputs), kModelVersion, platform()};
}

}  // namespace tribodyn::server
