// The method table, and what the dispatcher does with a call of any transport.
#include "server/application/call_dispatcher.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor_database.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/list_filter.h"
#include "server/support/processor_slots.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"
#include "tribodyn/v1/cycles.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::DescriptorPool;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// The full names of all methods of tribodyn.v1 that are compiled in.
std::multiset<std::string> methods_of_the_contract() {
  std::vector<std::string> files;
  DescriptorPool::internal_generated_database()->FindAllFileNames(&files);
  std::multiset<std::string> out;
  for (const std::string& name : files) {
    if (!name.starts_with("tribodyn/v1/")) continue;
    const auto* file = DescriptorPool::generated_pool()->FindFileByName(name);
    for (int i = 0; i < file->service_count(); ++i) {
      for (int k = 0; k < file->service(i)->method_count(); ++k) {
        out.insert(file->service(i)->method(k)->full_name());
      }
    }
  }
  return out;
}

TEST(MethodTable, HasOneRowForEveryMethodOfTheContract) {
  std::multiset<std::string> rows;
  for (const Method& each : method_table()) rows.insert(each.descriptor->full_name());
  EXPECT_GT(rows.size(), 40U);
  EXPECT_EQ(rows, methods_of_the_contract());
}

TEST(MethodTable, AnswersAsTheContractSays) {
  for (const Method& each : method_table()) {
    EXPECT_EQ(each.open != nullptr, each.descriptor->server_streaming());
    EXPECT_EQ(each.answer != nullptr, !each.descriptor->server_streaming());
    EXPECT_EQ(each.request->GetDescriptor(), each.descriptor->input_type());
    EXPECT_EQ(each.response->GetDescriptor(), each.descriptor->output_type());
    EXPECT_LE(maximum_request_bytes(*each.descriptor), kMaximumRequestBytes);
  }
}

/// A unary call without a transport.
class TestCall : public UnaryCall {
 public:
  explicit TestCall(const google::protobuf::Message& request)
      : UnaryCall(row_of(request)), bytes_(request.SerializeAsString()) {
    credentials.is_owner = true;
    context.client = "tester";
    context.request_id = "call-1";
    context.limits.cancelled = &cancelled;
  }

  std::size_t request_size() const override { return bytes_.size(); }
  std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() override {
    return std::make_unique<google::protobuf::io::ArrayInputStream>(
        bytes_.data(), static_cast<int>(bytes_.size()));
  }
  void drop_request() override { bytes_.clear(); }
  bool may_run_on_calling_thread() const override { return may_run_here; }
  void answered(Outcome<Reply> outcome) override {
    if (held_.valid() && outcome.ok()) {
      is_held_.set_value();
      held_.wait();
    }
    answer_.set_value(outcome.ok() ? google::rpc::Status() : outcome.error());
  }

  /// Lets every answer wait until `held` is ready, with the thread of its lane.
  void hold(std::shared_future<void> held) { held_ = std::move(held); }
  /// Returns once the answer of a call for hold() is there and waits.
  void wait_until_held() { is_held_.get_future().wait(); }
  bool is_answered() const {
    return answer_of_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  google::rpc::Status wait() { return answer_of_.get(); }

  std::atomic<bool> cancelled = false;
  bool may_run_here = false;

 private:
  std::string bytes_;
  std::shared_future<void> held_;
  std::promise<void> is_held_;
  std::promise<google::rpc::Status> answer_;
  std::future<google::rpc::Status> answer_of_ = answer_.get_future();
};

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream lines(text);
  std::vector<std::string> out;
  for (std::string line; std::getline(lines, line);) out.push_back(line);
  return out;
}

