#include "tests/crash/history.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
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
    const auto found = history.simulations.find(each.name);
    if (found == history.simulations.end()) {
      problems.push_back(each.name + " was acknowledged and is lost");
    } else if (found->second.request_id() != each.request_id) {
      problems.push_back(each.name + " was acknowledged to request " + each.request_id +
                         " and belongs to request " + found->second.request_id());
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

/// Returns true if a simulation was lost in too many crashes or missed its deadline.
bool may_fail(const v1::Simulation& simulation) {
  const std::string& reason = simulation.error().reason();
  return reason == "WORKER_LOST" ||
         (reason == "DEADLINE_EXCEEDED" && simulation.has_deadline_time() &&
          simulation.end_time() >= simulation.deadline_time());
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
    if (simulation.state() == v1::Simulation::FAILED && !may_fail(simulation)) {
      problems.push_back(name + " failed with " + simulation.error().reason());
    }
  }
}

/// Returns result_bits() and the bytes of the history.
std::string all_bits(const History& history, const std::string& name,
                     const v1::Simulation& simulation) {
  const auto found = history.histories.find(name);
  return result_bits(simulation) + (found == history.histories.end() ? "" : found->second);
}

void check_results(const History& history, Problems& problems) {
  std::map<std::string, std::pair<std::string, std::string>> by_hash;  // name and bits
  for (const auto& [name, simulation] : history.simulations) {
    if (simulation.state() != v1::Simulation::SUCCEEDED) continue;
    const std::string bits = all_bits(history, name, simulation);
    const auto [first, is_new] = by_hash.emplace(simulation.input_hash(), std::pair(name, bits));
    if (!is_new && first->second.second != bits) {
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
        all_bits(history, each.name, found->second) != right->second) {
      problems.push_back(each.name + " has other bits than an undisturbed run");
    }
  }
}

/// Checks that events are numbered without gaps after `after`, that (attempt, state) only moves
/// forward, and that no event follows a final state.
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

const std::vector<SeenEvent>& events_of(const History& history, const std::string& name) {
  static const std::vector<SeenEvent> kNone;
  const auto found = history.events.find(name);
  return found == history.events.end() ? kNone : found->second;
}

void check_last_event(const std::string& name, const v1::Simulation& simulation,
                      const std::vector<SeenEvent>& events, Problems& problems) {
  const SeenEvent expected = {simulation.event_sequence(), simulation.state(),
                              simulation.attempt()};
  if (events.empty()) {
    problems.push_back(name + " has no events");
  } else if (!(events.back() == expected)) {
    problems.push_back(name + " is at " + text(expected) + " and its last event is " +
                       text(events.back()));
  }
}

void check_watch(const SeenWatch& watch, const std::vector<SeenEvent>& kept, Problems& problems) {
  check_order(watch.name, watch.after_sequence, watch.events, problems);
  for (const SeenEvent& event : watch.events) {
    const auto index = static_cast<std::size_t>(event.sequence - 1);
    if (index >= kept.size() || !(kept[index] == event)) {
      problems.push_back(watch.name + ": " + text(event) + " was sent and is not kept");
    }
  }
}

void check_events(const History& history, Problems& problems) {
  for (const auto& [name, simulation] : history.simulations) {
    const std::vector<SeenEvent>& events = events_of(history, name);
    check_order(name, 0, events, problems);
    check_last_event(name, simulation, events, problems);
  }
  for (const SeenWatch& watch : history.watches) {
    check_watch(watch, events_of(history, watch.name), problems);
  }
}

void check_revisions(const History& history, Problems& problems) {
  for (const auto& [name, content] : history.revisions) {
    const auto found = history.kept_revisions.find(name);
    if (found == history.kept_revisions.end()) {
      problems.push_back(name + " was acknowledged and is lost");
    } else if (found->second != content) {
      problems.push_back(name + " was acknowledged as \"" + content + "\" and is \"" +
                         found->second + "\"");
    }
  }
  std::map<std::pair<std::string, std::string>, std::string> by_content;
  for (const auto& [name, content] : history.kept_revisions) {
    const std::string resource = name.substr(0, name.find('@'));
    const auto [first, is_new] = by_content.emplace(std::pair(resource, content), name);
    if (!is_new) problems.push_back("one update made " + first->second + " and " + name);
  }
}

void check_batches(const History& history, Problems& problems) {
  for (const auto& [names, is_acknowledged] : history.batches) {
    const auto kept = static_cast<std::size_t>(
        std::count_if(names.begin(), names.end(), [&history](const std::string& name) {
          return history.kept_revisions.contains(name + "@1");
        }));
    if (kept == names.size() || (kept == 0 && !is_acknowledged)) continue;
    problems.push_back("of the " + std::string(is_acknowledged ? "acknowledged " : "") +
                       "batch of " + names.front() + " " + std::to_string(kept) + " of " +
                       std::to_string(names.size()) + " are there");
  }
}

}  // namespace

std::string result_bits(const v1::Simulation& simulation) {
  v1::SimulationResult result = simulation.result();
  result.clear_assumptions();
  result.clear_input_hash();
  result.clear_platform();
  return result.SerializeAsString();
}

std::vector<std::string> violations(const History& history) {
  Problems problems;
  for (const std::string& refusal : history.refusals) problems.push_back("refused: " + refusal);
  check_acknowledged(history, problems);
  check_ends(history, problems);
  check_results(history, problems);
  check_events(history, problems);
  check_revisions(history, problems);
  check_batches(history, problems);
  for (std::string& each : campaign_violations(history.campaigns)) {
    problems.push_back(std::move(each));
  }
  return problems;
}

}  // namespace tribodyn::crash
