// Tests of DeleteSimulation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using State = v1::Simulation;

class DeleteTest : public testing::Test {
 protected:
  google::rpc::Status remove(const v1::DeleteSimulationRequest& request) {
    Application app = bench_.application();
    const auto outcome = delete_simulation(app, request);
    return outcome.ok() ? google::rpc::Status() : outcome.error();
  }
  static v1::DeleteSimulationRequest of(const std::string& name, bool cancel = false) {
    v1::DeleteSimulationRequest out;
    out.set_name(name);
    out.set_cancel(cancel);
    return out;
  }
  static std::string reason(const google::rpc::Status& status) {
    google::rpc::ErrorInfo info;
    for (const auto& each : status.details()) {
      if (each.UnpackTo(&info)) return info.reason();
    }
    return {};
  }
  std::string finished() {
    std::string name = bench_.create(point_simulation());
    EXPECT_TRUE(bench_.reaches(name, State::SUCCEEDED));
    return name;
  }
  std::string running() {
    bench_.restart(patient_studies(release_));
    std::string name = bench_.create(point_simulation());
    EXPECT_TRUE(bench_.reaches(name, State::RUNNING));
    return name;
  }
  bool exists(const std::string& name) {
    return bench_.store().simulation(*simulation_id(name)).has_value();
  }

  const std::shared_ptr<std::atomic<bool>> release_ = std::make_shared<std::atomic<bool>>(false);
  Bench bench_;
};

TEST_F(DeleteTest, ADeletedSimulationIsGoneWithItsResult) {
  const std::string name = finished();
  EXPECT_EQ(remove(of(name)).code(), google::rpc::OK);
  EXPECT_FALSE(exists(name));
  EXPECT_FALSE(bench_.get(finished()).cache_hit()) << "the result is gone too";
}

TEST_F(DeleteTest, TheRepetitionOfADeletionSucceedsOnlyOnRequest) {
  auto request = of(finished());
  EXPECT_EQ(remove(request).code(), google::rpc::OK);
  EXPECT_EQ(remove(request).code(), google::rpc::NOT_FOUND);
  request.set_allow_missing(true);
  EXPECT_EQ(remove(request).code(), google::rpc::OK);
  request.set_name("lubricants/paper-fluid-1");
  EXPECT_EQ(remove(request).code(), google::rpc::INVALID_ARGUMENT) << "what is no name";
}

TEST_F(DeleteTest, AResultThatAnotherSimulationSharesStaysReadable) {
  const std::string first = finished(), second = finished();
  ASSERT_TRUE(bench_.get(second).cache_hit());
  const std::string result = bench_.get(second).result().SerializeAsString();
  EXPECT_EQ(remove(of(first)).code(), google::rpc::OK);
  EXPECT_EQ(bench_.get(second).result().SerializeAsString(), result);
}

TEST_F(DeleteTest, AnUnfinishedSimulationIsDeletedOnlyTogetherWithItsCancellation) {
  const std::string name = running();
  const auto refused = remove(of(name));
  EXPECT_EQ(refused.code(), google::rpc::FAILED_PRECONDITION);
  EXPECT_EQ(reason(refused), "NOT_ENDED");
  EXPECT_EQ(refused.message(), name + " is RUNNING; cancel it to delete it");
  EXPECT_TRUE(exists(name));
  EXPECT_EQ(remove(of(name, true)).code(), google::rpc::OK);
  EXPECT_FALSE(exists(name));
  *release_ = true;
  EXPECT_TRUE(eventually([&] { return bench_.jobs().scheduler().occupancy().running == 0; }));
  EXPECT_FALSE(exists(name)) << "its thread adds nothing";
  EXPECT_EQ(bench_.jobs().progress(*simulation_id(name)), std::nullopt)
      << "no progress of it is kept";
}

TEST_F(DeleteTest, AWatchOfADeletedSimulationEnds) {
  const std::string name = running();
  v1::WatchSimulationRequest request;
  request.set_name(name);
  Application app = bench_.application();
  const auto source = watch_simulation(app, request).message();
  v1::SimulationEvent event;
  EXPECT_EQ(source->next(event), AnyMessageSource::Step::kMessage);
  EXPECT_EQ(remove(of(name, true)).code(), google::rpc::OK);
  while (source->next(event) == AnyMessageSource::Step::kMessage) {
  }
  EXPECT_EQ(event.kind(), v1::SimulationEvent::DELETED);
  EXPECT_EQ(source->next(event), AnyMessageSource::Step::kEnd);
}

TEST_F(DeleteTest, ASimulationThatHasChangedSinceItsEtagIsNotDeleted) {
  const std::string name = finished();
  auto request = of(name);
  request.set_etag(bench_.get(name).etag());
  v1::UpdateSimulationRequest update;
  update.mutable_simulation()->set_name(name);
  update.mutable_simulation()->set_display_name("keep me");
  Application app = bench_.application();
  ASSERT_TRUE(update_simulation(app, update).ok());
  const auto refused = remove(request);
  EXPECT_EQ(refused.code(), google::rpc::ABORTED);
  EXPECT_EQ(reason(refused), "ETAG_MISMATCH");
  request.set_etag(bench_.get(name).etag());
  EXPECT_EQ(remove(request).code(), google::rpc::OK);
}

TEST_F(DeleteTest, APinnedSimulationIsNeitherDeletedNorCancelled) {
  const std::string name = running();
  ASSERT_TRUE(bench_.store().set_pinned(*simulation_id(name), true));
  const auto refused = remove(of(name, true));
  EXPECT_EQ(refused.code(), google::rpc::FAILED_PRECONDITION);
  EXPECT_EQ(reason(refused), "PINNED");
  EXPECT_EQ(bench_.get(name).state(), State::RUNNING);
  *release_ = true;
}

TEST_F(DeleteTest, TheRequestIdOfADeletedSimulationIsFree) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  request.set_request_id("once");
  const std::string name = bench_.create(request);
  EXPECT_EQ(remove(of(name, true)).code(), google::rpc::OK);
  EXPECT_NE(bench_.create(request), name);
}

}  // namespace
}  // namespace tribodyn::server
