// Streams over HTTP: server-sent events and JSON lines, how a client resumes them, and what a
// client that is slow, gone or one of many may take.
#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "server/storage/event_rows.h"
#include "server/transport/http/http_server.h"
#include "tests/service/http_client.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::StartsWith;

/// One event as a browser receives it.
struct Event {
  std::string type = "message";
  std::string id;
  std::string data;
  bool is_comment = false;
};

/// A client of server-sent events.
class EventClient {
 public:
  explicit EventClient(int port, const std::string& target, const std::string& headers = {})
      : connection_(port) {
    connection_.send(get(target, headers));
    head_ = connection_.read_until("\r\n\r\n");
    const std::size_t end = head_.find("\r\n\r\n");
    if (end == std::string::npos) return;
    raw_ = head_.substr(end + 4);
    head_.resize(end + 4);
  }

  const std::string& head() const { return head_; }
  bool has_ended_well() const { return has_last_chunk_; }
  void hang_up() { connection_.hang_up(); }

  /// The next event; nullopt at the end of the stream or after `limit`.
  std::optional<Event> next(milliseconds limit = seconds(10)) {
    const auto last = steady_clock::now() + limit;
    for (;;) {
      unchunk();
      const std::size_t end = text_.find("\n\n");
      if (end != std::string::npos) {
        const Event event = parse(text_.substr(0, end + 1));
        text_.erase(0, end + 2);
        if (event.data.empty() && event.id.empty() && !event.is_comment) continue;  // "retry"
        return event;
      }
      if (connection_.is_closed() || steady_clock::now() >= last) return std::nullopt;
      raw_ += connection_.read_some(milliseconds(100));
    }
  }
  /// The data of all events until the stream ends, without comments.
  std::vector<Event> rest() {
    std::vector<Event> out;
    while (const auto event = next()) {
      if (!event->data.empty()) out.push_back(*event);
    }
    return out;
  }

 private:
  void unchunk() {
    for (;;) {
      const std::size_t line = raw_.find("\r\n");
      if (line == std::string::npos) return;
      const std::size_t size = std::stoul(raw_.substr(0, line), nullptr, 16);
      if (raw_.size() < line + 2 + size + 2) return;
      text_ += raw_.substr(line + 2, size);
      raw_.erase(0, line + 2 + size + 2);
      has_last_chunk_ = size == 0;
    }
  }
  static Event parse(const std::string& text) {
    Event out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("id: ")) out.id = line.substr(4);
      if (line.starts_with("event: ")) out.type = line.substr(7);
      if (line.starts_with("data: ")) out.data = line.substr(6);
      if (line.starts_with(":")) out.is_comment = true;
    }
    return out;
  }

  HttpConnection connection_;
  std::string head_, raw_, text_;
  bool has_last_chunk_ = false;
};

class EventStreamTest : public testing::Test {
 protected:
  EventStreamTest() { accept_owner(app_); }
  struct Served {
    Served(Application& app, const TimeLimits& times, const RestLimits& limits)
        : dispatcher(app, times),
          handler(dispatcher, {}, limits),
          server(std::make_unique<HttpServer>(handler, ListenAddress{"127.0.0.1", 0, ""})) {}
    int port() const { return server->address().port; }

    CallDispatcher dispatcher;
    RestHandler handler;
    std::unique_ptr<HttpServer> server;
  };
  std::unique_ptr<Served> serve(const TimeLimits& times = {}, const RestLimits& limits = {}) {
    return std::make_unique<Served>(app_, times, limits);
  }
  std::string finished() {
    std::string name = bench_.create(point_simulation());
    EXPECT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
    return name;
  }
  bool counts(const std::string& code, const std::string& method, int count) {
    return eventually([&] {
      return bench_.jobs().metrics().text({}).find("tribodyn_calls_total{code=\"" + code +
                                                   "\",method=\"tribodyn.v1.SimulationService." +
                                                   method + "\"} " + std::to_string(count) +
                                                   "\n") != std::string::npos;
    });
  }
  /// Writes events of deleted simulations into the database.
  void add_deletions(int count) {
    SQLite::Database db = bench_.open_database();
    const std::string trigger =
        db.execAndGet("SELECT sql FROM sqlite_master WHERE name = 'events_have_a_simulation'")
            .getString();
    db.exec("DROP TRIGGER events_have_a_simulation");
    db.exec(
        "INSERT INTO events (simulation, sequence, time, state, attempt, reason, project, number, "
        "simulation_number) "
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < " +
        std::to_string(count) +
        ") SELECT 1000000 + i, 1, 0, 0, 1, '', 'default', i, 1000000 + i FROM n");
    db.exec(trigger);
    db.exec("UPDATE projects SET last_number = 2000000, last_event = " + std::to_string(count));
  }
  std::int64_t latest() { return bench_.store().event_range("default").latest; }
  static std::string with_id(const std::string& id) { return "Last-Event-ID: " + id + "\r\n"; }