class CallDispatcherTest : public testing::Test {
 protected:
  static v1::GetLubricantRequest get() {
    v1::GetLubricantRequest out;
    out.set_name("lubricants/paper-fluid-1");
    return out;
  }
  static v1::BatchCreateLubricantsRequest batch(int count) {
    v1::BatchCreateLubricantsRequest out;
    v1::Lubricant fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
    for (int i = 0; i < count; ++i) {
      fluid.set_name("lubricants/many-" + std::to_string(i));
      *out.add_requests()->mutable_lubricant() = fluid;
    }
    return out;
  }
  google::rpc::Status answer(TestCall& call) {
    dispatcher_.answer(call);
    return call.wait();
  }
  std::string metrics() { return bench_.jobs().metrics().text({}); }
  std::size_t count() { return bench_.store().resource_names("default", "lubricants").size(); }

  const LogCapture log_;
  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
};

TEST_F(CallDispatcherTest, CountsACallByMethodAndCodeAndLogsOnlyWhatFails) {
  TestCall good(get());
  EXPECT_EQ(answer(good).code(), google::rpc::OK);
  EXPECT_THAT(log_.text(), testing::Not(HasSubstr("event=call ")));
  v1::GetLubricantRequest unknown;
  unknown.set_name("lubricants/none");
  TestCall bad(unknown);
  EXPECT_EQ(answer(bad).code(), google::rpc::NOT_FOUND);
  EXPECT_THAT(log_.text(), HasSubstr("event=call method=GetLubricant code=NOT_FOUND "
                                     "reason=NOT_FOUND seconds=0.0"));
  EXPECT_THAT(log_.text(), HasSubstr("client=tester call=call-1"));
  const std::string method = "method=\"" + good.method.descriptor->full_name() + "\"";
  EXPECT_THAT(metrics(), HasSubstr("tribodyn_calls_total{code=\"OK\"," + method + "} 1\n"));
  EXPECT_THAT(metrics(), HasSubstr("tribodyn_calls_total{code=\"NOT_FOUND\"," + method + "} 1\n"));
  EXPECT_THAT(metrics(), HasSubstr("tribodyn_call_seconds_count{" + method + "} 2\n"));
  EXPECT_THAT(metrics(), HasSubstr("tribodyn_refusals_total{reason=\"NOT_FOUND\"} 1\n"));
  EXPECT_THAT(metrics(), HasSubstr("tribodyn_refusals_total{reason=\"QUOTA_EXCEEDED\"} 0\n"));
}

TEST_F(CallDispatcherTest, ACallIsRefusedByItsSizeAndByItsDeadlineBeforeItIsRead) {
  v1::GetLubricantRequest long_one;
  long_one.set_name(std::string(kUsualRequestBytes, 'x'));
  TestCall large(long_one);
  EXPECT_THAT(answer(large).message(), HasSubstr("allowed: at most 1048576 for GetLubricant"));
  TestCall late(get());
  late.context.limits.deadline = CallLimits::Clock::now();
  EXPECT_EQ(answer(late).code(), google::rpc::DEADLINE_EXCEEDED);
}

TEST_F(CallDispatcherTest, ABatchWhoseClientCancelsEndsEarlyAndWritesNothing) {
  const std::size_t before = count();
  constexpr int kSize = 4000;
  TestCall call(batch(kSize));
  dispatcher_.answer(call);
  std::this_thread::sleep_for(milliseconds(20));
  call.cancelled = true;
  EXPECT_EQ(call.wait().code(), google::rpc::CANCELLED);
  EXPECT_EQ(count(), before);
  EXPECT_THAT(metrics(), HasSubstr("tribodyn_calls_total{code=\"CANCELLED\",method=\"" +
                                   call.method.descriptor->full_name() + "\"} 1\n"));
  EXPECT_THAT(log_.text(), HasSubstr("method=BatchCreateLubricants code=CANCELLED"));
}

