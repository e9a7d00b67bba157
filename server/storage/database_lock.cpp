#include "server/storage/database_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>

#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

constexpr std::chrono::milliseconds kNoWait{0}, kBetweenTries{20};

/// A lock file holds two lines: the number of the process, and what it remembers.
struct LockFileText {
  std::string process, remembered;
};

LockFileText read_lock_file(const std::filesystem::path& lock_file) {
  LockFileText out;
  std::ifstream file(lock_file);
  std::getline(file, out.process);
  // Without its end, a line was cut off: the process was killed, or the power went.
  if (!std::getline(file, out.remembered) || file.eof()) out.remembered.clear();
  return out;
}

/// Returns " (process 123)" from a lock file, or an empty string if the file has no number.
std::string holder(const std::filesystem::path& lock_file) {
  const std::string process = read_lock_file(lock_file).process;
  return process.empty() ? "" : " (process " + process + ")";
}

std::filesystem::path lock_file_of(const std::filesystem::path& database) {
  return database.string() + ".lock";
}

}  // namespace

DatabaseLock::DatabaseLock(const std::filesystem::path& database, std::chrono::milliseconds wait)
    : database_(database), wait_(wait) {
  lock_file_ = lock(lock_file_of(database_), O_RDWR | O_CREAT);
  try {
    if (std::filesystem::exists(database_)) lock_new_file();
  } catch (...) {
    close(lock_file_);
    throw;
  }
  remember(remembered(database_));  // with the number of this process
}

DatabaseLock::~DatabaseLock() {
  if (database_file_ >= 0) close(database_file_);
  close(lock_file_);
}

void DatabaseLock::lock_new_file() {
  if (database_file_ < 0) database_file_ = lock(database_, O_RDONLY);
}

void DatabaseLock::remember(const std::string& line) {
  std::string text = std::to_string(getpid()) + "\n";
  if (!line.empty()) text += line + "\n";
  if (ftruncate(lock_file_, 0) != 0 ||
      pwrite(lock_file_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) ||
      fdatasync(lock_file_) != 0) {
    // The number only completes a message, and the line serves a check that may go without it.
  }
}

std::string DatabaseLock::remembered(const std::filesystem::path& database) {
  return read_lock_file(lock_file_of(database)).remembered;
}

int DatabaseLock::lock(const std::filesystem::path& file, int flags) const {
  const int descriptor = open(file.c_str(), flags | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    throw StoreError(StoreError::Kind::kCannotOpen, "cannot open " + file.string() + ": " +
                                                        std::generic_category().message(errno));
  }
  int reason = 0;
  for (auto waited = kNoWait; reason == 0; waited += kBetweenTries) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
    if (errno != EWOULDBLOCK || waited >= wait_) reason = errno;
    if (reason == 0) std::this_thread::sleep_for(kBetweenTries);
  }
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