  static constexpr char kAll[] = "/v1/simulations:watch?filter=lubricant=%22paper-fluid-1%22";

  Bench bench_{quick_studies(), 2, {}, milliseconds(200)};
  Application app_ = bench_.application();
};

TEST_F(EventStreamTest, EventsOfOneSimulationEndWithTheSimulation) {
  const auto served = serve();
  const std::string name = finished();
  EventClient client(served->port(), "/v1/" + name + ":watch");
  EXPECT_THAT(client.head(), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(client.head(), HasSubstr("Content-Type: text/event-stream; charset=utf-8\r\n"));
  EXPECT_THAT(client.head(), HasSubstr("Cache-Control: no-store\r\n"));
  EXPECT_THAT(client.head(), HasSubstr("X-Content-Type-Options: nosniff\r\n"));
  const std::vector<Event> events = client.rest();
  ASSERT_EQ(events.size(), 4U);
  const char* kStates[] = {"QUEUED", "RUNNING", "SUCCEEDED"};
  for (int i = 0; i < 3; ++i) {
    const json data = json::parse(events[i].data);
    EXPECT_EQ(data["state"], kStates[i]);
    EXPECT_EQ(data["kind"], "STATE_CHANGE");
    EXPECT_EQ(events[i].id, data["sequence"]);
  }
  EXPECT_EQ(events[3].type, "end");
  EXPECT_TRUE(client.has_ended_well());
  EXPECT_TRUE(counts("OK", "WatchSimulation", 1));
  EventClient resumed(served->port(), "/v1/" + name + ":watch", with_id(events[1].id));
  EXPECT_EQ(resumed.rest().front().data, events[2].data);
}

TEST_F(EventStreamTest, OneStreamResumesWithoutAGapOrARepetition) {
  const auto served = serve();
  std::atomic<bool> is_over = false;
  std::thread writer([&] {
    for (int i = 0; i < 40; ++i) finished();
    is_over = true;
  });
  std::vector<std::int64_t> numbers;
  std::string id = "0";
  const auto end = steady_clock::now() + seconds(30);
  // Each connection is dropped after a few events, at any place.
  for (int most = 1; steady_clock::now() < end; ++most) {
    if (is_over && static_cast<std::int64_t>(numbers.size()) >= latest()) break;
    // Without a filter as with one that all satisfy.
    EventClient client(served->port(), most % 2 == 0 ? kAll : "/v1/simulations:watch", with_id(id));
    ASSERT_THAT(client.head(), StartsWith("HTTP/1.1 200"));
    for (int i = 0; i < most % 7; ++i) {
      const auto event = client.next(milliseconds(500));
      if (!event) break;
      if (!event->id.empty()) id = event->id;
      if (event->is_comment) continue;
      const json data = json::parse(event->data);
      if (data["kind"] != "STATE_CHANGE") continue;
      numbers.push_back(std::stoll(data["event_number"].get<std::string>()));
      EXPECT_EQ(event->id, data["event_number"]);
    }
  }
  writer.join();
  ASSERT_GT(latest(), 40);
  ASSERT_EQ(static_cast<std::int64_t>(numbers.size()), latest());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(numbers[i], static_cast<std::int64_t>(i) + 1);
  }
}

TEST_F(EventStreamTest, AHeartbeatIsACommentThatMovesTheResumePoint) {
  const auto served = serve();
  finished();
  EventClient client(served->port(), std::string(kAll) + "&after_event_number=3");
  const auto beat = client.next();
  ASSERT_TRUE(beat);
  EXPECT_TRUE(beat->is_comment);
  EXPECT_EQ(beat->id, "3");
  EXPECT_EQ(beat->data, "");
}

