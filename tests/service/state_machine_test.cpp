// Compares the life cycle of simulations in the store with a model over random schedules.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "server/storage/maintenance.h"
#include "server/storage/store.h"
#include "tests/service/schedule_seed.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {
namespace {

constexpr int kSchedules = kUnderSanitizer ? 1'000 : 10'000;  // ten times slower, and one thread
constexpr int kSteps = 12;
constexpr int kInputs = 2;
constexpr int kRequestIds = 2;

/// Returns true if `to` may follow `from`, as life_cycle.h states it.
bool may_follow(StoredState from, StoredState to) {
  if (from == StoredState::kQueued) return to != StoredState::kQueued;
  return from == StoredState::kRunning && to != StoredState::kRunning;
}

/// The expected state of a simulation.
struct Expected {
  std::string hash;
  std::string request_hash;
  bool is_forced = false;
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  int lost_attempts = 0;
  std::string worker = {};  ///< while it runs
  Microseconds lease_end = 0;
  bool cache_hit = false;
  std::vector<StoredEvent> events;

  bool may(StoredState to) const { return may_follow(state, to); }
  void go(StoredState to, Microseconds now, const std::string& reason = "") {
    if (to == StoredState::kQueued) ++attempt;
    state = to;
    events.push_back({.sequence = static_cast<std::int64_t>(events.size()) + 1,
                      .time = now,
                      .state = to,
                      .attempt = attempt,
                      .reason = reason});
  }
};

/// Runs one schedule on the store and on the model, and reports differences.
class Schedule {
 public:
  Schedule(Store& store, int number, std::uint64_t seed)
      : store_(store), number_(number), random_(seed) {}

  void run() {
    for (int step = 0; step < kSteps && !testing::Test::HasFailure(); ++step) {
      take_step();
      compare_rows();
    }
    compare_events();
    for (auto& [id, each] : jobs_) {  // leave no unfinished simulation for the next schedule
      if (!has_ended(each.state)) {
        EXPECT_TRUE(store_.mark_cancelled(id, ++now_)) << log_;
      }
    }
  }

  const std::string& log() const { return log_; }

