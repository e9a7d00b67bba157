#include "server/application/stored_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/application/errors.h"
#include "server/application/simulation_lookup.h"
#include "server/contract/constraints.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

constexpr char kHistoryType[] = "tribodyn.v1.History";

/// What ResourceInfo calls the history of a simulation.
std::string history_name(const std::string& simulation) { return simulation + "/history"; }

}  // namespace

Outcome<StoredHistory> find_history(Application& application, const std::string& name,
                                    const CallContext& call) {
  auto found = find_by_number(name, [&](std::int64_t number) {
    return application.store.stored_history(call.project, number, call.limits);
  });
  if (!found.ok()) return found;
  const StoredSimulation& stored = found.message().simulation;
  if (stored.state != StoredState::kSucceeded) {
    return not_possible(
        v1::ERROR_REASON_NO_RESULT_YET, "tribodyn.v1.Simulation", name,
        name + " has not succeeded, so it has no history",
        {{"state", v1::Simulation::State_Name(static_cast<v1::Simulation::State>(stored.state))}});
  }
  if (found.message().shape.names.empty()) {
    return not_found(kHistoryType, history_name(name), name + " was run without history",
                     v1::ERROR_REASON_NO_HISTORY);
  }
  return found;
}

google::rpc::Status history_evicted(const std::string& name) {
  return not_found(kHistoryType, history_name(name), "the history of " + name + " has been evicted",
                   v1::ERROR_REASON_HISTORY_EVICTED);
}

std::vector<std::size_t> history_places(
    const google::protobuf::RepeatedPtrField<std::string>& columns, const HistoryShape& shape,
    Violations& violations) {
  std::vector<std::size_t> out;
  const int asked = std::min(columns.size(), kMaximumHistoryColumns);
  for (int i = 0; i < asked; ++i) {
    bool is_known = false;
    for (std::size_t place = 0; place < shape.names.size(); ++place) {
      const std::string& name = shape.names[place];
      if (name != columns[i] && !name.starts_with(columns[i] + "_flank_")) continue;
      is_known = true;
      if (std::find(out.begin(), out.end(), place) == out.end()) out.push_back(place);
    }
    if (!is_known) {
      violations.push_back(
          {fmt::format("columns[{}]", i),
           fmt::format("no such column here{}", meant_text(columns[i], shape.names))});
    }
  }
  if (columns.size() > kMaximumHistoryColumns) {
    violations.push_back({"columns", fmt::format("{} columns; allowed: at most {}", columns.size(),
                                                 kMaximumHistoryColumns)});
  }
  return out;
}

}  // namespace tribodyn::server
