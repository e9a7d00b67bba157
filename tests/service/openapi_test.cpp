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
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;
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

  /// Adds to `wrong` each place of a value that its schema does not allow.
  void compare(const json& value, const json& schema, const std::string& place,
               std::string& wrong) {
    if (schema.contains("$ref")) {
      const std::string name = schema["$ref"];
      return compare(value, document_.at(json::json_pointer(name.substr(1))), place, wrong);
    }
    if (schema.contains("anyOf")) {
      for (const json& each : schema["anyOf"]) {
        std::string complaints;
        compare(value, each, place, complaints);
        if (complaints.empty()) return;
      }
      wrong += place + ": " + value.dump().substr(0, 50) + " is none of the forms\n";
      return;
    }
    const std::string type = schema.value("type", "");
    const bool fits = type == "object"    ? value.is_object()
                      : type == "array"   ? value.is_array()
                      : type == "string"  ? value.is_string()
                      : type == "boolean" ? value.is_boolean()
                      : type == "integer" ? value.is_number_integer()
                                          : value.is_number();
    if (!fits) wrong += place + ": " + value.dump().substr(0, 50) + " is no " + type + "\n";
    if (!fits) return;
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end()) {
      wrong += place + ": " + value.dump() + " is not in the list\n";
    }
    if (value.is_array()) {
      for (const json& each : value) compare(each, schema["items"], place + "[]", wrong);
    }
    if (!value.is_object() || !schema.contains("properties")) return;
    for (const auto& [name, field] : value.items()) {
      if (!schema["properties"].contains(name)) {
        if (schema.contains("additionalProperties")) continue;
        wrong += place + "." + name + " is not described\n";
      } else if (!field.is_null()) {
        compare(field, schema["properties"][name], place + "." + name, wrong);
      }
    }
  }

  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
  RestHandler handler_{dispatcher_, description_pages(dispatcher_.methods())};
  const json document_ = json::parse(openapi_document(handler_.routes()));
};

/// "/v1/projects/{project}/lubricants/{lubricant}:undelete" of a route.
std::string shape(const HttpRoutes::Route& route) {
  std::string out;
  for (const std::string& each : route.segments) out += each == "*" ? "/{}" : "/" + each;
  return route.custom_verb.empty() ? out : out + ":" + route.custom_verb;
}

std::string without_names(const std::string& path) {
  std::string out;
  bool is_inside = false;
  for (const char each : path) {
    if (each == '}') is_inside = false;
    if (!is_inside) out += each;
    if (each == '{') is_inside = true;
  }
  return out;
}

TEST_F(OpenApi, EveryRouteOfTheTableIsDescribedAndNoOther) {
  std::set<std::string> described;
  for (const auto& [path, verbs] : document_["paths"].items()) {
    for (const auto& [verb, operation] : verbs.items()) {
      described.insert(verb + " " + without_names(path));
    }
  }
  std::set<std::string> expected;
  for (const HttpRoutes::Route& route : handler_.routes().all()) {
    std::string verb = route.verb;
    for (char& each : verb) each = static_cast<char>(std::tolower(each));
    expected.insert(verb + " " + shape(route));
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
      std::string target = without_names(path);
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

TEST_F(OpenApi, AnswersHaveTheFormsThatAreDescribed) {
  const auto check = [&](const std::string& target, const std::string& path) {
    const HttpResponse response = send("GET", target);
    std::string wrong;
    const json& answers = document_["paths"][path]["get"]["responses"];
    const json& answer = answers[response.status == 200 ? "200" : "default"];
    const json& schema = response.status == 200 ? answer["content"]["application/json"]["schema"]
                                                : document_["components"]["schemas"]["Error"];
    compare(json::parse(response.body), schema, "", wrong);
    EXPECT_EQ(wrong, "") << target;
  };
  const std::string name = bench_.create(point_simulation());
  ASSERT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
  const std::string curve = bench_.create(curve_simulation());
  ASSERT_TRUE(bench_.reaches(curve, v1::Simulation::SUCCEEDED));
  check("/v1/lubricants", "/v1/lubricants");
  check("/v1/lubricants/none", "/v1/lubricants/{lubricant}");
  check("/v1/gearSets/reference-axle", "/v1/gearSets/{gear_set}");
  check("/v1/surfaces", "/v1/surfaces");
  check("/v1/vehicles", "/v1/vehicles");
  check("/v1/schema", "/v1/schema");
  check("/v1/simulations", "/v1/simulations");
  check("/v1/" + name + "?view=SIMULATION_VIEW_FULL", "/v1/simulations/{simulation}");
  check("/v1/" + curve + "?view=SIMULATION_VIEW_FULL", "/v1/simulations/{simulation}");
  check("/v1/" + curve + "?alt=columns", "/v1/simulations/{simulation}");
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
