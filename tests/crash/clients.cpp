#include "tests/crash/clients.h"

#include <grpcpp/support/status_code_enum.h>

#include <iterator>
#include <stop_token>
#include <thread>

#include "tests/support/run_length.h"

namespace tribodyn::crash {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr auto kCallLimit = std::chrono::seconds(3);
constexpr int kFavourites = 6;  // scenes that clients request repeatedly
constexpr int kScenes = 800;
// A marched point takes a tenth of a second, under sanitizers several: long enough for a crash to
// interrupt it.
constexpr int kMarchedOneIn = kUnderSanitizer ? 8 : 2;
constexpr int kFirstSubmissions = 8;  // for each client until the first crash
constexpr double kUrgentSeconds = 1;
constexpr int kBatchSize = 3;

SeenEvent seen(const v1::SimulationEvent& event) {
  return {event.sequence(), event.state(), event.attempt()};
}

void set_study(int number, v1::Simulation& out) {
  if (number % 5 == 4) {
    auto* curve = out.mutable_inefficiency_curve();
    for (int speed = 40; speed <= 90; speed += 10) curve->add_speeds_kilometres_per_hour(speed);
    return;
  }
  auto* point = out.mutable_operating_point();
  point->mutable_cruise()->set_speed_kilometres_per_hour(20 + number % 90);
  if (number % 5 == 3) point->set_model(v1::POINT_MODEL_QUASI_STATIC);
  if (number % 2 == 1) point->mutable_history()->add_columns("mesh_force_newtons");
  if (number % kMarchedOneIn == 0)
    out.mutable_solver_options()->set_method(v1::STEADY_STATE_METHOD_MARCH);
}

/// Changes one input.
void vary(int number, v1::Simulation& out) {
  switch (number % 3) {
    case 0:
      out.set_sump_temperature_celsius(out.sump_temperature_celsius() + 5);
      break;
    case 1:
      out.set_lubricant("lubricants/paper-fluid-" + std::to_string(1 + (number + 1) % 3));
      break;
    default:
      out.set_inlet_temperature_rise_kelvin(15);
  }
}

v1::Lubricant lubricant_of(const std::string& name, int content) {
  v1::Lubricant out;
  out.set_name(name);
  out.set_display_name(std::to_string(content));
  out.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  auto* measured = out.mutable_measurements();
  measured->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(73.3);
  measured->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(14.2);
  return out;
}

}  // namespace

bool is_refusal(const client::ServiceError& error) {
  switch (error.status_code()) {
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::UNAVAILABLE:
      return false;
    default:
      return error.kind() == client::ServiceError::Kind::kRefused;
  }
}

v1::Simulation simulation_of(const std::string& scene) {
  const int number = std::stoi(scene) / 2;
  v1::Simulation out;
  out.set_lubricant("lubricants/paper-fluid-" + std::to_string(1 + number % 3));
  out.set_sump_temperature_celsius(30 + 0.1 * number);
  set_study(number, out);
  if (std::stoi(scene) % 2 == 1) vary(number, out);
  return out;
}

std::string history_bytes(client::Connection& connection, const v1::Simulation& simulation) {
  if (simulation.result().history_columns().empty()) return {};
  return connection.read_history(simulation.name()).SerializeAsString();
}

v1::Simulation follow(client::Connection& connection, const std::string& name,
                      milliseconds patience, std::vector<SeenEvent>& events) {
  std::stop_source stop;
  const std::jthread clock([&stop, patience](const std::stop_token& over) {
    const auto end = steady_clock::now() + patience;
    while (!over.stop_requested() && steady_clock::now() < end) {
      std::this_thread::sleep_for(milliseconds(5));
    }
    stop.request_stop();
  });
  return connection.wait_for_end(
      name,
      [&events](const v1::SimulationEvent& event) {
        if (event.kind() == v1::SimulationEvent::STATE_CHANGE) events.push_back(seen(event));
      },
      stop.get_token());
}

Client::Client(std::string address, int number, std::uint64_t seed, Recorder& recorder)
    : connection_(std::move(address), kCallLimit),
      number_(number),
      random_(seed),
      recorder_(recorder) {}

