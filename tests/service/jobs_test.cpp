#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <thread>

#include "core/refusal.h"
#include "server/execution/simulation_jobs.h"
#include "server/scheduling/fair_queue.h"
#include "server/scheduling/progress_board.h"
#include "server/scheduling/turns.h"
#include "server/simulation/golden_case.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

/// Returns studies that throw.
template <class Thrown>
StudyFunctions throwing(const Thrown& thrown) {
  StudyFunctions out = quick_studies();
  out.solve_operating_point = [thrown](const Scene&, const OperatingCondition&, const PointOptions&,
                                       const auto&) -> PointResult { throw thrown; };
  return out;
}

/// Returns the ids in the order in which the queue releases them.
std::vector<std::int64_t> emptied(FairQueue& queue) {
  std::vector<std::int64_t> out;
  while (const auto job = queue.pop(Urgency::kBulk)) out.push_back(job->id);
  return out;
}

TEST(FairQueue, ServesPrincipalsInTurnHoweverMuchOneBrings) {
  FairQueue queue;
  for (int id = 1; id <= 100; ++id) queue.push({id, "bulk", 0.1});
  for (int i = 0; i < 10; ++i) queue.pop(Urgency::kBulk);
  queue.push({1000, "curve", 0.5});
  queue.push({1001, "curve", 0.5});
  const auto order = emptied(queue);
  const auto place = [&](std::int64_t id) {
    return std::find(order.begin(), order.end(), id) - order.begin();
  };
  EXPECT_LE(place(1000), 1);
  EXPECT_LE(place(1001), 8) << "five points of the other one in between";
  EXPECT_GE(place(1001), 4) << "no credit for the time away";
  EXPECT_EQ(order.back(), 100);
}

TEST(FairQueue, SmallJobsOfAPrincipalPassLargeOnesThatDoNotStarve) {
  FairQueue queue;
  queue.push({1, "a", 5});
  for (int id = 2; id <= 101; ++id) queue.push({id, "a", 0.5});
  EXPECT_EQ(queue.peek(Urgency::kBulk)->id, 2);
  for (int id = 102; id < 300; ++id) {
    if (queue.pop(Urgency::kBulk)->id == 1) {
      EXPECT_GT(id, 102 + 8) << "as much as it is large has passed it";
      return;
    }
    queue.push({id, "a", 0.5});  // new jobs keep arriving
  }
  FAIL() << "the large one never came";
}

TEST(FairQueue, APersonDoesNotWaitBehindTheCampaignsOfTheSamePrincipal) {
  FairQueue queue;
  const auto slice = [&queue](int campaign) {
    queue.push({campaign_part_id(campaign, 0), "a", 0.05});
  };
  for (int campaign = 1; campaign <= 100; ++campaign) slice(campaign);
  for (int i = 0; i < 150; ++i) {
    const std::int64_t id = queue.pop(Urgency::kBulk)->id;
    slice(static_cast<int>(campaign_part(id)->campaign));
  }
  queue.push({1, "a", 0.5});
  EXPECT_EQ(queue.peek(Urgency::kSmall)->id, 1);
  EXPECT_EQ(queue.pop(Urgency::kBulk)->id, 1);
  EXPECT_TRUE(campaign_part(queue.peek(Urgency::kSmall)->id));
}

TEST(FairQueue, SlicesOfCampaignsDoNotStarveBehindSmallJobs) {
  FairQueue queue;
  queue.push({campaign_part_id(1, 0), "a", 0.05});
  double served = 0;
  for (int id = 1; served < 3 * kSlicePatienceSeconds; ++id, served += 0.5) {
    queue.push({id, "a", 0.5});  // new jobs keep arriving
    if (campaign_part(queue.pop(Urgency::kBulk)->id)) break;
  }
  EXPECT_NEAR(served, kSlicePatienceSeconds, 1);
}

