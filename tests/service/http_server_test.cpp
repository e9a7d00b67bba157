// The HTTP server over real connections: what a client may send and how slowly, and what is
// refused.
#include "server/transport/http/http_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/service/http_client.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::size_t kLongPage = 50'000'000;  // [bytes], more than the buffers of both ends hold

HttpResponse page(std::string text) {
  HttpResponse out;
  out.headers["Content-Type"] = "text/plain";
  out.body = std::move(text);
  return out;
}

/// A body of one part, the last one.
class LastPart : public HttpStream {
 public:
  void start(std::shared_ptr<HttpStreamWriter> writer) override {
    writer->finish(std::string(kLongPage, 'x'));
  }
  void written(bool) override {}
  void hang_up() override {}
};

HttpResponse streamed_page() {
  HttpResponse out = page("");
  out.stream = std::make_shared<LastPart>();
  return out;
}

class HttpServerTest : public testing::Test {
 protected:
  HttpServerTest() { accept_owner(app_); }
  /// A server with its own limits.
  struct Served {
    Served(Application& app, const HttpLimits& limits)
        : dispatcher(app),
          handler(dispatcher,
                  {{"/hello", {[](const HttpRequest&) { return page("hello"); }, true}},
                   {"/streamed", {[](const HttpRequest&) { return streamed_page(); }, true}},
                   {"/long",
                    {[](const HttpRequest&) { return page(std::string(kLongPage, 'x')); }, true}}}),
          server(handler, {"127.0.0.1", 0, ""}, limits) {}
    int port() const { return server.address().port; }

    CallDispatcher dispatcher;
    RestHandler handler;
    HttpServer server;
  };
  std::unique_ptr<Served> serve(const HttpLimits& limits = {}) {
    return std::make_unique<Served>(app_, limits);
  }

  Bench bench_;
  Application app_ = bench_.application();
};

TEST_F(HttpServerTest, OneConnectionCarriesManyRequestsAlsoWhenSentAtOnce) {
  const auto served = serve();
  HttpConnection client(served->port());
  client.send(get("/hello") + get("/v1/lubricants/paper-fluid-1") +
              get("/hello", "Connection: close\r\n"));
  const std::string all = client.read_all();
  EXPECT_TRUE(client.is_closed());
  std::size_t answers = 0;
  for (std::size_t at = 0; (at = all.find("HTTP/1.1 200 OK", at)) != std::string::npos; ++at) {
    ++answers;
  }
  EXPECT_EQ(answers, 3U);
  EXPECT_LT(all.find("hello"), all.find("lubricants/paper-fluid-1"));
  EXPECT_THAT(all, HasSubstr("Date: "));
  EXPECT_THAT(all, Not(HasSubstr("Server: ")));
}

