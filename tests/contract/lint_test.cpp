#include "tests/contract/lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "google/api/annotations.pb.h"
#include "tests/contract/parsed_contract.h"

namespace tribodyn {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What lint says of a file with `body`, whose methods all have `route`.
std::vector<std::string> said_of(const std::string& body, const std::string& route = "/v1/x") {
  auto set = parsed_contract(body);
  for (auto& service : *set.mutable_file(0)->mutable_service()) {
    for (auto& method : *service.mutable_method()) {
      if (!route.empty()) {
        method.mutable_options()->MutableExtension(google::api::http)->set_get(route);
      }
    }
  }
  return lint(set);
}

TEST(Lint, AcceptsWhatKeepsTheRules) {
  EXPECT_THAT(said_of(R"(
    message Load {
      double force_newtons = 1;
      double torque_newton_metres = 2;
      double damping_newton_seconds_per_metre = 3;
      enum State { STATE_UNSPECIFIED = 0; DONE = 1; }
    }
    enum PointModel { POINT_MODEL_UNSPECIFIED = 0; POINT_MODEL_FULL = 1; }
    service LoadService { rpc GetLoad(GetLoadRequest) returns (Load); })"),
              IsEmpty());
}

TEST(Lint, RefusesOtherNames) {
  EXPECT_THAT(said_of("message M { string camelCase = 1; }"),
              ElementsAre("p.M.camelCase is not snake_case"));
  EXPECT_THAT(said_of("enum E { E_NONE = 0; lower = 1; }"),
              ElementsAre("p.E.E_NONE is number 0 and not E_UNSPECIFIED",
                          "p.E.lower is not UPPER_SNAKE_CASE", "p.E has values without E_"));
  EXPECT_THAT(said_of("message M { enum E { E_UNSPECIFIED = 0; A = 1; E_B = 2; } }"),
              ElementsAre("p.M.E has values with and without E_"));
}

TEST(Lint, RefusesOtherSpellingsOfUnits) {
  EXPECT_THAT(said_of("message M { double length_meters = 1; double load_newton = 2; "
                      "int32 lag_ms = 3; }"),
              ElementsAre("p.M.length_meters spells a unit in another way",
                          "p.M.load_newton spells a unit in another way",
                          "p.M.lag_ms spells a unit in another way"));
}

TEST(Lint, RefusesOtherServicesAndRoutes) {
  EXPECT_THAT(
      said_of("service Loads { rpc Get(GetRequest) returns (GetResponse); "
              "rpc Put(GetRequest) returns (GetResponse); }"),
      ElementsAre("p.Loads does not end in Service", "p.Loads.Put takes GetRequest, not PutRequest",
                  "p.Loads.Put returns GetResponse, not PutResponse",
                  "p.Loads.Put has the route of p.Loads.Get, GET /v1/x"));
  EXPECT_THAT(said_of("service LoadService { rpc Get(GetRequest) returns (Load); }", ""),
              ElementsAre("p.LoadService.Get has no HTTP route"));
}

}  // namespace
}  // namespace tribodyn
