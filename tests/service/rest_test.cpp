// The REST interface without a connection: routes, bodies, queries, errors, entity tags, and what a
// web page of another origin may do. The same calls over a connection: http_server_test.cpp.
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <atomic>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "google/api/annotations.pb.h"
#include "google/rpc/code.pb.h"
#include "server/application/campaigns.h"
#include "server/application/errors.h"
#include "server/application/request_limits.h"
#include "server/contract/resource_names.h"
#include "server/storage/seeds.h"
#include "server/transport/http/rest_answer.h"
#include "server/transport/http/rest_handler.h"
#include "tests/service/contract_methods.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

HttpResponse hello(const HttpRequest&) {
  HttpResponse out;
  out.headers["Content-Type"] = "text/plain";
  out.body = "hello";
  return out;
}

class RestTest : public testing::Test {
 protected:
  HttpResponse send(HttpRequest request) {
    request.headers.try_emplace("host", "127.0.0.1:50652");
    if (!request.body.empty()) request.headers.try_emplace("content-type", "application/json");
    std::promise<HttpResponse> answer;
    handler_.handle(std::move(request), std::make_shared<std::atomic<bool>>(false),
                    [&](HttpResponse response) { answer.set_value(std::move(response)); });
    return answer.get_future().get();
  }
  HttpResponse send(const std::string& verb, const std::string& target,
                    const std::string& body = {}, std::map<std::string, std::string> headers = {}) {
    return send(HttpRequest{verb, target, std::move(headers), body, "127.0.0.1", true});
  }
  static json parsed(const HttpResponse& response) { return json::parse(response.body); }

  /// The violations of an error: field and description.
  static std::map<std::string, std::string> violations(const HttpResponse& response) {
    std::map<std::string, std::string> out;
    const json body = parsed(response);
    for (const json& detail : body["error"]["details"]) {
      if (!detail.contains("field_violations")) continue;
      for (const json& each : detail["field_violations"]) {
        out[each.value("field", "")] = each["description"];
      }
    }
    return out;
  }

  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
  RestHandler handler_{dispatcher_, {{"/hello", {hello, true}}}};
};

TEST_F(RestTest, EveryRouteRefusesWhoeverHasNoValidTokenBeforeItReadsTheRequest) {
  for (const HttpRoutes::Route& route : handler_.routes().all()) {
    if (!route.method->answer) continue;
    std::string path;
    for (const std::string& segment : route.segments)
      path += "/" + (segment == "*" ? "x" : segment);
    if (!route.custom_verb.empty()) path += ":" + route.custom_verb;
    for (const char* header : {"", "Bearer unknown", "Basic YTpi"}) {
      const HttpResponse response =
          send(HttpRequest{route.verb, path, {{"authorization", header}}, "", "127.0.0.1", false});
      EXPECT_EQ(response.status, 401) << route.verb << " " << path;
      EXPECT_EQ(response.headers.at("WWW-Authenticate"), "Bearer realm=\"tribodyn\"");
      EXPECT_EQ(parsed(response)["error"]["details"][0]["reason"], "UNAUTHENTICATED");
    }
  }
}

TEST_F(RestTest, ATokenOpensWhatItIsFor) {
  StoredToken token{.name = "anna", .hash = token_hash("secret"), .scope = Scope::kRead};
  token.projects = {"default"};
  app_.authorizer->set_tokens({token}, 0);
  const auto status = [&](const std::string& verb, const std::string& path) {
    return send(
        HttpRequest{verb, path, {{"authorization", "Bearer secret"}}, "", "127.0.0.1", false});
  };
  EXPECT_EQ(status("GET", "/v1/lubricants/paper-fluid-1").status, 200);
  const HttpResponse denied = status("DELETE", "/v1/lubricants/paper-fluid-1");
  EXPECT_EQ(denied.status, 403);
  EXPECT_THAT(denied.headers.at("WWW-Authenticate"), HasSubstr("insufficient_scope"));
  EXPECT_EQ(status("GET", "/v1/projects/acme/lubricants/paper-fluid-1").status, 403);
}

TEST_F(RestTest, EveryMethodHasARouteThatFindsIt) {
  std::set<std::string> found;
  for (const HttpRoutes::Route& route : handler_.routes().all()) {
    std::string path;
    for (const std::string& segment : route.segments)
      path += "/" + (segment == "*" ? "x" : segment);
    if (!route.custom_verb.empty()) path += ":" + route.custom_verb;
    const auto match = handler_.routes().find(route.verb, path);
    ASSERT_TRUE(match) << route.verb << " " << path;
    EXPECT_EQ(match->method, route.method) << route.verb << " " << path;
    found.insert(match->method->descriptor->full_name());
  }
  for (const auto* method : all_methods()) EXPECT_TRUE(found.contains(method->full_name()));
}

