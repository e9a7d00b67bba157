#pragma once

#include <filesystem>

namespace tribodyn::server {

// File operations of backup and restore, whose effect outlasts a loss of power. All of them throw
// StoreError kFailed with a sentence that names the file.

/// The path of a file with all symbolic links resolved, so that two spellings of one path agree.
std::filesystem::path canonical_path(const std::filesystem::path& path);

/// Writes the contents of a file to disk.
void sync_file(const std::filesystem::path& file);

/// Writes to disk which names the folder of `file` holds.
void sync_folder_of(const std::filesystem::path& file);

/// Gives a file a second name (a hard link). Returns false if that name is taken.
bool add_name(const std::filesystem::path& file, const std::filesystem::path& name);

/// A file under construction that is to become `target`. It starts empty, beside `target`, under a
/// name that no file had ("<target>.new-XXXXXX"), and the destructor removes it, unless one of the
/// publishing functions has renamed it, and what SQLite left beside it.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& target);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Syncs the file and renames it to `target` in one step. Returns false, and changes nothing, if
  /// a file of that name exists.
  bool publish_as_new();
  /// As publish_as_new, under another name in the same folder.
  bool publish_as(const std::filesystem::path& name);
  /// Syncs the file and renames it to `target` in one step; a file of that name loses the name.
  void publish_over();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  bool is_published_ = false;
};

}  // namespace tribodyn::server