TEST(FairQueue, CountsQueuedJobs) {
  FairQueue queue;
  queue.push({1, "a", 2});
  queue.push({2, "b", 3});
  EXPECT_FALSE(queue.pop(Urgency::kSmall)) << "neither is interactive";
  EXPECT_EQ(queue.cost_seconds(), 5);
  EXPECT_EQ(queue.size_of("a"), 1U);
  EXPECT_TRUE(queue.erase(1));
  EXPECT_FALSE(queue.erase(1));
  EXPECT_EQ(queue.cost_seconds_of("a"), 0);
  EXPECT_EQ(queue.size(), 1U);
}

TEST(FairQueue, InteractiveJobsPassAllOthersOfTheirPrincipal) {
  FairQueue queue;
  for (int id = 1; id <= 20; ++id) queue.push({id, "a", 1e-4});
  queue.push({21, "a", 100, false, RequestedClass::kInteractive});
  queue.push({22, "a", 1e-4, false, RequestedClass::kBulk});
  EXPECT_EQ(queue.peek(Urgency::kInteractive)->id, 21);
  EXPECT_EQ(queue.pop(Urgency::kBulk)->id, 21);
  EXPECT_FALSE(queue.peek(Urgency::kInteractive));
  EXPECT_EQ(queue.pop(Urgency::kBulk)->id, 1);
  while (queue.peek(Urgency::kSmall) != nullptr) queue.pop(Urgency::kSmall);
  EXPECT_EQ(queue.pop(Urgency::kBulk)->id, 22) << "it asks for BULK, however small it is";
}

TEST(FairQueue, APrincipalThatUsedMoreThanEstimatedIsServedLater) {
  FairQueue queue;
  queue.push({1, "hog", 0.001});
  EXPECT_EQ(queue.pop(Urgency::kBulk)->id, 1);
  queue.charge("hog", 10);  // while it has no job in the queue
  queue.push({2, "hog", 0.001});
  for (int id = 3; id <= 12; ++id) queue.push({id, "other", 0.5});
  EXPECT_EQ(emptied(queue).back(), 2) << "the others have 5 s of work";
  EXPECT_EQ(queue.debtors(), 1U);
  queue.push({20, "hog", 0.001});
  queue.push({21, "late", 0.001});
  EXPECT_EQ(queue.pop(Urgency::kBulk)->id, 21);
  queue.charge("hog", -10);
  queue.pop(Urgency::kBulk);
  queue.push({22, "late", 0.001});
  queue.pop(Urgency::kBulk);
  EXPECT_LE(queue.debtors(), 2U);
}

TEST(FairQueue, RemembersABoundedNumberOfDebtors) {
  FairQueue queue;
  constexpr int kMost = static_cast<int>(FairQueue::kMostDebtors);
  for (int i = 0; i < 2 * kMost; ++i) queue.charge(std::to_string(i), 1 + i);
  EXPECT_EQ(queue.debtors(), FairQueue::kMostDebtors);
  queue.push({1, std::to_string(2 * kMost - 1), 0.001});
  queue.push({2, "0", 0.001});
  EXPECT_EQ(queue.pop(Urgency::kBulk)->id, 2) << "those who owe least are forgotten";
}

