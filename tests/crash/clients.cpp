#include "tests/crash/clients.h"

#include <chrono>
#include <iterator>
#include <stop_token>
#include <thread>

#include "tests/support/run_length.h"

namespace tribodyn::crash {
namespace {

using std::chrono::milliseconds;

constexpr auto kCallLimit = std::chrono::seconds(3);
constexpr int kFavourites = 6;
constexpr int kScenes = 400;
// Marched, a point takes a tenth of a second, under sanitizers some: long enough to be met by a
// crash.
constexpr int kMarchedOneIn = kUnderSanitizer ? 8 : 2;
constexpr int kFirstSubmissions = 8;  // of each client until the first crash

SeenEvent seen(const v1::SimulationEvent& event) {
  return {event.sequence(), event.state(), event.attempt()};
}

}  // namespace

v1::Simulation simulation_of(const std::string& scene) {
  const int number = std::stoi(scene);
  v1::Simulation out;
  out.set_lubricant("lubricants/" + std::to_string(1 + number % 3));
  out.set_sump_temperature_celsius(30 + 0.1 * number);
  if (number % 5 == 4) {
    auto* curve = out.mutable_inefficiency_curve();
    for (int speed = 40; speed <= 90; speed += 10) curve->add_speeds_kilometers_per_hour(speed);
  } else {
    auto* point = out.mutable_operating_point();
    point->mutable_cruise()->set_speed_kilometers_per_hour(20 + number % 90);
    if (number % 5 == 3) point->set_model(v1::QUASI_STATIC);
  }
  if (number % kMarchedOneIn == 0 && out.has_operating_point()) {
    out.mutable_solver_options()->set_method(v1::MARCH);
  }
  return out;
}

Client::Client(std::string address, int number, std::uint64_t seed, Recorder& recorder)
    : connection_(std::move(address), kCallLimit),
      number_(number),
      random_(seed),
      recorder_(recorder) {}

void Client::run(const std::atomic<bool>& stop, const std::atomic<int>& crashes) {
  while (!stop) {
    try {
      // Work in proportion to the crashes, not to the time: where the server is slow to start again
      // it would never come to an end.
      act(std::ssize(sent_) < kFirstSubmissions + crashes);
    } catch (const client::ServiceError& error) {
      // The server is dead at the moment. What it refuses is a mistake of this test.
      if (error.kind() == client::ServiceError::Kind::kRefused && error.reason().empty()) throw;
    }
    std::this_thread::sleep_for(milliseconds(draw(60)));
  }
}

std::string Client::draw_scene() {
  return std::to_string(draw(3) == 0 ? draw(kScenes) : draw(kFavourites));
}

void Client::act(bool may_submit) {
  const int kind = draw(10);
  if (sent_.empty() || (kind < 4 && may_submit)) {
    const std::string id = std::to_string(number_) + "-" + std::to_string(sent_.size());
    sent_.push_back({id, draw_scene(), draw(8) == 0, ""});
    recorder_.write([](History& history) { ++history.requests; });
    submit(sent_.back());
    if (draw(4) == 0) cancel(sent_.back().name);
    return;
  }
  Sent& chosen = sent_[static_cast<std::size_t>(draw(static_cast<int>(sent_.size())))];
  if (kind == 4 || chosen.name.empty()) return submit(chosen);
  if (kind < 8) return watch(chosen.name);
  if (kind == 8) return cancel(chosen.name);
  read(chosen.name);
}

void Client::submit(Sent& sent) {
  client::CreateOptions options;
  options.request_id = sent.request_id;
  options.force = sent.force;
  const v1::Simulation made = connection_.create_simulation(simulation_of(sent.scene), options);
  sent.name = made.name();
  recorder_.write([&](History& history) {
    history.submissions.push_back({sent.request_id, sent.name, sent.scene});
  });
  note_end(made);
}

void Client::watch(const std::string& name) {
  SeenWatch told{name, 0, {}};
  std::stop_source stop;
  const milliseconds patience(draw(800));
  std::jthread clock([&stop, patience](const std::stop_token& over) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!over.stop_requested() && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(milliseconds(5));
    }
    stop.request_stop();
  });
  const auto keep = [&] {
    recorder_.write([&](History& history) { history.watches.push_back(told); });
  };
  try {
    const v1::Simulation simulation = connection_.wait_for_end(
        name,
        [&told](const v1::SimulationEvent& event) {
          if (event.kind() == v1::SimulationEvent::STATE_CHANGE) told.events.push_back(seen(event));
        },
        stop.get_token());
    note_end(simulation);
  } catch (const client::ServiceError&) {
    keep();
    throw;
  }
  keep();
}

void Client::cancel(const std::string& name) { note_end(connection_.cancel_simulation(name)); }

void Client::read(const std::string& name) { note_end(connection_.get_simulation(name)); }

void Client::note_end(const v1::Simulation& simulation) {
  if (!client::has_ended(simulation.state())) return;
  recorder_.write([&](History& history) {
    history.ended.push_back({simulation.name(), simulation.state()});
  });
}

}  // namespace tribodyn::crash
