// Tests of the states of a stream, without a transport: in random orders, and from several threads.
#include "server/application/stream_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/workers.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;
using Clock = StreamMachine::Clock;

google::rpc::Status status_of(google::rpc::Code code) {
  google::rpc::Status out;
  out.set_code(code);
  return out;
}

/// Messages 1, 2, ... as they become available. Complains if it is asked by two threads at once.
class CountingSource : public AnyMessageSource {
 public:
  explicit CountingSource(bool is_short = false, bool is_ahead = false)
      : is_short_(is_short), is_ahead_(is_ahead) {}
  bool is_short() const override { return is_short_; }
  bool follows_changes() const override { return reports_changes; }
  bool may_be_ahead() const override { return is_ahead_; }
  int given() const { return given_; }
  bool may_continue() const override { return !says_when_it_waits || given_ < available; }
  Step next_message(google::protobuf::Message& out) override {
    EXPECT_FALSE(is_asked_.exchange(true)) << "two threads ask at once";
    EXPECT_FALSE(has_ended_) << "asked after the end";
    Step step = Step::kWait;
    if (given_ < available) {
      static_cast<v1::SimulationEvent&>(out).set_sequence(++given_);
      step = Step::kMessage;
    } else if (is_closed && given_ >= available) {
      has_ended_ = true;
      step = Step::kEnd;
    }
    is_asked_ = false;
    return step;
  }

  std::atomic<int> available = 0;
  std::atomic<bool> is_closed = false;  // set after the last message is available
  bool says_when_it_waits = false;
  bool reports_changes = false;

 private:
  const bool is_short_, is_ahead_;
  std::atomic<bool> is_asked_ = false;
  int given_ = 0;  // the machine lets one thread ask at a time
  bool has_ended_ = false;
};

/// What both transports of the tests check.
class CheckedTransport : public StreamTransport {
 public:
  std::optional<google::rpc::Status> write(const google::protobuf::Message& message) override {
    const std::lock_guard lock(mutex_);
    EXPECT_FALSE(is_writing_) << "two writes at once";
    EXPECT_FALSE(end_) << "a write after the end";
    is_writing_ = true;
    EXPECT_EQ(static_cast<const v1::SimulationEvent&>(message).sequence(), ++begun_);
    return std::nullopt;
  }
  void finish(const google::rpc::Status& status) override {
    const std::lock_guard lock(mutex_);
    EXPECT_FALSE(is_writing_) << "an end during a write";
    EXPECT_FALSE(end_) << "two ends";
    end_ = status;
  }
  void cut_off() override { is_cut_off_ = true; }

  /// Ends the write that is under way. Returns false if there is none.
  bool end_write() {
    const std::lock_guard lock(mutex_);
    return std::exchange(is_writing_, false);
  }
  bool is_writing() const {
    const std::lock_guard lock(mutex_);
    return is_writing_;
  }
  std::optional<google::rpc::Status> end() const {
    const std::lock_guard lock(mutex_);
    return end_;
  }
  int begun() const {
    const std::lock_guard lock(mutex_);
    return begun_;
  }
  bool is_cut_off() const { return is_cut_off_; }

 private:
  mutable std::mutex mutex_;
  bool is_writing_ = false;                 // guarded by mutex_
  int begun_ = 0;                           // guarded by mutex_; number of writes
  std::optional<google::rpc::Status> end_;  // guarded by mutex_
  std::atomic<bool> is_cut_off_ = false;
};

/// Steps wait until the test runs them.
class ManualTransport : public CheckedTransport {
 public:
  void run_step() override {
    EXPECT_FALSE(is_step_due) << "two steps at once";
    is_step_due = true;
  }
  bool is_step_due = false;
};

