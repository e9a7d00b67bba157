// The description of the REST interface: that it is complete and true, and how it is served.
#include "server/transport/http/openapi.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "server/transport/http/description_pages.h"
#include "tests/service/openapi_schemas.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class OpenApi : public testing::Test {
 protected:
  HttpResponse send(const std::string& verb, const std::string& target,
                    std::map<std::string, std::string> headers = {}, bool is_owner = true) {
    HttpRequest request{verb, target, std::move(headers), "", "127.0.0.1", is_owner};
    request.headers.try_emplace("host", "localhost");
    std::promise<HttpResponse> answer;
    handler_.handle(std::move(request), std::make_shared<std::atomic<bool>>(false),
                    [&](HttpResponse response) { answer.set_value(std::move(response)); });
    HttpResponse out = answer.get_future().get();
    if (out.stream != nullptr) out.stream->hang_up();
    return out;
  }

  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
  RestHandler handler_{dispatcher_, description_pages(dispatcher_.methods())};
  const OpenApiSchemas schemas_{json::parse(openapi_document(handler_.routes()))};
  const json& document_ = schemas_.document();
};

TEST_F(OpenApi, EveryRouteOfTheTableIsDescribedAndNoOther) {
  std::set<std::string> described;
  for (const auto& [path, verbs] : document_["paths"].items()) {
    for (const auto& [verb, operation] : verbs.items()) {
      described.insert(verb + " " + path_shape(path));
    }
  }
  std::set<std::string> expected;
  for (const HttpRoutes::Route& route : handler_.routes().all()) {
    std::string verb = route.verb;
    for (char& each : verb) each = static_cast<char>(std::tolower(each));
    expected.insert(verb + " " + route_shape(route));
  }
  for (const char* page : {"/healthz", "/metrics", "/openapi.json", "/docs", "/docs.css"}) {
    expected.insert(std::string("get ") + page);
  }
  EXPECT_EQ(described, expected);
}

TEST_F(OpenApi, EveryRouteThatIsDescribedAnswers) {
  for (const auto& [path, verbs] : document_["paths"].items()) {
    if (path == "/healthz" || path == "/metrics") continue;  // pages of the daemon
    for (const auto& [verb, operation] : verbs.items()) {
      std::string target = path_shape(path);
      for (std::size_t at = 0; (at = target.find("{}")) != std::string::npos;) {
        target.replace(at, 2, "x");
      }
      std::string upper = verb;
      for (char& each : upper) each = static_cast<char>(std::toupper(each));
      const HttpResponse response = send(upper, target);
      EXPECT_NE(response.status, 405) << upper << " " << target;
      EXPECT_LT(response.status, 500) << upper << " " << target;
      EXPECT_THAT(response.body.substr(0, 1000), Not(HasSubstr("UNKNOWN_METHOD")))
          << upper << " " << target;
    }
  }
}

TEST_F(OpenApi, ErrorsAndColumnsHaveTheFormsThatAreDescribed) {
  const auto check = [&](const std::string& target, const std::string& path,
                         const std::string& type) {
    const HttpResponse response = send("GET", target);
    const std::string content_type = response.headers.at("Content-Type");
    EXPECT_EQ(content_type.substr(0, content_type.find(';')), type) << target;
    const json& answer =
        document_["paths"][path]["get"]["responses"][response.status == 200 ? "200" : "default"];
    const json& schema = response.status == 200 ? answer["content"][type]["schema"]
                                                : document_["components"]["schemas"]["Error"];
    EXPECT_EQ(schemas_.complaints(json::parse(response.body), schema), "") << target;
  };
  const std::string curve = bench_.create(curve_simulation());
  ASSERT_TRUE(bench_.reaches(curve, v1::Simulation::SUCCEEDED));
  check("/v1/lubricants/none", "/v1/lubricants/{lubricant}", "application/json");
  check("/v1/" + curve, "/v1/simulations/{simulation}", "application/json");
  check("/v1/" + curve + "?alt=columns", "/v1/simulations/{simulation}",
        "application/vnd.tribodyn.columns+json");
}

TEST_F(OpenApi, JsonOfASimulationIsASimulationAndNothingElse) {
  const json& forms =
      document_["paths"]["/v1/simulations/{simulation}"]["get"]["responses"]["200"]["content"];
  EXPECT_EQ(forms["application/json"]["schema"]["$ref"], "#/components/schemas/Simulation");
}

