// Tests that interrupted downloads resume.
#include "client/cpp/report/history_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <sstream>

namespace tribodyn::client {
namespace {

class HistoryFileTest : public testing::TestWithParam<HistoryFile::Format> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / "tribodyn-history-file-test";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  HistoryFile open(const std::string& name,
                   const std::string& identity = "0123456789abcdef") const {
    return {(folder_ / name).string(), GetParam(), identity, {"time_seconds", "b"}, 4};
  }
  static HistoryRows rows(double first, int count) {
    HistoryRows out{0, {{}, {}}};
    for (int i = 0; i < count; ++i) {
      out.columns[0].push_back(first + i);
      out.columns[1].push_back(-0.1 * (first + i));
    }
    return out;
  }
  std::string text(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return out.str();
  }

  std::filesystem::path folder_;
};

TEST_P(HistoryFileTest, ResumesAfterItsLastCompleteRow) {
  HistoryFile whole = open("whole");
  whole.add(rows(0, 4));
  whole.finish();
  {
    HistoryFile begun = open("resumed");
    EXPECT_EQ(begun.rows_there(), 0);
    begun.add(rows(0, 2));
  }
  const auto part = folder_ / "resumed.0123456789ab.part";
  std::ofstream(part, std::ios::app | std::ios::binary) << "2,";  // half a row
  EXPECT_FALSE(std::filesystem::exists(folder_ / "resumed"));
  EXPECT_EQ(open("resumed", "another history").rows_there(), 0);
  HistoryFile resumed = open("resumed");
  EXPECT_EQ(resumed.rows_there(), 2);
  resumed.add(rows(2, 2));
  resumed.finish();
  EXPECT_EQ(text("resumed"), text("whole"));
  EXPECT_FALSE(std::filesystem::exists(part));
}

INSTANTIATE_TEST_SUITE_P(Formats, HistoryFileTest,
                         testing::Values(HistoryFile::Format::kCsv, HistoryFile::Format::kNumpy));

TEST(NumpyFile, HasTheLayoutThatNumpyReads) {
  const auto path = std::filesystem::temp_directory_path() / "tribodyn-numpy-test.npy";
  HistoryFile file(path.string(), HistoryFile::Format::kNumpy, "identity", {"a", "b"}, 2);
  file.add({0, {{1, 2}, {3, 4}}});
  file.finish();
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  std::filesystem::remove(path);
  const std::string bytes = out.str();
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t header =
      10 + static_cast<unsigned char>(bytes[8]) + 256 * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ(header % 64, 0U);
  EXPECT_NE(bytes.find("{'descr': [('a', '<f8'), ('b', '<f8'), ], 'fortran_order': False, "
                       "'shape': (2,), }"),
            std::string::npos);
  ASSERT_EQ(bytes.size(), header + 32);
  double values[4];
  std::memcpy(values, bytes.data() + header, sizeof(values));
  EXPECT_EQ(values[1], 3) << "row by row";
}

}  // namespace
}  // namespace tribodyn::client
