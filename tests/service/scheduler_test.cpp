// Which job begins next, and what becomes of leases: with a clock and an executor that the tests
// move by hand.
#include "server/scheduling/scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/version.h"
#include "server/simulation/compute.h"
#include "server/simulation/result_key.h"
#include "server/storage/seeds.h"
#include "tests/service/support.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {
namespace {

using Verdict = ClaimPolicy::Verdict;

constexpr RequestedClass kInteractive = RequestedClass::kInteractive;

ClaimPolicy policy_of(int threads, const QueueLimits& limits = {}) {
  ClaimPolicy out(limits);
  out.add_threads(threads);
  return out;
}

std::int64_t begun(ClaimPolicy& policy) {
  const auto job = policy.begin();
  return job ? job->id : 0;
}

std::int64_t begun_beside(ClaimPolicy& policy, std::int64_t lender) {
  const auto job = policy.begin_beside(lender);
  return job ? job->id : 0;
}

TEST(ClaimPolicy, BeginsWhatIsPushedInOrder) {
  ClaimPolicy policy = policy_of(1, {.jobs = 100});
  for (int id = 1; id <= 20; ++id) {
    ASSERT_TRUE(policy.reserve({}, {}).is_admitted);
    policy.push({id});
  }
  for (int id = 1; id <= 20; ++id) {
    EXPECT_EQ(begun(policy), id);
    policy.computed(id, 0);
    policy.end(id);
  }
  EXPECT_FALSE(policy.may_begin());
}

TEST(ClaimPolicy, TurnsAwayWhatIsTooMuch) {
  ClaimPolicy policy = policy_of(1, {.jobs = 2});
  ASSERT_TRUE(policy.reserve({}, {}).is_admitted);
  ASSERT_TRUE(policy.reserve({}, {}).is_admitted);
  EXPECT_FALSE(policy.reserve({}, {}).is_admitted) << "reserved places count";
  policy.release({});
  EXPECT_TRUE(policy.reserve({}, {}).is_admitted);
  policy.push({1});
  policy.push({2});
  EXPECT_EQ(begun(policy), 1);
  EXPECT_TRUE(policy.reserve({}, {}).is_admitted);
  policy.release({});
  EXPECT_TRUE(policy.add({3}));
  EXPECT_TRUE(policy.add({4}));
  EXPECT_FALSE(policy.add({4})) << "it is here";
  EXPECT_FALSE(policy.add({1})) << "it runs";
  EXPECT_FALSE(policy.reserve({}, {}).is_admitted) << "resumed jobs count";
}

TEST(ClaimPolicy, IsBoundedByCostAndLeavesRoomForOthers) {
  ClaimPolicy policy = policy_of(2, {.jobs = 100, .cost_seconds = 1000});
  EXPECT_TRUE(policy.reserve({1, "a", 5000}, {}).is_admitted) << "it must run once";
  const Admission refused = policy.reserve({2, "b", 1}, {});
  EXPECT_FALSE(refused.is_admitted);
  EXPECT_EQ(refused.retry_seconds, 250) << "a tenth of 5000 s on two processors";
  policy.release({1, "a", 5000});
  EXPECT_TRUE(policy.reserve({3, "a", 700}, {}).is_admitted);
  EXPECT_FALSE(policy.reserve({4, "a", 100}, {}).is_admitted)
      << "three quarters are for one principal";
  EXPECT_TRUE(policy.reserve({5, "b", 100}, {}).is_admitted);
}

/// Jobs are submitted at once to a queue of 300. Two threads take `job_seconds` for each, ten times
/// its estimate, and `first_jobs_seconds` for each of the first 40, while the submissions take the
/// processors too. A refused job is submitted again after its retry delay.
struct Crowd {
  double tries = 0;    // for a job
  double seconds = 0;  // until all have run, over the time for which threads compute
};
Crowd crowd_of(int jobs, double job_seconds, double first_jobs_seconds) {
  ClaimPolicy policy = policy_of(2, {.jobs = 400});
  std::multimap<double, std::int64_t> submissions, ends;  // by time [s]
  for (int id = 1; id <= jobs; ++id) submissions.emplace(1e-4 * id, id);
  Crowd out;
  double time = 0, computed = 0;
  while (!submissions.empty() || !ends.empty()) {
    const bool is_submission =
        ends.empty() || (!submissions.empty() && submissions.begin()->first < ends.begin()->first);
    std::multimap<double, std::int64_t>& events = is_submission ? submissions : ends;
    const std::int64_t id = events.begin()->second;
    time = events.begin()->first;
    events.erase(events.begin());
    const QueuedJob job{id, "a", job_seconds / 10};
    if (is_submission) {
      const auto now = Turns::Time() + std::chrono::duration_cast<Turns::Time::duration>(
                                           std::chrono::duration<double>(1 + time));
      const Admission admission = policy.reserve(job, now);
      out.tries += 1.0 / jobs;
      if (admission.is_admitted) policy.push(job);
      if (!admission.is_admitted) submissions.emplace(time + admission.retry_seconds, id);
    } else {
      policy.computed(id, job_seconds);
      policy.end(id);
    }
    while (ends.size() < 2 && policy.may_begin()) {
      const double seconds = computed < 20 * first_jobs_seconds ? first_jobs_seconds : job_seconds;
      computed += seconds / 2;
      ends.emplace(time + seconds, begun(policy));
    }
  }
  out.seconds = time / computed;
  return out;
}

TEST(ClaimPolicy, RefusedJobsComeBackAtThePaceAtWhichPlacesBecomeFree) {
  for (const double job_seconds : {0.004, 0.03, 1.0}) {
    const Crowd crowd = crowd_of(2000, job_seconds, 5 * job_seconds);
    EXPECT_LT(crowd.tries, 6) << job_seconds << " s for each job";
    EXPECT_LT(crowd.seconds, 1.1) << "the queue runs dry";
  }
}

TEST(ClaimPolicy, ACrowdOfManyTimesTheQueueComesBackAFewTimesAtASteadyPace) {
  for (const double job_seconds : {0.004, 0.03, 1.0}) {
    const Crowd crowd = crowd_of(8000, job_seconds, job_seconds);
    EXPECT_LT(crowd.tries, 10) << job_seconds << " s for each job; 20 if no delay is longer than "
                               << "1.5 times what the waiting work takes";
    EXPECT_LT(crowd.seconds, 1.02) << "the queue runs dry";
  }
}

TEST(ClaimPolicy, KeepsAThreadForInteractiveJobs) {
  ClaimPolicy policy = policy_of(2);
  for (int id = 1; id <= 5; ++id) policy.add({id, "a", 100});
  EXPECT_EQ(begun(policy), 1);
  EXPECT_EQ(begun(policy), 0);
  for (int id = 10; id < 30; ++id) {
    policy.add({id, "b", 0.1});
    EXPECT_EQ(begun(policy), id);
    policy.computed(id, 0.1);
    policy.end(id);
  }
  EXPECT_EQ(policy.occupancy().waiting, 4U);
}

TEST(ClaimPolicy, PartsOfCampaignsCountBesideTheSimulations) {
  ClaimPolicy policy = policy_of(2);
  for (const int part : {0, 1, 2}) policy.add({campaign_part_id(7, part), "a", 0.05});
  policy.add({1, "a", 100});
  policy.add({2, "a", 0.01});
  EXPECT_EQ(begun(policy), 2);
  EXPECT_LT(begun(policy), 0);
  const Occupancy both = policy.occupancy();
  EXPECT_EQ(both.waiting, 1U);
  EXPECT_EQ(both.waiting_seconds, 100);
  EXPECT_EQ(both.running, 1U);
  EXPECT_EQ(both.parts, 3U);
}

TEST(ClaimPolicy, AJobThatMayKillTheServerRunsAlone) {
  ClaimPolicy policy = policy_of(4);
  policy.add({1, "", 0});
  policy.add({2, "", 0, true});
  policy.add({3, "", 0});
  EXPECT_EQ(begun(policy), 1);
  EXPECT_EQ(begun(policy), 0) << "another one runs";
  policy.computed(1, 0);
  EXPECT_EQ(begun(policy), 0) << "its result is not written yet";
  policy.end(1);
  EXPECT_EQ(begun(policy), 2);
  EXPECT_EQ(begun(policy), 0);
  policy.end(2);
  EXPECT_EQ(begun(policy), 3);
}

TEST(ClaimPolicy, TheNextBeginsWhileResultsAreWrittenButTheseDoNotHeapUp) {
  ClaimPolicy policy = policy_of(1);
  for (int id = 1; id <= 5; ++id) policy.add({id});
  EXPECT_EQ(begun(policy), 1);
  policy.computed(1, 0);
  EXPECT_EQ(begun(policy), 2);
  policy.computed(2, 0);
  EXPECT_EQ(begun(policy), 0);
  policy.end(1);
  EXPECT_EQ(begun(policy), 3);
}

TEST(ClaimPolicy, AnInteractiveJobBeginsWhileResultsAreWritten) {
  ClaimPolicy policy = policy_of(1);
  for (int id = 1; id <= 3; ++id) policy.add({id});
  for (int id = 1; id <= 2; ++id) {
    EXPECT_EQ(begun(policy), id);
    policy.computed(id, 0);
  }
  EXPECT_EQ(begun(policy), 0);
  policy.add({10, "", 0, false, kInteractive});
  EXPECT_EQ(begun(policy), 10);
  policy.computed(10, 0);
  EXPECT_EQ(begun(policy), 0) << "not the others";
}

TEST(ClaimPolicy, BytesOfUnwrittenResultsAreBounded) {
  ClaimPolicy policy = policy_of(8, {.unwritten_bytes = 100});
  for (int id = 1; id <= 4; ++id) {
    QueuedJob job{id};
    job.result_bytes = 60;
    policy.add(job);
  }
  EXPECT_EQ(begun(policy), 1);
  EXPECT_EQ(begun(policy), 0);
  policy.set_result_bytes(1, 40);  // what came out
  EXPECT_EQ(begun(policy), 2);
  policy.computed(1, 0);
  EXPECT_EQ(begun(policy), 0) << "until it is written";
  policy.end(1);
  policy.end(2);
  policy.end(3);
  policy.set_result_bytes(4, 1000);
  EXPECT_EQ(begun(policy), 4) << "however large, alone";
}

TEST(ClaimPolicy, InteractiveJobsRunOnLentThreadsAtOnce) {
  ClaimPolicy policy = policy_of(1);
  for (int id = 1; id <= 1000; ++id) policy.add({id, "a", 0.5});
  EXPECT_EQ(begun(policy), 1);
  EXPECT_FALSE(policy.is_urgent());
  policy.add({2000, "a", 0.01, false, kInteractive});
  EXPECT_TRUE(policy.is_urgent());
  EXPECT_EQ(begun_beside(policy, 1), 2000);
  policy.add({2001, "a", 0.01, false, kInteractive});
  EXPECT_EQ(begun_beside(policy, 1), 0) << "one at a time";
  EXPECT_EQ(begun_beside(policy, 2000), 0) << "a lent thread is not lent again";
  policy.computed(2000, 0.01);
  policy.end(2000);
  EXPECT_EQ(begun_beside(policy, 1), 2001);
}

TEST(ClaimPolicy, AnInteractiveJobDoesNotLendItsThreadToAnother) {
  ClaimPolicy policy = policy_of(1);
  policy.add({1, "a", 0.01, false, kInteractive});
  policy.add({2, "a", 0.01, false, kInteractive});
  EXPECT_EQ(begun(policy), 1);
  EXPECT_EQ(begun_beside(policy, 1), 0);
  EXPECT_EQ(policy.use(1, 0.2), Verdict::kReclassed) << "it outran its estimate";
  EXPECT_EQ(begun_beside(policy, 1), 2);
}

TEST(ClaimPolicy, FreeThreadsComeBeforeLentOnes) {
  ClaimPolicy policy = policy_of(2);
  policy.add({1, "a", 100});
  EXPECT_EQ(begun(policy), 1);
  policy.add({2, "a", 0.01, false, kInteractive});
  EXPECT_FALSE(policy.is_urgent());
  EXPECT_EQ(begun_beside(policy, 1), 0);
  EXPECT_EQ(begun(policy), 2);
}

TEST(ClaimPolicy, SmallJobsRunOnLentThreadsWhereAllComputeBulkJobs) {
  ClaimPolicy policy = policy_of(2);
  policy.add({1, "hog", 0.0003});  // estimated wrongly
  policy.add({2, "hog", 0.0003});
  EXPECT_EQ(begun(policy), 1);
  EXPECT_EQ(begun(policy), 2);
  policy.add({3, "other", 0.02});
  EXPECT_EQ(begun_beside(policy, 1), 0) << "they may end at any moment";
  EXPECT_EQ(policy.use(1, 0.09), Verdict::kGoOn);
  EXPECT_EQ(policy.use(1, 0.11), Verdict::kReclassed);
  EXPECT_EQ(policy.use(1, 0.12), Verdict::kGoOn) << "told once";
  EXPECT_EQ(begun_beside(policy, 1), 0);
  EXPECT_EQ(policy.use(2, 0.11), Verdict::kReclassed);
  EXPECT_EQ(begun_beside(policy, 1), 3);
}

TEST(ClaimPolicy, ALenderGetsHalfOfItsThread) {
  ClaimPolicy policy = policy_of(1);
  policy.add({1, "a", 100});
  EXPECT_EQ(begun(policy), 1);
  double lent = 0;
  std::int64_t id = 2;
  for (; id < 1000; ++id) {  // a flood of interactive jobs
    policy.add({id, "b", 0.01, false, kInteractive});
    if (begun_beside(policy, 1) == 0) break;
    policy.computed(id, 0.01);
    policy.end(id);
    lent += 0.01;
  }
  EXPECT_NEAR(lent, 1.01, 0.02) << "a second of credit";
  policy.use(1, 5);
  EXPECT_EQ(begun_beside(policy, 1), id) << "and as much as it has used itself";
}

TEST(ClaimPolicy, WhatOutrunsItsEstimateOnALentThreadGoesBackAsABulkJob) {
  ClaimPolicy policy = policy_of(1);
  policy.add({1, "a", 100});
  EXPECT_EQ(begun(policy), 1);
  policy.add({2, "b", 0.001, false, kInteractive});
  EXPECT_EQ(begun_beside(policy, 1), 2);
  EXPECT_EQ(policy.use(2, 0.05), Verdict::kGoOn);
  EXPECT_EQ(policy.use(2, 0.11), Verdict::kGiveBack);
  EXPECT_EQ(policy.use(2, 0.12), Verdict::kGiveBack);
  policy.computed(2, 0.12);
  policy.requeue(2);
  EXPECT_FALSE(policy.is_urgent());
  EXPECT_EQ(begun_beside(policy, 1), 0);
  policy.computed(1, 10);
  policy.end(1);
  EXPECT_EQ(begun(policy), 2);
}

TEST(ClaimPolicy, PrincipalsPayForTheTimeUsed) {
  ClaimPolicy policy = policy_of(1);
  policy.add({1, "hog", 0.001});
  EXPECT_EQ(begun(policy), 1);
  policy.use(1, 10);
  policy.computed(1, 10);
  policy.end(1);
  policy.add({2, "hog", 0.001});
  for (int id = 3; id < 13; ++id) policy.add({id, "other", 0.9});
  for (int id = 3; id < 13; ++id) {
    EXPECT_EQ(begun(policy), id);
    policy.computed(id, 0.9);
    policy.end(id);
  }
  EXPECT_EQ(begun(policy), 2) << "after 9 s for the other one";
}

TEST(ClaimPolicy, EqualInputsWaitWithoutAThread) {
  ClaimPolicy policy = policy_of(2);
  for (int id = 1; id <= 4; ++id) policy.add({id, "a", 0.1});
  EXPECT_EQ(begun(policy), 1);
  EXPECT_TRUE(policy.hold(1, "key", true));
  EXPECT_EQ(begun(policy), 2);
  EXPECT_FALSE(policy.hold(2, "key", true));
  EXPECT_EQ(begun(policy), 3) << "the thread is free";
  EXPECT_TRUE(policy.hold(3, "key", false)) << "a forced one does not wait";
  policy.end(3);
  EXPECT_EQ(begun(policy), 4);
  EXPECT_FALSE(policy.hold(4, "key", true));
  EXPECT_EQ(policy.occupancy().waiting, 2U);
  EXPECT_FALSE(policy.may_begin());
  policy.end(4);  // cancelled while it waits
  policy.end(1);
  EXPECT_EQ(begun(policy), 2);
  EXPECT_TRUE(policy.hold(2, "key", true));
  EXPECT_EQ(begun(policy), 0);
}

/// A scheduler over a store, a clock that stands still, and an executor that is the test.
class SchedulerTest : public testing::Test {
 protected:
  SchedulerTest() { open(); }