TEST(FairQueue, TimeDoesNotGrowWithTheNumberOfPrincipals) {
  const auto seconds = [](int principals) {
    FairQueue queue;
    for (int i = 0; i < principals; ++i) queue.push({i, std::to_string(i), 0.001});
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 2000; ++i) {
      queue.peek(Urgency::kSmall);
      QueuedJob job = *queue.pop(Urgency::kBulk);
      queue.push(job);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const double few = seconds(20);
  EXPECT_LT(seconds(20'000), 50 * few) << "1000 times as many";
}

TEST(Turns, SpreadsTheRetriesOfRefusedPrincipals) {
  Turns turns;
  const Turns::Time now;
  const Turns::Delays delays{0.001, 100};
  EXPECT_EQ(turns.next("b", delays, 10, now), Turns::kLeastSeconds);
  EXPECT_DOUBLE_EQ(turns.next("b", delays, 10, now), 10.02) << "after that of 10 s";
  EXPECT_DOUBLE_EQ(turns.next("b", delays, 10, now), 20.02);
  EXPECT_EQ(turns.next("c", {0.3, 100}, 10, now), 0.3) << "others are not held up by them";
  for (int i = 0; i < 7; ++i) turns.next("b", delays, 10, now);
  EXPECT_EQ(turns.next("b", delays, 10, now), Turns::kLeastSeconds)
      << "after the most, at the least";
  EXPECT_DOUBLE_EQ(turns.next("b", delays, 10, now), 10.02);
  EXPECT_EQ(turns.next("d", {1000, 2000}, 10, now), Turns::kMostSeconds);
  const Turns::Time later = now + std::chrono::seconds(700);
  EXPECT_EQ(turns.next("b", delays, 10, later), Turns::kLeastSeconds);
  EXPECT_EQ(turns.size(), 1U) << "turns that are past are forgotten";
}

TEST(Turns, RequestsOfASlotReturnTogetherAtItsEnd) {
  Turns turns;
  const Turns::Time now = Turns::Time() + std::chrono::milliseconds(100);
  const Turns::Delays delays{0.05, 100, 0.25};
  for (int i = 0; i < 30; ++i) {  // 10 ms apart, from 0.15 s on
    const double time = 0.1 + turns.next("a", delays, 0.01, now);
    EXPECT_NEAR(time, i <= 10 ? 0.25 : 0.5, 1e-9) << i;
  }
}

TEST(Turns, RemembersABoundedNumberOfPrincipals) {
  Turns turns;
  for (std::size_t i = 0; i < 2 * Turns::kMostKept; ++i) {
    turns.next(std::to_string(i), {1 + 1e-3 * static_cast<double>(i), 600}, 10, {});
  }
  EXPECT_EQ(turns.size(), Turns::kMostKept);
}

TEST(ProgressChannel, NeverFallsWithinAnAttempt) {
  ProgressChannel channel;
  channel.publish_event(2);
  channel.publish_progress({0.5, "a", {}});
  channel.publish_progress({0.25, "b", 7.0});
  EXPECT_EQ(channel.latest().progress.fraction, 0.5);
  EXPECT_EQ(channel.latest().progress.stage, "b");
  const auto number = channel.latest().progress_number;
  channel.publish_event(1);
  EXPECT_EQ(channel.latest().sequence, 2) << "whoever is late with an event changes nothing";
  channel.publish_event(3);
  EXPECT_EQ(channel.latest().progress.fraction, 0);
  EXPECT_EQ(channel.latest().progress_number, number);
}

class Counter : public Observer {
 public:
  void changed() override { ++count; }
  std::atomic<int> count = 0;
};

TEST(ProgressChannel, NotifiesObserversWhileTheyExist) {
  ProgressChannel channel;
  auto observer = std::make_shared<Counter>();
  channel.observe(observer);
  channel.publish_progress({0.5, "", {}});
  EXPECT_EQ(observer->count, 1);
  observer.reset();
  channel.publish_event(1);
}

TEST(SimulationJobs, ProgressIsPublishedFourTimesASecondHoweverOftenItIsReported) {
  using std::chrono::milliseconds;
  using std::chrono::steady_clock;
  std::atomic<bool> watched = false;
  std::atomic<long> reports = 0;
  std::atomic<long> quarters = 0;
  StudyFunctions studies = quick_studies();
  studies.solve_operating_point = [&, inner = studies.solve_operating_point](
                                      const Scene& scene, const OperatingCondition& condition,
                                      const PointOptions& options, const auto& gear_set) {
    while (!watched) std::this_thread::yield();
    const auto begin = steady_clock::now();
    while (steady_clock::now() - begin < milliseconds(600)) {
      options.progress(0.5);
      ++reports;
    }
    quarters = (steady_clock::now() - begin) / milliseconds(250);
    return inner(scene, condition, options, gear_set);
  };
  Bench bench(studies);
  const std::string name = bench.create(point_simulation());
  const auto channel = bench.jobs().watch(*simulation_id(name))->channel;
  const auto before = channel->latest().progress_number;
  watched = true;
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::SUCCEEDED));
  EXPECT_GT(reports, 1000);
  EXPECT_GE(channel->latest().progress_number - before, 2U);
  EXPECT_LE(channel->latest().progress_number - before, static_cast<std::uint64_t>(quarters) + 1);
}

TEST(SimulationJobs, ASimulationSucceedsAndItsResultIsStored) {
  Bench bench;
  const std::string name = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::SUCCEEDED));
  const v1::Simulation done = bench.get(name);
  EXPECT_EQ(done.result().points(0).result().inefficiency_rms_percent(), 1.5);
  EXPECT_EQ(done.result().points(0).speed_kilometres_per_hour(), 65);
  EXPECT_EQ(done.progress_fraction(), 1);
  EXPECT_EQ(done.result().input_hash().size(), 64U);
  EXPECT_GT(done.result().assumptions_size(), 40);
}

