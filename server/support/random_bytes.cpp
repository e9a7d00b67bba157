#include "server/support/random_bytes.h"

#include <unistd.h>

#include <stdexcept>

namespace tribodyn::server {

std::string random_bytes(std::size_t count) {
  std::string out(count, '\0');
  if (getentropy(out.data(), count) != 0) throw std::runtime_error("no random bytes to be had");
  return out;
}

}  // namespace tribodyn::server