TEST_F(OpenApi, AnswersRequireWhatIsAlwaysPrintedAndRequestsWhatTheServerNeeds) {
  const json& schemas = document_["components"]["schemas"];
  const auto required = [&](const std::string& schema) {
    return schemas.at(schema).value("required", std::vector<std::string>());
  };
  EXPECT_THAT(required("Simulation"), AllOf(Contains("state"), Contains("labels")));
  EXPECT_THAT(required("Simulation"), Not(Contains("result"))) << "may be absent";
  EXPECT_THAT(required("SimulationEvent"), Not(Contains("remaining_seconds"))) << "optional";
  EXPECT_THAT(required("CandidateAttributeInput"), ElementsAre("name"));
  EXPECT_THAT(required("SimulationInput"), ElementsAre("lubricant"));
  EXPECT_THAT(required("SimulationUpdate"), IsEmpty()) << "a change states any of the fields";
  EXPECT_THAT(required("FindParetoCandidatesRequest"), ElementsAre("second"));
}

TEST_F(OpenApi, NoBodyHasAFieldOfThePathOfItsRequest) {
  for (const HttpRoutes::Route& route : handler_.routes().all()) {
    if (route.body_field != "*") continue;
    const json& body = schemas_.operation(route)["requestBody"];
    const std::string name = body["content"]["application/json"]["schema"]["$ref"];
    const json& schema = document_.at(json::json_pointer(name.substr(1)));
    for (const HttpRoutes::Route::Variable& each : route.variables) {
      EXPECT_FALSE(schema["properties"].contains(each.field)) << route.text;
      EXPECT_THAT(schema.value("required", std::vector<std::string>()), Not(Contains(each.field)))
          << route.text;
    }
    EXPECT_EQ(body["required"], schema.contains("required")) << route.text;
  }
  EXPECT_TRUE(
      document_["components"]["schemas"]["EvaluatePointsRequest"]["properties"].contains("parent"))
      << "the route without a project has it in the body";
}

TEST_F(OpenApi, CommentsOfTheProtosDescribeOperationsAndFields) {
  EXPECT_EQ(document_["paths"]["/v1/simulations/{simulation}"]["get"]["description"],
            "Returns a simulation.");
  const json& fluid = document_["components"]["schemas"]["Lubricant"]["properties"];
  EXPECT_EQ(fluid["relaxation_time_seconds"]["$ref"], "#/components/schemas/Number");
  EXPECT_THAT(fluid["relaxation_time_seconds"]["description"].get<std::string>(),
              HasSubstr("lambda of eq 24. Allowed: "));
  EXPECT_TRUE(fluid["etag"]["readOnly"]);
  EXPECT_EQ(
      document_["components"]["schemas"]["SimulationEvent"]["properties"]["event_number"]["$ref"],
      "#/components/schemas/Integer64");
}

TEST_F(OpenApi, ThePagesNeedNoTokenAndAreKeptByTheirETag) {
  for (const char* page : {"/openapi.json", "/docs", "/docs.css"}) {
    const HttpResponse plain = send("GET", page, {}, false);
    ASSERT_EQ(plain.status, 200) << page;
    const std::string etag = plain.headers.at("ETag");
    const HttpResponse known = send("GET", page, {{"if-none-match", etag}}, false);
    EXPECT_EQ(known.status, 304) << page;
    EXPECT_EQ(known.body, "") << page;
    const HttpResponse zipped = send("GET", page, {{"accept-encoding", "gzip"}}, false);
    EXPECT_EQ(zipped.headers.at("ETag"), etag) << page;
    EXPECT_EQ(zipped.headers.contains("Content-Encoding"), plain.body.size() >= 1024) << page;
    EXPECT_LE(zipped.body.size(), plain.body.size()) << page;
    EXPECT_EQ(send("GET", page, {{"origin", "http://evil.example"}}, false).status, 403) << page;
    EXPECT_EQ(send("POST", page, {}, false).status, 404) << page;
  }
}

TEST_F(OpenApi, ThePageForPeopleRunsNoScriptAndLoadsNothingOfOthers) {
  const HttpResponse page = send("GET", "/docs");
  EXPECT_THAT(page.headers.at("Content-Security-Policy"),
              HasSubstr("default-src 'none'; style-src 'self'"));
  for (const char* forbidden : {"<script", "style=", "src=", "http:", "https:", "onclick"}) {
    EXPECT_THAT(page.body, Not(HasSubstr(forbidden)));
  }
  EXPECT_THAT(page.body, HasSubstr("<section id=\"schema-Lubricant\">"));
  EXPECT_THAT(page.body, HasSubstr("<section id=\"EvaluatePoints\">"));
}

}  // namespace
}  // namespace tribodyn::server
