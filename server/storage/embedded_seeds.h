#pragma once

#include <span>
#include <string_view>

namespace tribodyn::server {

/// One file of server/seeds, as the build read it (embed_seeds.cmake).
struct EmbeddedSeed {
  std::string_view file;  ///< name without folder
  std::string_view json;
};

std::span<const EmbeddedSeed> embedded_seeds();

}  // namespace tribodyn::server