TEST_F(CallDispatcherTest, AStatementOfAClientThatCancelsIsInterrupted) {
  std::vector<NewResource> many;
  for (int i = 0; i < 20'000; ++i) {
    many.push_back({"lubricants/m" + std::to_string(i), std::string(200, 'x')});
  }
  bench_.store().add_project("default", many, 1);
  ResourceQuery query;
  query.collection = "lubricants";
  query.limit = 10;
  query.byte_limit = 1'000'000;
  Violations violations;
  query.restrictions =
      parse_filter("name:nowhere AND display_name:nowhere", "lubricants", violations);
  ASSERT_TRUE(violations.empty());
  std::atomic<bool> cancelled = false;
  // Gives up in the middle: neither before the first statement nor after the last one.
  const auto begin = CallLimits::Clock::now();
  bench_.store().resources(query);
  const auto whole = CallLimits::Clock::now() - begin;
  std::thread client([&] {
    std::this_thread::sleep_for(whole / 4);
    cancelled = true;
  });
  try {
    for (int i = 0; i < 100; ++i) bench_.store().resources(query, {.cancelled = &cancelled});
    ADD_FAILURE() << "nobody was interrupted";
  } catch (const StoreError& error) {
    EXPECT_EQ(error.kind(), StoreError::Kind::kCancelled);
  }
  client.join();
}

