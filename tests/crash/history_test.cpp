// Tests the checker of the crash test with histories that have exactly one fault: it must make
// exactly the fitting complaint, and none about a history without faults.
#include "tests/crash/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <utility>

namespace tribodyn::crash {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr State kQueued = v1::Simulation::QUEUED;
constexpr State kRunning = v1::Simulation::RUNNING;
constexpr State kSucceeded = v1::Simulation::SUCCEEDED;
constexpr State kFailed = v1::Simulation::FAILED;
constexpr State kCancelled = v1::Simulation::CANCELLED;

/// Adds a simulation in the state of its last event.
v1::Simulation& add(History& history, const std::string& name, const std::string& request_id,
                    std::vector<SeenEvent> events) {
  v1::Simulation& simulation = history.simulations[name];
  simulation.set_name(name);
  simulation.set_request_id(request_id);
  simulation.set_state(events.back().state);
  simulation.set_attempt(events.back().attempt);
  simulation.set_event_sequence(events.back().sequence);
  history.events[name] = std::move(events);
  ++history.requests;
  return simulation;
}

void set_result(v1::Simulation& simulation, const std::string& hash, double speed) {
  simulation.set_input_hash(hash);
  simulation.mutable_result()->set_input_hash(hash);
  simulation.mutable_result()->clear_points();
  simulation.mutable_result()->add_points()->set_speed_kilometres_per_hour(speed);
}

/// The bits of a row with one figure beside refusal_number.
std::string bits_of_row(double figure) {
  const double row[] = {0, figure};
  return {reinterpret_cast<const char*>(row), sizeof row};
}

/// Adds a campaign of scene 4 at two conditions; one that has succeeded has all rows.
void add_campaign(History& history, const std::string& name, v1::Campaign::State state,
                  int candidates) {
  CampaignHistory& campaigns = history.campaigns;
  v1::Campaign& campaign = campaigns.campaigns[name];
  campaign.set_name(name);
  campaign.set_request_id("campaign-0-" + std::to_string(name.back() - '1'));
  campaign.set_state(state);
  campaign.set_candidates(candidates);
  campaign.set_points(2 * candidates);
  v1::CandidateColumn& column = *campaign.add_candidate_columns();
  for (int i = 0; i < candidates; ++i) column.add_values(candidate_value(4, i));
  if (state != v1::Campaign::SUCCEEDED) return;
  campaign.set_points_done(campaign.points());
  for (int i = 0; i < campaign.points(); ++i) campaigns.rows[name][i] = bits_of_row(0.5 * i);
}

/// Adds a campaign that was extended and read, one that was cancelled and one that was deleted.
void add_campaigns(History& history) {
  CampaignHistory& campaigns = history.campaigns;
  add_campaign(history, "campaigns/1", v1::Campaign::SUCCEEDED,
               kFirstCandidates + kAppendedCandidates);
  add_campaign(history, "campaigns/2", v1::Campaign::CANCELLED, kFirstCandidates);
  campaigns.requests = 3;
  campaigns.found = campaigns.campaigns;
  campaigns.made = {{"campaign-0-0", "campaigns/1", 4},
                    {"campaign-0-0", "campaigns/1", 4},
                    {"campaign-0-1", "campaigns/2", 4},
                    {"campaign-0-2", "campaigns/3", 4}};
  campaigns.sent_appends["campaigns/1"] = 2;
  campaigns.acknowledged_appends["campaigns/1"] = 1;
  campaigns.ended = {{"campaigns/2", v1::Campaign::CANCELLED}};
  campaigns.sent_deletions = campaigns.deleted = {"campaigns/3"};
  campaigns.reads = {{"campaigns/1", {{7, bits_of_row(3.5)}}},
                     {"campaigns/3", {{1, bits_of_row(0.5)}}}};
  for (int i = 0; i < 900; ++i) campaigns.undisturbed[4][i] = bits_of_row(0.5 * i);
}

/// Returns a history with everything that may happen without a fault: a simulation runs again after
/// a crash, is served from the cache, is cancelled, fails after too many crashes or at its
/// deadline, is requested twice, is never acknowledged; an update is not acknowledged; a batch has
/// an effect or none.
History faultless() {
  History history;
  add_campaigns(history);
  const std::vector<SeenEvent> run_again = {
      {1, kQueued, 1}, {2, kRunning, 1}, {3, kQueued, 2}, {4, kRunning, 2}, {5, kSucceeded, 2}};
  set_result(add(history, "simulations/1", "0-0", run_again), "hash of 7", 65);
  set_result(add(history, "simulations/2", "0-1", {{1, kQueued, 1}, {2, kSucceeded, 1}}),
             "hash of 7", 65);
  add(history, "simulations/3", "1-0", {{1, kQueued, 1}, {2, kRunning, 1}, {3, kCancelled, 1}});
  add(history, "simulations/4", "1-1", {{1, kQueued, 1}, {2, kRunning, 1}, {3, kFailed, 1}})
      .mutable_error()
      ->set_reason("WORKER_LOST");
  set_result(
      add(history, "simulations/5", "1-2", {{1, kQueued, 1}, {2, kRunning, 1}, {3, kSucceeded, 1}}),
      "hash of 8", 66);
  ++history.requests;  // a request that the server never received
  history.submissions = {{"0-0", "simulations/1", "7"},
                         {"0-0", "simulations/1", "7"},
                         {"0-1", "simulations/2", "7"},
                         {"1-0", "simulations/3", "9"},
                         {"1-1", "simulations/4", "9"}};
  history.ended = {{"simulations/1", kSucceeded}, {"simulations/3", kCancelled}};
  history.watches = {{"simulations/1", 0, run_again},
                     {"simulations/1", 3, {{4, kRunning, 2}, {5, kSucceeded, 2}}},
                     {"simulations/3", 0, {{1, kQueued, 1}, {2, kRunning, 1}}},
                     {"simulations/4", 0, {}}};
  history.histories = {{"simulations/1", "rows"}, {"simulations/2", "rows"}};
  history.undisturbed["7"] = result_bits(history.simulations["simulations/1"]) + "rows";
  v1::Simulation& late =
      add(history, "simulations/late", "1-3", {{1, kQueued, 1}, {2, kFailed, 1}});
  late.mutable_error()->set_reason("DEADLINE_EXCEEDED");
  late.mutable_deadline_time()->set_seconds(100);
  late.mutable_end_time()->set_seconds(100);
  history.kept_revisions = {{"lubricants/a@1", "0"},
                            {"lubricants/a@2", "1"},
                            {"lubricants/a@3", "2"},
                            {"lubricants/b@1", "0"},
                            {"lubricants/c@1", "0"}};
  history.revisions = {{"lubricants/a@1", "0"}, {"lubricants/a@3", "2"}};
  history.batches = {{{"lubricants/b", "lubricants/c"}, true},
                     {{"lubricants/d", "lubricants/e"}, false}};
  return history;
}

TEST(CrashHistory, WithoutAFaultCausesNoComplaint) {
  EXPECT_THAT(violations(faultless()), IsEmpty());
}

struct Fault {
  std::string name;
  std::function<void(History&)> plant;
  std::string complaint;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.complaint; }

class CrashHistoryFault : public testing::TestWithParam<Fault> {};

TEST_P(CrashHistoryFault, CausesExactlyItsComplaint) {
  History history = faultless();
  GetParam().plant(history);
  EXPECT_THAT(violations(history), ElementsAre(GetParam().complaint));
}

/// Replaces the events of a simulation and sets its state to that of the last one.
void set_events(History& history, const std::string& name, std::vector<SeenEvent> events) {
  v1::Simulation& simulation = history.simulations[name];
  simulation.set_state(events.back().state);
  simulation.set_attempt(events.back().attempt);
  simulation.set_event_sequence(events.back().sequence);
  history.events[name] = std::move(events);
}

const std::vector<Fault> kFaults = {
    {"AcknowledgedSimulationIsLost",
     [](History& history) {
       history.simulations.erase("simulations/4");
       history.events.erase("simulations/4");
     },
     "simulations/4 was acknowledged and is lost"},
    {"AcknowledgedNameIsOfAnotherRequest",
     [](History& history) { history.simulations["simulations/4"].set_request_id("3-7"); },
     "simulations/4 was acknowledged to request 1-1 and belongs to request 3-7"},
    {"OneRequestHasTwoNames",
     [](History& history) {
       add(history, "simulations/6", "0-1", {{1, kQueued, 1}, {2, kCancelled, 1}});
       history.submissions.push_back({"0-1", "simulations/6", "7"});
     },
     "one request made simulations/2 and simulations/6"},
    {"MoreSimulationsThanRequests", [](History& history) { history.requests = 5; },
     "5 requests made 6 simulations"},
    {"EndDoesNotLast",
     [](History& history) {
       history.ended.push_back({"simulations/5", kCancelled});
     },
     "simulations/5 had ended CANCELLED and is SUCCEEDED"},
    {"NeverEnds",
     [](History& history) {
       add(history, "simulations/6", "2-0", {{1, kQueued, 1}, {2, kRunning, 1}});
     },
     "simulations/6 never ended"},
    {"FailsWithoutACrash",
     [](History& history) {
       history.simulations["simulations/4"].mutable_error()->set_reason("INTERNAL");
     },
     "simulations/4 failed with INTERNAL"},
    {"FailsBeforeItsDeadline",
     [](History& history) {
       history.simulations["simulations/late"].mutable_deadline_time()->set_nanos(1);
     },
     "simulations/late failed with DEADLINE_EXCEEDED"},
    {"FailsByADeadlineThatItDoesNotHave",
     [](History& history) { history.simulations["simulations/late"].clear_deadline_time(); },
     "simulations/late failed with DEADLINE_EXCEEDED"},
    {"EqualInputsHaveTwoHistories",
     [](History& history) {
       set_result(add(history, "simulations/6", "2-0", {{1, kQueued, 1}, {2, kSucceeded, 1}}),
                  "hash of 8", 66);
       history.histories["simulations/6"] = "other rows";
     },
     "simulations/5 and simulations/6 have equal inputs and different results"},
    {"EqualInputsHaveTwoResults",
     [](History& history) {
       set_result(add(history, "simulations/6", "2-0", {{1, kQueued, 1}, {2, kSucceeded, 1}}),
                  "hash of 8", 67);
     },
     "simulations/5 and simulations/6 have equal inputs and different results"},
    {"ResultIsOfOtherInputs",
     [](History& history) {
       history.simulations["simulations/5"].mutable_result()->set_input_hash("hash of 7");
     },
     "simulations/5 has the result of other inputs"},
    {"ResultHasOtherBits",
     [](History& history) {
       set_result(add(history, "simulations/6", "2-0", {{1, kQueued, 1}, {2, kSucceeded, 1}}),
                  "another hash", 65.00000000000001);
       history.submissions.push_back({"2-0", "simulations/6", "7"});
     },
     "simulations/6 has other bits than an undisturbed run"},
    {"EventIsMissing",
     [](History& history) {
       set_events(history, "simulations/5", {{1, kQueued, 1}, {3, kSucceeded, 1}});
     },
     "simulations/5: a gap before event 3 (SUCCEEDED, attempt 1)"},
    {"FirstEventIsMissing",
     [](History& history) {
       set_events(history, "simulations/5", {{2, kRunning, 1}, {3, kSucceeded, 1}});
     },
     "simulations/5: a gap before event 2 (RUNNING, attempt 1)"},
    {"WatchLeavesAnEventOut",
     [](History& history) {
       history.watches.push_back({"simulations/5", 0, {{1, kQueued, 1}, {3, kSucceeded, 1}}});
     },
     "simulations/5: a gap before event 3 (SUCCEEDED, attempt 1)"},
    {"ResumedWatchLeavesAnEventOut",
     [](History& history) {
       history.watches.push_back({"simulations/5", 1, {{3, kSucceeded, 1}}});
     },
     "simulations/5: a gap before event 3 (SUCCEEDED, attempt 1)"},
    {"StateMovesBackwards",
     [](History& history) {
       set_events(history, "simulations/5",
                  {{1, kQueued, 1}, {2, kRunning, 1}, {3, kQueued, 1}, {4, kSucceeded, 1}});
     },
     "simulations/5: event 3 (QUEUED, attempt 1) after event 2 (RUNNING, attempt 1)"},
    {"AttemptMovesBackwards",
     [](History& history) {
       set_events(history, "simulations/5", {{1, kQueued, 2}, {2, kSucceeded, 1}});
     },
     "simulations/5: event 2 (SUCCEEDED, attempt 1) after event 1 (QUEUED, attempt 2)"},
    {"EventFollowsTheEnd",
     [](History& history) {
       set_events(history, "simulations/5",
                  {{1, kQueued, 1}, {2, kFailed, 1}, {3, kQueued, 2}, {4, kSucceeded, 2}});
     },
     "simulations/5: event 3 (QUEUED, attempt 2) after event 2 (FAILED, attempt 1)"},
    {"LastEventIsNotTheState",
     [](History& history) { history.events["simulations/4"].back().state = kCancelled; },
     "simulations/4 is at event 3 (FAILED, attempt 1) and its last event is "
     "event 3 (CANCELLED, attempt 1)"},
    {"LastEventIsMissing", [](History& history) { history.events["simulations/5"].pop_back(); },
     "simulations/5 is at event 3 (SUCCEEDED, attempt 1) and its last event is "
     "event 2 (RUNNING, attempt 1)"},
    {"HasNoEvents", [](History& history) { history.events.erase("simulations/5"); },
     "simulations/5 has no events"},
    {"SentEventIsNotKept",
     [](History& history) {
       history.watches.push_back({"simulations/4", 0, {{1, kQueued, 1}, {2, kCancelled, 1}}});
     },
     "simulations/4: event 2 (CANCELLED, attempt 1) was sent and is not kept"},
    {"SentEventIsBehindTheLastOneKept",
     [](History& history) {
       history.watches.push_back({"simulations/2", 2, {{3, kCancelled, 1}}});
     },
     "simulations/2: event 3 (CANCELLED, attempt 1) was sent and is not kept"},
    {"ClientIsRefused", [](History& history) { history.refusals.emplace_back("no such thing"); },
     "refused: no such thing"},
    {"RevisionIsLost",
     [](History& history) {
       history.revisions.push_back({"lubricants/a@4", "3"});
     },
     "lubricants/a@4 was acknowledged and is lost"},
    {"RevisionIsAnother",
     [](History& history) {
       history.revisions.push_back({"lubricants/a@2", "3"});
     },
     "lubricants/a@2 was acknowledged as \"3\" and is \"1\""},
    {"UpdateMakesTwoRevisions",
     [](History& history) { history.kept_revisions["lubricants/a@4"] = "2"; },
     "one update made lubricants/a@3 and lubricants/a@4"},
    {"BatchIsLost", [](History& history) { history.batches[1].is_acknowledged = true; },
     "of the acknowledged batch of lubricants/d 0 of 2 are there"},
    {"BatchIsKeptInPart", [](History& history) { history.kept_revisions["lubricants/e@1"] = "0"; },
     "of the batch of lubricants/d 1 of 2 are there"},
    {"CampaignIsLost", [](History& history) { history.campaigns.campaigns.erase("campaigns/1"); },
     "campaigns/1 was acknowledged and is lost"},
    {"CampaignIsOfAnotherRequest",
     [](History& history) {
       history.campaigns.campaigns["campaigns/1"].set_request_id("campaign-0-9");
     },
     "campaigns/1 was acknowledged to request campaign-0-0 and belongs to request campaign-0-9"},
    {"RequestMakesTwoCampaigns", [](History& history) { history.campaigns.requests = 1; },
     "1 requests made 2 campaigns"},
    {"DeletedCampaignIsThere",
     [](History& history) {
       add_campaign(history, "campaigns/3", v1::Campaign::SUCCEEDED, kFirstCandidates);
       ++history.campaigns.requests;
     },
     "campaigns/3 was deleted and is there"},
    {"CancelledCampaignSucceeds",
     [](History& history) {
       history.campaigns.ended.emplace_back("campaigns/1", v1::Campaign::CANCELLED);
     },
     "campaigns/1 had ended CANCELLED and is SUCCEEDED"},
    {"PausedCampaignRuns",
     [](History& history) {
       history.campaigns.paused.insert("campaigns/1");
       history.campaigns.found["campaigns/1"].set_state(v1::Campaign::RUNNING);
     },
     "campaigns/1 was paused and runs"},
    {"CampaignNeverEnds",
     [](History& history) {
       history.campaigns.campaigns["campaigns/2"].set_state(v1::Campaign::RUNNING);
       history.campaigns.ended.clear();
     },
     "campaigns/2 never ended: it is RUNNING with 0 rows"},
    {"AppendedCandidatesAreLost",
     [](History& history) { history.campaigns.acknowledged_appends["campaigns/2"] = 1; },
     "campaigns/2 has 300 candidates after 1 to 0 appends"},
    {"CandidatesAreAddedTwice",
     [](History& history) { history.campaigns.sent_appends["campaigns/1"] = 0; },
     "campaigns/1 has 400 candidates after 1 to 0 appends"},
    {"CandidatesAreOthers",
     [](History& history) {
       history.campaigns.campaigns["campaigns/1"].mutable_candidate_columns(0)->set_values(7, 1);
     },
     "campaigns/1 has other candidates than it was sent"},
    {"RowsAreCountedThatAreNotThere",
     [](History& history) { history.campaigns.campaigns["campaigns/2"].set_points_done(4); },
     "campaigns/2 counts 4 rows as computed and has 0"},
    {"ReadRowIsLost",
     [](History& history) {
       history.campaigns.reads.push_back({"campaigns/2", {{5, bits_of_row(1)}}});
     },
     "campaigns/2: row 5 was read and is lost"},
    {"ReadRowHasChanged",
     [](History& history) {
       history.campaigns.reads.push_back({"campaigns/1", {{5, bits_of_row(1)}}});
     },
     "campaigns/1: row 5 was read and has changed"},
    {"RowHasOtherBits",
     [](History& history) { history.campaigns.undisturbed[4][799] = bits_of_row(1); },
     "campaigns/1: row 799 has other bits than in an undisturbed run"},
};

INSTANTIATE_TEST_SUITE_P(All, CrashHistoryFault, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return fault.param.name; });

}  // namespace
}  // namespace tribodyn::crash
