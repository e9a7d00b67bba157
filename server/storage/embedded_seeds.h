#pragma once

#include <span>
#include <string_view>

namespace tribodyn::server {

/// One file of server/seeds, embedded at build time (embed_seeds.cmake).
struct EmbeddedSeed {
  std::string_view file;  ///< file name without folder
  std::string_view json;
};

std::span<const EmbeddedSeed> embedded_seeds();

}  // namespace tribodyn::server