 private:
  int draw(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  ResultKey key(const std::string& hash) const { return {hash, "model", "platform"}; }
  std::string hash(int input) const { return fmt::format("{:064d}", number_ * kInputs + input); }

  void take_step() {
    ++now_;
    const int kind = draw(10);
    if (jobs_.empty() || kind <= 1) return submit();
    if (kind == 2) return die();
    auto job = jobs_.begin();
    std::advance(job, draw(static_cast<int>(jobs_.size())));
    switch (kind) {
      case 3:
        return start(job->first, job->second);
      case 4:
        return succeed(job->first, job->second);
      case 5:
        return end(job->first, job->second, StoredState::kFailed);
      case 6:
        return end(job->first, job->second, StoredState::kCancelled);
      case 7:
        return lose(job->first, job->second);
      case 8:
        return extend(job->first, job->second);
      default:
        return go_back(job->first, job->second);
    }
  }

  void submit() {
    const std::string input = hash(draw(kInputs));
    const bool forced = draw(4) == 0;
    const int id_drawn = draw(kRequestIds + 1);
    const std::string request_id = id_drawn == 0 ? "" : fmt::format("{}-{}", number_, id_drawn);
    const std::string request_hash = input + (forced ? "forced" : "");
    const bool may_wait = draw(4) != 0;
    log_ += fmt::format("submit {} {} {} {}\n", input.substr(58), forced, request_id, may_wait);
    const AddOutcome added = store_.add_simulation({.request = "",
                                                    .key = key(input),
                                                    .request_id = request_id,
                                                    .request_hash = request_hash,
                                                    .is_forced = forced},
                                                   now_, may_wait);
    const auto earlier = request_ids_.find(request_id);
    if (earlier != request_ids_.end()) {
      EXPECT_EQ(added.id, earlier->second) << log_;
      EXPECT_EQ(added.kind, jobs_.at(added.id).request_hash == request_hash
                                ? AddOutcome::Kind::kRepeated
                                : AddOutcome::Kind::kRequestIdTaken)
          << log_;
      return;
    }
    const bool served = !forced && results_.contains(input);
    if (!served && !may_wait) {
      EXPECT_EQ(added.kind, AddOutcome::Kind::kNoPlace) << log_;
      return;
    }
    EXPECT_EQ(added.kind, served ? AddOutcome::Kind::kServed : AddOutcome::Kind::kQueued) << log_;
    EXPECT_FALSE(jobs_.contains(added.id)) << log_;
    Expected& job = jobs_[added.id];
    job = {.hash = input, .request_hash = request_hash, .is_forced = forced, .events = {}};
    job.events.push_back({.sequence = 1, .time = now_, .reason = ""});
    if (served) serve(job);
    if (!request_id.empty()) request_ids_[request_id] = added.id;
  }

  void serve(Expected& job) const {
    job.cache_hit = true;
    job.go(StoredState::kSucceeded, now_);
  }

  void start(std::int64_t id, Expected& job) {
    log_ += fmt::format("start {}\n", id);
    const LeaseTerms lease{draw(2) == 0 ? LeaseTerms::kLocalWorker : "far", now_ + draw(8)};
    const auto event = store_.mark_running(id, now_, key(job.hash), lease);
    EXPECT_EQ(event.has_value(), job.state == StoredState::kQueued) << log_;
    if (job.state != StoredState::kQueued) return;
    if (!job.is_forced && results_.contains(job.hash)) {
      serve(job);
    } else {
      job.go(StoredState::kRunning, now_);
      job.worker = lease.worker;
      job.lease_end = lease.expire_time;
    }
  }

  /// The present attempt, or the one before it.
  int drawn_attempt(const Expected& job) { return job.attempt - (draw(4) == 0 ? 1 : 0); }

  void lose(std::int64_t id, Expected& job) {
    const int attempt = drawn_attempt(job);
    log_ += fmt::format("lose {} {}\n", id, attempt);
    const auto event = store_.mark_lost(id, attempt, now_, "LEASE_EXPIRED");
    const bool may = job.state == StoredState::kRunning && attempt == job.attempt;
    EXPECT_EQ(event.has_value(), may) << log_;
    if (may) lose_attempt(job, "LEASE_EXPIRED");
  }

  void lose_attempt(Expected& job, const std::string& reason) const {
    const bool for_good = ++job.lost_attempts == kMaximumLostAttempts;
    job.go(for_good ? StoredState::kFailed : StoredState::kQueued, now_, reason);
  }

  void extend(std::int64_t id, Expected& job) {
    const int attempt = drawn_attempt(job);
    log_ += fmt::format("extend {} {}\n", id, attempt);
    const bool may = job.state == StoredState::kRunning && attempt == job.attempt;
    EXPECT_EQ(store_.extend_lease(id, attempt, now_ + 8), may) << log_;
    if (may) job.lease_end = now_ + 8;
  }

  void succeed(std::int64_t id, Expected& job) {
    const bool other_bits = draw(8) == 0;
    const int attempt = drawn_attempt(job);
    log_ += fmt::format("succeed {} {} {}\n", id, attempt, other_bits);
    v1::SimulationResult result;
    result.set_input_hash(job.hash);
    if (other_bits) result.set_direction(v1::SWEEP_DIRECTION_DOWN);
    const std::string body = result.SerializeAsString();
    const auto event =
        store_.mark_succeeded(id, now_, {key(job.hash), body, {{"a", {1, 2}}}}, attempt);
    const bool may = job.state == StoredState::kRunning && attempt == job.attempt;
    EXPECT_EQ(event.has_value(), may) << log_;
    if (!may) return;
    const auto before = results_.find(job.hash);
    if (before != results_.end() && before->second != body) {
      return job.go(StoredState::kFailed, now_);
    }
    results_[job.hash] = body;
    job.go(StoredState::kSucceeded, now_);
  }

  void end(std::int64_t id, Expected& job, StoredState to) {
    log_ += fmt::format("end {} {}\n", id, static_cast<int>(to));
    const auto event = to == StoredState::kCancelled ? store_.mark_cancelled(id, now_)
                                                     : store_.mark_failed(id, now_, "X", "y");
    EXPECT_EQ(event.has_value(), job.may(to)) << log_;
    if (job.may(to)) job.go(to, now_);
  }

  void go_back(std::int64_t id, Expected& job) {
    log_ += fmt::format("go back {}\n", id);
    const auto event = store_.mark_queued(id, now_, "SERVER_STOPPED");
    EXPECT_EQ(event.has_value(), job.may(StoredState::kQueued)) << log_;
    if (event) job.go(StoredState::kQueued, now_, "SERVER_STOPPED");
  }

  void die() {
    log_ += "die\n";
    std::vector<std::int64_t> waiting;
    for (auto& [id, job] : jobs_) {
      const bool is_lost = job.worker == LeaseTerms::kLocalWorker || job.lease_end <= now_;
      if (job.state == StoredState::kRunning && is_lost) lose_attempt(job, "SERVER_LOST");
      if (!has_ended(job.state)) waiting.push_back(id);
    }
    std::vector<std::int64_t> found;
    for (const UnfinishedSimulation& each : store_.requeue_unfinished(now_)) {
      found.push_back(each.id);
      EXPECT_EQ(each.lease.has_value(), jobs_.at(each.id).state == StoredState::kRunning) << log_;
    }
    EXPECT_EQ(found, waiting) << log_;
  }

  void compare_rows() {
    for (const auto& [id, job] : jobs_) {
      const auto row = store_.simulation(id);
      ASSERT_TRUE(row) << log_;
      EXPECT_EQ(row->state, job.state) << log_;
      EXPECT_EQ(row->attempt, job.attempt) << log_;
      EXPECT_EQ(row->cache_hit, job.cache_hit) << log_;
      EXPECT_EQ(row->sequence, static_cast<std::int64_t>(job.events.size())) << log_;
      EXPECT_EQ(row->end_time.has_value(), has_ended(job.state)) << log_;
    }
  }

  void compare_events() {
    for (const auto& [id, job] : jobs_) {
      const auto count = static_cast<std::int64_t>(job.events.size());
      for (std::int64_t after = 0; after < count; ++after) {
        const auto event = store_.next_event(id, after);
        const StoredEvent& expected = job.events[static_cast<std::size_t>(after)];
        ASSERT_TRUE(event) << log_;
        EXPECT_EQ(event->sequence, expected.sequence) << log_;
        EXPECT_EQ(event->time, expected.time) << log_;
        EXPECT_EQ(event->state, expected.state) << log_;
        EXPECT_EQ(event->attempt, expected.attempt) << log_;
        EXPECT_EQ(event->reason, expected.reason) << log_;
      }
      EXPECT_FALSE(store_.next_event(id, count)) << log_;
      if (job.state == StoredState::kSucceeded) {
        EXPECT_EQ(store_.result(id), results_.at(job.hash)) << log_;
        EXPECT_EQ(history_rows(store_, id, "a", 1, 1), std::vector<double>{2}) << log_;
      }
    }
  }

  Store& store_;
  const int number_;
  std::mt19937_64 random_;
  Microseconds now_ = 0;
  std::map<std::int64_t, Expected> jobs_;
  std::map<std::string, std::string> results_;
  std::map<std::string, std::int64_t> request_ids_;
  std::string log_;
};

TEST(StateMachine, AgreesWithItsModelOverRandomSchedules) {
  const std::uint64_t seed = first_schedule_seed();
  const TemporaryFolder folder(TemporaryFolder::Kind::kMemory);
  const std::string path = folder.file("tribodyn.db");
  {
    Store store(path);
    for (int number = 0; number < kSchedules && !HasFailure(); ++number) {
      Schedule(store, number, seed + static_cast<std::uint64_t>(number)).run();
    }
  }
  EXPECT_FALSE(HasFailure()) << "TRIBODYN_TEST_SEED=" << seed;
  EXPECT_THAT(check_database(path), testing::IsEmpty());
}

}  // namespace
}  // namespace tribodyn::server