TEST_F(RestTest, GetAnswersTheResourceWithNamesInSnakeCaseAndItsZeros) {
  const HttpResponse response = send("GET", "/v1/lubricants/paper-fluid-1");
  EXPECT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.headers.at("Content-Type"), "application/json; charset=utf-8");
  const json fluid = parsed(response);
  EXPECT_EQ(fluid["name"], "lubricants/paper-fluid-1");
  EXPECT_TRUE(fluid["pressure_viscosity_coefficient_per_pascal"].is_number());
  EXPECT_EQ(fluid["external_sample_id"], "") << "an empty text is printed";
  EXPECT_EQ(response.headers.at("ETag"), "\"" + fluid["etag"].get<std::string>() + "\"");
}

TEST_F(RestTest, AProjectIsAPartOfThePath) {
  bench_.store().add_project("acme", seed_resources(), 1);
  json fluid = parsed(send("GET", "/v1/projects/acme/lubricants/paper-fluid-1"));
  EXPECT_EQ(fluid["name"], "projects/acme/lubricants/paper-fluid-1");
  const HttpResponse made =
      send("POST", "/v1/projects/acme/lubricants?lubricant_id=mine", fluid.dump());
  ASSERT_EQ(made.status, 200) << made.body;
  EXPECT_EQ(parsed(made)["name"], "projects/acme/lubricants/mine");
  EXPECT_EQ(send("GET", "/v1/projects/acme/lubricants/mine").status, 200);
  EXPECT_EQ(send("GET", "/v1/projects/acme/lubricants/mine:listRevisions").status, 200);
  EXPECT_EQ(send("GET", "/v1/lubricants/mine").status, 404);
  EXPECT_EQ(send("GET", "/v1/projects/none/lubricants").status, 404);
}

TEST_F(RestTest, ResourceIsCreatedUpdatedAndDeletedWithItsEtag) {
  json fluid = parsed(send("GET", "/v1/lubricants/paper-fluid-1"));
  fluid.erase("etag");
  fluid["display_name"] = "Mine \"A\" \u00e9";
  const HttpResponse made = send("POST", "/v1/lubricants?lubricant_id=mine", fluid.dump());
  ASSERT_EQ(made.status, 200) << made.body;
  EXPECT_EQ(parsed(made)["name"], "lubricants/mine");
  EXPECT_EQ(parsed(made)["display_name"], fluid["display_name"]);

  const std::string first = made.headers.at("ETag");
  const HttpResponse renamed = send("PATCH", "/v1/lubricants/mine?update_mask=display_name",
                                    R"({"display_name": "B"})", {{"if-match", first}});
  ASSERT_EQ(renamed.status, 200) << renamed.body;
  EXPECT_EQ(parsed(renamed)["display_name"], "B");
  EXPECT_EQ(parsed(renamed)["relaxation_time_seconds"], fluid["relaxation_time_seconds"]);

  const HttpResponse late =
      send("PATCH", "/v1/lubricants/mine", R"({"display_name": "C"})", {{"if-match", first}});
  EXPECT_EQ(late.status, 412) << late.body;
  EXPECT_EQ(send("DELETE", "/v1/lubricants/mine", "", {{"if-match", first}}).status, 412);
  EXPECT_EQ(send("DELETE", "/v1/lubricants/mine").status, 200);
  EXPECT_EQ(send("POST", "/v1/lubricants/mine:undelete", "{}").status, 200);
}

TEST_F(RestTest, ABodyThatNamesAnotherResourceThanThePathIsRefused) {
  const auto undelete = [&](const std::string& path, const std::string& name) {
    return send("POST", path + ":undelete", json{{"name", name}}.dump());
  };
  EXPECT_EQ(send("DELETE", "/v1/lubricants/paper-fluid-2").status, 200);
  const HttpResponse other = undelete("/v1/lubricants/paper-fluid-2", "lubricants/paper-fluid-1");
  EXPECT_EQ(other.status, 400);
  EXPECT_THAT(violations(other).at("name"), testing::AllOf(HasSubstr("lubricants/paper-fluid-1"),
                                                           HasSubstr("lubricants/paper-fluid-2")));
  EXPECT_EQ(
      undelete("/v1/lubricants/paper-fluid-2", "projects/default/lubricants/paper-fluid-2").status,
      200)
      << "the same name";
  const HttpResponse renamed = send("PATCH", "/v1/lubricants/paper-fluid-2",
                                    R"({"name": "lubricants/paper-fluid-1", "description": "x"})");
  EXPECT_THAT(violations(renamed).at("lubricant.name"), HasSubstr("lubricants/paper-fluid-1"));
  EXPECT_EQ(send("PATCH", "/v1/lubricants/paper-fluid-2",
                 R"({"name": "lubricants/paper-fluid-2", "description": "x"})")
                .status,
            200);
  bench_.store().add_project("acme", seed_resources(), 1);
  const HttpResponse elsewhere =
      send("POST", "/v1/projects/acme/points:evaluate", R"({"parent": "projects/default"})");
  EXPECT_THAT(violations(elsewhere).at("parent"), HasSubstr("projects/acme"));
}