TEST_F(HttpServerTest, HeadAnswersTheLengthWithoutTheBody) {
  const auto served = serve();
  HttpConnection client(served->port());
  client.send("HEAD /hello HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string head = client.read_all();
  EXPECT_THAT(head, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(head, HasSubstr("Content-Length: 5\r\n"));
  EXPECT_THAT(head, testing::EndsWith("\r\n\r\n"));
}

TEST_F(HttpServerTest, AClientThatAsksBeforeItSendsIsInvited) {
  const auto served = serve();
  HttpConnection client(served->port());
  const std::string body = R"({"load_newtons": 0})";
  client.send(std::string("POST /v1/contacts:evaluate HTTP/1.1\r\n") + kHost +
              "Content-Type: application/json\r\nExpect: 100-continue\r\nContent-Length: " +
              std::to_string(body.size()) + "\r\n\r\n");
  EXPECT_EQ(client.read_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  client.send(body);
  EXPECT_THAT(client.read_until("\r\n\r\n"), StartsWith("HTTP/1.1 400 Bad Request"));
}

TEST_F(HttpServerTest, WhatIsNoRequestIsRefusedAndTheConnectionClosed) {
  const auto served = serve();
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"\x16\x03\x01\x02 what TLS sends\r\n\r\n", "400"},
      {"GET /hello HTTP/9.9\r\n\r\n", "400"},
      {"GET /hello HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", "400"},
      {get("/hello", "X: " + std::string(20'000, 'x') + "\r\n"), "431"},
      {std::string("POST /v1/simulations HTTP/1.1\r\n") + kHost +
           "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n",
       "411"},
      {std::string("POST /v1/simulations HTTP/1.1\r\n") + kHost +
           "Content-Length: 99999999\r\n\r\n",
       "413"},
      {std::string("GET /hello HTTP/1.1\r\n") + kHost + "Content-Length: 1\r\n\r\nx", "413"},
      {std::string("POST /v1/simulations HTTP/1.1\r\n") + kHost + "Content-Length: -1\r\n\r\n",
       "400"}};
  for (const auto& [request, status] : cases) {
    HttpConnection client(served->port());
    client.send(request);
    const std::string answer = client.read_all();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 " + status)) << request.substr(0, 60);
    EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
    EXPECT_THAT(answer, HasSubstr("INVALID_HTTP"));
    EXPECT_TRUE(client.is_closed()) << request.substr(0, 60);
  }
}

TEST_F(HttpServerTest, SlowClientsAreClosedAtTheLimitOfTheirState) {
  HttpLimits limits;
  limits.head_time = limits.body_time = milliseconds(300);
  const auto served = serve(limits);
  const std::string half_body = std::string("POST /v1/simulations HTTP/1.1\r\n") + kHost +
                                "Content-Type: application/json\r\nContent-Length: 10\r\n\r\n{";
  for (const std::string& beginning : {std::string(), std::string("GET /hel"), half_body}) {
    HttpConnection client(served->port());
    client.send(beginning);
    EXPECT_EQ(client.read_all(), "") << beginning;
    EXPECT_TRUE(client.is_closed()) << beginning;
  }
  // One byte at a time does not lengthen the limit.
  HttpConnection trickle(served->port());
  const auto begin = steady_clock::now();
  for (const char each : get("/hello", "X: " + std::string(1000, 'x') + "\r\n")) {
    if (!trickle.send({each})) break;
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(8)) << "ten seconds in all";
}

TEST_F(HttpServerTest, ABodyByTheByteDoesNotLengthenItsLimit) {
  HttpLimits limits;
  limits.body_time = milliseconds(300);
  const auto served = serve(limits);
  HttpConnection trickle(served->port());
  trickle.send(std::string("POST /v1/simulations HTTP/1.1\r\n") + kHost +
               "Content-Type: application/json\r\nContent-Length: 1000\r\n\r\n");
  const auto begin = steady_clock::now();
  for (int i = 0; i < 1000 && trickle.send(" "); ++i) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(8)) << "ten seconds in all";
  EXPECT_EQ(trickle.read_all(), "");
}

TEST_F(HttpServerTest, AnAnswerReadBitByBitEndsAtTheWriteLimit) {
  HttpLimits limits;
  limits.write_time = milliseconds(500);
  const auto served = serve(limits);
  HttpConnection trickle(served->port());
  trickle.send(get("/long"));
  std::size_t bytes = 0;
  const auto begin = steady_clock::now();
  while (!trickle.is_closed() && steady_clock::now() - begin < std::chrono::seconds(60)) {
    bytes += trickle.read_some(milliseconds(10)).size();
    std::this_thread::sleep_for(milliseconds(20));
  }
  EXPECT_TRUE(trickle.is_closed());
  EXPECT_LT(bytes, kLongPage / 2) << "what the system held, and what half a second takes";
}

/// Idle connections of one address. Allows the process as many open files as the system does.
class IdleConnections {
 public:
  IdleConnections() {
    rlimit files{};
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
  }
  ~IdleConnections() { clear(); }
  IdleConnections(const IdleConnections&) = delete;
  IdleConnections& operator=(const IdleConnections&) = delete;

  /// Connects from an address such as 127.0.0.2.
  void add(int port, int last_number) {
    const int descriptor = socket(AF_INET, SOCK_STREAM, 0);
    ASSERT_GE(descriptor, 0) << "too few files may be open";
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK + static_cast<unsigned>(last_number) - 1);
    ASSERT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    name.sin_port = htons(static_cast<std::uint16_t>(port));
    // The system may refuse as well, while the server closes others.
    if (connect(descriptor, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0) {
      descriptors_.push_back(descriptor);
    } else {
      close(descriptor);
    }
  }
  /// Number of those that the server has not closed.
  int open() const {
    int out = 0;
    for (const int each : descriptors_) {
      char byte = 0;
      const ssize_t count = recv(each, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
      if (count < 0 && errno == EAGAIN) ++out;
    }
    return out;
  }
  void clear() {
    for (const int each : descriptors_) close(each);
    descriptors_.clear();
  }

 private:
  std::vector<int> descriptors_;
};

TEST_F(HttpServerTest, ThousandsOfIdleConnectionsAreRefusedBeyondTheLimitAndOthersUnharmed) {
  const int attempts = full_run() ? 10'000 : 3'000;
  HttpLimits limits;
  limits.head_time = std::chrono::minutes(10);  // longer than the test
  const auto served = serve(limits);
  HttpConnection active(served->port());
  steady_clock::duration longest{};
  const auto answers = [&] {
    const auto begin = steady_clock::now();
    active.send(get("/v1/lubricants/paper-fluid-1"));
    EXPECT_THAT(active.read_until("\r\n\r\n"), StartsWith("HTTP/1.1 200"));
    longest = std::max(longest, steady_clock::now() - begin);
  };
  IdleConnections idle;
  for (int i = 0; i < attempts; ++i) {
    idle.add(served->port(), i % 2 == 0 ? 2 : 3);  // two addresses, each with its own limit
    if (i % 100 == 0) answers();
  }
  // All that the limit leaves room for, less the active one.
  EXPECT_TRUE(eventually([&] { return idle.open() == limits.connections - 1; })) << idle.open();
  for (int i = 0; i < 100; ++i) answers();
  EXPECT_LT(longest, std::chrono::seconds(kShortRun ? 10 : 2));
  idle.clear();
  EXPECT_TRUE(eventually([&] {
    HttpConnection another(served->port());
    another.send(get("/hello"));
    return another.read_until("hello", milliseconds(2000)).starts_with("HTTP/1.1 200");
  })) << "room again";
}

TEST_F(HttpServerTest, OneAddressCannotTakeAllConnections) {
  HttpLimits limits;
  limits.connections = 300;
  limits.connections_of_a_peer = 200;
  const auto served = serve(limits);
  IdleConnections greedy;
  for (int i = 0; i < 400; ++i) greedy.add(served->port(), 2);
  EXPECT_TRUE(eventually([&] { return greedy.open() == 200; })) << greedy.open();
  IdleConnections others;
  for (int i = 0; i < 100; ++i) others.add(served->port(), 3);
  EXPECT_TRUE(eventually([&] { return others.open() == 100; })) << others.open();
}

TEST_F(HttpServerTest, ConnectionsBeyondTheLimitAreClosedAndTheOthersServed) {
  HttpLimits limits;
  limits.connections = 20;
  limits.connections_of_a_peer = 15;
  const auto served = serve(limits);
  std::vector<HttpConnection> silent;
  for (int i = 0; i < 14; ++i) silent.emplace_back(served->port());
  HttpConnection active(served->port());
  active.send(get("/hello"));
  EXPECT_THAT(active.read_until("hello"), StartsWith("HTTP/1.1 200"));
  HttpConnection further(served->port());
  further.send(get("/hello"));
  EXPECT_EQ(further.read_all(), "");
  silent.pop_back();
  EXPECT_TRUE(eventually([&] {
    HttpConnection another(served->port());
    another.send(get("/hello"));
    return another.read_until("hello", milliseconds(2000)).starts_with("HTTP/1.1 200");
  })) << "room again";
}

TEST_F(HttpServerTest, BodiesThatAreReadTogetherAreLimited) {
  HttpLimits limits;
  limits.bodies_bytes = 1000;
  const auto served = serve(limits);
  const auto head = [](int length) {
    return std::string("POST /v1/simulations HTTP/1.1\r\n") + kHost +
           "Content-Type: application/json\r\nContent-Length: " + std::to_string(length) +
           "\r\n\r\n";
  };
  HttpConnection first(served->port());
  first.send(head(900) + "{");
  EXPECT_TRUE(eventually([&] {
    HttpConnection second(served->port());
    second.send(head(200) + "{}");
    return second.read_until("\r\n\r\n", milliseconds(200)).starts_with("HTTP/1.1 429");
  }));
  first.hang_up();
  EXPECT_TRUE(eventually([&] {
    HttpConnection third(served->port());
    third.send(head(900) + std::string(900, ' '));
    return third.read_until("\r\n\r\n", milliseconds(2000)).starts_with("HTTP/1.1 400");
  })) << "counted no longer";
}

TEST_F(HttpServerTest, ACallWhoseClientHangsUpIsCancelled) {
  const auto served = serve();
  std::string batch = R"({"requests":[)";
  for (int i = 0; i < 4000; ++i) {
    batch += std::string(i > 0 ? "," : "") + R"({"lubricant":{"name":"lubricants/many-)" +
             std::to_string(i) + R"(","derived_from":"lubricants/paper-fluid-1"}})";
  }
  batch += "]}";
  {
    HttpConnection client(served->port());
    client.send(std::string("POST /v1/lubricants:batchCreate HTTP/1.1\r\n") + kHost +
                "Content-Type: application/json\r\nContent-Length: " +
                std::to_string(batch.size()) + "\r\n\r\n");
    client.send_all(batch);
  }
  EXPECT_TRUE(eventually([&] {
    return bench_.jobs().metrics().text({}).find(
               "tribodyn_calls_total{code=\"CANCELLED\",method=\"tribodyn.v1.LubricantService."
               "BatchCreateLubricants\"} 1\n") != std::string::npos;
  }));
  HttpConnection other(served->port());
  other.send(get("/v1/lubricants?filter=name:many&read_mask=name", "Connection: close\r\n"));
  EXPECT_THAT(other.read_all(), Not(HasSubstr("many-1"))) << "nothing is written";
}