struct Manual {
  explicit Manual(Clock::duration unread = std::chrono::minutes(1),
                  Clock::duration lasts = std::chrono::hours(1), bool is_ahead = false)
      : source(std::make_shared<CountingSource>(false, is_ahead)),
        machine(transport, v1::SimulationEvent::default_instance(), unread),
        begin(Clock::now()) {
    machine.open(source, begin + lasts);
  }
  bool run_step() {
    if (!std::exchange(transport.is_step_due, false)) return false;
    machine.step();
    return true;
  }
  bool end_write(bool ok = true) {
    if (!transport.end_write()) return false;
    machine.written(ok);
    return true;
  }
  void feed() {
    ++source->available;
    machine.changed();
  }
  void run_all() {
    while (run_step() || end_write()) {
    }
  }
  int code() const { return transport.end() ? transport.end()->code() : -1; }

  std::shared_ptr<CountingSource> source;
  ManualTransport transport;
  StreamMachine machine;
  Clock::time_point begin;
};

TEST(StreamMachine, WritesEveryMessageOnceInEveryOrderOfEvents) {
  const int schedules = kUnderSanitizer ? 2000 : 20'000;
  for (int seed = 0; seed < schedules; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    Manual stream(std::chrono::minutes(1), std::chrono::hours(1), seed % 2 == 1);
    stream.source->reports_changes = seed % 4 < 2;
    bool is_disturbed = false;
    std::optional<int> available_at_shutdown;
    for (int i = 0; i < 60; ++i) {
      switch (random() % 12) {
        case 0:
        case 1:
        case 2:
          stream.feed();
          break;
        case 3:
          stream.machine.changed();
          break;
        case 4:
          stream.machine.look_at_clock(stream.begin + milliseconds(random() % 1000));
          break;
        case 5:
          if (random() % 20 == 0) {
            stream.machine.close(status_of(google::rpc::UNAVAILABLE));
            is_disturbed = true;
          }
          break;
        case 6:
          if (random() % 20 == 0) is_disturbed |= stream.end_write(false);
          if (random() % 20 == 0 && !available_at_shutdown) {
            available_at_shutdown = stream.source->available;
            stream.machine.shut_down(status_of(google::rpc::UNAVAILABLE));
          }
          break;
        case 7:
        case 8:
          stream.end_write();
          break;
        default:
          stream.run_step();
      }
      const bool is_idle = !stream.transport.is_step_due && !stream.transport.is_writing();
      if (is_idle && !stream.transport.end()) {
        ASSERT_EQ(stream.transport.begun(), stream.source->available)
            << "schedule " << seed << ": nobody will ask for what is available";
      }
    }
    stream.source->is_closed = true;
    stream.machine.changed();
    stream.run_all();
    ASSERT_TRUE(stream.transport.end()) << "schedule " << seed;
    if (available_at_shutdown) {
      if (!is_disturbed && stream.source->reports_changes) {
        ASSERT_GE(stream.transport.begun(), *available_at_shutdown) << "schedule " << seed;
      }
    } else if (!is_disturbed) {
      ASSERT_EQ(stream.code(), google::rpc::OK);
      ASSERT_EQ(stream.transport.begun(), stream.source->available) << "schedule " << seed;
    }
    stream.machine.changed();
    stream.machine.close(status_of(google::rpc::CANCELLED));
    ASSERT_FALSE(stream.transport.is_step_due) << "nothing happens after the end";
  }
}

TEST(StreamMachine, HoldsOneMessageForASlowClient) {
  Manual stream;
  for (int i = 0; i < 100; ++i) stream.feed();
  stream.run_step();
  for (int i = 0; i < 100; ++i) stream.machine.changed();
  EXPECT_FALSE(stream.transport.is_step_due) << "it is asked again when the first one is written";
  EXPECT_EQ(stream.transport.begun(), 1);
}

