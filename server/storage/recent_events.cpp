#include "server/storage/recent_events.h"

#include <algorithm>
#include <utility>

namespace tribodyn::server {

std::optional<EventPage> RecentEvents::after(const std::string& project, std::int64_t after,
                                             const Source& source) {
  const std::lock_guard lock(mutex_);
  const Project& kept = renewed(project, source);
  if (after < kept.forgotten) return std::nullopt;
  EventPage out;
  out.through = std::max(after, kept.latest);
  const auto first = std::find_if(kept.events.begin(), kept.events.end(),
                                  [&](const StoredEvent& each) { return each.number > after; });
  out.events.assign(first, kept.events.end());
  return out;
}

RecentEvents::States RecentEvents::states(const std::string& project,
                                          const std::vector<std::int64_t>& numbers,
                                          const Source& source) {
  const std::lock_guard lock(mutex_);
  auto& states = renewed(project, source).states;
  std::vector<std::int64_t> missing;
  for (const std::int64_t each : numbers) {
    if (!states.contains(each)) missing.push_back(each);
  }
  if (states.size() + missing.size() > kStates) {
    states.clear();
    missing = numbers;
  }
  if (!missing.empty()) {
    const States read = source.states(missing);
    for (std::size_t i = 0; i < missing.size(); ++i) {
      if (read[i]) states[missing[i]] = *read[i];
    }
  }
  States out;
  for (const std::int64_t each : numbers) {
    const auto found = states.find(each);
    out.push_back(found == states.end() ? std::nullopt : std::optional(found->second));
  }
  return out;
}

/// Returns the entry of a project with all that has changed up to now.
RecentEvents::Project& RecentEvents::renewed(const std::string& project, const Source& source) {
  Project& kept = entry(project, source);
  kept.last_use = ++uses_;
  // Changes that come during the read are left to the next call.
  if (const std::uint64_t changes = changes_; kept.changes != changes) {
    renew(kept, source);
    kept.changes = changes;
  }
  return kept;
}

/// Returns the entry of a project, a new one from its latest event on.
RecentEvents::Project& RecentEvents::entry(const std::string& project, const Source& source) {
  if (const auto found = projects_.find(project); found != projects_.end()) return found->second;
  Project added;
  added.changes = changes_;
  added.forgotten = added.latest = source.latest();
  if (projects_.size() == kProjects) {
    projects_.erase(std::min_element(
        projects_.begin(), projects_.end(),
        [](const auto& a, const auto& b) { return a.second.last_use < b.second.last_use; }));
  }
  return projects_[project] = std::move(added);
}

/// Adds the events since the last look at the database. Begins anew after more than one page.
void RecentEvents::renew(Project& project, const Source& source) {
  const EventPage page = source.events(project.latest);
  if (page.more) {
    project.forgotten = project.latest = source.latest();
    project.events.clear();
    project.states.clear();
    return;
  }
  for (const StoredEvent& each : page.events) add(project, each);
  project.latest = std::max(project.latest, page.through);
}

/// A deletion takes the place of all other events of its simulation, as in the database.
void RecentEvents::add(Project& project, const StoredEvent& event) {
  if (event.state == StoredState::kDeleted) {
    std::erase_if(project.events,
                  [&](const StoredEvent& each) { return each.simulation == event.simulation; });
    project.states.erase(event.simulation_number);
  } else if (const auto found = project.states.find(event.simulation_number);
             found != project.states.end() && found->second.sequence < event.sequence) {
    found->second = {event.simulation, event.state, event.attempt, event.sequence, event.number};
  }
  project.events.push_back(event);
  if (project.events.size() > kKept) {
    project.forgotten = project.events.front().number;
    project.events.pop_front();
  }
}

}  // namespace tribodyn::server
