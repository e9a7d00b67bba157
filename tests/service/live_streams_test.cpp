// Tests of the clock of the open streams of a transport.
#include "server/application/live_streams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;
using Clock = LiveStreams::Clock;

/// Returns, from each call of look_at_clock(), the time after the next of its pauses; after the
/// last pause nullopt.
class PausingStream : public LiveStream {
 public:
  explicit PausingStream(std::vector<milliseconds> pauses = {}) : pauses_(std::move(pauses)) {}
  void shut_down(const google::rpc::Status&) override { is_shut_down = true; }
  std::optional<Clock::time_point> look_at_clock() override {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    EXPECT_GE(now, next_) << "looked at too early";
    latest_ = looks_ == 0 ? Clock::duration(0) : std::max(latest_, now - next_);
    const std::size_t look = looks_++;
    if (look == pauses_.size()) return std::nullopt;
    next_ = now + pauses_[look];
    return next_;
  }
  std::size_t looks() const {
    const std::lock_guard lock(mutex_);
    return looks_;
  }
  /// By how much a look was late at most.
  Clock::duration latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
  }

  std::atomic<bool> is_shut_down = false;

 private:
  const std::vector<milliseconds> pauses_;
  mutable std::mutex mutex_;
  std::size_t looks_ = 0;                     // guarded by mutex_
  Clock::time_point next_{};                  // guarded by mutex_
  Clock::duration latest_ = milliseconds(0);  // guarded by mutex_
};

/// Returns false if that does not happen within ten seconds.
template <class Condition>
bool happens(const Condition& condition) {
  const auto until = Clock::now() + std::chrono::seconds(10);
  while (!condition()) {
    if (Clock::now() > until) return false;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return true;
}

TEST(LiveStreams, LookAtTheClockOfEachStreamWhenItSaysAndNeverBefore) {
  LiveStreams streams(100);
  std::vector<std::shared_ptr<PausingStream>> all;
  for (int i = 0; i < 50; ++i) {
    all.push_back(std::make_shared<PausingStream>(
        std::vector{milliseconds(i), milliseconds(150), milliseconds(50 - i)}));
    ASSERT_FALSE(streams.add(all.back()));
    streams.follow_clock(*all.back());
  }
  for (const auto& each : all) {
    EXPECT_TRUE(happens([&] { return each->looks() == 4; }));
    EXPECT_LT(each->latest(), std::chrono::seconds(5)) << "the interval and a busy machine's delay";
  }
}

TEST(LiveStreams, WakesForAStreamWhoseTimeComesBeforeThatOfTheOthers) {
  LiveStreams streams(2);
  const auto late = std::make_shared<PausingStream>(std::vector{milliseconds(3'600'000)});
  const auto early = std::make_shared<PausingStream>(std::vector{milliseconds(1)});
  for (const auto& each : {late, early}) {
    ASSERT_FALSE(streams.add(each));
    streams.follow_clock(*each);
  }
  EXPECT_TRUE(happens([&] { return early->looks() == 2; }));
  EXPECT_EQ(late->looks(), 1);
}

TEST(LiveStreams, AStreamThatWasRemovedIsNotLookedAt) {
  LiveStreams streams(2);
  const auto gone = std::make_shared<PausingStream>(std::vector{milliseconds(1000)});
  const auto other = std::make_shared<PausingStream>(std::vector{milliseconds(1100)});
  for (const auto& each : {gone, other}) {
    ASSERT_FALSE(streams.add(each));
    streams.follow_clock(*each);
  }
  streams.remove(gone.get());
  EXPECT_TRUE(happens([&] { return other->looks() == 2; }));
  EXPECT_EQ(gone->looks(), 0);
  EXPECT_EQ(gone.use_count(), 1);
}

TEST(LiveStreams, AShutdownReachesEachStreamAndEndsTheClock) {
  LiveStreams streams(2);
  const auto stream = std::make_shared<PausingStream>(std::vector{milliseconds(50)});
  ASSERT_FALSE(streams.add(stream));
  streams.follow_clock(*stream);
  streams.shut_down();
  EXPECT_TRUE(stream->is_shut_down);
  const std::size_t looks = stream->looks();
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_EQ(stream->looks(), looks);
  EXPECT_TRUE(streams.add(std::make_shared<PausingStream>())) << "a stream opens after a shutdown";
}

}  // namespace
}  // namespace tribodyn::server
