// Tests of every method of the contract, found by its descriptor, so that no method is forgotten.
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/resource_kinds.h"
#include "tests/service/contract_methods.h"
#include "tests/service/grpc_fixture.h"
#include "tests/service/raw_client.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Message;
using google::protobuf::MethodDescriptor;
using testing::HasSubstr;

std::string method_name(const testing::TestParamInfo<const MethodDescriptor*>& info) {
  return info.param->name();
}

class EveryMethod : public testing::TestWithParam<const MethodDescriptor*> {
 protected:
  static void SetUpTestSuite() {
    server_ = new Server({});
    server_->start();
    hasty_server_ = new Server({"--call-limit-seconds", "0", "--stream-limit-seconds", "0"});
    hasty_server_->start();
  }
  static void TearDownTestSuite() {
    delete server_;
    delete hasty_server_;
    server_ = hasty_server_ = nullptr;
  }

  std::unique_ptr<Message> request() const {
    return std::unique_ptr<Message>(google::protobuf::MessageFactory::generated_factory()
                                        ->GetPrototype(GetParam()->input_type())
                                        ->New());
  }
  bool has(const std::string& field) const {
    return GetParam()->input_type()->FindFieldByName(field) != nullptr;
  }
  bool is_list() const { return has("page_size"); }

  /// An error as received, and all its texts.
  struct Answer {
    grpc::Status status;
    bool has_reason = false;
    std::string text;
  };
  Answer call(const Message& message) const { return call(*server_, message); }
  Answer call_hasty_server(const Message& message) const { return call(*hasty_server_, message); }

  void expect_refused(const Message& message, const std::string& part) const {
    const Answer answer = call(message);
    EXPECT_THAT(answer.status.error_code(),
                testing::AnyOf(grpc::StatusCode::INVALID_ARGUMENT, grpc::StatusCode::NOT_FOUND))
        << answer.text;
    EXPECT_TRUE(answer.has_reason) << "no ErrorInfo";
    EXPECT_THAT(answer.text, HasSubstr(part));
  }

 private:
  /// One server for all tests.
  class Server : public GrpcTest {
   public:
    explicit Server(std::vector<std::string> flags) { more_flags_ = std::move(flags); }
    void start() {
      GrpcTest::start();
      client_ = std::make_unique<RawClient>(channel_);
    }
    RawClient& client() { return *client_; }
    void TestBody() override {}

   private:
    std::unique_ptr<RawClient> client_;
  };
  Answer call(Server& server, const Message& message) const {
    Answer out;
    out.status = server.client().call(path_of(*GetParam()), message.SerializeAsString()).first;
    google::rpc::Status details;
    details.ParseFromString(out.status.error_details());
    out.text = out.status.error_message();
    for (const auto& any : details.details()) {
      google::rpc::BadRequest bad;
      google::rpc::ErrorInfo info;
      if (any.UnpackTo(&info)) out.has_reason = !info.reason().empty();
      if (!any.UnpackTo(&bad)) continue;
      for (const auto& each : bad.field_violations()) {
        out.text += "\n" + each.field() + ": " + each.description();
      }
    }
    return out;
  }

  static Server* server_;
  static Server* hasty_server_;  // its deadline for calls is 0 s
};

EveryMethod::Server* EveryMethod::server_ = nullptr;
EveryMethod::Server* EveryMethod::hasty_server_ = nullptr;

TEST_P(EveryMethod, IsServedAndChecksAnEmptyRequest) {
  if (GetParam()->name() == "WatchSimulations") {
    GTEST_SKIP() << "an empty request means all simulations, and its stream does not end";
  }
  const Answer answer = call(*request());
  if (is_list() && !has("name")) {
    EXPECT_TRUE(answer.status.ok()) << "an empty list request means the first page";
    return;
  }
  if (GetParam()->name() == "GetSchema") {
    EXPECT_TRUE(answer.status.ok());
    return;
  }
  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << answer.text;
  EXPECT_TRUE(answer.has_reason);
}

TEST_P(EveryMethod, EndsAtTheServersDeadline) {
  const Answer answer = call_hasty_server(*request());
  EXPECT_EQ(answer.status.error_code(), grpc::StatusCode::DEADLINE_EXCEEDED) << answer.text;
  EXPECT_TRUE(answer.has_reason) << "by the server, not by the client";
}

