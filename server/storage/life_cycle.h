#pragma once

namespace tribodyn::server {

/// States of a simulation as stored; the numbers are those of Simulation.State. kDeleted is that of
/// an event only: a deleted simulation has no row. A simulation is queued, runs and ends. It is
/// queued again, as a further attempt, only when its server stops or crashes. A queued simulation
/// may end without running: cancelled, after its deadline, or because equal inputs have a result by
/// then. The trigger states_move_forward (schema_texts.h) enforces that.
enum class StoredState {
  kDeleted = 0,
  kQueued = 1,
  kRunning = 2,
  kSucceeded = 3,
  kFailed = 4,
  kCancelled = 5
};

/// Returns true if the state is final.
inline bool has_ended(StoredState state) { return state >= StoredState::kSucceeded; }

/// Number of attempts that may end with a crash of the server before the simulation is considered
/// its cause and fails.
inline constexpr int kMaximumLostAttempts = 3;

}  // namespace tribodyn::server
