// Eight clients at work while the server is killed again and again; then everything that they were
// told is held against what is there. A checker that never complains proves nothing: three faults
// planted into the database of a dead server must be found.
#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <thread>

#include "server/store/maintenance.h"
#include "tests/crash/clients.h"
#include "tests/service/server_process.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"

namespace tribodyn::crash {
namespace {

using server::ServerProcess;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kClients = 8;
constexpr auto kLongestWait = std::chrono::minutes(5);

int number_from(const char* variable, int otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::atoi(value);
}

/// How often the server is killed; TRIBODYN_CRASHES=200 is the full mode.
int crashes() { return number_from("TRIBODYN_CRASHES", kUnderSanitizer ? 10 : 20); }

class CrashTest : public testing::Test {
 protected:
  std::string address() const { return "unix:" + folder_.file("socket"); }
  std::string database() const { return folder_.file("tribodyn.db"); }

  void start() {
    std::filesystem::remove(folder_.file("port"));
    process_ = std::make_unique<ServerProcess>(
        std::vector<std::string>{"--listen", address(), "--database", database(), "--port-file",
                                 folder_.file("port"), "--threads", "2", "--heartbeat-seconds",
                                 "0.2", "--drain-seconds", "5"},
        folder_.file("log"));
    ASSERT_EQ(server::wait_for_address(folder_.file("port"), *process_), address())
        << process_->log();
  }

  void kill_server() {
    process_->signal(SIGKILL);
    ASSERT_EQ(process_->wait(), 128 + SIGKILL) << process_->log();
  }

  using Enough = std::function<bool(const History&)>;

  /// Clients at work, a server that is killed `count` times, for the last time when they have been
  /// told `enough`, and once it is dead whatever `plant` does to its database.
  void play(int count, const Enough& enough = {},
            const std::function<void(const std::string&)>& plant = {}) {
    const auto seed = static_cast<std::uint64_t>(
        number_from("TRIBODYN_TEST_SEED", static_cast<int>(std::random_device()() % 1'000'000)));
    RecordProperty("seed", static_cast<int>(seed));
    SCOPED_TRACE("TRIBODYN_TEST_SEED=" + std::to_string(seed));
    std::mt19937_64 random(seed);
    start();
    std::atomic<bool> stop = false;
    std::atomic<int> crashes = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < kClients; ++i) {
      threads.emplace_back([this, &stop, &crashes, i, seed] {
        Client(address(), i, seed * kClients + static_cast<std::uint64_t>(i), recorder_)
            .run(stop, crashes);
      });
    }
    for (int crash = 0; crash < count && !HasFatalFailure(); ++crash) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50 + random() % 600));
      if (crash + 1 == count && enough) {
        EXPECT_TRUE(server::eventually([&] {
          bool told = false;
          recorder_.write([&](const History& history) { told = enough(history); });
          return told;
        }));
      }
      kill_server();
      ++crashes;
      if (crash + 1 < count) start();
    }
    stop = true;
    for (std::thread& thread : threads) thread.join();
    if (plant) plant(database());
    start();
    read_everything();
    process_->signal(SIGTERM);
    EXPECT_EQ(process_->wait(), 0) << process_->log();
  }

  /// What there is once all has ended.
  void read_everything() {
    History& history = recorder_.finished();
    client::Connection connection(address());
    for (const auto& each : connection.list_simulations().resources) {
      const std::string& name = each.name();
      history.events[name];
      std::stop_source stop;
      const auto end = std::chrono::steady_clock::now() + kLongestWait;
      history.simulations[name] = connection.wait_for_end(
          name,
          [&](const v1::SimulationEvent& event) {
            if (event.kind() == v1::SimulationEvent::STATE_CHANGE) {
              history.events[name].push_back({event.sequence(), event.state(), event.attempt()});
            }
            if (std::chrono::steady_clock::now() > end) stop.request_stop();
          },
          stop.get_token());
    }
  }

  /// Every scene again on a server that nobody kills.
  void compute_undisturbed() {
    History& history = recorder_.finished();
    const server::TemporaryFolder other;
    ServerProcess process({"--listen", "unix:" + other.file("socket"), "--database",
                           other.file("db"), "--port-file", other.file("port")},
                          other.file("log"));
    ASSERT_FALSE(server::wait_for_address(other.file("port"), process).empty());
    client::Connection connection("unix:" + other.file("socket"));
    std::map<std::string, std::string> names;
    for (const auto& each : history.submissions) {
      if (names.contains(each.scene)) continue;
      names[each.scene] = connection.create_simulation(simulation_of(each.scene)).name();
    }
    for (const auto& [scene, name] : names) {
      history.undisturbed[scene] = result_bits(connection.wait_for_end(name));
    }
  }

  server::TemporaryFolder folder_;
  std::unique_ptr<ServerProcess> process_;
  Recorder recorder_;
};

