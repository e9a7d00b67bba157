// The write-ahead log is copied into the database beside the commits, and stays bounded.
#include "server/storage/checkpointer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

constexpr std::uintmax_t kPageBytes = 4096;

class CheckpointerTest : public testing::Test {
 protected:
  CheckpointerTest() : writer_(database_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, 5000) {
    writer_.execAndGet("PRAGMA journal_mode = WAL");
    writer_.exec("PRAGMA synchronous = OFF");  // of the writer alone: these tests lose no power
    writer_.exec("CREATE TABLE rows (id INTEGER PRIMARY KEY, body BLOB)");
  }

  /// Commits a row that takes about `pages` pages.
  void commit(int pages) {
    writer_.exec("INSERT INTO rows (body) VALUES (randomblob(" +
                 std::to_string(pages * static_cast<int>(kPageBytes)) + "))");
    ++rows_;
  }
  std::uintmax_t database_pages() const {
    return std::filesystem::file_size(database_) / kPageBytes;
  }
  std::uintmax_t log_pages() const {
    return std::filesystem::file_size(database_ + "-wal") / kPageBytes;
  }

  const TemporaryFolder folder_;
  const std::string database_ = folder_.file("rows.db");
  Connection writer_;
  int rows_ = 0;
};

TEST_F(CheckpointerTest, TheThreadCopiesTheLogWithoutAFurtherCommit) {
  const Checkpointer checkpointer(database_, writer_);
  for (int i = 0; i < 11; ++i) commit(Checkpointer::kPages / 10);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (database_pages() < Checkpointer::kPages && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GE(database_pages(), Checkpointer::kPages);
}

TEST_F(CheckpointerTest, AShortLogIsNotCopied) {
  const Checkpointer checkpointer(database_, writer_);
  for (int i = 0; i < 8; ++i) commit(Checkpointer::kPages / 10);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LT(database_pages(), 10);
}

TEST_F(CheckpointerTest, TheLogStaysBoundedWhileCommitsFollowWithoutAPause) {
  constexpr int kCommitPages = 50;
  {
    const Checkpointer checkpointer(database_, writer_);
    for (int i = 0; i < 10 * Checkpointer::kMostPages / kCommitPages; ++i) commit(kCommitPages);
    EXPECT_LE(log_pages(), Checkpointer::kMostPages + 4 * kCommitPages);
  }
  EXPECT_EQ(writer_.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(writer_.execAndGet("SELECT count(*) FROM rows").getInt(), rows_);
}

TEST_F(CheckpointerTest, AReaderThatHoldsTheLogLosesNothing) {
  const Checkpointer checkpointer(database_, writer_);
  commit(1);
  SQLite::Database reader(database_, SQLite::OPEN_READONLY);
  SQLite::Statement rows(reader, "SELECT id FROM rows");
  ASSERT_TRUE(rows.executeStep());  // holds its snapshot from here on
  for (int i = 0; i < 30; ++i) commit(Checkpointer::kPages / 10);
  EXPECT_FALSE(rows.executeStep());
  rows.reset();
  EXPECT_EQ(reader.execAndGet("SELECT count(*) FROM rows").getInt(), rows_);
}

}  // namespace
}  // namespace tribodyn::server
