#include "tests/contract/lint.h"

#include <gmock/gmock.h>
#include <google/protobuf/compiler/parser.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include "google/api/annotations.pb.h"

namespace tribodyn {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What lint says of a file with `body`. Options stay uninterpreted: routes come from `route`.
std::vector<std::string> said_of(const std::string& body, const std::string& route = "/v1/x") {
  const std::string text = "syntax = \"proto3\"; package p;\n" + body;
  google::protobuf::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  google::protobuf::io::Tokenizer tokenizer(&stream, nullptr);
  google::protobuf::compiler::Parser parser;
  google::protobuf::FileDescriptorSet set;
  EXPECT_TRUE(parser.Parse(&tokenizer, set.add_file())) << text;
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
    // A load.
    message Load {
      double force_newtons = 1;  // W
      // Torque.
      double torque_newton_metres = 2;
      double damping_newton_seconds_per_metre = 3;  // c
      double film_ratio = 4;  // lambda
      // States.
      enum State { STATE_UNSPECIFIED = 0; DONE = 1;  // has ended
      }
      State state = 5;  // state
    }
    // Models.
    enum PointModel { POINT_MODEL_UNSPECIFIED = 0; POINT_MODEL_FULL = 1;  // all
    }
    // Request.
    message GetLoadRequest {}
    // Loads.
    service LoadService {
      // Returns a load.
      rpc GetLoad(GetLoadRequest) returns (Load);
    })"),
              IsEmpty());
}

TEST(Lint, MissesComments) {
  EXPECT_THAT(said_of("message M { string a = 1; }\n\nenum E { E_UNSPECIFIED = 0; E_A = 1; }"),
              ElementsAre("p.M has no comment", "p.M.a has no comment", "p.E has no comment",
                          "p.E.E_A has no comment"));
}

TEST(Lint, RefusesOtherNames) {
  EXPECT_THAT(said_of("// M\nmessage M {\n string camelCase = 1;  // x\n}"),
              ElementsAre("p.M.camelCase is not snake_case"));
  EXPECT_THAT(said_of("// E\nenum E {\n E_NONE = 0;\n lower = 1;  // x\n}"),
              ElementsAre("p.E.E_NONE is number 0 and not E_UNSPECIFIED",
                          "p.E.lower is not UPPER_SNAKE_CASE", "p.E has values without E_"));
  EXPECT_THAT(said_of("// M\nmessage M {\n // E\n enum E {\n E_UNSPECIFIED = 0;\n A = 1;  // x\n"
                      " E_B = 2;  // x\n }\n}"),
              ElementsAre("p.M.E has values with and without E_"));
}

TEST(Lint, RefusesOtherUnits) {
  EXPECT_THAT(
      said_of("// M\nmessage M {\n double load = 1;  // x\n double length_meters = 2;  // x\n"
              " double load_newton = 3;  // x\n int32 lag_ms = 4;  // x\n}"),
      ElementsAre("p.M.load ends in no unit", "p.M.length_meters spells a unit in another way",
                  "p.M.length_meters ends in no unit",
                  "p.M.load_newton spells a unit in another way", "p.M.load_newton ends in no unit",
                  "p.M.lag_ms spells a unit in another way"));
}

TEST(Lint, RefusesOtherServicesAndRoutes) {
  const std::string service =
      "// S\nservice Loads {\n // A\n rpc Get(GetRequest) returns (GetResponse);\n"
      " // B\n rpc Put(GetRequest) returns (GetResponse);\n}";
  EXPECT_THAT(said_of(service), ElementsAre("p.Loads does not end in Service",
                                            "p.Loads.Put takes GetRequest, not PutRequest",
                                            "p.Loads.Put returns GetResponse, not PutResponse",
                                            "p.Loads.Put has the route of p.Loads.Get, GET /v1/x"));
  EXPECT_THAT(
      said_of("// S\nservice LoadService {\n // A\n rpc Get(GetRequest) returns (Load);\n}", ""),
      ElementsAre("p.LoadService.Get has no HTTP route"));
}

}  // namespace
}  // namespace tribodyn
