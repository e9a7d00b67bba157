#include <gtest/gtest.h>

#include <string>

#include "client/cpp/failure.h"
#include "client/cpp/library/status.h"
#include "client/cpp/text/flags.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace tribodyn::client {
namespace {

std::string readable_error(const grpc::Status& status) { return service_error(status, "x").what(); }

Failure to_failure(const grpc::Status& status, const std::string& address) {
  return Failure(service_error(status, address));
}

grpc::Status refusal_with_violations() {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  info.set_reason("INVALID_INPUTS");
  details.add_details()->PackFrom(info);
  google::rpc::BadRequest bad;
  auto* violation = bad.add_field_violations();
  violation->set_field("simulation.sump_temperature_celsius");
  violation->set_description("sump_temperature_celsius = 900 C; allowed: -70 to 200 C (eq 14)");
  violation = bad.add_field_violations();
  violation->set_field("simulation.lubricant");
  violation->set_description("lubricants/7 does not exist");
  details.add_details()->PackFrom(bad);
  return {grpc::StatusCode::INVALID_ARGUMENT, "2 fields are invalid", details.SerializeAsString()};
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Errors, ListEveryViolation) {
  const std::string text = readable_error(refusal_with_violations());
  for (const char* part : {"[INVALID_INPUTS]", "sump_temperature_celsius = 900 C",
                           "-70 to 200 C (eq 14)", "\n  simulation.lubricant: lubricants/7"}) {
    EXPECT_TRUE(says(text, part)) << text;
  }
  EXPECT_EQ(to_failure(refusal_with_violations(), "here").exit_code(), kExitFailed);
}

TEST(Errors, StateThePauseBeforeARetry) {
  google::rpc::Status details;
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(2);
  details.add_details()->PackFrom(retry);
  const grpc::Status status(grpc::StatusCode::RESOURCE_EXHAUSTED, "queue full",
                            details.SerializeAsString());
  const std::string text = readable_error(status);
  for (const char* part : {"queue full", "[RESOURCE_EXHAUSTED]", " 2.0 s"}) {
    EXPECT_TRUE(says(text, part)) << text;
  }
}

TEST(Errors, GiveOnlyTheCauseOfALostConnection) {
  const std::string text = readable_error(
      {grpc::StatusCode::UNAVAILABLE,
       "failed to connect to all addresses; last error: UNKNOWN: ipv4:127.0.0.1:9: Failed to "
       "connect to remote host: Connection refused"});
  EXPECT_TRUE(says(text, " x: connection refused")) << text;
  EXPECT_FALSE(says(text, "ipv4"));
}

TEST(Errors, DistinguishNoServerFromAnErrorOfTheServer) {
  const grpc::Status absent(grpc::StatusCode::UNAVAILABLE, "connection refused");
  EXPECT_EQ(to_failure(absent, "127.0.0.1:1").exit_code(), kExitCannotConnect);
  EXPECT_NE(std::string(to_failure(absent, "127.0.0.1:1").what()).find("127.0.0.1:1"),
            std::string::npos);
  const grpc::Status stopping(grpc::StatusCode::UNAVAILABLE, "stopping",
                              refusal_with_violations().error_details());
  EXPECT_EQ(to_failure(stopping, "x").exit_code(), kExitFailed);
}

TEST(Errors, SurviveDetailsThatAreNotProtobuf) {
  const grpc::Status status(grpc::StatusCode::INTERNAL, "bad \x1b[31m", "\xff\xff\xff");
  EXPECT_EQ(readable_error(status), "bad ?[31m [INTERNAL]");
}

TEST(Flags, AreNamedAfterFields) {
  EXPECT_EQ(flag_of_field("simulation.sump_temperature_celsius"), "--sump-temperature-celsius");
  EXPECT_EQ(flag_of_field("a.speeds[3]"), "--speeds");
}

}  // namespace
}  // namespace tribodyn::client