TEST_F(HttpServerTest, AClientThatDoesNotReadAnAnswerOrTheEndOfAStreamIsClosedAtTheWriteLimit) {
  HttpLimits limits;
  limits.write_time = milliseconds(300);
  for (const char* page : {"/long", "/streamed"}) {
    const auto served = serve(limits);
    HttpConnection slow(served->port());
    slow.send(get(page));
    EXPECT_THAT(slow.read_until("\r\n\r\n"), StartsWith("HTTP/1.1 200")) << page;
    std::this_thread::sleep_for(milliseconds(800));
    EXPECT_LT(slow.read_all().size(), kLongPage) << page << " is not cut off";
    EXPECT_TRUE(slow.is_closed()) << page;
    const auto patient = serve();
    HttpConnection reader(patient->port());
    reader.send(get(page, "Connection: close\r\n"));
    EXPECT_GT(reader.read_all().size(), kLongPage) << page;
  }
}

TEST_F(HttpServerTest, TheServerEndsWhileClientsAreConnectedAndCallsRun) {
  for (int round = 0; round < 20; ++round) {
    auto served = serve();
    std::vector<HttpConnection> clients;
    for (int i = 0; i < 10; ++i) {
      clients.emplace_back(served->port());
      clients.back().send(i % 2 == 0 ? get("/v1/lubricants") : "GET /v1/lubr");
    }
    served.reset();
    for (HttpConnection& each : clients) each.read_all();
  }
}

}  // namespace
}  // namespace tribodyn::server
