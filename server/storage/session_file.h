#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "server/storage/times.h"

namespace tribodyn::server {

/// The key that seals the sessions of browsers, and the sessions that were ended before their time:
/// in "<database>.sessions", readable by its owner alone, so that nothing in a database or a backup
/// opens a session. Whoever replaces the file, in any process, ends all sessions. Safe for
/// concurrent access.
class SessionFile {
 public:
  /// Reads the file; makes it with a new key if there is none. Throws StoreError.
  explicit SessionFile(const std::filesystem::path& database, Microseconds now);

  /// Replaces the file by one with a new key. Throws StoreError.
  static void renew(const std::filesystem::path& database);

  /// Returns the present key.
  std::string key();
  /// Returns true if the session was ended; `session`: 64 hexadecimal digits that name it.
  bool has_ended(const std::string& session);
  /// Ends a session that would expire at `expire_time`. It is on disk when the call returns. Throws
  /// StoreError, and then does so in memory only.
  void end(const std::string& session, Microseconds expire_time);

 private:
  void read();
  void refresh();

  const std::filesystem::path path_;
  std::mutex mutex_;
  std::string key_;                            // guarded by mutex_, as all below
  std::map<std::string, Microseconds> ended_;  // until their own end
  ino_t inode_ = 0;
};

}  // namespace tribodyn::server