TEST(StreamMachine, PreparesOneMessageWhileTheClientReadsTheOneBefore) {
  Manual stream(std::chrono::minutes(1), std::chrono::hours(1), true);
  for (int i = 0; i < 100; ++i) stream.feed();
  for (int written = 1; written < 4; ++written) {
    EXPECT_TRUE(stream.run_step());
    EXPECT_EQ(stream.transport.begun(), written);
    EXPECT_TRUE(stream.run_step()) << "the write goes on meanwhile";
    EXPECT_EQ(stream.source->given(), written + 1);
    stream.machine.changed();
    EXPECT_FALSE(stream.transport.is_step_due) << "no third message waits for the client";
    EXPECT_TRUE(stream.end_write());
  }
}

TEST(StreamMachine, AMessageThatIsWrittenBeforeTheNextOneIsPreparedDelaysNothing) {
  Manual stream(std::chrono::minutes(1), std::chrono::hours(1), true);
  for (int i = 0; i < 3; ++i) stream.feed();
  EXPECT_TRUE(stream.run_step());
  EXPECT_TRUE(stream.end_write());
  EXPECT_TRUE(stream.run_step());
  EXPECT_EQ(stream.transport.begun(), 2) << "the step writes what it has pulled";
}

TEST(StreamMachine, AClientThatIsGoneReceivesNoPreparedMessage) {
  for (const bool is_prepared : {true, false}) {
    Manual stream(std::chrono::minutes(1), std::chrono::hours(1), true);
    for (int i = 0; i < 3; ++i) stream.feed();
    EXPECT_TRUE(stream.run_step());
    if (is_prepared) stream.run_step();
    EXPECT_TRUE(stream.end_write(false));
    stream.run_step();
    EXPECT_EQ(stream.code(), google::rpc::CANCELLED);
    EXPECT_EQ(stream.transport.begun(), 1);
  }
}

TEST(StreamMachine, TheFirstMessageNeedsNoFurtherThread) {
  ManualTransport transport;
  StreamMachine machine(transport, v1::SimulationEvent::default_instance(),
                        std::chrono::minutes(1));
  const auto source = std::make_shared<CountingSource>();
  source->available = 1;
  machine.open(source, Clock::now() + std::chrono::hours(1));
  EXPECT_EQ(transport.begun(), 1);
  EXPECT_FALSE(transport.is_step_due);
}

/// Runs short steps on the thread that reports the end of a write.
class InlineTransport : public ManualTransport {
 public:
  void run_short_step() override { machine->step(); }
  StreamMachine* machine = nullptr;
};

TEST(StreamMachine, OnlyTheEndOfAWriteCausesAShortStep) {
  InlineTransport transport;
  StreamMachine machine(transport, v1::SimulationEvent::default_instance(),
                        std::chrono::minutes(1));
  transport.machine = &machine;
  const auto source = std::make_shared<CountingSource>(true);
  source->available = 2;
  machine.open(source, Clock::now() + std::chrono::hours(1));
  for (int written = 1; written <= 2; ++written) {
    EXPECT_EQ(transport.begun(), written);
    transport.end_write();
    machine.written(true);
  }
  EXPECT_FALSE(transport.is_step_due);
  ++source->available;
  machine.changed();
  EXPECT_TRUE(transport.is_step_due) << "observers are told on threads that must not wait";
}

TEST(StreamMachine, TakesNoStepAfterAMessageThatNothingFollows) {
  Manual stream;
  stream.source->says_when_it_waits = true;
  stream.source->available = 2;
  stream.machine.changed();
  EXPECT_TRUE(stream.run_step());
  EXPECT_TRUE(stream.end_write());
  EXPECT_TRUE(stream.run_step()) << "the second message";
  EXPECT_TRUE(stream.end_write());
  EXPECT_FALSE(stream.transport.is_step_due);
  stream.feed();
  EXPECT_TRUE(stream.run_step()) << "a change after the last write";
  stream.machine.changed();
  EXPECT_TRUE(stream.end_write());
  EXPECT_TRUE(stream.run_step()) << "a change during the last write";
  stream.machine.close(status_of(google::rpc::UNAVAILABLE));
  EXPECT_EQ(stream.code(), google::rpc::UNAVAILABLE);
}

