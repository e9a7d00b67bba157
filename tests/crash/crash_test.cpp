// Clients work while the server is killed repeatedly: afterwards the server must keep every promise
// that violations() lists. seeded_bugs_test.cpp shows that broken promises are detected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "server/storage/maintenance.h"
#include "tests/crash/crash_run.h"
#include "tests/support/paths.h"
#include "tests/support/run_length.h"

namespace tribodyn::crash {
namespace {

using testing::IsEmpty;

constexpr int kClients = 8;
constexpr auto kPatience = std::chrono::minutes(1);

/// Returns the number of kills; TRIBODYN_CRASHES=200 is the full mode.
int crashes() {
  const char* chosen = std::getenv("TRIBODYN_CRASHES");
  if (chosen != nullptr) return std::atoi(chosen);
  return kUnderSanitizer ? 10 : 20;
}

TEST(CrashTest, NothingAcknowledgedIsLostHoweverOftenTheServerDies) {
  CrashRun run({server_program()}, kPatience);
  run.play(kClients, crashes());
  if (HasFatalFailure()) return;
  run.compute_undisturbed();
  const History& history = run.history();
  EXPECT_THAT(violations(history), IsEmpty());
  EXPECT_THAT(server::check_database(run.database()), IsEmpty());
  std::map<State, int> ends;
  int repeated = 0;
  for (const auto& [name, simulation] : history.simulations) {
    ++ends[simulation.state()];
    if (simulation.attempt() > 1) ++repeated;
  }
  RecordProperty("simulations", static_cast<int>(history.simulations.size()));
  RecordProperty("succeeded", ends[v1::Simulation::SUCCEEDED]);
  RecordProperty("cancelled", ends[v1::Simulation::CANCELLED]);
  RecordProperty("failed", ends[v1::Simulation::FAILED]);
  RecordProperty("run_again", repeated);
  RecordProperty("watches", static_cast<int>(history.watches.size()));
  EXPECT_GT(history.simulations.size(), 20U);
  EXPECT_GT(ends[v1::Simulation::SUCCEEDED], 10);
  EXPECT_GT(repeated, 0) << "no crash met a simulation that ran";
  const CampaignHistory& campaigns = history.campaigns;
  RecordProperty("campaigns", static_cast<int>(campaigns.campaigns.size()));
  RecordProperty("campaign_reads", static_cast<int>(campaigns.reads.size()));
  RecordProperty("appends", static_cast<int>(campaigns.acknowledged_appends.size()));
  EXPECT_GT(campaigns.campaigns.size(), 2U);
  EXPECT_FALSE(campaigns.acknowledged_appends.empty());
  EXPECT_FALSE(campaigns.reads.empty());
}

}  // namespace
}  // namespace tribodyn::crash
