#include "server/store/database_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "server/store/store_error.h"

namespace tribodyn::server {
namespace {

std::string holder(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t length = pread(descriptor, text.data(), text.size() - 1, 0);
  std::string pid(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  while (!pid.empty() && pid.back() == '\n') pid.pop_back();
  return pid.empty() ? "" : " (process " + pid + ")";
}

}  // namespace

DatabaseLock::DatabaseLock(const std::filesystem::path& database) {
  const std::string path = database.string() + ".lock";
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor_ < 0) {
    throw StoreError(StoreError::Kind::kCannotOpen,
                     "cannot open " + path + ": " + std::generic_category().message(errno));
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    const std::string other = holder(descriptor_);
    close(descriptor_);
    if (reason == EWOULDBLOCK) {
      throw StoreError(StoreError::Kind::kInUse,
                       "database " + database.string() + " is in use by another tribodynd" + other);
    }
    throw StoreError(StoreError::Kind::kCannotOpen,
                     "cannot lock " + path + ": " + std::generic_category().message(reason));
  }
  const std::string pid = std::to_string(getpid()) + "\n";
  if (ftruncate(descriptor_, 0) != 0 ||
      pwrite(descriptor_, pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size())) {
    // Only the hint in the other server's message is lost.
  }
}

DatabaseLock::~DatabaseLock() { close(descriptor_); }

}  // namespace tribodyn::server
