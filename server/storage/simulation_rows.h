#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/resource_rows.h"
#include "server/storage/stored_simulation.h"
#include "server/storage/times.h"

namespace tribodyn::server {

// Rows of simulations, events, results and ledgers on an open connection, inside the caller's
// transaction. All throw SQLite::Exception.

/// Replaces the request of a simulation, and its labels. Returns false, and changes nothing, if the
/// request is not `before`.
bool set_labels(Connection& db, std::int64_t id, const std::string& before,
                const std::string& request,
                const std::vector<std::pair<std::string, std::string>>& labels);

/// The row of a serialised list of assumptions, added if it is not there and repaired if it is
/// damaged.
std::int64_t ledger_row(Connection& db, const std::string& body);

/// What a column of a revision holds: its name in statements that read one simulation, its row in
/// statements that read a page. RevisionNames turns the rows of a page into names.
enum class RevisionColumns { kNames, kRows };
/// Returns the columns of stored_simulation(), to be followed by the rest of a SELECT over
/// simulations.
std::string simulation_columns(RevisionColumns form);
inline constexpr int kRequestColumn = 8;
/// `names`: set for RevisionColumns::kRows, null for kNames.
StoredSimulation stored_simulation(const SQLite::Statement& query, RevisionNames* names);

std::optional<StoredSimulation> query_simulation(Connection& db, std::int64_t id);
std::optional<StoredSimulation> query_numbered_simulation(Connection& db,
                                                          const std::string& project,
                                                          std::int64_t number);
std::optional<StoredSimulation> query_simulation_of_request(Connection& db,
                                                            const std::string& project,
                                                            const std::string& request_id);

/// Returns true if insert_simulation() would find an earlier request or a result.
bool is_known_or_served(Connection& db, const NewSimulation& simulation);
/// As Store::add_simulation.
AddOutcome insert_simulation(Connection& db, const NewSimulation& simulation, Microseconds now,
                             bool may_wait);

/// One step of the state machine, and what the row says afterwards.
struct StateChange {
  std::int64_t id = 0;
  StoredState to = StoredState::kQueued;
  Microseconds time = 0;
  std::optional<StoredState> from = {};  ///< empty: from whichever allows it
  std::string reason = {};               ///< of the event
  std::string error_reason = {};         ///< of FAILED
  std::string error_message = {};
  std::optional<std::int64_t> result = {};  ///< row, of SUCCEEDED
  bool cache_hit = false;
  bool attempt_is_lost = false;          ///< its worker died
  std::optional<int> attempt = {};       ///< empty: whichever it is
  std::optional<LeaseTerms> lease = {};  ///< of RUNNING
};

/// Changes the state and writes the event; nothing when the state does not allow it.
std::optional<StoredEvent> change_state(Connection& db, const StateChange& change);

/// As Store::result. Throws StoreError kDataLoss too.
std::optional<std::string> query_result(Connection& db, std::int64_t id);

// As Store::mark_running, mark_succeeded and requeue_unfinished.
std::optional<StoredEvent> start_simulation(Connection& db, std::int64_t id, Microseconds now,
                                            const ResultKey& key, const LeaseTerms& lease);
std::optional<StoredEvent> finish_simulation(Connection& db, std::int64_t id, Microseconds now,
                                             const NewResult& result, std::optional<int> attempt,
                                             const std::vector<CompressedColumn>& history);
std::vector<UnfinishedSimulation> requeue_lost(Connection& db, Microseconds now);
// As Store::mark_lost and extend_lease.
std::optional<StoredEvent> lose_attempt(Connection& db, std::int64_t id, int attempt,
                                        Microseconds now, const std::string& reason);
bool extend_lease(Connection& db, std::int64_t id, int attempt, Microseconds expire_time);

}  // namespace tribodyn::server