  void open() {
    scheduler_.reset();
    store_.reset();
    store_ = std::make_unique<Store>(folder_.file("tribodyn.db"));
    store_->add_project("default", seed_resources(), 1);
    Scheduler::Options options;
    options.clock = [this] { return wall_; };
    options.steady = [this] { return steady_; };
    options.wants_proof = false;
    options.tick = std::chrono::hours(1);  // the tests call expire_leases
    scheduler_ = std::make_unique<Scheduler>(*store_, board_, metrics_, options);
    scheduler_->resume();
    scheduler_->enroll("far", {"platform", 2}, nullptr);
    scheduler_->enroll("local", {platform(), 2}, nullptr);
  }

  /// Moves the clocks and looks at leases every second, as the timekeeper does.
  void pass(int seconds) {
    for (int i = 0; i < seconds; ++i) {
      wall_ += 1'000'000;
      steady_ += std::chrono::seconds(1);
      scheduler_->expire_leases();
    }
  }

  std::int64_t submit(double speed = 65, bool force = false,
                      std::optional<Microseconds> deadline = {},
                      const std::string& principal = {}) {
    v1::Simulation simulation = point_simulation();
    simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(speed);
    Violations violations;
    auto inputs = read_simulation(simulation, seed_lookup(), "simulation", violations);
    const NewSimulation row{
        .request = inputs->requested.SerializeAsString(),
        .key = result_key(*inputs),
        .is_forced = force,
        .deadline_time = deadline,
        .principal = principal,
        .cost_seconds = 0.001,
        .revisions = {inputs->effective.lubricant_revision(), inputs->effective.gear_set_revision(),
                      inputs->effective.surface_revision(), inputs->effective.vehicle_revision()}};
    return scheduler_->admit(row, std::make_shared<const SimulationInputs>(std::move(*inputs)))
        .added.id;
  }

