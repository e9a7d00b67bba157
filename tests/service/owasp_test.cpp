// The ten risks of OWASP's list for APIs (edition of 2023), a test each, over REST without a
// connection. Tables over all methods: authorization_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "server/storage/seeds.h"
#include "server/transport/http/rest_handler.h"
#include "tests/service/contract_methods.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class OwaspApiTop10 : public testing::Test {
 protected:
  OwaspApiTop10() {
    bench_.store().add_project("acme", seed_resources(), 1);
    const auto token = [](const std::string& name, Scope scope) {
      return StoredToken{.name = name, .hash = token_hash(name), .scope = scope};
    };
    StoredToken plant = token("plant", Scope::kAdmin);
    plant.projects = {"default"};
    StoredToken slow = token("slow", Scope::kWrite);
    slow.calls_per_second = 0.2;
    slow.processor_hours = 1e-9;
    StoredToken revoked = token("revoked", Scope::kAdmin);
    revoked.revoke_time = 1;
    StoredToken expired = token("expired", Scope::kAdmin);
    expired.expire_time = 1;
    app_.authorizer->set_tokens({plant, slow, revoked, expired, token("reader", Scope::kRead),
                                 token("writer", Scope::kWrite)},
                                2);
  }

  HttpResponse send_as(const std::string& secret, const std::string& verb,
                       const std::string& target, const std::string& body = {},
                       std::map<std::string, std::string> headers = {}) {
    headers.try_emplace("host", "127.0.0.1:50652");
    if (!secret.empty()) headers.try_emplace("authorization", "Bearer " + secret);
    if (!body.empty()) headers.try_emplace("content-type", "application/json");
    std::promise<HttpResponse> answer;
    handler_.handle(HttpRequest{verb, target, std::move(headers), body, "127.0.0.1", false},
                    std::make_shared<std::atomic<bool>>(false),
                    [&](HttpResponse response) { answer.set_value(std::move(response)); });
    return answer.get_future().get();
  }
  static std::string reason_in(const HttpResponse& response) {
    return json::parse(response.body)["error"]["details"][0].value("reason", "");
  }
  /// The paper's fluid under another name, as a body.
  json fluid() {
    json out = json::parse(send_as("reader", "GET", "/v1/lubricants/paper-fluid-1").body);
    out.erase("etag");
    out.erase("name");
    return out;
  }

  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
  RestHandler handler_{dispatcher_,
                       {{"/metrics", {[](const HttpRequest&) { return HttpResponse(); }}}}};
};

TEST_F(OwaspApiTop10, Api1BrokenObjectLevelAuthorization) {
  const auto body = [&](const std::string& path) {
    const HttpResponse response = send_as("plant", "GET", "/v1/projects/acme/" + path);
    EXPECT_EQ(response.status, 403) << path;
    return response.body;
  };
  const std::string refused = body("lubricants/paper-fluid-1");
  EXPECT_EQ(refused, body("lubricants/no-such-thing")) << "the answer does not say what exists";
  EXPECT_EQ(refused, body("simulations/1"));
  EXPECT_EQ(send_as("plant", "GET", "/v1/lubricants/paper-fluid-1").status, 200);
  EXPECT_EQ(send_as("plant", "POST", "/v1/simulations",
                    R"({"lubricant": "projects/acme/lubricants/paper-fluid-1"})")
                    .status /
                100,
            4)
      << "nor does a request reach into another project";
}

TEST_F(OwaspApiTop10, Api2BrokenAuthentication) {
  const std::string path = "/v1/lubricants/paper-fluid-1";
  for (const std::string& secret :
       {std::string(), std::string("unknown"), std::string("revoked"), std::string("expired"),
        token_hash("reader"), std::string("certificate:reader")}) {
    EXPECT_EQ(send_as(secret, "GET", path).status, 401) << secret;
  }
  for (const char* header : {"Basic cmVhZGVyOg==", "reader", "Bearer", "bearer  reader"}) {
    EXPECT_EQ(send_as("", "GET", path, "", {{"authorization", header}}).status, 401) << header;
  }
  EXPECT_EQ(send_as("", "GET", path + "?access_token=reader").status, 401)
      << "no secret stands in a URL";
  EXPECT_EQ(send_as("revoked", "GET", path).body, send_as("unknown", "GET", path).body);
}