TEST(StreamMachine, CutsOffAClientThatDoesNotReadAMessage) {
  Manual stream(milliseconds(100));
  stream.feed();
  stream.run_step();
  const auto now = Clock::now();
  const auto next = stream.machine.look_at_clock(now);
  ASSERT_TRUE(next);
  EXPECT_LE(*next, now + milliseconds(100));
  EXPECT_FALSE(stream.transport.is_cut_off());
  EXPECT_FALSE(stream.machine.look_at_clock(now + milliseconds(100)));
  EXPECT_TRUE(stream.transport.is_cut_off());
  EXPECT_TRUE(stream.end_write(false));
  EXPECT_EQ(stream.code(), google::rpc::CANCELLED);
}

TEST(StreamMachine, AnIdleStreamEndsAtItsTime) {
  Manual stream(std::chrono::minutes(1), milliseconds(100));
  stream.run_step();
  EXPECT_EQ(stream.machine.look_at_clock(stream.begin), stream.begin + milliseconds(100));
  stream.machine.look_at_clock(stream.begin + milliseconds(100));
  EXPECT_EQ(stream.code(), google::rpc::DEADLINE_EXCEEDED);
}

TEST(StreamMachine, AWriteMayEndSoonAfterTheStreamsTime) {
  for (const bool client_reads : {true, false}) {
    Manual stream(std::chrono::minutes(1), milliseconds(100));
    stream.feed();
    stream.feed();
    stream.run_step();
    const auto end = stream.begin + milliseconds(100);
    EXPECT_EQ(stream.machine.look_at_clock(end), end + StreamMachine::kLastWrite);
    EXPECT_FALSE(stream.transport.end()) << "a write is under way";
    if (client_reads) {
      stream.end_write();
      stream.run_all();
      EXPECT_EQ(stream.code(), google::rpc::DEADLINE_EXCEEDED);
      EXPECT_EQ(stream.transport.begun(), 1) << "no further message after the end";
    } else {
      stream.machine.look_at_clock(end + StreamMachine::kLastWrite);
      EXPECT_TRUE(stream.transport.is_cut_off());
    }
  }
}

TEST(StreamMachine, AShutdownWhileItIsOpenedEndsIt) {
  ManualTransport transport;
  StreamMachine machine(transport, v1::SimulationEvent::default_instance(),
                        std::chrono::minutes(1));
  machine.close(status_of(google::rpc::UNAVAILABLE));
  EXPECT_FALSE(transport.end()) << "whoever opens it owns it";
  machine.open(std::make_shared<CountingSource>(), Clock::now() + std::chrono::hours(1));
  EXPECT_EQ(transport.end()->code(), google::rpc::UNAVAILABLE);
}

TEST(StreamMachine, AShutdownEndsAStreamOfChangesAfterTheLastOne) {
  for (const bool is_writing : {false, true}) {
    Manual stream;
    stream.source->reports_changes = true;
    stream.source->says_when_it_waits = true;
    if (is_writing) {
      stream.feed();
      stream.run_step();
    }
    stream.source->available += 2;  // their notification is under way
    stream.machine.shut_down(status_of(google::rpc::UNAVAILABLE));
    EXPECT_FALSE(stream.transport.end());
    stream.run_all();
    EXPECT_EQ(stream.transport.begun(), is_writing ? 3 : 2);
    EXPECT_EQ(stream.code(), google::rpc::UNAVAILABLE);
  }
}

