#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>

#include "server/storage/connection.h"

struct sqlite3;

namespace tribodyn::server {

/// Copies the write-ahead log of a database into the database (a passive checkpoint) on a thread of
/// its own, beside the commits of the writer. SQLite by itself does so within the commit that fills
/// the log, and every call that waits for the writer then waits for the copy. A checkpoint that
/// fails is tried again when the log has grown further.
class Checkpointer {
 public:
  /// Length of the log at which the thread begins to copy, and between two copies [pages of 4 KiB].
  /// The disk makes commits wait for a copy too, so that many short ones are better than a long
  /// one: beside a campaign the 99th percentile of an interactive job was 38 ms above that of an
  /// idle server with 1000 pages (49 ms by SQLite itself), 32 ms with 250 and 31 ms with 100 (two
  /// cores, means of four and more runs).
  static constexpr int kPages = 250;
  /// Length of the log from which on a commit waits for the thread and copies what is left, so that
  /// the log stays bounded while commits follow one another without a pause [pages].
  static constexpr int kMostPages = 4000;

  /// Opens a connection of its own. `writer` must outlive the object. Throws SQLite::Exception.
  Checkpointer(const std::filesystem::path& database, Connection& writer);
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;

 private:
  /// SQLite calls this function after each commit of the writer, on the thread of the commit.
  static int after_commit(void* self, sqlite3* writer, const char* schema, int pages);
  void run();

  Connection& writer_;
  Connection connection_;
  int last_pages_ = 0;       // of the log after the latest commit; used by commits alone
  int next_pages_ = kPages;  // at which the next copy begins; likewise
  std::mutex copy_mutex_;    // of a checkpoint: SQLite refuses a second one meanwhile
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_wanted_ = false;  // guarded by mutex_
  bool is_ending_ = false;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace tribodyn::server