TEST_F(RestTest, AConditionThatCannotBeKeptIsRefused) {
  for (const char* header : {"tag", "W/\"tag\"", "\"a\", \"b\"", "\"\""}) {
    const HttpResponse response =
        send("DELETE", "/v1/lubricants/paper-fluid-1", "", {{"if-match", header}});
    EXPECT_EQ(response.status, 400) << header;
    EXPECT_THAT(violations(response).at("If-Match"), HasSubstr("one etag in double quotes"));
  }
  EXPECT_THAT(
      violations(send("GET", "/v1/lubricants", "", {{"if-match", "\"tag\""}})).at("If-Match"),
      HasSubstr("compares no etag"));
  EXPECT_EQ(send("GET", "/v1/lubricants/paper-fluid-1").status, 200) << "nothing was deleted";
}

TEST_F(RestTest, TextThatIsNotUtf8IsRefusedByTheNameOfItsField) {
  // A lone byte, one cut off, one too many, a surrogate, a number above U+10FFFF, a long form of /.
  for (const char* text : {"%ff", "%C3", "a%80", "%ED%A0%80", "%F4%90%80%80", "%C0%AF"}) {
    EXPECT_EQ(
        violations(send("GET", std::string("/v1/lubricants/") + text)).at("name"),
        "is \"lubricants/" + plain_excerpt(*percent_decoded(text)) + "\"; allowed: text in UTF-8");
    EXPECT_THAT(violations(send("GET", std::string("/v1/lubricants?filter=") + text)).at("filter"),
                HasSubstr("allowed: text in UTF-8"));
    EXPECT_THAT(
        violations(send("GET", std::string("/v1/lubricants?read_mask=") + text)).at("read_mask"),
        HasSubstr("allowed: names of fields"));
  }
  EXPECT_EQ(
      send("GET", "/v1/lubricants?filter=display_name:%22%C3%A9%E2%82%AC%F0%9F%98%80%22").status,
      200);
}