TEST(StreamMachine, AShutdownEndsAStreamWhoseMessagesNeverEnd) {
  Manual stream;
  stream.source->reports_changes = true;
  const auto begin = Clock::now();
  stream.machine.shut_down(status_of(google::rpc::UNAVAILABLE));
  while (!stream.transport.end() && Clock::now() < begin + 4 * StreamMachine::kLastChanges) {
    ++stream.source->available;
    stream.run_step();
    stream.end_write();
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(stream.code(), google::rpc::UNAVAILABLE);
  EXPECT_GE(Clock::now() - begin, StreamMachine::kLastChanges);
  EXPECT_GT(stream.transport.begun(), 1);
}

TEST(StreamMachine, AShutdownEndsOtherStreamsBeforeTheirNextMessage) {
  Manual stream;
  stream.source->available = 2;
  stream.machine.shut_down(status_of(google::rpc::UNAVAILABLE));
  EXPECT_EQ(stream.code(), google::rpc::UNAVAILABLE);
  EXPECT_EQ(stream.transport.begun(), 0);
}

TEST(StreamMachine, AClientThatLeavesDuringAShutdownEndsAStreamOfChanges) {
  Manual stream;
  stream.source->reports_changes = true;
  stream.source->available = 2;
  stream.machine.shut_down(status_of(google::rpc::UNAVAILABLE));
  EXPECT_TRUE(stream.run_step());
  stream.machine.close(status_of(google::rpc::CANCELLED));
  EXPECT_TRUE(stream.end_write());
  stream.run_all();
  EXPECT_EQ(stream.code(), google::rpc::CANCELLED);
  EXPECT_EQ(stream.transport.begun(), 1);
}

/// Steps and ends of writes on threads of their own.
class ThreadedTransport : public CheckedTransport {
 public:
  explicit ThreadedTransport(Workers& workers) : workers_(workers) {}
  void run_step() override {
    run([this] { machine->step(); });
  }
  std::optional<google::rpc::Status> write(const google::protobuf::Message& message) override {
    CheckedTransport::write(message);
    run([this] {
      if (end_write()) machine->written(!is_cut_off());
    });
    return std::nullopt;
  }
  StreamMachine* machine = nullptr;

 private:
  void run(std::function<void()> task) { workers_.run(0, task); }
  Workers& workers_;
};

TEST(StreamMachine, WritesEveryMessageOnceFromManyThreads) {
  constexpr int kMessages = 200;
  const int streams = kUnderSanitizer ? 20 : 100;
  for (int round = 0; round < streams; ++round) {
    const auto source = std::make_shared<CountingSource>(false, round % 2 == 1);
    const bool is_closed_early = round % 8 > 5;
    source->reports_changes = round % 8 == 7;
    std::unique_ptr<ThreadedTransport> transport;
    std::unique_ptr<StreamMachine> machine;
    {
      constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();
      Workers workers(3, kUnlimited, kUnlimited);
      transport = std::make_unique<ThreadedTransport>(workers);
      machine = std::make_unique<StreamMachine>(*transport, v1::SimulationEvent::default_instance(),
                                                std::chrono::minutes(1));
      transport->machine = machine.get();
      std::vector<std::thread> threads;
      for (int i = 0; i < 2; ++i) {
        threads.emplace_back([&] {
          for (int k = 0; k < kMessages / 2; ++k) {
            ++source->available;
            machine->changed();
            if (k % 16 == 0) std::this_thread::yield();
          }
        });
      }
      machine->open(source, Clock::now() + std::chrono::hours(1));
      threads.emplace_back([&] {
        for (int k = 0; k < 50; ++k) {
          machine->look_at_clock();
          machine->changed();
        }
        if (!is_closed_early) return;
        const auto status = status_of(google::rpc::UNAVAILABLE);
        source->reports_changes ? machine->shut_down(status) : machine->close(status);
      });
      for (std::thread& thread : threads) thread.join();
      source->is_closed = true;
      machine->changed();
      ASSERT_TRUE(eventually([&] { return transport->end().has_value(); })) << "round " << round;
    }
    if (is_closed_early) continue;
    EXPECT_EQ(transport->end()->code(), google::rpc::OK);
    EXPECT_EQ(transport->begun(), kMessages);
  }
}

}  // namespace
}  // namespace tribodyn::server
