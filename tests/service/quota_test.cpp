// Quotas of principals and projects, and turns between principals.
#include "server/application/quota.h"

#include <gmock/gmock.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/call_dispatcher.h"
#include "server/application/workers.h"
#include "server/storage/seeds.h"
#include "tests/service/support.h"
#include "tribodyn/v1/schemas.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Message;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;

/// A call with a token, without a transport.
class QuotaCall : public UnaryCall, public StreamCall {
 public:
  QuotaCall(const Method& row, const Message& request, const std::string& secret)
      : UnaryCall(row), StreamCall(row), bytes_(request.SerializeAsString()) {
    UnaryCall::credentials.authorization = "Bearer " + secret;
    StreamCall::credentials = UnaryCall::credentials;
  }

  google::rpc::Status answer(CallDispatcher& dispatcher) {
    if (UnaryCall::method.open) {
      dispatcher.open(*this);
    } else {
      dispatcher.answer(*this);
    }
    return answer_.get_future().get();
  }

  std::size_t request_size() const override { return bytes_.size(); }
  std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() override {
    return std::make_unique<google::protobuf::io::ArrayInputStream>(
        bytes_.data(), static_cast<int>(bytes_.size()));
  }
  void drop_request() override { bytes_.clear(); }
  void answered(Outcome<Reply> outcome) override {
    answer_.set_value(outcome.ok() ? google::rpc::Status() : outcome.error());
  }
  void opened(Outcome<ReplySource> outcome) override {
    const auto status = outcome.ok() ? google::rpc::Status() : outcome.error();
    if (outcome.ok()) source = std::move(outcome.message());
    answer_.set_value(status);
  }

  ReplySource source;  ///< open until it is destroyed

 private:
  std::string bytes_;
  std::promise<google::rpc::Status> answer_;
};

/// The quota that a refusal names; "" if it is no refusal by a quota.
std::string quota_of(const google::rpc::Status& status) {
  google::rpc::ErrorInfo info;
  for (const auto& detail : status.details()) {
    if (detail.UnpackTo(&info) && info.reason() == "QUOTA_EXCEEDED" &&
        status.code() == google::rpc::RESOURCE_EXHAUSTED) {
      return info.metadata().at("quota");
    }
  }
  return "";
}

bool names_delay(const google::rpc::Status& status) {
  return std::any_of(status.details().begin(), status.details().end(),
                     [](const auto& each) { return each.template Is<google::rpc::RetryInfo>(); });
}

TEST(Allowance, LetsCallsOfFiveSecondsComeAtOnceAndThenAsManyASecondAsStated) {
  Allowance allowance;
  Allowance::Time now{};
  for (int i = 0; i < 50; ++i) ASSERT_EQ(allowance.take_call(10, now), 0) << i;
  EXPECT_NEAR(allowance.take_call(10, now), 0.1, 1e-9);
  now += milliseconds(99);
  EXPECT_NEAR(allowance.take_call(10, now), 0.001, 1e-9) << "refused calls take nothing";
  now += milliseconds(902);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(allowance.take_call(10, now), 0) << i;
  EXPECT_GT(allowance.take_call(10, now), 0);
  now += std::chrono::hours(1);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(allowance.take_call(10, now), 0) << i;
  EXPECT_GT(allowance.take_call(10, now), 0) << "no more than the bucket holds";
}

TEST(Allowance, OfLessThanACallASecondHasOneCall) {
  Allowance allowance;
  EXPECT_EQ(allowance.take_call(0.1, {}), 0);
  EXPECT_NEAR(allowance.take_call(0.1, {}), 10, 1e-9);
}

TEST(Allowance, ReservesAsMuchProcessorTimeAsThereIsUntilThePlaceIsReturned) {
  Allowance allowance;
  double written = 1;
  const auto unfinished = [&] { return written; };
  auto first = allowance.reserve(2, 5, unfinished);
  EXPECT_NE(first, nullptr);
  EXPECT_EQ(allowance.reserve(3, 5, unfinished), nullptr);
  const auto second = allowance.reserve(2, 5, unfinished);
  EXPECT_NE(second, nullptr);
  first = nullptr;
  EXPECT_NE(allowance.reserve(2, 5, unfinished), nullptr);
  written = 4;
  EXPECT_EQ(allowance.reserve(2, 5, unfinished), nullptr);
}