TEST_F(CallDispatcherTest, ADriveCycleOfAMillionPlacesIsRefused) {
  v1::EvaluateCycleRequest request;
  for (int i = 0; i < 1'000'000; ++i) {
    request.add_places()->set_time_seconds(i);
    if (i != 20'000) continue;
    TestCall many(request);
    EXPECT_THAT(complaints(answer(many)),
                HasSubstr("places: 20001 entries; allowed: at most 10000"));
  }
  TestCall too_many(request);
  EXPECT_THAT(complaints(answer(too_many)),
              HasSubstr("bytes; allowed: at most 1048576 for EvaluateCycle"));
}

TEST_F(CallDispatcherTest, ReadsDoNotWaitForDriveCycles) {
  v1::EvaluateCycleRequest request;
  request.add_lubricants("lubricants/paper-fluid-1");
  request.set_named_cycle(v1::NAMED_CYCLE_NEDC);
  request.set_map_tolerance(2e-2);
  std::vector<std::unique_ptr<TestCall>> cycles;
  for (int i = 0; i < 4; ++i) cycles.push_back(std::make_unique<TestCall>(request));
  const StopWatch computing;
  for (const auto& each : cycles) dispatcher_.answer(*each);
  std::vector<double> seconds;
  while (seconds.size() < 20) {
    TestCall read(get());
    const StopWatch watch;
    EXPECT_EQ(answer(read).code(), google::rpc::OK);
    seconds.push_back(watch.seconds());
  }
  for (const auto& each : cycles) EXPECT_EQ(each->wait().code(), google::rpc::OK);
  std::nth_element(seconds.begin(), seconds.begin() + 10, seconds.end());
  EXPECT_LT(seconds[10], computing.seconds() / 10);
}

TEST_F(CallDispatcherTest, ReadsDoNotWaitForHeavyCalls) {
  std::vector<std::unique_ptr<TestCall>> heavy;
  for (int i = 0; i < 4; ++i) {
    v1::BatchCreateLubricantsRequest request = batch(kUnderSanitizer ? 500 : 2000);
    request.set_validate_only(true);
    request.mutable_read_mask()->add_paths("name");
    heavy.push_back(std::make_unique<TestCall>(request));
  }
  const StopWatch batches;
  for (const auto& each : heavy) dispatcher_.answer(*each);
  std::vector<double> seconds;
  while (seconds.size() < 20) {
    TestCall read(get());
    const StopWatch watch;
    EXPECT_EQ(answer(read).code(), google::rpc::OK);
    seconds.push_back(watch.seconds());
  }
  for (const auto& each : heavy) EXPECT_EQ(each->wait().code(), google::rpc::OK);
  std::nth_element(seconds.begin(), seconds.begin() + 10, seconds.end());
  EXPECT_LT(seconds[10], batches.seconds() / 10);
}

TEST_F(CallDispatcherTest, AReadRunsOnTheThreadThatBringsItIfTheTransportAllows) {
  TestCall read(get());
  read.may_run_here = true;
  dispatcher_.answer(read);
  EXPECT_TRUE(read.is_answered());
}

TEST_F(CallDispatcherTest, OnlyOneCallRunsOnAThreadOfATransport) {
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  TestCall stuck(get());  // e.g. by a slow disk
  stuck.may_run_here = true;
  stuck.hold(released);
  std::thread transport([&] { dispatcher_.answer(stuck); });
  stuck.wait_until_held();
  TestCall other(get());
  other.may_run_here = true;
  other.hold(released);  // answer() would block if it ran the call
  dispatcher_.answer(other);
  EXPECT_FALSE(other.is_answered());
  release.set_value();
  EXPECT_EQ(stuck.wait().code(), google::rpc::OK);
  EXPECT_EQ(other.wait().code(), google::rpc::OK);
  transport.join();
}

TEST_F(CallDispatcherTest, AListRunsOnTheThreadThatBringsItIfItIsShort) {
  TestCall page(v1::ListSimulationsRequest{});
  page.may_run_here = true;
  dispatcher_.answer(page);
  EXPECT_TRUE(page.is_answered());
  v1::ListSimulationsRequest filtered, long_page, with_results;
  filtered.set_filter("state = QUEUED");
  long_page.set_page_size(1000);
  with_results.set_view(v1::SIMULATION_VIEW_FULL);
  for (const auto& request : {filtered, long_page, with_results}) {
    std::promise<void> release;
    TestCall list(request);
    list.may_run_here = true;
    list.hold(release.get_future().share());  // answer() would block if it ran the call
    dispatcher_.answer(list);
    EXPECT_FALSE(list.is_answered());
    release.set_value();
    EXPECT_EQ(list.wait().code(), google::rpc::OK);
  }
}

TEST_F(CallDispatcherTest, LongCallsAndWritesNeverRunOnAThreadOfATransport) {
  TestCall check(batch(500));
  check.may_run_here = true;
  dispatcher_.answer(check);
  EXPECT_FALSE(check.is_answered());
  EXPECT_EQ(check.wait().code(), google::rpc::OK);
}

TEST_F(CallDispatcherTest, ACallToAFullLaneIsToldTheLimitAndWhatToDo) {
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  std::deque<TestCall> calls;
  // Sends the same request until one is refused.
  const auto refusal = [&](const google::protobuf::Message& request, std::size_t most) {
    google::rpc::Status out;
    for (std::size_t i = 0; i < most && out.code() == google::rpc::OK; ++i) {
      TestCall& call = calls.emplace_back(request);
      call.hold(released);
      dispatcher_.answer(call);
      if (call.is_answered()) out = call.wait();
      if (out.code() != google::rpc::OK) calls.pop_back();
    }
    return out;
  };
  v1::BatchCreateLubricantsRequest checked = batch(1);
  checked.set_validate_only(true);
  const auto heavy = refusal(checked, 1000);
  EXPECT_EQ(heavy.code(), google::rpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(heavy.message(),
            "no more than 64 batches, imports and requests above 1 MiB may wait, and they may have "
            "128 MiB together; try again in 2 s, or send fewer or smaller ones at a time");
  const auto small = refusal(get(), 2 * CallLanes::kWaiting);
  EXPECT_EQ(small.code(), google::rpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(small.message(),
            "no more than 10000 calls of this kind may wait; try again in 2 s, or send fewer calls "
            "at a time");
  EXPECT_TRUE(eventually([&] {
    const auto lanes = dispatcher_.workload().lanes;
    const LaneOccupancy& read = lanes[static_cast<std::size_t>(CallLane::kRead)];
    const LaneOccupancy& large = lanes[static_cast<std::size_t>(CallLane::kHeavy)];
    return read.lane == "read" && read.running == 4 && large.lane == "heavy" &&
           large.running == 2 && read.waiting + large.waiting == calls.size() - 6;
  }));
  EXPECT_THAT(metrics(), HasSubstr("tribodyn_refusals_total{reason=\"TOO_MANY_CALLS\"} 1\n"));
  release.set_value();
  for (TestCall& each : calls) EXPECT_EQ(each.wait().code(), google::rpc::OK);
  EXPECT_THAT(log_.text(), HasSubstr("reason=TOO_MANY_CALLS"));
}

TEST_F(CallDispatcherTest, EveryCallIsAnsweredOnceWhateverTheLoadAndWhoeverCancels) {
  constexpr int kThreads = 4;
  constexpr int kRounds = 60;
  auto dispatcher = std::make_unique<CallDispatcher>(app_);
  std::vector<std::deque<TestCall>> calls(kThreads);
  std::vector<std::thread> clients;
  for (int thread = 0; thread < kThreads; ++thread) {
    clients.emplace_back([&, thread] {
      std::deque<TestCall>& own = calls[static_cast<std::size_t>(thread)];
      v1::UpdateLubricantRequest update;
      update.mutable_lubricant()->set_name("lubricants/paper-fluid-1");
      v1::ListLubricantsRequest list;
      v1::BatchCreateLubricantsRequest checked = batch(20);
      checked.set_validate_only(true);
      for (int round = 0; round < kRounds; ++round) {
        update.mutable_lubricant()->set_display_name(std::to_string(kRounds * thread + round));
        const std::array<const google::protobuf::Message*, 4> requests = {&update, &list, &checked,
                                                                          nullptr};
        const google::protobuf::Message* request = requests[static_cast<std::size_t>(round % 4)];
        TestCall& call = request == nullptr ? own.emplace_back(get()) : own.emplace_back(*request);
        if (round % 7 == 0) {
          call.context.limits.deadline = CallLimits::Clock::now() + std::chrono::microseconds(500);
        }
        dispatcher->answer(call);
        if (round % 3 == 0) own[own.size() / 2].cancelled = true;  // waits, runs or is answered
      }
    });
  }
  for (std::thread& each : clients) each.join();
  dispatcher.reset();  // answers the calls that wait
  std::map<int, int> codes;
  for (std::deque<TestCall>& own : calls) {
    for (TestCall& each : own) {
      ASSERT_TRUE(each.is_answered());
      ++codes[each.wait().code()];
    }
  }
  EXPECT_GT(codes[google::rpc::OK], 0);
  const std::set<int> allowed = {google::rpc::OK, google::rpc::ABORTED, google::rpc::CANCELLED,
                                 google::rpc::DEADLINE_EXCEEDED, google::rpc::RESOURCE_EXHAUSTED};
  for (const auto& [code, count] : codes) EXPECT_TRUE(allowed.contains(code)) << code;
  const std::string counted = metrics();
  int total = 0;
  for (const std::string& line : lines_of(counted)) {
    if (line.starts_with("tribodyn_calls_total{")) {
      total += std::stoi(line.substr(line.rfind(' ')));
    }
  }
  EXPECT_EQ(total, kThreads * kRounds) << counted;
}

TEST(ProcessorSlots, LetNoMoreThreadsInThanThereAreSlots) {
  constexpr int kSlots = 2;
  ProcessorSlots slots(kSlots);
  std::atomic<int> inside = 0, most = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) {
        const std::lock_guard slot(slots);
        const int now = ++inside;
        for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
        }
        std::this_thread::yield();
        --inside;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_LE(most, kSlots);
  EXPECT_EQ(inside, 0);
}

TEST(Workers, RefuseWhatTheirQueueHasNoPlaceFor) {
  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  std::atomic<int> done = 0;
  {
    Workers workers(1, 2, 100);
    const auto run = [&](std::size_t bytes) {
      std::function<void()> task = [&] {
        released.wait();
        ++done;
      };
      return workers.run(bytes, task);
    };
    EXPECT_FALSE(run(101));
    EXPECT_TRUE(run(60));
    EXPECT_FALSE(run(50)) << "beside the one that is under way";
    while (!run(20)) std::this_thread::yield();
    while (!run(20)) std::this_thread::yield();  // until the first one is under way
    EXPECT_FALSE(run(0)) << "two wait already";
    release.set_value();
  }
  EXPECT_EQ(done, 3) << "what was accepted is run";
}

}  // namespace
}  // namespace tribodyn::server
