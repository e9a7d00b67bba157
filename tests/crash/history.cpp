#include "tests/crash/history.h"

#include <set>
#include <utility>

namespace tribodyn::crash {
namespace {

using Problems = std::vector<std::string>;

bool has_ended(State state) { return state >= v1::Simulation::SUCCEEDED; }

std::string text(const SeenEvent& event) {
  return "event " + std::to_string(event.sequence) + " (" +
         v1::Simulation::State_Name(event.state) + ", attempt " + std::to_string(event.attempt) +
         ")";
}

void check_acknowledged(const History& history, Problems& problems) {
  std::map<std::string, std::string> name_of_request;
  for (const auto& each : history.submissions) {
    if (!history.simulations.contains(each.name)) {
      problems.push_back(each.name + " was acknowledged and is lost");
    }
    const auto [known, is_new] = name_of_request.emplace(each.request_id, each.name);
    if (!is_new && known->second != each.name) {
      problems.push_back("one request made " + known->second + " and " + each.name);
    }
  }
  if (static_cast<int>(history.simulations.size()) > history.requests) {
    problems.push_back(std::to_string(history.requests) + " requests made " +
                       std::to_string(history.simulations.size()) + " simulations");
  }
}

void check_ends(const History& history, Problems& problems) {
  for (const auto& [name, state] : history.ended) {
    const auto found = history.simulations.find(name);
    if (found == history.simulations.end() || found->second.state() == state) continue;
    problems.push_back(name + " had ended " + v1::Simulation::State_Name(state) + " and is " +
                       v1::Simulation::State_Name(found->second.state()));
  }
  for (const auto& [name, simulation] : history.simulations) {
    if (!has_ended(simulation.state())) problems.push_back(name + " never ended");
  }
}

void check_results(const History& history, Problems& problems) {
  std::map<std::string, std::pair<std::string, std::string>> by_hash;  // name and bits
  for (const auto& [name, simulation] : history.simulations) {
    if (simulation.state() != v1::Simulation::SUCCEEDED) continue;
    const auto [first, is_new] =
        by_hash.emplace(simulation.input_hash(), std::pair(name, result_bits(simulation)));
    if (!is_new && first->second.second != result_bits(simulation)) {
      problems.push_back(first->second.first + " and " + name +
                         " have equal inputs and different results");
    }
    if (simulation.result().input_hash() != simulation.input_hash()) {
      problems.push_back(name + " has the result of other inputs");
    }
  }
  for (const auto& each : history.submissions) {
    const auto found = history.simulations.find(each.name);
    const auto right = history.undisturbed.find(each.scene);
    if (found == history.simulations.end() || right == history.undisturbed.end()) continue;
    if (found->second.state() == v1::Simulation::SUCCEEDED &&
        result_bits(found->second) != right->second) {
      problems.push_back(each.name + " has other bits than an undisturbed run");
    }
  }
}

/// Numbered one by one from `after`, forward in (attempt, state), nothing behind an end.
void check_order(const std::string& name, std::int64_t after, const std::vector<SeenEvent>& events,
                 Problems& problems) {
  const SeenEvent* before = nullptr;
  for (const SeenEvent& event : events) {
    const std::int64_t expected = (before != nullptr ? before->sequence : after) + 1;
    if (event.sequence != expected) {
      problems.push_back(name + ": a gap before " + text(event));
    }
    if (before != nullptr &&
        (has_ended(before->state) ||
         std::pair(event.attempt, event.state) <= std::pair(before->attempt, before->state))) {
      problems.push_back(name + ": " + text(event) + " after " + text(*before));
    }
    before = &event;
  }
}

void check_events(const History& history, Problems& problems) {
  for (const auto& [name, events] : history.events) {
    check_order(name, 0, events, problems);
    const auto found = history.simulations.find(name);
    if (events.empty() ||
        (found != history.simulations.end() && events.back().state != found->second.state())) {
      problems.push_back(name + ": its last event is not its state");
    }
  }
  for (const SeenWatch& watch : history.watches) {
    check_order(watch.name, watch.after_sequence, watch.events, problems);
    const auto found = history.events.find(watch.name);
    if (found == history.events.end()) continue;
    const std::vector<SeenEvent>& kept = found->second;
    for (const SeenEvent& event : watch.events) {
      const auto index = static_cast<std::size_t>(event.sequence - 1);
      if (index >= kept.size() || !(kept[index] == event)) {
        problems.push_back(watch.name + ": " + text(event) + " was told and is not kept");
      }
    }
  }
}

}  // namespace

std::string result_bits(const v1::Simulation& simulation) {
  std::string out;
  for (const auto& point : simulation.result().points()) out += point.SerializeAsString();
  return out;
}

std::vector<std::string> violations(const History& history) {
  Problems problems;
  check_acknowledged(history, problems);
  check_ends(history, problems);
  check_results(history, problems);
  check_events(history, problems);
  return problems;
}

}  // namespace tribodyn::crash