class QuotaTest : public testing::Test {
 protected:
  QuotaTest() {
    app_.authorizer = std::make_shared<Authorizer>(Quota{.calls_per_second = 1000, .streams = 2});
    StoredToken slow{.name = "slow", .hash = token_hash("slow"), .scope = Scope::kWrite};
    slow.calls_per_second = 0.2;
    slow.processor_hours = 1e-5;
    app_.authorizer->set_tokens(
        {slow,
         {.name = "usual", .hash = token_hash("usual"), .scope = Scope::kWrite},
         {.name = kOwner, .hash = token_hash("owner"), .scope = Scope::kAdmin}},
        0);
  }
  const Method& row(const Message& request) const {
    for (const Method& each : dispatcher_.methods()) {
      if (each.descriptor->input_type() == request.GetDescriptor()) return each;
    }
    throw std::logic_error("no such method");
  }
  google::rpc::Status answer(const Message& request, const std::string& secret) {
    return QuotaCall(row(request), request, secret).answer(dispatcher_);
  }
  static v1::GetSchemaRequest small() { return {}; }
  static v1::CreateSimulationRequest create(const v1::Simulation& simulation) {
    v1::CreateSimulationRequest out;
    *out.mutable_simulation() = simulation;
    out.set_force(true);
    return out;
  }

  std::shared_ptr<std::atomic<bool>> release_ = std::make_shared<std::atomic<bool>>(false);
  Bench bench_{patient_studies(release_)};
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
};

TEST_F(QuotaTest, CallsBeyondTheRateAreRefusedWithTheRateAndADelayAndOthersAreNot) {
  EXPECT_NE(answer(small(), "slow").code(), google::rpc::RESOURCE_EXHAUSTED);
  const google::rpc::Status refused = answer(small(), "slow");
  EXPECT_EQ(quota_of(refused), "calls-per-second");
  EXPECT_THAT(refused.message(),
              AllOf(HasSubstr("the quota of slow is 0.2 calls a second"), HasSubstr("try again")));
  EXPECT_THAT(bench_.jobs().metrics().text({}),
              HasSubstr("tribodyn_refusals_total{reason=\"QUOTA_EXCEEDED\"} 1\n"));
  for (int i = 0; i < 20; ++i) {
    EXPECT_NE(answer(small(), "usual").code(), google::rpc::RESOURCE_EXHAUSTED);
    EXPECT_NE(answer(small(), "owner").code(), google::rpc::RESOURCE_EXHAUSTED);
  }
}

TEST_F(QuotaTest, StreamsBeyondTheQuotaAreRefusedUntilOneEnds) {
  v1::WatchSimulationsRequest request;
  request.set_filter("lubricant = paper-fluid-1");
  const Method& method = row(request);
  QuotaCall first(method, request, "usual"), second(method, request, "usual");
  QuotaCall third(method, request, "usual"), fourth(method, request, "usual");
  QuotaCall owners[] = {
      {method, request, "owner"}, {method, request, "owner"}, {method, request, "owner"}};
  EXPECT_EQ(first.answer(dispatcher_).code(), google::rpc::OK);
  EXPECT_EQ(second.answer(dispatcher_).code(), google::rpc::OK);
  const google::rpc::Status refused = third.answer(dispatcher_);
  EXPECT_EQ(quota_of(refused), "streams");
  EXPECT_THAT(refused.message(), HasSubstr("the quota of usual is 2 open streams"));
  for (QuotaCall& each : owners) EXPECT_EQ(each.answer(dispatcher_).code(), google::rpc::OK);
  EXPECT_EQ(dispatcher_.workload().open_streams, 5U);
  first.source = nullptr;
  EXPECT_EQ(dispatcher_.workload().open_streams, 4U);
  EXPECT_EQ(fourth.answer(dispatcher_).code(), google::rpc::OK);
}

TEST_F(QuotaTest, AStreamThatIsRefusedForItsRequestTakesNoPlace) {
  v1::WatchSimulationsRequest request;
  request.set_filter("no such thing");
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(answer(request, "usual").code(), google::rpc::INVALID_ARGUMENT);
  }
}

TEST_F(QuotaTest, SimulationsBeyondTheProcessorHoursAreRefusedWhileOthersWaitAndRun) {
  const google::rpc::Status refused = answer(create(long_simulation()), "slow");
  EXPECT_EQ(quota_of(refused), "processor-hours");
  EXPECT_THAT(refused.message(),
              HasSubstr("processor hours of simulations and campaigns that wait and run"));
  EXPECT_EQ(answer(create(long_simulation()), "usual").code(), google::rpc::OK);
  *release_ = true;
}

TEST_F(QuotaTest, ARefusalNamesADelayOnlyIfWaitingHelps) {
  EXPECT_EQ(answer(create(long_simulation()), "usual").code(), google::rpc::OK);
  const double hours = bench_.store().unfinished_seconds("default") / 3600;
  app_.project_quotas = std::make_shared<ProjectQuotas>(Quota{.processor_hours = 1.5 * hours});
  EXPECT_TRUE(names_delay(answer(create(long_simulation()), "usual")));
  app_.project_quotas = std::make_shared<ProjectQuotas>(Quota{.processor_hours = 0.5 * hours});
  EXPECT_FALSE(names_delay(answer(create(long_simulation()), "usual"))) << "it can never run";
  *release_ = true;
}

