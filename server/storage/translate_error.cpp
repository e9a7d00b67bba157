#include "server/storage/translate_error.h"

#include <sqlite3.h>

namespace tribodyn::server {

StoreError translate_error(const SQLite::Exception& error, const std::filesystem::path& path) {
  const std::string name = "database " + path.string();
  switch (error.getErrorCode()) {
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      return {StoreError::Kind::kCorrupt,
              name + " is damaged or not a SQLite database: " + error.what()};
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return {StoreError::Kind::kReadOnly, name + " cannot be written: " + error.what()};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {StoreError::Kind::kInUse, name + " is locked by another program: " + error.what()};
    case SQLITE_CANTOPEN:
      return {StoreError::Kind::kCannotOpen, name + " cannot be opened: " + error.what()};
    case SQLITE_FULL:
      return {StoreError::Kind::kFull, name + ": " + error.what()};
    default:
      return {StoreError::Kind::kFailed, name + ": " + error.what()};
  }
}

}  // namespace tribodyn::server
