#include "server/storage/durable_files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

StoreError file_error(const std::string& what, const std::filesystem::path& file, int reason) {
  return {StoreError::Kind::kFailed,
          "cannot " + what + " " + file.string() + ": " + std::generic_category().message(reason)};
}

/// Syncs a file or a folder. Returns 0 or the error number.
int sync_path(const std::filesystem::path& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int reason = fsync(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  return reason;
}

}  // namespace

std::filesystem::path canonical_path(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path found = std::filesystem::weakly_canonical(path, ignored);
  return found.empty() ? path : found;
}

void sync_file(const std::filesystem::path& file) {
  const int reason = sync_path(file, O_RDONLY);
  if (reason != 0) throw file_error("write", file, reason);
}

void sync_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path parent = file.parent_path();
  const std::filesystem::path folder = parent.empty() ? "." : parent;
  const int reason = sync_path(folder, O_RDONLY | O_DIRECTORY);
  // EINVAL: the file system cannot sync folders.
  if (reason != 0 && reason != EINVAL) throw file_error("write folder", folder, reason);
}

bool add_name(const std::filesystem::path& file, const std::filesystem::path& name) {
  if (link(file.c_str(), name.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  throw file_error("keep " + file.string() + " as", name, errno);
}

void replace_file(const std::filesystem::path& file, std::string_view text, unsigned mode) {
  const std::filesystem::path unfinished = file.string() + ".new";
  unlink(unfinished.c_str());
  const int descriptor =
      open(unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
  if (descriptor < 0) throw file_error("write", file, errno);
  const bool is_written =
      write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      fdatasync(descriptor) == 0;
  const int reason = errno;
  close(descriptor);
  if (!is_written) throw file_error("write", file, reason);
  if (rename(unfinished.c_str(), file.c_str()) != 0) throw file_error("write", file, errno);
  sync_folder_of(file);
}

UnfinishedFile::UnfinishedFile(const std::filesystem::path& target) : target_(target) {
  std::string name = target.string() + ".new-XXXXXX";
  const int descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) throw file_error("make a file for", target, errno);
  close(descriptor);
  path_ = name;
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code ignored;
  for (const char* suffix : {"-journal", "-wal", "-shm"}) {
    std::filesystem::remove(path_.string() + suffix, ignored);
  }
  if (!is_published_) std::filesystem::remove(path_, ignored);
}

bool UnfinishedFile::publish_as_new() { return publish_as(target_); }

bool UnfinishedFile::publish_as(const std::filesystem::path& name) {
  sync_file(path_);
  if (renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, name.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno == EEXIST) return false;
    // Some file systems, e.g. NFS, have no rename that refuses to replace a file.
    if (errno != EINVAL && errno != ENOSYS) throw file_error("make", name, errno);
    if (!add_name(path_, name)) return false;
    unlink(path_.c_str());
  }
  is_published_ = true;
  try {
    sync_folder_of(name);
  } catch (const StoreError&) {
    unlink(name.c_str());
    throw;
  }
  return true;
}

void UnfinishedFile::publish_over() {
  sync_file(path_);
  if (rename(path_.c_str(), target_.c_str()) != 0) throw file_error("replace", target_, errno);
  is_published_ = true;
  sync_folder_of(target_);
}

}  // namespace tribodyn::server
