#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/storage/life_cycle.h"
#include "server/storage/stored_resource.h"
#include "server/storage/times.h"

namespace tribodyn::server {

/// What a result is kept under: whoever has an equal key gets it bit for bit.
struct ResultKey {
  std::string input_hash;     ///< SHA-256, 64 hex digits
  std::string model_version;  ///< core/version.h
  std::string platform;       ///< of the processor that computes (platform.h); never empty
};

/// A simulation to be stored.
struct NewSimulation {
  std::string request;  ///< serialised Simulation
  ResultKey key;
  std::string ledger = {};  ///< serialised SimulationResult, assumptions and input warnings only
  std::string request_id = {};    ///< empty: none
  std::string request_hash = {};  ///< of all that the client stated
  bool is_forced = false;
  std::optional<Microseconds> deadline_time = {};
  std::string client = {};  ///< on whose behalf
  double cost_seconds = 0;  ///< estimated, of one processor
  std::vector<std::pair<std::string, std::string>> labels = {};
  // The revisions it rests on, "lubricants/1@2"; each exists or is empty.
  std::string lubricant_revision = {};
  std::string gear_set_revision = {};
  std::string surface_revision = {};
  std::string vehicle_revision = {};
};

struct StoredSimulation {
  std::int64_t id = 0;
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  std::int64_t sequence = 0;  ///< of its latest event
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
  double cost_seconds = 0;
  bool cache_hit = false;
  std::string input_hash;
  std::string error_reason;
  std::string error_message;
  // What it rests on, as above; empty where that is not known.
  std::string lubricant_revision;
  std::string gear_set_revision;
  std::string surface_revision;
  std::string vehicle_revision;
};

/// Which simulations are listed, by time of creation and, of equal ones, by id.
struct SimulationQuery {
  /// All of them hold: "state" as its number, "lubricant", "create_time", "labels.KEY".
  std::vector<Restriction> restrictions = {};
  bool ascending = false;
  struct Place {
    Microseconds create_time = 0;
    std::int64_t id = 0;
  };
  std::optional<Place> after = {};
  int limit = 0;
  std::size_t byte_limit = 0;  ///< of requests; a page holds at least one row
};

/// A change of state as it is kept.
struct StoredEvent {
  std::int64_t sequence = 0;
  Microseconds time = 0;
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  std::string reason;  ///< why an attempt did not end; empty otherwise
  /// When the attempt began. Only in what a change of state returns; it is not kept with the event.
  std::optional<Microseconds> start_time = {};
};

struct StoredColumn {
  std::string name;
  std::vector<double> values;
};

/// A column as it goes to disk: its levels (pyramid.h), each in compressed blocks.
struct CompressedColumn {
  std::string name;
  std::int64_t rows = 0;
  std::vector<std::vector<std::string>> levels;
};

/// A simulation that waits.
struct Waiting {
  std::int64_t id = 0;
  int lost_attempts = 0;
  std::optional<Microseconds> deadline_time;
  std::string client;
  double cost_seconds = 0;
};

/// What became of a request to add a simulation.
struct Added {
  enum class Kind {
    kQueued,
    kServed,          ///< SUCCEEDED at once: equal inputs have a result
    kRepeated,        ///< an earlier request of the same id and hash made it
    kRequestIdTaken,  ///< an earlier request of the same id but another hash made it
    kNoPlace,         ///< it would have had to wait; nothing was added
  };
  Kind kind = Kind::kQueued;
  std::int64_t id = 0;
  /// The simulation `id` as it is in the store once this is committed; empty with kNoPlace.
  StoredSimulation stored = {};
};

/// What a study came to.
struct NewResult {
  ResultKey key;
  std::string body;  ///< serialised SimulationResult without assumptions
  std::vector<StoredColumn> history = {};
};

}  // namespace tribodyn::server