  static internal::v1::ComputeResult result_of(const Lease& lease) {
    v1::SimulationResult result;
    result.set_input_hash(lease.task.input_hash());
    internal::v1::ComputeResult out;
    out.set_result(result.SerializeAsString());
    out.set_model_version(kModelVersion);
    out.set_platform("platform");
    return out;
  }

  void finish(const Lease& lease, const internal::v1::ComputeResult& result) {
    scheduler_->computed(lease, result);
    scheduler_->complete(lease, result);
  }

  StoredState state(std::int64_t id) { return store_->simulation(id)->state; }
  int attempt(std::int64_t id) { return store_->simulation(id)->attempt; }

  TemporaryFolder folder_{TemporaryFolder::Kind::kMemory};
  Microseconds wall_ = 1'000'000;
  std::chrono::steady_clock::time_point steady_;
  ProgressBoard board_;
  Metrics metrics_;
  std::unique_ptr<Store> store_;
  std::unique_ptr<Scheduler> scheduler_;
};

TEST_F(SchedulerTest, ALeaseBringsAllThatItsTaskNeeds) {
  const std::int64_t id = submit();
  const auto lease = scheduler_->claim("far");
  ASSERT_TRUE(lease);
  EXPECT_EQ(state(id), StoredState::kRunning);
  internal::v1::ComputeTask task;
  ASSERT_TRUE(task.ParseFromString(lease->task.SerializeAsString()));
  EXPECT_EQ(task.simulation(), id);
  EXPECT_EQ(task.attempt(), 1);
  PreparedGearSets gear_sets;
  const auto result = compute(task, {}, gear_sets, [](double, const StageText&) { return true; });
  ASSERT_TRUE(result.has_result());
  finish(*lease, result);
  EXPECT_EQ(state(id), StoredState::kSucceeded);
  v1::SimulationResult stored;
  ASSERT_TRUE(stored.ParseFromString(*store_->result(id)));
  EXPECT_EQ(stored.points_size(), 1);
  EXPECT_EQ(stored.platform(), platform()) << "the executor's";
  EXPECT_FALSE(scheduler_->claim("far"));
}

TEST_F(SchedulerTest, WhoIsNotEnrolledOrComputesWronglyGetsNoLease) {
  submit();
  EXPECT_FALSE(scheduler_->claim("nobody"));
  Scheduler strict(*store_, board_, metrics_, {});
  const auto wrong = [](const internal::v1::ComputeTask&) {
    internal::v1::ComputeResult out;
    v1::SimulationResult result;
    result.add_points();
    out.set_result(result.SerializeAsString());
    return out;
  };
  EXPECT_THAT(strict.enroll("far", {"platform", 1}, wrong),
              testing::HasSubstr("pinion_torque_newton_metres is 0"));
  EXPECT_FALSE(strict.claim("far"));
}

TEST_F(SchedulerTest, AJobWhoseWorkerIsLostIsGivenToAnother) {
  const std::int64_t id = submit();
  const auto lost = scheduler_->claim("far");
  ASSERT_TRUE(lost);
  pass(59);
  EXPECT_EQ(state(id), StoredState::kRunning);
  scheduler_->extend(*lost, 0);
  pass(59);
  EXPECT_EQ(state(id), StoredState::kRunning) << "extended";
  pass(2);
  EXPECT_EQ(state(id), StoredState::kQueued);
  EXPECT_EQ(attempt(id), 2);
  EXPECT_EQ(store_->next_event(id, 2)->reason, "LEASE_EXPIRED");
  EXPECT_EQ(lost->stop->reason(), StopReason::kEnded);
  const auto next = scheduler_->claim("local");
  ASSERT_TRUE(next);
  EXPECT_EQ(next->attempt, 2);
  finish(*lost, result_of(*lost));
  EXPECT_EQ(state(id), StoredState::kRunning) << "the lost one comes too late";
  finish(*next, result_of(*next));
  EXPECT_EQ(state(id), StoredState::kSucceeded);
  EXPECT_EQ(scheduler_->occupancy().running, 0U);
}

TEST_F(SchedulerTest, APrincipalWhoseJobOutranItsEstimateWaitsUntilOthersHadAsMuch) {
  submit(10, false, {}, "hog");
  const auto hog = scheduler_->claim("far");
  ASSERT_TRUE(hog);
  scheduler_->extend(*hog, 5);
  internal::v1::ComputeResult result = result_of(*hog);
  result.set_processor_seconds(5);
  finish(*hog, result);
  const std::int64_t next_of_hog = submit(11, false, {}, "hog");
  std::vector<std::int64_t> others;
  for (int i = 0; i < 3; ++i) others.push_back(submit(20 + i, false, {}, "other"));
  for (const std::int64_t id : others) {
    const auto lease = scheduler_->claim("far");
    ASSERT_TRUE(lease);
    EXPECT_EQ(lease->id, id);
    finish(*lease, result_of(*lease));
  }
  EXPECT_EQ(scheduler_->claim("far")->id, next_of_hog);
}

TEST_F(SchedulerTest, AJobThatLosesItsWorkersAgainAndAgainFails) {
  const std::int64_t id = submit();
  for (int i = 0; i < kMaximumLostAttempts; ++i) {
    ASSERT_TRUE(scheduler_->claim("far"));
    pass(61);
  }
  EXPECT_EQ(state(id), StoredState::kFailed);
  EXPECT_EQ(store_->simulation(id)->error_reason, "WORKER_LOST");
  EXPECT_FALSE(scheduler_->claim("far"));
  EXPECT_EQ(scheduler_->occupancy().running, 0U);
}

TEST_F(SchedulerTest, TimeInWhichTheServerStoodStillDoesNotCount) {
  const std::int64_t id = submit();
  ASSERT_TRUE(scheduler_->claim("far"));
  steady_ += std::chrono::hours(5);
  scheduler_->expire_leases();
  EXPECT_EQ(state(id), StoredState::kRunning);
  pass(61);
  EXPECT_EQ(state(id), StoredState::kQueued);
}

TEST_F(SchedulerTest, AComputedResultDoesNotExpireBeforeItIsWritten) {
  const std::int64_t id = submit();
  const auto lease = scheduler_->claim("far");
  scheduler_->computed(*lease, result_of(*lease));
  pass(1000);
  scheduler_->complete(*lease, result_of(*lease));
  EXPECT_EQ(state(id), StoredState::kSucceeded);
}

TEST_F(SchedulerTest, ARestartEndsTheLeasesOfTheServerAndKeepsThoseOfOthers) {
  const std::int64_t here = submit(60);
  const std::int64_t there = submit(70);
  ASSERT_EQ(scheduler_->claim("local")->id, here);
  ASSERT_EQ(scheduler_->claim("far")->id, there);
  open();
  EXPECT_EQ(state(here), StoredState::kQueued);
  EXPECT_EQ(attempt(here), 2);
  EXPECT_EQ(state(there), StoredState::kRunning);
  EXPECT_EQ(attempt(there), 1);
  EXPECT_EQ(scheduler_->occupancy().running, 1U);
  pass(61);
  EXPECT_EQ(state(there), StoredState::kQueued) << "nobody has extended it";
}

TEST_F(SchedulerTest, EqualInputsAreComputedOnce) {
  const std::int64_t first = submit();
  const std::int64_t second = submit();
  const auto lease = scheduler_->claim("far");
  ASSERT_EQ(lease->id, first);
  EXPECT_FALSE(scheduler_->claim("far"));
  EXPECT_EQ(state(second), StoredState::kQueued) << "it takes no thread";
  finish(*lease, result_of(*lease));
  EXPECT_FALSE(scheduler_->claim("far")) << "there is nothing to be computed";
  EXPECT_EQ(state(second), StoredState::kSucceeded);
  EXPECT_TRUE(store_->simulation(second)->cache_hit);
}

TEST_F(SchedulerTest, WhoWaitsForEqualInputsRunsWhenTheseFail) {
  const std::int64_t first = submit();
  const std::int64_t second = submit();
  const std::int64_t third = submit();
  const auto lease = scheduler_->claim("far");
  EXPECT_FALSE(scheduler_->claim("far"));
  scheduler_->cancel(first);
  EXPECT_TRUE(lease->stop->requested());
  internal::v1::ComputeResult stopped;
  stopped.set_stopped(true);
  finish(*lease, stopped);
  EXPECT_EQ(state(first), StoredState::kCancelled);
  const auto next = scheduler_->claim("far");
  ASSERT_TRUE(next);
  EXPECT_EQ(next->id, second);
  EXPECT_FALSE(scheduler_->claim("far"));
  scheduler_->cancel(third);
  EXPECT_EQ(state(third), StoredState::kCancelled);
  EXPECT_EQ(scheduler_->occupancy().waiting, 0U);
}

TEST_F(SchedulerTest, DeadlinesGoWhenTheirSimulationsEnd) {
  const Microseconds far = wall_ + 1'000'000'000;
  const std::int64_t cancelled = submit(50, false, far);
  submit(60, false, far);
  EXPECT_EQ(scheduler_->deadlines(), 2U);
  scheduler_->cancel(cancelled);
  EXPECT_EQ(scheduler_->deadlines(), 1U);
  const auto lease = scheduler_->claim("far");
  finish(*lease, result_of(*lease));
  EXPECT_EQ(scheduler_->deadlines(), 0U);
}

TEST_F(SchedulerTest, ASimulationThatIsReadFromTheStoreHasTheSameTask) {
  submit();
  const auto kept = scheduler_->claim("local");
  open();
  const auto read = scheduler_->claim("local");
  ASSERT_TRUE(read);
  internal::v1::ComputeTask expected = kept->task;
  expected.set_attempt(2);
  EXPECT_EQ(read->task.SerializeAsString(), expected.SerializeAsString());
}

}  // namespace
}  // namespace tribodyn::server