TEST_F(QuotaTest, AProjectWithTooManyBytesOfResultsAcceptsNoSimulation) {
  *release_ = true;
  app_.project_bytes = 1;
  EXPECT_EQ(answer(create(point_simulation()), "usual").code(), google::rpc::OK);
  ASSERT_TRUE(bench_.reaches("simulations/1", v1::Simulation::SUCCEEDED));
  const google::rpc::Status refused = answer(create(point_simulation()), "usual");
  EXPECT_EQ(quota_of(refused), "project-megabytes");
  EXPECT_THAT(refused.message(), HasSubstr("the quota of project default is"));
  ASSERT_EQ(bench_.store().remove_simulation(1), Store::Removal::kDone);
  EXPECT_EQ(answer(create(point_simulation()), "usual").code(), google::rpc::OK);
}

TEST_F(QuotaTest, CallsAboutAProjectBeyondItsRateAreRefusedWhoeverMakesThemButTheOwner) {
  app_.project_quotas = std::make_shared<ProjectQuotas>(Quota{.calls_per_second = 0.2});
  const auto list = [](const std::string& project) {
    v1::ListLubricantsRequest out;
    out.set_parent("projects/" + project);
    return out;
  };
  bench_.store().add_project("acme", {}, 1);
  EXPECT_EQ(answer(list("default"), "usual").code(), google::rpc::OK);
  const google::rpc::Status refused = answer(list("default"), "slow");
  EXPECT_EQ(quota_of(refused), "project-calls-per-second");
  EXPECT_THAT(refused.message(), HasSubstr("the quota of project default is 0.2 calls a second"));
  EXPECT_EQ(quota_of(answer(list("default"), "usual")), "project-calls-per-second");
  EXPECT_EQ(answer(list("acme"), "usual").code(), google::rpc::OK) << "another project";
  EXPECT_EQ(answer(list("default"), "owner").code(), google::rpc::OK);
}

TEST_F(QuotaTest, StreamsAboutAProjectBeyondItsQuotaAreRefusedUntilOneEnds) {
  app_.project_quotas = std::make_shared<ProjectQuotas>(Quota{.streams = 1});
  v1::WatchSimulationsRequest request;
  request.set_filter("lubricant = paper-fluid-1");
  const Method& method = row(request);
  QuotaCall first(method, request, "usual"), second(method, request, "slow");
  QuotaCall third(method, request, "usual"), owners(method, request, "owner");
  EXPECT_EQ(first.answer(dispatcher_).code(), google::rpc::OK);
  EXPECT_EQ(quota_of(second.answer(dispatcher_)), "project-streams");
  EXPECT_EQ(owners.answer(dispatcher_).code(), google::rpc::OK);
  first.source = nullptr;
  EXPECT_EQ(third.answer(dispatcher_).code(), google::rpc::OK);
}

TEST_F(QuotaTest, SimulationsOfAProjectBeyondItsProcessorHoursAreRefusedWhoeverSubmitsThem) {
  const v1::CreateSimulationRequest one = create(long_simulation());
  EXPECT_EQ(answer(one, "usual").code(), google::rpc::OK);
  const double hours = bench_.store().unfinished_seconds("default") / 3600;
  ASSERT_GT(hours, 0);
  app_.project_quotas = std::make_shared<ProjectQuotas>(Quota{.processor_hours = 1.5 * hours});
  for (const char* token : {"usual", "owner"}) {
    const google::rpc::Status refused = answer(one, token);
    EXPECT_EQ(quota_of(refused), "project-processor-hours") << refused.message();
  }
  bench_.store().add_project("acme", seed_resources(), 1);
  v1::CreateSimulationRequest elsewhere = one;
  elsewhere.set_parent("projects/acme");
  EXPECT_EQ(answer(elsewhere, "usual").code(), google::rpc::OK);
  *release_ = true;
  ASSERT_TRUE(eventually([&] { return bench_.store().unfinished_seconds("default") == 0; }));
  EXPECT_EQ(answer(one, "usual").code(), google::rpc::OK);
}

TEST_F(QuotaTest, SubmissionsAtTheSameTimeDoNotPassTheProcessorHoursOfAProjectTogether) {
  EXPECT_EQ(answer(create(long_simulation()), "usual").code(), google::rpc::OK);
  const double hours = bench_.store().unfinished_seconds("default") / 3600;
  app_.project_quotas = std::make_shared<ProjectQuotas>(Quota{.processor_hours = 3.5 * hours});
  std::atomic<int> accepted = 0, refused = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 6; ++i) {
    clients.emplace_back([&] {
      const google::rpc::Status status = answer(create(long_simulation()), "usual");
      ++(quota_of(status).empty() ? accepted : refused);
    });
  }
  for (std::thread& each : clients) each.join();
  EXPECT_GE(accepted, 1);  // a place that is still held beside its written row counts twice
  EXPECT_LE(accepted, 2);
  EXPECT_EQ(accepted + refused, 6);
  EXPECT_LE(bench_.store().unfinished_seconds("default") / 3600, 3.5 * hours);
  *release_ = true;
}

