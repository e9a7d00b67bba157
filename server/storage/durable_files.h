#pragma once

#include <filesystem>
#include <string_view>

namespace tribodyn::server {

// File operations of backup and restore. Their effects survive a loss of power. All throw
// StoreError kFailed with a sentence that names the file.

/// Returns the path of a file with all symbolic links resolved, so that two spellings of one path
/// are equal.
std::filesystem::path canonical_path(const std::filesystem::path& path);

/// Syncs the contents of a file.
void sync_file(const std::filesystem::path& file);

/// Syncs the folder of `file`, and thus the names of its files.
void sync_folder_of(const std::filesystem::path& file);

/// Gives a file a second name (a hard link). Returns false if that name is taken.
bool add_name(const std::filesystem::path& file, const std::filesystem::path& name);

/// Replaces a file atomically by one with this text and mode, on disk when the call returns. It
/// follows no link.
void replace_file(const std::filesystem::path& file, std::string_view text, unsigned mode = 0600);

/// A new file that will become `target`. The constructor creates it empty beside `target` under an
/// unused name ("<target>.new-XXXXXX"). The destructor removes it, unless it was published, and the
/// files that SQLite left beside it.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& target);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Syncs the file and renames it to `target` atomically. Returns false, and changes nothing, if
  /// `target` exists.
  bool publish_as_new();
  /// Like publish_as_new(), with another name in the same folder.
  bool publish_as(const std::filesystem::path& name);
  /// Syncs the file and renames it to `target` atomically, over an existing file.
  void publish_over();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  bool is_published_ = false;
};

}  // namespace tribodyn::server