void Client::run(const std::atomic<bool>& stop, const std::atomic<int>& crashes) {
  while (!stop) {
    try {
      // The number of submissions depends on the number of crashes and not on time: otherwise a
      // server that starts slowly would have more and more work left at the end.
      act(std::ssize(sent_) < kFirstSubmissions + crashes);
    } catch (const client::ServiceError& error) {
      if (is_refusal(error)) {
        recorder_.write([&](History& history) { history.refusals.emplace_back(error.what()); });
      }
    }
    std::this_thread::sleep_for(milliseconds(draw(60)));
  }
}

std::string Client::draw_scene() {
  return std::to_string(draw(3) == 0 ? draw(kScenes) : draw(kFavourites));
}

void Client::act(bool may_submit) {
  const int kind = draw(12);
  if (sent_.empty() || (kind < 4 && may_submit)) {
    const std::string id = std::to_string(number_) + "-" + std::to_string(sent_.size());
    sent_.push_back({id, draw_scene(), draw(8) == 0, draw(6) == 0, ""});
    recorder_.write([](History& history) { ++history.requests; });
    submit(sent_.back());
    const int next = draw(4);
    if (next == 0) note_end(connection_.cancel_simulation(sent_.back().name));
    if (next > 1) watch(sent_.back().name);  // so that most crashes interrupt a watch
    return;
  }
  if (kind == 9 || kind == 10) return update_lubricant();
  if (kind == 11 && may_submit) return create_batch();
  Sent& chosen = sent_[static_cast<std::size_t>(draw(static_cast<int>(sent_.size())))];
  if (kind == 4 || chosen.name.empty()) return submit(chosen);
  if (kind < 7) return watch(chosen.name);
  if (kind == 7) return note_end(connection_.cancel_simulation(chosen.name));
  note_end(connection_.get_simulation(chosen.name));
}

void Client::submit(Sent& sent) {
  client::CreateOptions options;
  options.request_id = sent.request_id;
  options.force = sent.force;
  v1::Simulation simulation = simulation_of(sent.scene);
  if (sent.is_urgent) simulation.set_deadline_seconds(kUrgentSeconds);
  const v1::Simulation made = connection_.create_simulation(simulation, options);
  sent.name = made.name();
  recorder_.write([&](History& history) {
    history.submissions.push_back({sent.request_id, sent.name, sent.scene});
  });
  note_end(made);
}

void Client::watch(const std::string& name) {
  SeenWatch watched{name, 0, {}};
  const auto keep = [&] {
    recorder_.write([&](History& history) { history.watches.push_back(watched); });
  };
  try {
    note_end(follow(connection_, name, milliseconds(draw(800)), watched.events));
  } catch (const client::ServiceError&) {
    keep();
    throw;
  }
  keep();
}

void Client::update_lubricant() {
  client::UpdateOptions options;
  options.allow_missing = true;
  const std::string name = "lubricants/of-client-" + std::to_string(number_);
  const v1::Lubricant sent = lubricant_of(name, updates_++);
  const v1::Lubricant made = connection_.update(sent, options);
  recorder_.write([&](History& history) {
    history.revisions.push_back(
        {made.name() + "@" + std::to_string(made.revision()), sent.display_name()});
  });
}

void Client::create_batch() {
  std::vector<v1::Lubricant> lubricants;
  History::Batch batch;
  for (int i = 0; i < kBatchSize; ++i) {
    batch.names.push_back("lubricants/batch-" + std::to_string(number_) + "-" +
                          std::to_string(batches_) + "-" + std::to_string(i));
    lubricants.push_back(lubricant_of(batch.names.back(), i));
  }
  ++batches_;
  std::size_t place = 0;
  recorder_.write([&](History& history) {
    place = history.batches.size();
    history.batches.push_back(batch);
  });
  connection_.create_all(lubricants);
  recorder_.write([&](History& history) { history.batches[place].is_acknowledged = true; });
}

void Client::note_end(const v1::Simulation& simulation) {
  if (!client::has_ended(simulation.state())) return;
  recorder_.write([&](History& history) {
    history.ended.push_back({simulation.name(), simulation.state()});
  });
}

}  // namespace tribodyn::crash
