#include "tests/crash/crash_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <thread>
#include <utility>

#include "tests/crash/campaign_client.h"

namespace tribodyn::crash {
namespace {

using server::ServerProcess;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kClientsOfACampaignClient = 4;

/// TRIBODYN_TEST_SEED repeats the draws of an earlier run, though not its timing.
std::uint64_t seed_of_run() {
  const char* chosen = std::getenv("TRIBODYN_TEST_SEED");
  return chosen != nullptr ? std::strtoull(chosen, nullptr, 10)
                           : std::random_device()() % 1'000'000;
}

}  // namespace

CrashRun::CrashRun(std::vector<std::string> command, milliseconds patience)
    : command_(std::move(command)), patience_(patience), seed_(seed_of_run()) {}

void CrashRun::start() {
  std::filesystem::remove(folder_.file("port"));
  std::vector<std::string> arguments(command_.begin() + 1, command_.end());
  for (const std::string& each :
       {std::string("--listen"), address(), std::string("--database"), database(),
        std::string("--port-file"), folder_.file("port"), std::string("--threads"),
        std::string("2"), std::string("--heartbeat-seconds"), std::string("0.2"),
        std::string("--drain-seconds"), std::string("5")}) {
    arguments.push_back(each);
  }
  process_ = std::make_unique<ServerProcess>(arguments, folder_.file("log"), 0, command_.front());
  ASSERT_EQ(server::wait_for_address(folder_.file("port"), *process_), address())
      << process_->log();
}

void CrashRun::kill_server() {
  process_->signal(SIGKILL);
  ASSERT_EQ(process_->wait(), 128 + SIGKILL) << process_->log();
}

void CrashRun::stop_server() {
  process_->signal(SIGTERM);
  ASSERT_EQ(process_->wait(), 0) << process_->log();
}

void CrashRun::crash_under_load(int clients, int crashes) {
  std::mt19937_64 random(seed_);
  std::atomic<bool> stop = false;
  std::atomic<int> crashed = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < clients; ++i) {
    threads.emplace_back([this, &stop, &crashed, i, clients] {
      const auto seed = seed_ * static_cast<std::uint64_t>(clients) + static_cast<std::uint64_t>(i);
      Client(address(), i, seed, recorder_).run(stop, crashed);
    });
  }
  for (int i = 0; i < clients / kClientsOfACampaignClient; ++i) {
    threads.emplace_back([this, &stop, &crashed, i] {
      CampaignClient(address(), i, seed_ + static_cast<std::uint64_t>(i), recorder_)
          .run(stop, crashed);
    });
  }
  while (crashed < crashes && !testing::Test::HasFatalFailure()) {
    std::this_thread::sleep_for(milliseconds(50 + random() % 600));
    kill_server();
    if (++crashed < crashes) start();
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
}

void CrashRun::play(int clients, int crashes) {
  SCOPED_TRACE("TRIBODYN_TEST_SEED=" + std::to_string(seed_));
  start();
  if (testing::Test::HasFatalFailure()) return;
  crash_under_load(clients, crashes);
  if (testing::Test::HasFatalFailure()) return;
  start();
  if (testing::Test::HasFatalFailure()) return;
  read_everything();
  stop_server();
}

void CrashRun::wait_for_ends(client::Connection& connection) const {
  std::map<std::string, State> states;
  auto changed = steady_clock::now();
  while (steady_clock::now() - changed < patience_) {
    std::map<std::string, State> now;
    for (const auto& each : connection.list_simulations().resources)
      now[each.name()] = each.state();
    if (now != states) changed = steady_clock::now();
    states = std::move(now);
    if (std::all_of(states.begin(), states.end(),
                    [](const auto& one) { return client::has_ended(one.second); })) {
      return;
    }
    std::this_thread::sleep_for(milliseconds(20));
  }
}

void CrashRun::wait_for_campaigns(client::Connection& connection) const {
  std::map<std::string, std::pair<int, int>> states;
  auto changed = steady_clock::now();
  while (steady_clock::now() - changed < patience_) {
    std::map<std::string, std::pair<int, int>> now;
    bool is_over = true;
    for (const auto& each : connection.list_campaigns().resources) {
      now[each.name()] = {each.state(), each.points_done()};
      is_over = is_over && client::has_ended(each.state());
    }
    if (is_over) return;
    if (now != states) changed = steady_clock::now();
    states = std::move(now);
    std::this_thread::sleep_for(milliseconds(20));
  }
}

void CrashRun::read_campaigns(client::Connection& connection) {
  CampaignHistory& history = recorder_.finished().campaigns;
  for (const auto& each : connection.list_campaigns().resources) {
    history.found[each.name()] = each;
    if (each.state() == v1::Campaign::PAUSED) connection.resume_campaign(each.name());
  }
  wait_for_campaigns(connection);
  for (const auto& [name, campaign] : history.found) {
    history.campaigns[name] = connection.get_campaign(name, v1::CAMPAIGN_VIEW_FULL);
    history.rows[name] = computed_rows(connection, name);
  }
}

void CrashRun::read_everything() {
  History& history = recorder_.finished();
  client::Connection connection(address());
  read_campaigns(connection);
  wait_for_ends(connection);
  for (const auto& each : connection.list_simulations().resources) {
    const milliseconds patience = client::has_ended(each.state()) ? patience_ : milliseconds(300);
    std::vector<SeenEvent>& events = history.events[each.name()];
    const v1::Simulation simulation = follow(connection, each.name(), patience, events);
    history.simulations[each.name()] = simulation;
    history.histories[each.name()] = history_bytes(connection, simulation);
  }
  for (const auto& each : connection.list<v1::Lubricant>().resources) {
    for (const auto& revision : connection.revisions<v1::Lubricant>(each.name()).resources) {
      history.kept_revisions[revision.name()] = revision.display_name();
    }
  }
}

void CrashRun::compute_undisturbed() {
  History& history = recorder_.finished();
  const server::TemporaryFolder other;
  ServerProcess process({"--listen", "unix:" + other.file("socket"), "--database", other.file("db"),
                         "--port-file", other.file("port")},
                        other.file("log"));
  ASSERT_FALSE(server::wait_for_address(other.file("port"), process).empty()) << process.log();
  client::Connection connection("unix:" + other.file("socket"));
  std::map<std::string, std::string> names;
  for (const auto& each : history.submissions) {
    if (names.contains(each.scene)) continue;
    names[each.scene] = connection.create_simulation(simulation_of(each.scene)).name();
  }
  for (const auto& [scene, name] : names) {
    const v1::Simulation simulation = connection.wait_for_end(name);
    history.undisturbed[scene] = result_bits(simulation) + history_bytes(connection, simulation);
  }
  for (const auto& each : history.campaigns.made) {
    auto& rows = history.campaigns.undisturbed[each.scene];
    if (!rows.empty()) continue;
    constexpr int kAll = kFirstCandidates + kMostAppends * kAppendedCandidates;
    const std::string name = connection.create_campaign(campaign_of(each.scene, kAll)).name();
    connection.follow_campaign(name);
    rows = computed_rows(connection, name);
  }
}

}  // namespace tribodyn::crash
