#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/storage/life_cycle.h"
#include "server/storage/stored_resource.h"
#include "server/storage/times.h"

namespace tribodyn::server {

/// Key of a stored result. Simulations of one project with equal keys share the result, bit for
/// bit.
struct ResultKey {
  std::string input_hash;     ///< SHA-256, 64 hex digits
  std::string model_version;  ///< core/version.h
  std::string platform;  ///< processor and C library of the computation (result_key.h); never empty
};

/// A simulation before it is stored.
struct NewSimulation {
  std::string project = kDefaultProject;
  std::string request;  ///< serialised Simulation
  ResultKey key;
  std::string ledger = {};  ///< serialised SimulationResult, assumptions and input warnings only
  std::string request_id = {};    ///< empty: none
  std::string request_hash = {};  ///< hash of everything that the client set
  bool is_forced = false;
  std::optional<Microseconds> deadline_time = {};
  std::string client = {};     ///< client that submitted it
  std::string principal = {};  ///< whose share of the processors pays for it
  int scheduling_class = 0;    ///< SchedulingClass
  double cost_seconds = 0;     ///< estimate, in seconds of one processor
  std::vector<std::pair<std::string, std::string>> labels = {};
  ResourceRevisions revisions = {};  ///< each exists in the project or is empty
};

struct StoredSimulation {
  std::int64_t id = 0;  ///< row, over all projects
  std::string project;
  std::int64_t number = 0;  ///< in its name; counts within the project
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  std::int64_t sequence = 0;  ///< number of its latest event
  Microseconds create_time = 0;
  std::optional<Microseconds> start_time;
  std::optional<Microseconds> end_time;
  std::optional<Microseconds> deadline_time;
  std::string request;     ///< serialised Simulation
  std::string request_id;  ///< empty: none
  std::string request_hash;
  bool is_forced = false;
  bool is_pinned = false;
  std::string client;
  std::string principal;
  int scheduling_class = 0;
  double cost_seconds = 0;
  bool cache_hit = false;
  std::string input_hash;
  std::string error_reason;
  std::string error_message;
  ResourceRevisions revisions;
};

/// Returns the full name of a stored simulation.
inline std::string name_of(const StoredSimulation& simulation) {
  return simulation_name(simulation.project, simulation.number);
}

/// Selects and orders simulations: by time of creation, and equal times by number.
struct SimulationQuery {
  std::string project = kDefaultProject;
  /// All must be true. Keys: those of property_fields("simulations"), "state" as its number, and
  /// "labels.KEY".
  std::vector<Restriction> restrictions = {};
  bool ascending = false;
  struct Cursor {
    Microseconds create_time = 0;
    std::int64_t number = 0;
  };
  std::optional<Cursor> after = {};
  int limit = 0;
  std::size_t byte_limit = 0;  ///< bytes of requests; a page has at least one row
  bool counts_all = false;  ///< sets Page::total; only of a query from the start, without `after`
};

/// What a watch needs of a simulation.
struct SimulationState {
  std::int64_t id = 0;  ///< row, over all projects
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  std::int64_t sequence = 0;      ///< number of its latest event among those of the simulation
  std::int64_t event_number = 0;  ///< the same among those of the project
};

/// A stored change of state, or the deletion of a simulation.
struct StoredEvent {
  std::int64_t number = 0;      ///< among the events of its project; grows with each commit
  std::int64_t simulation = 0;  ///< row, over all projects
  std::int64_t sequence = 0;    ///< number among the events of the simulation
  Microseconds time = 0;
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  std::string reason;  ///< why an attempt did not finish; else empty
  // Of the name of the simulation. Set in events that are read, and to write a deletion.
  std::string project = {};
  std::int64_t simulation_number = 0;
  /// Start of the attempt. Set only in the event that a change of state returns; not stored.
  std::optional<Microseconds> start_time = {};
};

struct StoredColumn {
  std::string name;
  std::vector<double> values;
};

/// A column in the form of the disk: its levels (pyramid.h), each in compressed blocks.
struct CompressedColumn {
  std::string name;
  std::int64_t rows = 0;
  std::vector<std::vector<std::string>> levels;
};

/// Returns the full name of the simulation of an event that was read.
inline std::string name_of(const StoredEvent& event) {
  return simulation_name(event.project, event.simulation_number);
}

/// Selects events after number `after`: of the simulations with these ids or, if there is none, of
/// those of the project that satisfy all restrictions now; deletions satisfy every restriction.
struct EventQuery {
  std::vector<std::int64_t> simulations = {};
  std::string project = kDefaultProject;
  std::vector<Restriction> restrictions = {};
  std::int64_t after = 0;
};

/// Events in the order of their numbers. All selected events up to number `through` are in it.
struct EventPage {
  std::vector<StoredEvent> events;
  std::int64_t through = 0;
  bool more = false;  ///< there may be further ones already
};

/// The numbers of the events of a project that the database keeps.
struct EventRange {
  std::int64_t latest = 0;
  /// Deletions up to this number have been forgotten: whoever knows nothing later may have missed
  /// some.
  std::int64_t forgotten = 0;
};

/// Who computes a simulation, and until when the attempt counts as alive.
struct LeaseTerms {
  std::string worker = kLocalWorker;
  Microseconds expire_time = 0;
  /// The server's own process; its leases end with it.
  static constexpr char kLocalWorker[] = "local";
};

/// A simulation that has not ended.
struct UnfinishedSimulation {
  std::int64_t id = 0;
  int attempt = 1;
  int lost_attempts = 0;
  std::optional<Microseconds> deadline_time;
  std::string principal;
  int scheduling_class = 0;
  double cost_seconds = 0;
  std::optional<LeaseTerms> lease = {};  ///< set if a worker of another process runs it
};

/// Outcome of Store::add_simulation().
struct AddOutcome {
  enum class Kind {
    kQueued,
    kServed,          ///< SUCCEEDED at once: equal inputs have a result
    kRepeated,        ///< an earlier request with the same id and hash added it
    kRequestIdTaken,  ///< an earlier request with the same id and another hash added it
    kNoPlace,         ///< the queue is full; nothing was added
  };
  Kind kind = Kind::kQueued;
  std::int64_t id = 0;
  /// The simulation `id` as stored; empty with kNoPlace.
  StoredSimulation stored = {};
};

/// Result of a study before it is stored.
struct NewResult {
  ResultKey key;
  std::string body;  ///< serialised SimulationResult without assumptions
  std::vector<StoredColumn> history = {};
};

}  // namespace tribodyn::server
