#include "server/storage/session_file.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "server/storage/durable_files.h"
#include "server/storage/store_error.h"
#include "server/support/random_bytes.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 64;  // of a key and of the name of a session

StoreError failed(const fs::path& path, const std::string& why) {
  return {StoreError::Kind::kCannotOpen, "session file " + path.string() + " " + why};
}

StoreError failed_now(const fs::path& path, const char* what) {
  return failed(path,
                std::string("cannot be ") + what + ": " + std::generic_category().message(errno));
}

fs::path path_of(const fs::path& database) { return database.string() + ".sessions"; }

/// Closes its descriptor.
struct OpenFile {
  int descriptor;
  ~OpenFile() {
    if (descriptor >= 0) close(descriptor);
  }
};

/// Appends a text, and waits until it is on disk. Returns false if it is not.
bool append(int file, const std::string& text) {
  return write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
         fdatasync(file) == 0;
}

std::string new_key() { return sha256(random_bytes(32)); }

}  // namespace

SessionFile::SessionFile(const fs::path& database, Microseconds now) : path_(path_of(database)) {
  if (!fs::exists(fs::symlink_status(path_))) replace_file(path_, new_key() + "\n");
  const std::lock_guard lock(mutex_);
  read();
  if (std::erase_if(ended_, [now](const auto& each) { return each.second <= now; }) == 0) return;
  std::string text = key_ + "\n";
  for (const auto& [session, end] : ended_) text += session + " " + std::to_string(end) + "\n";
  replace_file(path_, text);
  read();
}

void SessionFile::renew(const fs::path& database) {
  replace_file(path_of(database), new_key() + "\n");
}

/// Reads the file. Requires mutex_. Throws StoreError, and then changes nothing.
void SessionFile::read() {
  const OpenFile file{open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  struct stat found {};
  if (file.descriptor < 0 || fstat(file.descriptor, &found) != 0) throw failed_now(path_, "read");
  if (!S_ISREG(found.st_mode) || found.st_uid != geteuid() || (found.st_mode & 077) != 0) {
    throw failed(path_,
                 "may be read or written by others; remove it: the server makes a new one, and "
                 "all sessions end");
  }
  std::string text(static_cast<std::size_t>(found.st_size), '\0');
  const ssize_t count = ::read(file.descriptor, text.data(), text.size());
  if (count < 0) throw failed_now(path_, "read");
  text.resize(static_cast<std::size_t>(count));
  std::istringstream lines(text);
  std::string key, session;
  std::map<std::string, Microseconds> ended;
  lines >> key;
  for (Microseconds end = 0; lines >> session >> end;) ended[session] = end;
  if (key.size() != kDigits) {
    throw failed(path_, "holds no key; remove it: the server makes a new one");
  }
  key_ = std::move(key);
  ended_ = std::move(ended);
  inode_ = found.st_ino;
}

/// Reads the file again if it was replaced. Requires mutex_.
void SessionFile::refresh() {
  struct stat found {};
  if (stat(path_.c_str(), &found) != 0 || found.st_ino == inode_) return;
  try {
    read();
  } catch (const StoreError& error) {
    spdlog::error("{}", error.what());
    key_ = new_key();  // whatever the former key sealed is over
    inode_ = found.st_ino;
  }
}

std::string SessionFile::key() {
  const std::lock_guard lock(mutex_);
  refresh();
  return key_;
}

bool SessionFile::has_ended(const std::string& session) {
  const std::lock_guard lock(mutex_);
  return ended_.contains(session);
}

void SessionFile::end(const std::string& session, Microseconds expire_time) {
  const std::lock_guard lock(mutex_);
  refresh();
  if (!ended_.emplace(session, expire_time).second) return;
  const OpenFile file{open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW)};
  if (file.descriptor < 0 ||
      !append(file.descriptor, session + " " + std::to_string(expire_time) + "\n")) {
    throw failed_now(path_, "written");
  }
}

}  // namespace tribodyn::server