TEST_F(CrashTest, NothingAcknowledgedIsLostHoweverOftenTheServerDies) {
  play(crashes());
  if (HasFatalFailure()) return;
  compute_undisturbed();
  const History& history = recorder_.finished();
  EXPECT_THAT(violations(history), IsEmpty());
  EXPECT_THAT(server::check_database(database()), IsEmpty());
  std::map<State, int> ends;
  int repeated = 0;
  for (const auto& [name, simulation] : history.simulations) {
    ++ends[simulation.state()];
    if (simulation.attempt() > 1) ++repeated;
  }
  RecordProperty("simulations", static_cast<int>(history.simulations.size()));
  RecordProperty("succeeded", ends[v1::Simulation::SUCCEEDED]);
  RecordProperty("cancelled", ends[v1::Simulation::CANCELLED]);
  RecordProperty("failed", ends[v1::Simulation::FAILED]);
  RecordProperty("run_again", repeated);
  RecordProperty("watches", static_cast<int>(history.watches.size()));
  EXPECT_GT(history.simulations.size(), 20U);
  EXPECT_GT(ends[v1::Simulation::SUCCEEDED], 10);
  EXPECT_GT(repeated, 0) << "no crash met a simulation that ran";
  for (const auto& [name, simulation] : history.simulations) {
    if (simulation.state() != v1::Simulation::FAILED) continue;
    EXPECT_EQ(simulation.error().reason(), "WORKER_LOST") << name;
  }
}

/// Changes the database behind the server's back.
void change(const std::string& database, const std::string& sql) {
  SQLite::Database raw(database, SQLite::OPEN_READWRITE);
  raw.exec("PRAGMA foreign_keys = OFF");
  raw.exec(sql);
}

/// How many simulations clients know to have succeeded, by scene.
std::map<std::string, std::set<std::string>> successes(const History& history) {
  std::map<std::string, std::string> scene;
  for (const auto& each : history.submissions) scene[each.name] = each.scene;
  std::map<std::string, std::set<std::string>> out;
  for (const auto& each : history.ended) {
    if (each.state == v1::Simulation::SUCCEEDED && scene.contains(each.name)) {
      out[scene[each.name]].insert(each.name);
    }
  }
  return out;
}

TEST_F(CrashTest, ALostAcknowledgementIsFound) {
  if (kUnderSanitizer) GTEST_SKIP() << "tests the checker of this file: the release stage runs it";
  std::string lost;
  play(
      2, [](const History& history) { return !history.submissions.empty(); },
      [&](const std::string& database) {
        lost = recorder_.finished().submissions.front().name;
        const std::string id = lost.substr(lost.find('/') + 1);
        change(database, "DELETE FROM events WHERE simulation = " + id +
                             "; DELETE FROM simulations WHERE id = " + id);
      });
  EXPECT_THAT(violations(recorder_.finished()), Contains(lost + " was acknowledged and is lost"));
}

TEST_F(CrashTest, AGapInTheEventsIsFound) {
  if (kUnderSanitizer) GTEST_SKIP() << "tests the checker of this file: the release stage runs it";
  play(
      2, [](const History& history) { return !successes(history).empty(); },
      [](const std::string& database) {
        change(database,
               "DELETE FROM events WHERE sequence = 2 AND simulation = "
               "(SELECT min(id) FROM simulations WHERE state = 3 AND cache_hit = 0)");
      });
  EXPECT_THAT(violations(recorder_.finished()), Contains(HasSubstr(": a gap before event 3")));
}

TEST_F(CrashTest, ADoubleResultIsFound) {
  if (kUnderSanitizer) GTEST_SKIP() << "tests the checker of this file: the release stage runs it";
  const auto shared = [](const History& history) {
    const auto by_scene = successes(history);
    return by_scene.size() > 1 &&
           std::any_of(by_scene.begin(), by_scene.end(),
                       [](const auto& one) { return one.second.size() > 1; });
  };
  play(3, shared, [](const std::string& database) {
    change(database,
           "DROP INDEX one_result_per_input;"
           "INSERT INTO results SELECT 1000000, input_hash, model_version, platform, create_time, "
           "(SELECT body FROM results b WHERE b.input_hash <> a.input_hash LIMIT 1) "
           "FROM results a WHERE id = (SELECT result FROM simulations WHERE state = 3 "
           "GROUP BY result HAVING count(*) > 1 LIMIT 1);"
           "UPDATE simulations SET result = 1000000 WHERE id = "
           "(SELECT max(s.id) FROM simulations s WHERE s.input_hash = "
           "(SELECT input_hash FROM results WHERE id = 1000000) AND s.state = 3)");
  });
  EXPECT_THAT(violations(recorder_.finished()),
              Contains(HasSubstr("have equal inputs and different results")));
}

}  // namespace
}  // namespace tribodyn::crash
