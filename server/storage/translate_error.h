#pragma once

#include <SQLiteCpp/Exception.h>

#include <filesystem>

#include "server/storage/store_error.h"

namespace tribodyn::server {

/// A failure of SQLite as a sentence for the person who runs the server.
StoreError translate_error(const SQLite::Exception& error, const std::filesystem::path& path);

}  // namespace tribodyn::server
