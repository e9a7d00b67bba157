// Kills a server that has a bug while clients use it: the crash test must complain about each bug
// of seeded_bugs/*.patch. Without a chosen bug the same server must pass.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/crash/crash_run.h"
#include "tests/support/paths.h"

namespace tribodyn::crash {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kClientsOfABug = 8;
constexpr int kCrashesOfABug = 2;
constexpr int kRounds = 20;  // after them a bug counts as not found; most need one
constexpr auto kShortPatience = std::chrono::seconds(2);

struct Bug {
  std::string name;
  std::string complaint;  ///< complaint that the crash test must make
};

void PrintTo(const Bug& bug, std::ostream* out) { *out << bug.name; }

/// Returns the bugs of the patches. A patch without a complaint only prepares the others.
std::vector<Bug> bugs() {
  std::vector<Bug> out;
  for (const auto& entry : std::filesystem::directory_iterator(seeded_bugs_folder())) {
    if (entry.path().extension() != ".patch") continue;
    std::ifstream patch(entry.path());
    constexpr std::string_view kComplaint = "Complaint: ";
    for (std::string line; std::getline(patch, line);) {
      if (!line.starts_with(kComplaint)) continue;
      out.push_back({entry.path().stem().string(), line.substr(kComplaint.size())});
    }
  }
  std::sort(out.begin(), out.end(), [](const Bug& a, const Bug& b) { return a.name < b.name; });
  return out;
}

class SeededBug : public testing::TestWithParam<Bug> {};

TEST_P(SeededBug, IsFound) {
  const auto& [name, complaint] = GetParam();
  std::vector<std::string> complaints;
  const auto is_found = [&complaints, &complaint = GetParam().complaint] {
    return testing::Value(complaints, Contains(HasSubstr(complaint)));
  };
  for (int round = 0; round < kRounds; ++round) {
    CrashRun run({"/usr/bin/env", "TRIBODYN_SEEDED_BUG=" + name, seeded_server_program()},
                 kShortPatience);
    run.play(kClientsOfABug, kCrashesOfABug);
    if (HasFatalFailure()) return;
    RecordProperty("rounds", round + 1);
    complaints = violations(run.history());
    if (is_found()) return;
    run.compute_undisturbed();
    complaints = violations(run.history());
    if (is_found()) return;
  }
  EXPECT_THAT(complaints, Contains(HasSubstr(complaint))) << "the bug survived";
}

INSTANTIATE_TEST_SUITE_P(All, SeededBug, testing::ValuesIn(bugs()),
                         [](const auto& bug) { return bug.param.name; });

TEST(SeededBugs, AreWhatMakesTheServerFail) {
  CrashRun run({seeded_server_program()}, std::chrono::minutes(1));
  run.play(kClientsOfABug, kCrashesOfABug);
  if (HasFatalFailure()) return;
  run.compute_undisturbed();
  EXPECT_THAT(violations(run.history()), IsEmpty());
}

}  // namespace
}  // namespace tribodyn::crash
