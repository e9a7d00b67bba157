#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

// Rows of events on an open connection, inside the caller's transaction. All throw
// SQLite::Exception.

/// Adds an event of `event.simulation` and sets its project and its number. Writes the number of
/// the simulation only with a deletion.
void insert_event(Connection& db, StoredEvent& event);

/// Replaces the events of a simulation by one that tells of its deletion. Forgets the oldest
/// deletions of the project beyond kKeptDeletions.
void insert_deletion(Connection& db, std::int64_t simulation);
inline constexpr int kKeptDeletions = 100'000;  ///< of a project; some 60 bytes each

/// Returns the event of a simulation after sequence number `after_sequence`; nullopt if there is
/// none.
std::optional<StoredEvent> query_next_event(Connection& db, std::int64_t simulation,
                                            std::int64_t after_sequence);

/// Returns the deletion of the simulation with this number in a project; nullopt if it was not
/// deleted or the deletion has been forgotten.
std::optional<StoredEvent> query_deletion(Connection& db, const std::string& project,
                                          std::int64_t simulation_number);

/// Returns the first events of a selection. Looks at no more than kEventWindow events if the
/// selection is by restrictions, so that a rare match takes no longer than a frequent one.
EventPage query_events(Connection& db, const EventQuery& query);
inline constexpr int kEventPage = 100;
inline constexpr int kEventWindow = 5000;

/// Returns the states of simulations of a project, in the order of `numbers`; nullopt for one that
/// does not exist.
std::vector<std::optional<SimulationState>> query_states(Connection& db, const std::string& project,
                                                         const std::vector<std::int64_t>& numbers);

EventRange query_event_range(Connection& db, const std::string& project);

}  // namespace tribodyn::server