TEST_F(OwaspApiTop10, Api3BrokenObjectPropertyLevelAuthorization) {
  json made = fluid();
  made["revision"] = 77;
  made["create_time"] = "2001-01-01T00:00:00Z";
  const HttpResponse created =
      send_as("writer", "POST", "/v1/lubricants?lubricant_id=mine", made.dump());
  ASSERT_EQ(created.status, 200) << created.body;
  EXPECT_EQ(json::parse(created.body)["revision"], 1) << "what the server sets is the server's";
  EXPECT_THAT(json::parse(created.body)["create_time"].get<std::string>(), Not(HasSubstr("2001-")));
  const std::string name = bench_.create(point_simulation());
  const HttpResponse changed =
      send_as("writer", "PATCH", "/v1/" + name + "?update_mask=state", R"({"state": "SUCCEEDED"})");
  EXPECT_EQ(changed.status, 400) << changed.body;
  for (const char* field : {"client", "principal", "input_hash", "lubricant"}) {
    EXPECT_EQ(send_as("writer", "PATCH", "/v1/" + name + "?update_mask=" + field, "{}").status, 400)
        << field;
  }
}

TEST_F(OwaspApiTop10, Api4UnrestrictedResourceConsumption) {
  EXPECT_EQ(send_as("slow", "GET", "/v1/lubricants/paper-fluid-1").status, 200);
  const HttpResponse refused = send_as("slow", "GET", "/v1/lubricants/paper-fluid-1");
  EXPECT_EQ(refused.status, 429);
  EXPECT_EQ(reason_in(refused), "QUOTA_EXCEEDED");
  EXPECT_EQ(refused.headers.at("Retry-After"), "5");
  EXPECT_EQ(send_as("reader", "GET", "/v1/lubricants?page_size=-1").status, 400);
  const HttpResponse page = send_as("reader", "GET", "/v1/lubricants?page_size=2000000000");
  EXPECT_LE(json::parse(page.body)["lubricants"].size(), 1000U);
  const HttpRequest head{"POST", "/v1/lubricants", {}, "", "127.0.0.1", false};
  EXPECT_LE(handler_.maximum_body_bytes(head), RestHandler::kMaximumBodyBytes);
  EXPECT_EQ(send_as("reader", "GET", "/v1/lubricants?filter=" + std::string(9000, 'x')).status,
            414);
}

TEST_F(OwaspApiTop10, Api5BrokenFunctionLevelAuthorization) {
  for (const HttpRoutes::Route& route : handler_.routes().all()) {
    if (route.method->scope == Scope::kRead) continue;
    std::string path;
    for (const std::string& segment : route.segments)
      path += "/" + (segment == "*" ? "x" : segment);
    if (!route.custom_verb.empty()) path += ":" + route.custom_verb;
    const HttpResponse response = send_as("reader", route.verb, path);
    EXPECT_EQ(response.status, 403) << route.verb << " " << path;
    EXPECT_EQ(reason_in(response), "SCOPE_TOO_SMALL") << route.verb << " " << path;
  }
  EXPECT_EQ(send_as("writer", "POST", "/v1/lubricants/paper-fluid-1:purge", "{}").status, 403);
  EXPECT_EQ(send_as("plant", "GET", "/metrics").status, 403) << "metrics are of all projects";
}

TEST_F(OwaspApiTop10, Api6UnrestrictedAccessToSensitiveBusinessFlows) {
  const std::string work = R"({"lubricant": "lubricants/paper-fluid-1",
      "operating_point": {"cruise": {"speed_kilometres_per_hour": 60}}})";
  const HttpResponse refused = send_as("slow", "POST", "/v1/simulations", work);
  EXPECT_EQ(refused.status, 429) << refused.body;
  EXPECT_EQ(reason_in(refused), "QUOTA_EXCEEDED") << "one caller may not take all processors";
  EXPECT_EQ(send_as("writer", "POST", "/v1/simulations", work).status, 200) << "others may go on";
}