TEST(SimulationJobs, ARefusalBecomesAFailureWithItsReason) {
  Bench bench(throwing(Refusal("NO_FORWARD_ROTATION", "the pinion stands still")));
  const std::string name = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::FAILED));
  EXPECT_EQ(bench.get(name).error().reason(), "NO_FORWARD_ROTATION");
  EXPECT_EQ(bench.get(name).error().message(), "the pinion stands still");
}

TEST(SimulationJobs, ADefectBecomesAFailureAndTheNextOneRuns) {
  const LogCapture log;
  Bench bench(throwing(std::logic_error("the defect itself")), 1);
  const std::string name = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::FAILED));
  EXPECT_EQ(bench.get(name).error().reason(), "INTERNAL");
  EXPECT_THAT(bench.get(name).error().message(), testing::Not(testing::HasSubstr("defect")));
  EXPECT_THAT(log.text(),
              testing::HasSubstr("simulation=" + name + " cause=\"the defect itself\""));
  const std::string next = bench.create(curve_simulation());
  EXPECT_TRUE(bench.reaches(next, v1::Simulation::SUCCEEDED));
}

TEST(SimulationJobs, AThrownValueOfAnyTypeBecomesAFailure) {
  Bench bench(throwing(42));
  EXPECT_TRUE(bench.reaches(bench.create(point_simulation()), v1::Simulation::FAILED));
}

TEST(SimulationJobs, LackOfMemoryBecomesAFailure) {
  Bench bench(throwing(std::bad_alloc()));
  const std::string name = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::FAILED));
  EXPECT_EQ(bench.get(name).error().reason(), "OUT_OF_MEMORY");
}

TEST(SimulationJobs, NumbersThatAreNotFiniteNeverBecomeAResult) {
  StudyFunctions studies = quick_studies();
  studies.solve_operating_point = [](const Scene&, const OperatingCondition&, const PointOptions&,
                                     const auto&) {
    PointResult out;
    out.film_ratio.mean = std::numeric_limits<double>::quiet_NaN();
    return out;
  };
  Bench bench(studies);
  const std::string name = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::FAILED));
  EXPECT_EQ(bench.get(name).error().reason(), "RESULT_NOT_FINITE");
  EXPECT_THAT(bench.get(name).error().message(), testing::HasSubstr("film_ratio.mean"));
}

TEST(SimulationJobs, ARunningSimulationStopsWhenCancelled) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 1);
  const std::string name = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::RUNNING));
  bench.jobs().scheduler().cancel(*simulation_id(name));
  EXPECT_EQ(bench.get(name).state(), v1::Simulation::CANCELLED) << "at once";
  const std::string next = bench.create(curve_simulation());
  EXPECT_TRUE(bench.reaches(next, v1::Simulation::RUNNING)) << "the only thread is free again";
  *release = true;
  EXPECT_TRUE(bench.reaches(next, v1::Simulation::SUCCEEDED));
  EXPECT_EQ(bench.get(name).state(), v1::Simulation::CANCELLED);
  EXPECT_FALSE(bench.get(name).has_result());
}

TEST(SimulationJobs, AWaitingSimulationIsCancelledWithoutRunning) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 1);
  const std::string first = bench.create(point_simulation());
  const std::string second = bench.create(point_simulation());
  bench.jobs().scheduler().cancel(*simulation_id(second));
  *release = true;
  EXPECT_TRUE(bench.reaches(first, v1::Simulation::SUCCEEDED));
  EXPECT_EQ(bench.get(second).state(), v1::Simulation::CANCELLED);
  EXPECT_FALSE(bench.get(second).has_start_time());
}

