#include "server/storage/database_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

/// Returns " (process 123)" from the contents of a lock file, or an empty string if the file has
/// none.
std::string holder(const std::filesystem::path& lock_file) {
  const int descriptor = open(lock_file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {};
  std::array<char, 32> text{};
  const ssize_t length = pread(descriptor, text.data(), text.size() - 1, 0);
  close(descriptor);
  std::string pid(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  while (!pid.empty() && pid.back() == '\n') pid.pop_back();
  return pid.empty() ? "" : " (process " + pid + ")";
}

std::filesystem::path lock_file_of(const std::filesystem::path& database) {
  return database.string() + ".lock";
}

}  // namespace

DatabaseLock::DatabaseLock(const std::filesystem::path& database) : database_(database) {
  lock_file_ = lock(lock_file_of(database_), O_RDWR | O_CREAT);
  try {
    if (std::filesystem::exists(database_)) lock_new_file();
  } catch (...) {
    close(lock_file_);
    throw;
  }
  const std::string pid = std::to_string(getpid()) + "\n";
  if (ftruncate(lock_file_, 0) != 0 ||
      pwrite(lock_file_, pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size())) {
    // A failure is ignored: the number only appears in the error of a second server.
  }
}

DatabaseLock::~DatabaseLock() {
  if (database_file_ >= 0) close(database_file_);
  close(lock_file_);
}

void DatabaseLock::lock_new_file() {
  if (database_file_ < 0) database_file_ = lock(database_, O_RDONLY);
}

int DatabaseLock::lock(const std::filesystem::path& file, int flags) const {
  const int descriptor = open(file.c_str(), flags | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    throw StoreError(StoreError::Kind::kCannotOpen, "cannot open " + file.string() + ": " +
                                                        std::generic_category().message(errno));
  }
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  const int reason = errno;
  close(descriptor);
  if (reason == EWOULDBLOCK) {
    throw StoreError(StoreError::Kind::kInUse, "database " + database_.string() +
                                                   " is in use by another tribodynd" +
                                                   holder(lock_file_of(database_)));
  }
  throw StoreError(StoreError::Kind::kCannotOpen,
                   "cannot lock " + file.string() + ": " + std::generic_category().message(reason));
}

}  // namespace tribodyn::server
