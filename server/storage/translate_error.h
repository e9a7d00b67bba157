#pragma once

#include <SQLiteCpp/Exception.h>

#include <filesystem>

#include "server/storage/store_error.h"

namespace tribodyn::server {

/// Converts an error of SQLite to a StoreError whose sentence is for the operator.
StoreError translate_error(const SQLite::Exception& error, const std::filesystem::path& path);

}  // namespace tribodyn::server