TEST(SimulationJobs, ProgressIsMonotoneAndRateLimited) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 1);
  const std::string name = bench.create(curve_simulation());
  const auto channel = bench.jobs().watch(*simulation_id(name))->channel;
  auto counter = std::make_shared<Counter>();
  channel->observe(counter);
  double last = 0;
  const auto begin = std::chrono::steady_clock::now();
  while (last < 0.6) {
    const double now = channel->latest().progress.fraction;
    ASSERT_GE(now, last);
    last = now;
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(counter->count, 2 + 4 * seconds.count()) << "at most four a second, and the state";
  EXPECT_THAT(channel->latest().progress.stage,
              testing::HasSubstr("settling at 20 km/h, point 1 of 13"));
  *release = true;
  EXPECT_TRUE(bench.reaches(name, v1::Simulation::SUCCEEDED));
  EXPECT_TRUE(eventually([&] { return channel->latest().sequence == 3; }));
}

TEST(SimulationJobs, AStopQueuesRunningSimulationsAgain) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 1);
  const std::string running = bench.create(point_simulation());
  const std::string waiting = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(running, v1::Simulation::RUNNING));
  bench.jobs().stop();
  EXPECT_EQ(bench.get(running).state(), v1::Simulation::QUEUED);
  EXPECT_EQ(bench.get(waiting).state(), v1::Simulation::QUEUED);
  bench.restart(quick_studies());
  EXPECT_TRUE(bench.reaches(running, v1::Simulation::SUCCEEDED));
  EXPECT_TRUE(bench.reaches(waiting, v1::Simulation::SUCCEEDED));
}

TEST(SimulationJobs, WatchingAnEndedSimulationShowsItsEnd) {
  Bench bench(throwing(Refusal("WORK_LIMIT", "too long")));
  const std::string name = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(name, v1::Simulation::FAILED));
  bench.restart(quick_studies());
  const auto watched = bench.jobs().watch(*simulation_id(name));
  EXPECT_EQ(watched->simulation.state, StoredState::kFailed);
  EXPECT_EQ(watched->simulation.error_reason, "WORK_LIMIT");
  EXPECT_FALSE(bench.jobs().watch(4711));
  EXPECT_FALSE(bench.jobs().progress(*simulation_id(name))) << "nothing is kept of the ended";
}

TEST(GoldenCase, PassesAndAWrongFigureIsNamed) {
  EXPECT_EQ(check_golden_case(), "");
  EXPECT_THAT(check_golden_case(quick_studies()),
              testing::AllOf(testing::HasSubstr("pinion_torque_newton_metres is 0"),
                             testing::HasSubstr("33.15")));
  EXPECT_THAT(check_golden_case(throwing(Refusal("X", "no answer"))),
              testing::HasSubstr("no answer"));
}

TEST(SimulationJobs, ASimulationWhoseResultIsBeingWrittenIsNotComputedAgain) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 1);
  v1::Simulation slowly_written = point_simulation();
  v1::HistoryRequest* history = slowly_written.mutable_operating_point()->mutable_history();
  history->add_columns("mesh_force_newtons");
  history->set_mesh_cycles(20);
  history->set_samples_per_mesh_cycle(50'000);
  const std::string first = bench.create(slowly_written);
  const std::string second = bench.create(slowly_written);
  *release = true;
  ASSERT_TRUE(bench.reaches(second, v1::Simulation::SUCCEEDED));
  EXPECT_FALSE(bench.get(first).cache_hit());
  EXPECT_TRUE(bench.get(second).cache_hit());
}

TEST(SimulationJobs, AFullQueueRefusesSimulations) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 1, {.jobs = 2});
  const std::string running = bench.create(point_simulation());
  ASSERT_TRUE(bench.reaches(running, v1::Simulation::RUNNING));
  bench.create(point_simulation());
  bench.create(point_simulation());
  EXPECT_EQ(bench.jobs()
                .scheduler()
                .admit({.request = "request", .key = {std::string(64, 'a'), "model", "platform"}},
                       nullptr)
                .added.kind,
            AddOutcome::Kind::kNoPlace);
  *release = true;
}

}  // namespace
}  // namespace tribodyn::server