/// Returns the text fields that name an existing resource, at the top level and one level below.
TEST_P(EveryMethod, SuggestsTheNearestNameForAnUnknownOne) {
  const std::string method = GetParam()->name();
  const auto message = request();
  const auto set = [&](const std::string& field, const std::string& value) {
    const auto* descriptor = message->GetDescriptor()->FindFieldByName(field);
    message->GetReflection()->SetString(message.get(), descriptor, value);
  };
  const auto set_inner = [&](const std::string& outer, const std::string& field,
                             const std::string& value) {
    Message* inner = message->GetReflection()->MutableMessage(
        message.get(), message->GetDescriptor()->FindFieldByName(outer));
    const auto* descriptor = inner->GetDescriptor()->FindFieldByName(field);
    inner->GetReflection()->SetString(inner, descriptor, value);
  };
#define TRIBODYN_SEED(Resource, field, collection, seed) \
  {#Resource "Service", #collection "/" seed},
  static const std::map<std::string, std::string> kCollections = {
      TRIBODYN_RESOURCE_KINDS(TRIBODYN_SEED)};
#undef TRIBODYN_SEED
  const auto known = kCollections.find(GetParam()->service()->name());
  if (known == kCollections.end()) {
    const bool is_campaign = GetParam()->service()->name() == "CampaignService";
    if (has("name")) {
      const std::string name = is_campaign ? "campaigns/99999" : "simulations/99999";
      set("name", name);
      return expect_refused(*message, name);
    }
    if (method == "CreateCampaign") {
      set_inner("campaign", "lubricant", "lubricants/paper-fluid-11");
      return expect_refused(*message, "did you mean \"lubricants/paper-fluid-1\"?");
    }
    if (method == "GetSchema") {
      set("message", "Lubricnt");
      return expect_refused(*message, "did you mean \"Lubricant\"?");
    }
    if (method == "EvaluateContact" || method == "EvaluatePoints" || method == "EvaluateRig" ||
        method == "EvaluateViscosity") {
      set("lubricant", "lubricants/paper-fluid-11");
      return expect_refused(*message, "did you mean \"lubricants/paper-fluid-1\"?");
    }
    if (method == "EvaluateCycle") {
      message->GetReflection()->AddString(message.get(),
                                          message->GetDescriptor()->FindFieldByName("lubricants"),
                                          "lubricants/paper-fluid-11");
      message->GetReflection()->SetEnumValue(
          message.get(), message->GetDescriptor()->FindFieldByName("named_cycle"), 1);
      return expect_refused(*message, "did you mean \"lubricants/paper-fluid-1\"?");
    }
    if (method == "EvaluateProfiles") {
      return expect_refused(*message, "0 profiles; allowed: 1 to 24");
    }
    if (method == "ComparePoints" || method == "ExplainPoints") {
      if (method == "ComparePoints") {
        message->GetReflection()->AddString(message.get(),
                                            message->GetDescriptor()->FindFieldByName("lubricants"),
                                            "lubricants/paper-fluid-11");
      } else {
        set("lubricant", "lubricants/paper-fluid-1");
        set("other_lubricant", "lubricants/paper-fluid-11");
      }
      const auto* conditions = message->GetDescriptor()->FindFieldByName("conditions");
      Message* condition = message->GetReflection()->AddMessage(message.get(), conditions);
      condition->GetReflection()->SetDouble(
          condition, condition->GetDescriptor()->FindFieldByName("speed_kilometres_per_hour"), 50);
      return expect_refused(*message, "did you mean \"lubricants/paper-fluid-1\"?");
    }
    if (method == "CreateSimulation") {
      set_inner("simulation", "lubricant", "lubricants/paper-fluid-11");
      return expect_refused(*message, "did you mean \"lubricants/paper-fluid-1\"?");
    }
    if (method == "UpdateSimulation") {
      set_inner("simulation", "name", "simulations/99999");
      return expect_refused(*message, "simulations/99999");
    }
    if (method == "UpdateCampaign") {
      set_inner("campaign", "name", "campaigns/99999");
      return expect_refused(*message, "campaigns/99999");
    }
    if (method == "WatchSimulations") {
      message->GetReflection()->AddString(
          message.get(), message->GetDescriptor()->FindFieldByName("names"), "simulations/99999");
      return expect_refused(*message, "simulations/99999");
    }
    if (method == "ListSimulations" || method == "ListCampaigns") {
      set("page_token", "simulations/x");
      return expect_refused(*message, "page_token");
    }
    FAIL() << "no case for " << method;
  }
  const std::string hint = "did you mean \"" + known->second + "\"?";
  const std::string unknown = known->second + "x";
  if (has("name")) {
    set("name", unknown);
    return expect_refused(*message, hint);
  }
  if (has("filter")) {
    set("filter", "lims = 1");
    return expect_refused(*message, "did you mean \"lims_id\"?");
  }
  if (method.starts_with("Batch")) {
    Message& request = *message->GetReflection()->AddMessage(
        message.get(), message->GetDescriptor()->FindFieldByName("requests"));
    Message& resource =
        *request.GetReflection()->MutableMessage(&request, request.GetDescriptor()->field(0));
    const auto* field = resource.GetDescriptor()->FindFieldByName(
        method.starts_with("BatchUpdate") ? "name" : "derived_from");
    resource.GetReflection()->SetString(&resource, field, unknown);
    expect_refused(*message, "requests[0]." + request.GetDescriptor()->field(0)->name() + ".");
    return expect_refused(*message, hint);
  }
  const std::string resource = message->GetDescriptor()->field(0)->name();
  if (method.starts_with("Update")) {
    set_inner(resource, "name", unknown);
    return expect_refused(*message, hint);
  }
  if (method.starts_with("Create")) {
    set_inner(resource, "derived_from", unknown);
    return expect_refused(*message, hint);
  }
  ASSERT_TRUE(method.starts_with("Import")) << "no case for " << method;
  // The names of an import are the headers of its tables.
  const auto* text = message->GetDescriptor()->FindFieldByName(
      method == "ImportLubricant" ? "viscosity_table_csv" : "tooth_contact_csv");
  if (text != nullptr) {
    message->GetReflection()->SetString(message.get(), text, "load_shar,temperature_celsiu\n1,2\n");
    return expect_refused(*message, "did you mean");
  }
  auto* import = dynamic_cast<v1::ImportSurfaceProfilesRequest*>(message.get());
  ASSERT_NE(import, nullptr);
  import->add_profiles()->set_csv("position_metre,height_metres\n1,2\n");
  expect_refused(*message, "did you mean \"position_metres\"?");
}

TEST_P(EveryMethod, RefusesAPageOfNegativeSize) {
  if (!is_list()) return;
  const auto message = request();
  message->GetReflection()->SetInt32(message.get(),
                                     message->GetDescriptor()->FindFieldByName("page_size"), -1);
  expect_refused(*message, "page_size = -1; allowed: 0");
}

INSTANTIATE_TEST_SUITE_P(Contract, EveryMethod, testing::ValuesIn(all_methods()), method_name);

}  // namespace
}  // namespace tribodyn::server