TEST_F(RestTest, AnAnswerThatIsTooLongForJsonIsRefusedUntilAReadMaskShortensIt) {
  v1::CreateCampaignRequest create;
  v1::Campaign& campaign = *create.mutable_campaign();
  campaign.set_lubricant("lubricants/paper-fluid-1");
  campaign.add_conditions()->set_speed_kilometres_per_hour(60);
  campaign.mutable_budget()->set_points(1);
  for (int i = 0; i < 22; ++i) {
    v1::CandidateAttribute& attribute = *campaign.add_candidate_attributes();
    attribute.set_name("x" + std::to_string(i));
    attribute.mutable_values()->Resize(100'000, i);
  }
  v1::CandidateColumn& column = *campaign.add_candidate_columns();
  column.set_path("surface.asperity_friction_coefficient");
  column.mutable_values()->Resize(100'000, 0.1);
  const auto created = create_campaign(app_, create);
  ASSERT_TRUE(created.ok()) << complaints(created.error());
  const std::string target = "/v1/" + created.message().name() + "?view=CAMPAIGN_VIEW_FULL";
  const HttpResponse whole = send("GET", target);
  EXPECT_EQ(whole.status, 400);
  EXPECT_TRUE(violations(whole).contains("read_mask"));
  EXPECT_EQ(send("GET", target + "&read_mask=candidate_columns").status, 200);
}

TEST_F(RestTest, OnlyAReadMaskThatNamesFieldsLeavesOutZeros) {
  const auto fields = [&](const std::string& query) {
    return parsed(send("GET", "/v1/lubricants?" + query))["lubricants"][0].size();
  };
  const std::size_t whole = fields("");
  EXPECT_EQ(fields("read_mask="), whole);
  EXPECT_EQ(fields("read%5Fmask=name,external_sample_id"), 1U) << "the empty id is left out";
}

/// The message in indented JSON, the longest that writers of JSON make of it.
std::string indented(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  std::string out;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(message, &out, options).ok());
  return out;
}

TEST(BodyLimit, TakesTheLongestResourcesInIndentedJson) {
  v1::GearSet gears = seed<v1::GearSet>("gearSets/reference-axle");
  v1::Lubricant fluid = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  for (int i = 0; i < 10'000; ++i) {  // mostly 17 digits and a power of ten
    gears.mutable_flank_slots(0)->add_radius_x_metres(-0.01 / (3 + i));
  }
  for (int i = 0; i < 1000; ++i) {
    auto& measured = *fluid.mutable_measurements();
    v1::ViscosityMeasurement& viscosity = *measured.add_viscosities();
    viscosity.set_temperature_celsius(20 + i / 7.0);
    viscosity.set_kinematic_viscosity_square_millimetres_per_second(100 / 3.0 - i / 1100.0);
    viscosity.set_relative_standard_uncertainty(0.01 / 3);
    v1::BrookfieldViscosity& brookfield = *measured.add_brookfield_viscosities();
    brookfield.set_temperature_celsius(-40 + i / 70.0);
    brookfield.set_dynamic_viscosity_millipascal_seconds(1e5 / 3 - i);
    v1::DensityMeasurement& density = *measured.add_densities();
    density.set_temperature_celsius(20 + i / 7.0);
    density.set_density_kilograms_per_cubic_metre(2500 / 3.0 - i / 10.0);
  }
  // The longest gear sets consist of numbers, which grow by a factor of 3.2. Measurements grow by
  // more, but the longest ones fit easily.
  EXPECT_LE(indented(gears).size(), RestHandler::kJsonGrowth * gears.ByteSizeLong());
  EXPECT_LE(indented(fluid).size(), RestHandler::kJsonGrowth * kUsualRequestBytes / 2);
}

TEST_F(RestTest, AnUnknownMethodIsNamed) {
  const json unknown = parsed(send("GET", "/v2/none"))["error"]["details"][0];
  EXPECT_EQ(unknown["reason"], "UNKNOWN_METHOD");
  EXPECT_EQ(unknown["metadata"]["method"], "GET /v2/none");
  EXPECT_EQ(parsed(send("PUT", "/v1/lubricants"))["error"]["details"][0]["metadata"]["method"],
            "PUT /v1/lubricants");
}

TEST_F(RestTest, HttpThatIsNotServedHasAReasonOfItsOwn) {
  for (const HttpResponse& response :
       {send("GET", "/v1/lubricants?" + std::string(9000, 'x')),
        send("POST", "/v1/lubricants", "{}", {{"content-type", "text/plain"}})}) {
    EXPECT_EQ(parsed(response)["error"]["details"][0]["reason"], "INVALID_HTTP");
    EXPECT_EQ(parsed(response)["error"]["code"], response.status);
  }
}

/// A contract of one method with this route; its request has a text, a number and a message.
class Contract {
 public:
  Contract(const std::string& path, const std::string& body) {
    using google::protobuf::FieldDescriptorProto;
    google::protobuf::FileDescriptorProto file;
    file.set_name("one_method.proto");
    auto& message = *file.add_message_type();
    message.set_name("Request");
    const std::pair<const char*, FieldDescriptorProto::Type> kFields[] = {
        {"name", FieldDescriptorProto::TYPE_STRING},
        {"count", FieldDescriptorProto::TYPE_INT32},
        {"inner", FieldDescriptorProto::TYPE_MESSAGE}};
    for (const auto& [name, type] : kFields) {
      auto& field = *message.add_field();
      field.set_name(name);
      field.set_number(message.field_size());
      field.set_label(FieldDescriptorProto::LABEL_OPTIONAL);
      field.set_type(type);
      if (type == FieldDescriptorProto::TYPE_MESSAGE) field.set_type_name("Request");
    }
    auto& service = *file.add_service();
    service.set_name("Service");
    auto& method = *service.add_method();
    method.set_name("Call");
    method.set_input_type("Request");
    method.set_output_type("Request");
    auto& rule = *method.mutable_options()->MutableExtension(google::api::http);
    rule.set_post(path);
    rule.set_body(body);
    methods_[0].descriptor = pool_.BuildFile(file)->service(0)->method(0);
  }
  const std::vector<Method>& methods() const { return methods_; }

 private:
  google::protobuf::DescriptorPool pool_;
  std::vector<Method> methods_{1};
};

TEST(HttpRoutes, RefuseFieldsThatTheRequestDoesNotHave) {
  const auto routes = [](const char* path, const char* body) {
    const Contract contract(path, body);
    return HttpRoutes(contract.methods()).all().size();
  };
  EXPECT_EQ(routes("/v1/{name=things/*}", ""), 1U);
  EXPECT_EQ(routes("/v1/{inner.name=things/*}", "inner"), 1U);
  EXPECT_EQ(routes("/v1/{name=things/*}", "*"), 1U);
  for (const char* path : {"/v1/{nane=things/*}", "/v1/{count=things/*}", "/v1/{inner=things/*}",
                           "/v1/{inner.nane=things/*}", "/v1/{name.inner=things/*}"}) {
    EXPECT_THROW(routes(path, ""), std::logic_error) << path;
  }
  for (const char* body : {"iner", "name", "inner.inner"}) {
    EXPECT_THROW(routes("/v1/things", body), std::logic_error) << body;
  }
}

TEST_F(RestTest, KnownEtagAnswersNotModifiedWithoutABody) {
  const HttpResponse whole = send("GET", "/v1/lubricants/paper-fluid-1");
  const std::string tag = whole.headers.at("ETag");
  for (const std::string& known : {tag, "\"other\", " + tag, "W/" + tag, std::string("*")}) {
    const HttpResponse again =
        send("GET", "/v1/lubricants/paper-fluid-1", "", {{"if-none-match", known}});
    EXPECT_EQ(again.status, 304) << known;
    EXPECT_TRUE(again.body.empty());
    EXPECT_EQ(again.headers.at("ETag"), tag);
  }
  EXPECT_EQ(
      send("GET", "/v1/lubricants/paper-fluid-1", "", {{"if-none-match", "\"other\""}}).status,
      200);
  const std::string of_list = send("GET", "/v1/lubricants").headers.at("ETag");
  EXPECT_EQ(send("GET", "/v1/lubricants", "", {{"if-none-match", of_list}}).status, 304);
}

TEST_F(RestTest, QueryGivesFieldsOfEveryKind) {
  const HttpResponse page =
      send("GET",
           "/v1/lubricants?page_size=2&pageToken=&read_mask=name,display_name&"
           "filter=display_name%3A%22Lubricant%22");
  ASSERT_EQ(page.status, 200) << page.body;
  const json list = parsed(page);
  EXPECT_EQ(list["lubricants"].size(), 2U);
  EXPECT_EQ(list["total_size"], 3) << page.body;
  EXPECT_EQ(list["lubricants"][0].size(), 2U) << "no zeros of what the mask leaves out";
  EXPECT_EQ(send("GET", "/v1/simulations?view=SIMULATION_VIEW_BASIC").status, 200);
}

TEST_F(RestTest, EachWrongParameterIsNamedWithWhatIsAllowed) {
  const HttpResponse response =
      send("GET", "/v1/simulations?page_sise=5&page_size=many&view=WHOLE&filter=%zz");
  EXPECT_EQ(response.status, 400);
  const auto wrong = violations(response);
  ASSERT_EQ(wrong.size(), 4U);
  EXPECT_THAT(wrong.at("page_sise"), HasSubstr("did you mean \"page_size\"?"));
  EXPECT_THAT(wrong.at("page_size"), HasSubstr("is \"many\"; allowed: a whole number"));
  EXPECT_THAT(wrong.at("view"), HasSubstr("SIMULATION_VIEW_FULL"));
  EXPECT_THAT(wrong.at("filter"), HasSubstr("%25"));
  EXPECT_THAT(violations(send("GET", "/v1/lubricants/paper-fluid-1?name=lubricants/2")).at("name"),
              HasSubstr("stands in the path"));
  EXPECT_THAT(violations(send("POST", "/v1/contacts:evaluate?x=1", "{}")).at("x"),
              HasSubstr("takes no query"));
  EXPECT_THAT(
      violations(send("POST", "/v1/lubricants?lubricant.name=x", "{}")).at("lubricant.name"),
      HasSubstr("stands in the JSON body"));
}

TEST_F(RestTest, ABodyThatCannotBeReadIsRefusedWithThePlace) {
  for (const std::string& body :
       {std::string("{"), std::string("[]"), std::string("5"), std::string("{\"a\":\xff}"),
        std::string(1, '\0'), std::string(200'000, '['), std::string(R"({"measurements": [1]})")}) {
    const HttpResponse response = send("POST", "/v1/lubricants?lubricant_id=x", body);
    EXPECT_EQ(response.status, 400) << body.substr(0, 60);
    EXPECT_THAT(violations(response).at("lubricant"),
                HasSubstr("the body is no JSON of Lubricant"));
  }
  EXPECT_THAT(violations(send("GET", "/v1/lubricants/paper-fluid-1", "{}")).at(""),
              HasSubstr("takes no body"));
}

TEST_F(RestTest, AWrongValueInABodyIsRefusedWithItsFieldAndWhatIsAllowed) {
  const auto wrong = [&](const std::string& body) {
    const HttpResponse response = send("POST", "/v1/lubricants?lubricant_id=x", body);
    EXPECT_EQ(response.status, 400) << body;
    const auto all = violations(response);
    return all.size() == 1 ? all.begin()->first + " " + all.begin()->second : response.body;
  };
  EXPECT_THAT(violations(send("POST", "/v1/simulations",
                              R"({"inefficiency_curve": {"model": "POINT_MODEL_HALF"}})"))
                  .at("simulation.inefficiency_curve.model"),
              AllOf(HasSubstr("is \"POINT_MODEL_HALF\"; allowed: one of POINT_MODEL_UNSPECIFIED, "),
                    HasSubstr("POINT_MODEL_QUASI_STATIC")));
  EXPECT_THAT(wrong(R"({"provenance": [{}, {"provenance": 7.5}]})"),
              AllOf(HasSubstr("lubricant.provenance[1].provenance is 7.5; allowed: one of "),
                    HasSubstr("PROVENANCE_MEASURED")));
  EXPECT_EQ(wrong(R"({"relaxation_time_seconds": "long"})"),
            "lubricant.relaxation_time_seconds is \"long\"; allowed: a number, \"NaN\", "
            "\"Infinity\" or \"-Infinity\"");
  EXPECT_EQ(wrong(R"({"revision": 1.5})"),
            "lubricant.revision is 1.5; allowed: a whole number of 32 bits");
  EXPECT_THAT(wrong(R"({"create_time": "yesterday"})"),
              HasSubstr("; allowed: a time such as \"2025-01-31T12:00:00Z\""));
  EXPECT_EQ(wrong(R"({"measurements": 5})"),
            "lubricant.measurements is 5; allowed: a JSON object, LubricantMeasurements");
  EXPECT_EQ(wrong(R"({"relaxation_tme_seconds": 1})"),
            "lubricant.relaxation_tme_seconds is no field of Lubricant; did you mean "
            "\"relaxation_time_seconds\"?");
  EXPECT_EQ(wrong(R"({"measurements": {"viscosities": [{}, {"temperature": 40}]}})"),
            "lubricant.measurements.viscosities[1].temperature is no field of "
            "ViscosityMeasurement; did you mean \"temperature_celsius\"?");
  // Values that look like the parser's own words.
  EXPECT_THAT(wrong(R"({"base_oil_class": "a) for type type.googleapis.com/x.Y"})"),
              HasSubstr("BASE_OIL_CLASS_GROUP_I"));
  EXPECT_THAT(
      violations(send("POST", "/v1/contacts:evaluate", R"({"lubricnt": ""})")).at("lubricnt"),
      HasSubstr("did you mean \"lubricant\"?"));
}

TEST_F(RestTest, ErrorsHaveTheCodeTheReasonAndTheDetails) {
  const HttpResponse response = send("GET", "/v1/lubricants/none");
  EXPECT_EQ(response.status, 404);
  const json error = parsed(response)["error"];
  EXPECT_EQ(error["code"], 404);
  EXPECT_EQ(error["status"], "NOT_FOUND");
  EXPECT_THAT(error["message"].get<std::string>(), HasSubstr("lubricants/none"));
  EXPECT_EQ(error["details"][0]["@type"], "type.googleapis.com/google.rpc.ErrorInfo");
  EXPECT_EQ(error["details"][0]["reason"], "NOT_FOUND");
  EXPECT_EQ(error["details"][0]["domain"], "tribodyn.dev");
}

TEST(RestAnswer, EveryCodeHasItsStatus) {
  using google::rpc::Code;
  const std::map<Code, int> expected = {
      {google::rpc::INVALID_ARGUMENT, 400},   {google::rpc::FAILED_PRECONDITION, 400},
      {google::rpc::OUT_OF_RANGE, 400},       {google::rpc::UNAUTHENTICATED, 401},
      {google::rpc::PERMISSION_DENIED, 403},  {google::rpc::NOT_FOUND, 404},
      {google::rpc::ALREADY_EXISTS, 409},     {google::rpc::ABORTED, 409},
      {google::rpc::RESOURCE_EXHAUSTED, 429}, {google::rpc::CANCELLED, 499},
      {google::rpc::INTERNAL, 500},           {google::rpc::UNKNOWN, 500},
      {google::rpc::DATA_LOSS, 500},          {google::rpc::UNIMPLEMENTED, 501},
      {google::rpc::UNAVAILABLE, 503},        {google::rpc::DEADLINE_EXCEEDED, 504}};
  for (const auto& [code, status] : expected) {
    google::rpc::Status failure;
    failure.set_code(code);
    EXPECT_EQ(http_status(failure), status) << code;
  }
}

TEST(RestAnswer, RetryDelayIsRoundedUpToSeconds) {
  const HttpResponse busy = error_response(exhausted(v1::ERROR_REASON_TOO_MANY_CALLS, "busy", 1.2));
  EXPECT_EQ(busy.status, 429);
  EXPECT_EQ(busy.headers.at("Retry-After"), "2");
}

TEST_F(RestTest, UnknownPathsAndVerbsSayWhatThereIs) {
  EXPECT_EQ(send("GET", "/v2/lubricants").status, 404);
  EXPECT_EQ(send("GET", "/v1/lubricants/paper-fluid-1/x").status, 404);
  EXPECT_EQ(send("GET", "/v1/lubricants/a%2Fb").status, 404) << "no slash inside an id";
  EXPECT_EQ(send("GET", "/v1/../v1/lubricants").status, 404);
  EXPECT_EQ(send("GET", "").status, 404);
  const HttpResponse other = send("PUT", "/v1/lubricants");
  EXPECT_EQ(other.status, 405);
  EXPECT_EQ(other.headers.at("Allow"), "GET, POST");
  EXPECT_EQ(send("OPTIONS", "/v1/lubricants").status, 405) << "no CORS";
  EXPECT_EQ(send("GET", "/v1/lubricants?" + std::string(9000, 'x')).status, 414);
}

TEST_F(RestTest, TheFormOfAnAnswerIsOneThatTheMethodHas) {
  const auto status = [&](const std::string& target, const std::string& accept) {
    return send("GET", target, "", {{"accept", accept}}).status;
  };
  for (const char* accept : {"", "*/*", "application/json", "text/html, application/*;q=0.5",
                             "text/html;q=0.9, */*;q=0.1", "APPLICATION/JSON; charset=utf-8"}) {
    EXPECT_EQ(status("/v1/lubricants", accept), 200) << accept;
  }
  for (const char* accept : {"text/html", "application/json;q=0", "*/*, application/json;q=0"}) {
    EXPECT_EQ(status("/v1/lubricants", accept), 406) << accept;
  }
  EXPECT_THAT(send("GET", "/v1/lubricants", "", {{"accept", "text/html"}}).body,
              HasSubstr("this method answers application/json"));
  EXPECT_EQ(status("/v1/lubricants?alt=json", "text/html"), 200) << "the parameter decides";
  EXPECT_EQ(status("/v1/lubricants?alt=sse", ""), 400);
  EXPECT_THAT(send("GET", "/v1/simulations/1:watch?alt=csv").body,
              HasSubstr("alt is \\\"csv\\\"; allowed: sse, ndjson"));
}

TEST_F(RestTest, AStreamThatCannotOpenIsAnsweredWithItsError) {
  EXPECT_EQ(send("GET", "/v1/simulations/77:watch").status, 404);
  EXPECT_EQ(send("HEAD", "/v1/simulations/77:watch").status, 405);
  EXPECT_EQ(send("GET", "/v1/simulations:watch?filter=x&names=y").status, 400);
  const HttpResponse late =
      send("GET", "/v1/simulations:watch?filter=lubricant=%22paper-fluid-1%22", "",
           {{"last-event-id", "last"}});
  EXPECT_THAT(violations(late).at("Last-Event-ID"), HasSubstr("is last; allowed: the id"));
  const HttpResponse future =
      send("GET", "/v1/simulations:watch?filter=lubricant=%22paper-fluid-1%22", "",
           {{"last-event-id", "9"}});
  EXPECT_THAT(violations(future).at("after_event_number"), HasSubstr("9; allowed: 0 to 0"));
}

TEST_F(RestTest, PagesOfOtherOriginsAreRefused) {
  const auto status = [&](const std::string& verb, std::map<std::string, std::string> headers) {
    return send(verb, "/v1/lubricants", verb == "GET" ? "" : "{}", std::move(headers)).status;
  };
  EXPECT_EQ(status("GET", {{"host", "evil.example:50652"}}), 403) << "DNS rebinding";
  EXPECT_EQ(status("GET", {{"host", ""}}), 403);
  EXPECT_EQ(status("GET", {{"origin", "http://evil.example"}}), 403);
  EXPECT_EQ(status("POST", {{"origin", "null"}}), 403) << "a sandboxed frame or a file";
  EXPECT_EQ(status("POST", {{"sec-fetch-site", "cross-site"}}), 403);
  EXPECT_EQ(status("GET", {{"origin", "http://127.0.0.1:50652"}}), 200);
  for (const char* host : {"localhost:50652", "127.0.0.1", "[::1]:50652", "[::1]"}) {
    EXPECT_EQ(status("GET", {{"host", host}}), 200) << host;
  }
  // What a form of a page can send without asking first.
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", ""}) {
    EXPECT_EQ(status("POST", {{"content-type", type}}), 415) << type;
  }
  EXPECT_EQ(status("POST", {{"content-encoding", "gzip"}}), 415);
}

TEST_F(RestTest, EveryAnswerForbidsSniffingFramingAndSharing) {
  for (const char* path : {"/v1/lubricants", "/hello", "/none"}) {
    const HttpResponse response = send("GET", path);
    for (const auto& [name, value] : security_headers()) {
      EXPECT_EQ(response.headers.at(name), value) << path;
    }
    EXPECT_FALSE(response.headers.contains("Access-Control-Allow-Origin"));
  }
}

/// Decompresses gzip.
std::string unzipped(const std::string& body) {
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  std::string out(1 << 22, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(body.data()));
  stream.avail_in = static_cast<uInt>(body.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

TEST_F(RestTest, LongAnswersAreCompressedForThoseWhoAskForIt) {
  const HttpResponse plain = send("GET", "/v1/gearSets");
  const HttpResponse zipped =
      send("GET", "/v1/gearSets", "", {{"accept-encoding", "br, GZIP;q=0.5"}});
  EXPECT_EQ(zipped.headers.at("Content-Encoding"), "gzip");
  EXPECT_LT(zipped.body.size(), plain.body.size() / 2);
  EXPECT_EQ(unzipped(zipped.body), plain.body);
  for (const char* header : {"", "br", "gzip;q=0"}) {
    const HttpResponse other = send("GET", "/v1/gearSets", "", {{"accept-encoding", header}});
    EXPECT_FALSE(other.headers.contains("Content-Encoding")) << header;
  }
}

TEST_F(RestTest, BodiesAreLimitedByTheirMethod) {
  const auto most = [&](const std::string& verb, const std::string& target) {
    HttpRequest head;
    head.verb = verb;
    head.target = target;
    return handler_.maximum_body_bytes(head);
  };
  EXPECT_EQ(most("GET", "/v1/lubricants"), 0U);
  EXPECT_EQ(most("POST", "/none"), 0U);
  EXPECT_EQ(most("POST", "/v1/simulations"), 4 * kUsualRequestBytes);
  EXPECT_EQ(most("POST", "/v1/lubricants:batchCreate?x=1"), RestHandler::kMaximumBodyBytes);
}

TEST_F(RestTest, AHostileBodyIsRefusedBeforeItGrows) {
  std::string many = R"({"requests":[{})";
  for (int i = 0; i < 100'000; ++i) many += ",{}";
  const HttpResponse response = send("POST", "/v1/lubricants:batchCreate", many + "]}");
  EXPECT_EQ(response.status, 400);
  EXPECT_THAT(response.body, HasSubstr("at most"));
}

TEST_F(RestTest, SimulationRunsOverRestAndItsCurveIsRead) {
  const HttpResponse made = send("POST", "/v1/simulations?request_id=r1", R"({
    "lubricant": "lubricants/paper-fluid-1",
    "operating_point": {"cruise": {"speed_kilometres_per_hour": 65}}})");
  ASSERT_EQ(made.status, 200) << made.body;
  const std::string name = parsed(made)["name"];
  EXPECT_EQ(parsed(send("POST", "/v1/simulations?request_id=r1", R"({
    "lubricant": "lubricants/paper-fluid-1",
    "operating_point": {"cruise": {"speed_kilometres_per_hour": 65}}})"))["name"],
            name);
  ASSERT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
  const json done = parsed(send("GET", "/v1/" + name + "?view=SIMULATION_VIEW_FULL"));
  EXPECT_EQ(done["state"], "SUCCEEDED");
  EXPECT_GT(done["result"]["points"].size() + done["result"].size(), 0U);
}

TEST_F(RestTest, PagesAreServedByTheirPath) {
  EXPECT_EQ(send("GET", "/hello").body, "hello");
  EXPECT_EQ(send("HEAD", "/hello").status, 200);
  EXPECT_EQ(send("POST", "/hello", "{}").status, 404);
}

}  // namespace
}  // namespace tribodyn::server