TEST_F(OwaspApiTop10, Api7ServerSideRequestForgery) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof name;
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  ASSERT_EQ(listen(listener, 5), 0);
  ASSERT_EQ(getsockname(listener, reinterpret_cast<sockaddr*>(&name), &size), 0);
  const std::string url = "http://127.0.0.1:" + std::to_string(ntohs(name.sin_port)) + "/";
  json made = fluid();
  made["display_name"] = url;
  made["external_sample_id"] = url;
  EXPECT_EQ(send_as("writer", "POST", "/v1/lubricants?lubricant_id=url", made.dump()).status, 200);
  for (const std::string& target : {"/v1/lubricants/" + url, "/v1/" + url, url + "v1/lubricants"}) {
    EXPECT_EQ(send_as("writer", "GET", target).status, 404) << target;
  }
  for (const char* place : {"file:///etc/passwd", "http://169.254.169.254/"}) {
    const json import = {{"lubricant", {{"display_name", "x"}}}, {"viscosity_table_csv", place}};
    EXPECT_EQ(send_as("writer", "POST", "/v1/lubricants:import", import.dump()).status, 400);
  }
  pollfd asked{listener, POLLIN, 0};
  EXPECT_EQ(poll(&asked, 1, 100), 0) << "the server connects to nobody";
  close(listener);
}

TEST_F(OwaspApiTop10, Api8SecurityMisconfiguration) {
  for (const HttpResponse& each :
       {send_as("reader", "GET", "/v1/lubricants/paper-fluid-1"),
        send_as("", "GET", "/v1/lubricants"), send_as("reader", "GET", "/nothing"),
        send_as("reader", "TRACE", "/v1/lubricants"),
        send_as("reader", "OPTIONS", "/v1/lubricants", "", {{"origin", "https://evil.example"}})}) {
    EXPECT_EQ(each.headers.at("X-Content-Type-Options"), "nosniff");
    EXPECT_THAT(each.headers.at("Content-Security-Policy"), HasSubstr("frame-ancestors 'none'"));
    EXPECT_FALSE(each.headers.contains("Access-Control-Allow-Origin"));
    EXPECT_FALSE(each.headers.contains("Server"));
    for (const char* inside : {".cpp", "/tmp/", "SQL", "sqlite", "std::"}) {
      EXPECT_THAT(each.body, Not(HasSubstr(inside)));
    }
  }
  for (const char* verb : {"TRACE", "OPTIONS", "CONNECT"}) {
    EXPECT_EQ(send_as("reader", verb, "/v1/lubricants").status, 405) << verb;
  }
  EXPECT_EQ(send_as("reader", "GET", "/v1/lubricants", "", {{"host", "evil.example"}}).status, 403);
}

TEST_F(OwaspApiTop10, Api9ImproperInventoryManagement) {
  std::set<std::string> served;
  for (const HttpRoutes::Route& route : handler_.routes().all()) {
    EXPECT_EQ(route.segments.front(), "v1") << "one version is served";
    served.insert(route.method->descriptor->full_name());
  }
  std::set<std::string> listed;
  for (const auto* method : all_methods()) listed.insert(method->full_name());
  EXPECT_EQ(served, listed) << "what is served is what the contract lists";
  for (const char* path : {"/v0/lubricants", "/v2/lubricants", "/debug", "/admin", "/v1/tokens"}) {
    EXPECT_EQ(send_as("plant", "GET", path).status, 404) << path;
  }
}

TEST_F(OwaspApiTop10, Api10UnsafeConsumptionOfApis) {
  // The server calls no other service. What others write reaches it in imports, as text.
  for (const char* table : {"dGVtcGVyYXR1cmVfY2Vsc2l1cwpOYU4K", "AAECAwQFBgc=", "JSUlJSUl",
                            "dGVtcGVyYXR1cmVfY2Vsc2l1cyxraW5lbWF0aWNfdmlzY29zaXR5X3NxdWFyZV9taWxsaW"
                            "1ldHJlc19wZXJfc2Vjb25kCjQwLGluZgoxMDAsLTEK"}) {
    const json import = {{"lubricant", {{"display_name", "x"}}}, {"viscosity_table_csv", table}};
    const HttpResponse response =
        send_as("writer", "POST", "/v1/lubricants:import?lubricant_id=x", import.dump());
    EXPECT_EQ(response.status, 400) << response.body;
  }
  EXPECT_EQ(send_as("writer", "GET", "/v1/lubricants/x").status, 404) << "nothing was stored";
}

}  // namespace
}  // namespace tribodyn::server
