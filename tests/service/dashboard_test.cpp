// What browsers are served beside the methods: the files of the dashboard, and sessions by cookie.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "server/storage/maintenance.h"
#include "server/transport/http/rest_handler.h"
#include "tests/service/http_client.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

using Headers = std::map<std::string, std::string>;

class DashboardTest : public testing::Test {
 protected:
  DashboardTest() {
    accept_owner(app_);
    write("index.html", "<!doctype html>");
    write("assets/index-1a2b.js", "run()");
    write("assets/index-1a2b.js.gz", "compressed");
    start();
  }
  ~DashboardTest() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  void start(std::chrono::seconds lifetime = std::chrono::hours(12)) {
    const auto sessions = std::make_shared<SessionFile>(bench_.database(), system_time());
    const RestDashboard dashboard{std::make_shared<SessionCookies>(sessions, lifetime),
                                  std::make_shared<StaticFiles>(folder_)};
    handler_ = std::make_unique<RestHandler>(
        dispatcher_, std::map<std::string, RestHandler::Page>{}, RestLimits{}, dashboard);
  }
  HttpResponse send(const std::string& verb, const std::string& target, Headers headers = {},
                    const std::string& body = {}) {
    headers.try_emplace("host", "127.0.0.1:50652");
    if (!body.empty()) headers.try_emplace("content-type", "application/json");
    std::promise<HttpResponse> answer;
    handler_->handle(HttpRequest{verb, target, std::move(headers), body, "127.0.0.1", false},
                     std::make_shared<std::atomic<bool>>(false),
                     [&](HttpResponse response) { answer.set_value(std::move(response)); });
    return answer.get_future().get();
  }
  /// Signs in as the owner. Returns the cookie as a browser sends it.
  std::string sign_in() {
    const HttpResponse response =
        send("POST", "/session", {{"authorization", std::string("Bearer ") + kSecret}});
    EXPECT_EQ(response.status, 200);
    csrf_ = json::parse(response.body)["csrf_token"];
    set_cookie_ = response.headers.at("Set-Cookie");
    return set_cookie_.substr(0, set_cookie_.find(';'));
  }
  /// A small change, as a page sends it: the new name of a lubricant.
  HttpResponse rename(Headers headers) {
    return send("PATCH", "/v1/lubricants/paper-fluid-1", std::move(headers),
                R"({"display_name": "another name"})");
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      testing::UnitTest::GetInstance()->current_test_info()->name();
  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
  std::unique_ptr<RestHandler> handler_;
  std::string csrf_;
  std::string set_cookie_;
};

TEST_F(DashboardTest, FilesAreServedWithoutATokenAndTheirPageRunsScriptsOfThisServerOnly) {
  const HttpResponse page = send("GET", "/");
  EXPECT_EQ(send("GET", "/index.html").body, "<!doctype html>");
  EXPECT_EQ(page.status, 404) << "the path of a view is a page for those who accept HTML only";
  const HttpResponse view = send("GET", "/curves?r=1", {{"accept", "text/html,*/*"}});
  EXPECT_EQ(view.body, "<!doctype html>");
  EXPECT_EQ(view.headers.at("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(view.headers.at("Cache-Control"), "private, no-cache");
  const std::string policy = view.headers.at("Content-Security-Policy");
  EXPECT_THAT(policy, HasSubstr("default-src 'none'; script-src 'self';"));
  EXPECT_THAT(policy, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(policy, Not(HasSubstr("unsafe")));
  EXPECT_EQ(send("GET", "/v1/nothing", {{"accept", "text/html"}}).status, 404);
  EXPECT_EQ(send("GET", "/../secret", {{"accept", "*/*"}}).status, 404);
}

TEST_F(DashboardTest, AFileIsSentOnceAndCompressedIfTheClientAllows) {
  const HttpResponse plain = send("GET", "/assets/index-1a2b.js");
  EXPECT_EQ(plain.body, "run()");
  EXPECT_EQ(plain.headers.at("Cache-Control"), "public, max-age=31536000, immutable");
  const HttpResponse small = send("GET", "/assets/index-1a2b.js", {{"accept-encoding", "gzip"}});
  EXPECT_EQ(small.body, "compressed");
  EXPECT_EQ(small.headers.at("Content-Encoding"), "gzip");
  const HttpResponse again =
      send("GET", "/assets/index-1a2b.js", {{"if-none-match", plain.headers.at("ETag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.body, "");
}

TEST_F(DashboardTest, AFolderWithoutAPageIsRefused) {
  std::filesystem::remove(folder_ / "index.html");
  EXPECT_THROW(StaticFiles{folder_}, std::runtime_error);
  EXPECT_THROW(StaticFiles{folder_ / "missing"}, std::runtime_error);
}

TEST_F(DashboardTest, ASessionReadsWithItsCookieAndWritesWithItsCsrfToken) {
  const std::string cookie = sign_in();
  EXPECT_THAT(set_cookie_, HasSubstr("HttpOnly; SameSite=Strict"));
  EXPECT_THAT(set_cookie_, Not(HasSubstr(kSecret)));
  EXPECT_EQ(send("GET", "/v1/lubricants").status, 401);
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", "a=b; " + cookie}}).status, 200);
  const json session = json::parse(send("GET", "/session", {{"cookie", cookie}}).body);
  EXPECT_EQ(session["principal"], "owner");
  EXPECT_EQ(session["csrf_token"], csrf_);
  const HttpResponse refused = rename({{"cookie", cookie}});
  EXPECT_EQ(refused.status, 403);
  EXPECT_THAT(refused.body, HasSubstr("FOREIGN_ORIGIN"));
  EXPECT_EQ(rename({{"cookie", cookie}, {"tribodyn-csrf", "guess"}}).status, 403);
  EXPECT_EQ(rename({{"cookie", cookie}, {"tribodyn-csrf", csrf_}}).status, 200);
}

TEST_F(DashboardTest, ASessionIsRefusedToPagesOfAnotherPort) {
  const std::string cookie = sign_in();
  for (const char* site : {"same-site", "cross-site"}) {
    const Headers headers = {{"cookie", cookie}, {"sec-fetch-site", site}};
    EXPECT_EQ(send("GET", "/v1/lubricants", headers).status, 403) << site;
    EXPECT_EQ(send("GET", "/session", headers).status, 403) << site;
  }
  for (const char* site : {"same-origin", "none"}) {
    const Headers headers = {{"cookie", cookie}, {"sec-fetch-site", site}};
    EXPECT_EQ(send("GET", "/v1/lubricants", headers).status, 200) << site;
  }
}

TEST_F(DashboardTest, AForgedAnOldAndARevokedSessionAreNone) {
  const std::string cookie = sign_in();
  std::string forged = cookie;
  forged[cookie.find('=') + 70] ^= 1;  // a digit of the time at which it ends
  for (const std::string& each : {forged, cookie.substr(0, cookie.rfind('.')),
                                  cookie.substr(0, cookie.find('=') + 1), cookie + "0"}) {
    EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", each}}).status, 401) << each;
  }
  // A restart with the same key accepts the cookie.
  start();
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", cookie}}).status, 200);
  app_.authorizer->set_tokens({}, 0);
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", cookie}}).status, 401);
  accept_owner(app_);
  start(std::chrono::seconds(0));
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", sign_in()}}).status, 401);
}

TEST_F(DashboardTest, AnEndedSessionIsNoneForACopyOfItsCookieAlsoAfterARestart) {
  const std::string cookie = sign_in();
  const Headers of_session = {{"cookie", cookie}, {"tribodyn-csrf", csrf_}};
  const std::string other = sign_in();
  ASSERT_EQ(send("DELETE", "/session", of_session).status, 204);
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", cookie}}).status, 401);
  start();
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", cookie}}).status, 401);
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", other}}).status, 200);
}

TEST_F(DashboardTest, ANewKeyEndsAllSessionsWhileTheServerRuns) {
  const std::string cookie = sign_in();
  SessionFile::renew(bench_.database());
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", cookie}}).status, 401);
  EXPECT_EQ(send("GET", "/v1/lubricants", {{"cookie", sign_in()}}).status, 200);
}

TEST_F(DashboardTest, ABackupHasNothingThatSealsASession) {
  sign_in();
  std::string key;
  std::ifstream(bench_.database() + ".sessions") >> key;
  ASSERT_EQ(key.size(), 64U);
  const std::string copy = bench_.database() + ".copy";
  backup_database(bench_.database(), copy);
  std::ifstream file(copy, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(bytes.find(key), std::string::npos);
  EXPECT_EQ(std::filesystem::status(bench_.database() + ".sessions").permissions() &
                std::filesystem::perms(077),
            std::filesystem::perms::none);
}

TEST_F(DashboardTest, TheEndOfASessionTakesTheCookieAway) {
  const std::string cookie = sign_in();
  EXPECT_EQ(send("DELETE", "/session", {{"cookie", cookie}}).status, 403);
  const HttpResponse response =
      send("DELETE", "/session", {{"cookie", cookie}, {"tribodyn-csrf", csrf_}});
  EXPECT_EQ(response.status, 204);
  EXPECT_THAT(response.headers.at("Set-Cookie"), HasSubstr("Max-Age=0"));
}

TEST_F(DashboardTest, ASessionBeginsWithAValidToken) {
  EXPECT_EQ(send("POST", "/session").status, 401);
  EXPECT_EQ(send("POST", "/session", {{"authorization", "Bearer unknown"}}).status, 401);
  EXPECT_EQ(send("PUT", "/session").status, 405);
}

}  // namespace
}  // namespace tribodyn::server
