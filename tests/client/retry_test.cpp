// Tests which requests may be sent again, and the pauses between tries.
#include "client/cpp/library/retry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {
namespace {

using std::chrono::milliseconds;

grpc::Status turned_away(const std::string& reason, int seconds) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  info.set_reason(reason);
  details.add_details()->PackFrom(info);
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(seconds);
  details.add_details()->PackFrom(retry);
  return {grpc::StatusCode::UNAVAILABLE, "later", details.SerializeAsString()};
}

TEST(Retry, RepeatsOnlyIdempotentRequests) {
  EXPECT_TRUE(may_repeat(v1::GetSimulationRequest()));
  EXPECT_TRUE(may_repeat(v1::ListLubricantsRequest()));
  EXPECT_TRUE(may_repeat(v1::CancelSimulationRequest()));
  EXPECT_TRUE(may_repeat(v1::DeleteLubricantRequest()));
  EXPECT_TRUE(may_repeat(v1::EvaluateContactRequest()));
  v1::DeleteSimulationRequest deletion;
  EXPECT_FALSE(may_repeat(deletion)) << "the second one would not find it";
  deletion.set_allow_missing(true);
  EXPECT_TRUE(may_repeat(deletion));
  v1::PurgeLubricantRequest purge;
  EXPECT_FALSE(may_repeat(purge));
  purge.set_allow_missing(true);
  EXPECT_TRUE(may_repeat(purge));
  EXPECT_FALSE(may_repeat(v1::UndeleteLubricantRequest())) << "the second one is refused";
  EXPECT_FALSE(may_repeat(v1::CreateLubricantRequest())) << "it may exist by now";
  EXPECT_FALSE(may_repeat(v1::UpdateLubricantRequest())) << "others may have changed it since";
  EXPECT_FALSE(may_repeat(v1::ImportLubricantRequest()));
  v1::UpdateLubricantRequest check;
  check.set_validate_only(true);
  EXPECT_TRUE(may_repeat(check));
  v1::CreateSimulationRequest create;
  EXPECT_FALSE(may_repeat(create)) << "it would create two";
  create.set_request_id("x");
  EXPECT_TRUE(may_repeat(create));
}

TEST(Retry, RepeatsRequestsThatTheServerTurnedAway) {
  EXPECT_TRUE(was_turned_away(turned_away("SHUTTING_DOWN", 5)));
  EXPECT_TRUE(was_turned_away(turned_away("TOO_MANY_WAITING", 5)));
  EXPECT_TRUE(was_turned_away(turned_away("TOO_MANY_STREAMS", 5)));
  EXPECT_TRUE(was_turned_away(turned_away("TOO_MANY_LARGE_REQUESTS", 5)));
  EXPECT_TRUE(was_turned_away(turned_away("TOO_MANY_CALLS", 5)));
  EXPECT_TRUE(was_turned_away(turned_away("QUOTA_EXCEEDED", 5)));
  EXPECT_FALSE(was_turned_away(turned_away("STORE_FAILED", 5))) << "it may have been written";
  EXPECT_FALSE(was_turned_away(turned_away("OUT_OF_MEMORY", 5))) << "it may have been written";
  EXPECT_FALSE(was_turned_away({grpc::StatusCode::UNAVAILABLE, "Socket closed"}));
  EXPECT_EQ(retry_delay(turned_away("SHUTTING_DOWN", 5)), milliseconds(5000));
  EXPECT_EQ(retry_delay({grpc::StatusCode::UNAVAILABLE, "Socket closed"}), std::nullopt);
}

TEST(Retry, PausesGrowAreRandomAndAtLeastTheRequestedOne) {
  std::set<milliseconds> seen;
  for (int client = 0; client < 20; ++client) {
    Backoff backoff;
    milliseconds longest(100);
    for (int i = 0; i < 8; ++i) {
      const milliseconds pause = backoff.next();
      EXPECT_LE(pause, longest);
      longest = std::min(2 * longest, milliseconds(5000));
      if (i == 7) seen.insert(pause);
    }
    EXPECT_GE(backoff.next(milliseconds(9000)), milliseconds(9000));
    backoff.reset();
    EXPECT_LE(backoff.next(), milliseconds(100));
  }
  EXPECT_GT(seen.size(), 10U) << "clients do not retry together";
}

TEST(Retry, RequestIdsAreUniqueAndValid) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = new_request_id();
    EXPECT_EQ(id.size(), 36U);
    EXPECT_EQ(id[14], '4');
    seen.insert(id);
  }
  EXPECT_EQ(seen.size(), 1000U);
}

}  // namespace
}  // namespace tribodyn::client