TEST_F(QuotaTest, AnEqualResultIsServedWhateverWaitsAndRuns) {
  *release_ = true;
  v1::CreateSimulationRequest one;
  *one.mutable_simulation() = point_simulation();
  EXPECT_EQ(answer(one, "usual").code(), google::rpc::OK);
  ASSERT_TRUE(bench_.reaches("simulations/1", v1::Simulation::SUCCEEDED));
  app_.project_quotas = std::make_shared<ProjectQuotas>(Quota{.processor_hours = 1e-9});
  EXPECT_EQ(answer(one, "usual").code(), google::rpc::OK);
  one.set_force(true);
  EXPECT_EQ(quota_of(answer(one, "usual")), "project-processor-hours");
}

TEST_F(QuotaTest, AResultIsReadInAnotherProjectOnlyByATokenThatAnAdministratorMadeForBoth) {
  *release_ = true;
  bench_.store().add_project("acme", seed_resources(), 1);
  app_.authorizer->set_tokens(
      {{.name = "own", .hash = token_hash("own"), .scope = Scope::kWrite, .projects = {"acme"}},
       {.name = "both",
        .hash = token_hash("both"),
        .scope = Scope::kWrite,
        .projects = {"acme", "default"}}},
      0);
  v1::CreateSimulationRequest first;
  *first.mutable_simulation() = point_simulation();
  EXPECT_EQ(answer(first, "both").code(), google::rpc::OK);
  ASSERT_TRUE(bench_.reaches("simulations/1", v1::Simulation::SUCCEEDED));
  v1::GetSimulationRequest get;
  get.set_name("projects/default/simulations/1");
  EXPECT_EQ(answer(get, "both").code(), google::rpc::OK);
  EXPECT_EQ(answer(get, "own").code(), google::rpc::PERMISSION_DENIED);
  first.set_parent("projects/acme");
  for (const char* token : {"own", "both"}) {
    EXPECT_EQ(answer(first, token).code(), google::rpc::OK);
  }
  const auto other = [&] { return *bench_.store().numbered_simulation("acme", 1); };
  ASSERT_TRUE(eventually([&] { return other().state == StoredState::kSucceeded; }));
  EXPECT_FALSE(other().cache_hit)
      << "equal inputs are computed again: the time would tell of the other project";
}

/// What principals queue while the only thread is held, in the order in which it runs.
class Turn {
 public:
  explicit Turn(std::size_t waiting) : workers_(1, waiting, 1000) {
    std::function<void()> hold = [this] {
      begun_.set_value();
      released_.get_future().wait();
    };
    workers_.run(0, hold, "holder");
    begun_.get_future().wait();
  }
  bool queue(const std::string& principal) {
    std::function<void()> task = [this, principal] {
      order_ += principal;
      if (--left_ == 0) ended_.set_value();
    };
    const bool is_queued = workers_.run(0, task, principal);
    left_ += is_queued ? 1 : 0;
    return is_queued;
  }
  std::string order() {
    released_.set_value();
    ended_.get_future().wait();
    return order_;
  }

 private:
  std::promise<void> begun_, released_, ended_;
  int left_ = 0;  // changed by the test before the thread is released, by the thread afterwards
  std::string order_;
  Workers workers_;
};

TEST(Turns, OfPrincipalsKeepACallFromWaitingForMoreThanOneOfEachOther) {
  Turn turn(64);
  for (int i = 0; i < 60; ++i) EXPECT_TRUE(turn.queue("a"));
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(turn.queue("b"));
  EXPECT_TRUE(turn.queue("c"));
  EXPECT_EQ(turn.order().substr(0, 7), "abcabaa") << "each principal in turn";
}

TEST(Turns, APrincipalThatFillsTheQueueLeavesPlacesForOthers) {
  Turn turn(64);
  int flooded = 0;
  while (turn.queue("a")) ++flooded;
  EXPECT_EQ(flooded, 64);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(turn.queue("b")) << i;
  EXPECT_FALSE(turn.queue("b"));
  EXPECT_FALSE(turn.queue("a"));
  EXPECT_TRUE(turn.queue("c"));
  EXPECT_EQ(turn.order().substr(0, 6), "abcaba");
}

}  // namespace
}  // namespace tribodyn::server
