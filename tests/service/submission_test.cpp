// What the submission of a simulation reads and commits: no row twice, one commit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <string>
#include <vector>

#include "server/application/simulations.h"
#include "server/storage/connections.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

thread_local std::vector<std::string>* recorded = nullptr;

/// Records the statements that this thread runs, with their values, on connections that are opened
/// while the object exists. Triggers are not recorded.
class StatementTrace {
 public:
  StatementTrace() {
    configure_sqlite();
    sqlite3_auto_extension(reinterpret_cast<void (*)()>(&trace));
  }
  ~StatementTrace() {
    recorded = nullptr;
    sqlite3_cancel_auto_extension(reinterpret_cast<void (*)()>(&trace));
  }
  StatementTrace(const StatementTrace&) = delete;
  StatementTrace& operator=(const StatementTrace&) = delete;

  template <class Action>
  std::vector<std::string> of(const Action& action) {
    std::vector<std::string> out;
    recorded = &out;
    action();
    recorded = nullptr;
    return out;
  }

 private:
  static int trace(sqlite3* db, char**, const void*) {
    return sqlite3_trace_v2(
        db, SQLITE_TRACE_STMT,
        [](unsigned int, void*, void* statement, void* text) {
          const bool is_trigger = std::string(static_cast<const char*>(text)).starts_with("--");
          if (recorded == nullptr || is_trigger) return 0;
          char* sql = sqlite3_expanded_sql(static_cast<sqlite3_stmt*>(statement));
          recorded->emplace_back(sql);
          sqlite3_free(sql);
          return 0;
        },
        nullptr);
  }
};

/// Returns what each statement that only reads looks for.
std::vector<std::string> reads_of(const std::vector<std::string>& statements) {
  std::vector<std::string> out;
  for (const std::string& sql : statements) {
    if (!sql.starts_with("SELECT")) continue;
    const auto value = [&](const std::string& before) {
      const std::size_t begin = sql.rfind(before) + before.size();
      return sql.substr(begin, sql.find('\'', begin) - begin);
    };
    if (sql.find("FROM resources r JOIN revisions v ON v.id = r.present") != std::string::npos) {
      out.push_back(value("r.name = '"));
    } else if (sql.find("FROM results WHERE project = 'default' AND input_hash") !=
               std::string::npos) {
      out.push_back("result of equal inputs");
    } else if (sql.find("FROM ledgers WHERE content_hash") != std::string::npos) {
      out.push_back("assumptions");
    } else if (sql.find("FROM simulations WHERE project = 'default' AND request_id") !=
               std::string::npos) {
      out.push_back("simulation of request_id " + value("request_id = '"));
    } else {
      out.push_back(sql);
    }
  }
  return out;
}

class Submission : public testing::Test {
 protected:
  std::vector<std::string> statements(const std::string& request_id = "") {
    v1::CreateSimulationRequest request;
    *request.mutable_simulation() = point_simulation();
    request.set_request_id(request_id);
    return trace_.of([&] { answer_ = create_simulation(app_, request).message(); });
  }
  static std::vector<std::string> resources() {
    const v1::Simulation simulation = point_simulation();
    return {simulation.lubricant(), kDefaultGearSet, kDefaultSurface, kDefaultVehicle};
  }
  static long commits(const std::vector<std::string>& statements) {
    return std::count(statements.begin(), statements.end(), "COMMIT");
  }

  StatementTrace trace_;
  Bench bench_;
  Application app_ = bench_.application();
  v1::Simulation answer_;
};

TEST_F(Submission, ReadsEachRowOnceAndCommitsOnce) {
  const auto first = statements();
  std::vector<std::string> expected = resources();
  expected.insert(expected.end(), {"result of equal inputs", "assumptions"});
  EXPECT_THAT(reads_of(first), ElementsAreArray(expected));
  EXPECT_EQ(commits(first), 1);
  EXPECT_EQ(answer_.state(), v1::Simulation::QUEUED);

  ASSERT_TRUE(bench_.reaches(answer_.name(), v1::Simulation::SUCCEEDED));
  const auto cached = statements();
  EXPECT_THAT(reads_of(cached), ElementsAreArray(expected));
  EXPECT_EQ(commits(cached), 1);
  EXPECT_EQ(answer_.state(), v1::Simulation::SUCCEEDED);
  v1::Simulation kept = bench_.get(answer_.name());
  kept.clear_result();
  EXPECT_EQ(answer_.DebugString(), kept.DebugString()) << "nothing is read to answer";
}

TEST_F(Submission, LooksForARequestIdOnceMoreInTheTransaction) {
  const auto first = statements("once");
  std::vector<std::string> expected = {"simulation of request_id once"};
  const auto named = resources();
  expected.insert(expected.end(), named.begin(), named.end());
  // Neither look finds a row. The second one finds it if the same request came twice at a time.
  expected.insert(expected.end(),
                  {"simulation of request_id once", "result of equal inputs", "assumptions"});
  EXPECT_THAT(reads_of(first), ElementsAreArray(expected));
  EXPECT_EQ(commits(first), 1);

  ASSERT_TRUE(bench_.reaches(answer_.name(), v1::Simulation::SUCCEEDED));
  const std::string name = answer_.name();
  const auto repeated = statements("once");
  EXPECT_THAT(reads_of(repeated), ElementsAre("simulation of request_id once"));
  EXPECT_EQ(commits(repeated), 0);
  EXPECT_EQ(answer_.name(), name);
}

TEST_F(Submission, IsRefusedByAReadThatWaitsForNoCommit) {
  AddOutcome added;
  const NewSimulation simulation{.request = "request",
                                 .key = {std::string(64, 'a'), "model", "platform"}};
  const auto refused =
      trace_.of([&] { added = app_.store.add_simulation(simulation, 0, /*may_wait=*/false); });
  EXPECT_EQ(added.kind, AddOutcome::Kind::kNoPlace);
  EXPECT_THAT(reads_of(refused), ElementsAre("result of equal inputs"));
  EXPECT_EQ(refused.size(), 1u) << "no transaction";
}

}  // namespace
}  // namespace tribodyn::server