TEST_F(EventStreamTest, JsonLinesHaveTheSameMessages) {
  const auto served = serve();
  const std::string name = finished();
  HttpConnection client(served->port());
  client.send(get("/v1/" + name + ":watch", "Accept: application/x-ndjson\r\n"));
  const std::string all = client.read_all();
  EXPECT_THAT(all, HasSubstr("Content-Type: application/x-ndjson\r\n"));
  EXPECT_THAT(all, HasSubstr("{\"result\":{\"state\":\"QUEUED\","));
  EXPECT_THAT(all, HasSubstr("{\"result\":{\"state\":\"SUCCEEDED\","));
  EXPECT_THAT(all, testing::EndsWith("\n\r\n0\r\n\r\n"));
  HttpConnection old(served->port());
  old.send("GET /v1/" + name + ":watch HTTP/1.0\r\n" + kHost + "\r\n");
  const std::string plain = old.read_all();
  EXPECT_THAT(plain, testing::Not(HasSubstr("chunked")));
  EXPECT_THAT(plain, testing::EndsWith("event: end\ndata: {}\n\n"));
}

TEST_F(EventStreamTest, AClientThatHangsUpEndsItsStream) {
  const auto served = serve();
  for (int i = 0; i < 3; ++i) {
    EventClient client(served->port(), kAll);
    EXPECT_THAT(client.head(), StartsWith("HTTP/1.1 200"));
    if (i == 1) client.next();
    if (i == 2) {
      HttpConnection before_the_head(served->port());
      before_the_head.send(get(kAll));
    }
  }
  EXPECT_TRUE(counts("CANCELLED", "WatchSimulations", 4));
  EXPECT_EQ(app_.project_watches.taken(), 0U);
}

TEST_F(EventStreamTest, StreamsAreLimitedInAllAndForEachPeer) {
  const auto served = serve({}, {.streams = 100, .streams_of_peer = 2});
  auto first = std::make_unique<EventClient>(served->port(), kAll);
  const EventClient second(served->port(), kAll), third(served->port(), kAll);
  EXPECT_THAT(second.head(), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(third.head(), StartsWith("HTTP/1.1 429"));
  EXPECT_THAT(third.head(), HasSubstr("Retry-After: 10\r\n"));
  first.reset();
  EXPECT_TRUE(eventually([&] {
    return EventClient(served->port(), kAll).head().starts_with("HTTP/1.1 200");
  })) << "room again";
}

TEST_F(EventStreamTest, AServerThatStopsTellsItsStreams) {
  const auto served = serve();
  EventClient client(served->port(), kAll);
  ASSERT_THAT(client.head(), StartsWith("HTTP/1.1 200"));
  served->server.reset();
  const std::vector<Event> events = client.rest();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].type, "failure");
  EXPECT_EQ(json::parse(events[0].data)["error"]["details"][0]["reason"], "SHUTTING_DOWN");
  EXPECT_TRUE(client.has_ended_well());
}

TEST_F(EventStreamTest, AStreamEndsAtItsTimeLimit) {
  const auto served = serve({.stream = milliseconds(300)});
  EventClient client(served->port(), kAll);
  const std::vector<Event> events = client.rest();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(json::parse(events[0].data)["error"]["details"][0]["reason"], "STREAM_TIME_LIMIT");
}

TEST_F(EventStreamTest, AClientThatReadsNothingIsCutOffAndTheOthersAreServed) {
  add_deletions(20'000);  // 7 MB of events: more than the buffers of both ends hold
  const auto served = serve({.unread = milliseconds(500)});
  HttpConnection slow(served->port(), 4096);
  slow.send(get(kAll));
  EXPECT_THAT(slow.read_until("\r\n\r\n"), StartsWith("HTTP/1.1 200"));
  HttpConnection other(served->port());
  other.send(get(kAll));
  const std::string last = "\"event_number\":\"20000\"";
  EXPECT_THAT(other.read_until(last, std::chrono::minutes(2)), HasSubstr(last));
  EXPECT_TRUE(counts("CANCELLED", "WatchSimulations", 1)) << "cut off after the limit";
}

TEST_F(EventStreamTest, AClientWhoseEventsAreForgottenIsToldBeforeTheStream) {
  add_deletions(kKeptDeletions + 999);
  SQLite::Database(bench_.database(), SQLite::OPEN_READWRITE)
      .exec("UPDATE projects SET deletions = " + std::to_string(kKeptDeletions + 999));
  finished();
  bench_.store().remove_simulation(1);
  const auto served = serve();
  HttpConnection late(served->port());
  late.send(get(kAll, with_id("1") + "Connection: close\r\n"));
  const std::string answer = late.read_all();
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(answer, HasSubstr("\"reason\":\"EVENTS_FORGOTTEN\""));
  EXPECT_THAT(answer, HasSubstr("\"status\":\"OUT_OF_RANGE\""));
}

}  // namespace
}  // namespace tribodyn::server
