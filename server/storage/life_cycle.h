#pragma once

namespace tribodyn::server {

/// States as on disk; the numbers are those of Simulation.State.
enum class StoredState { kQueued = 1, kRunning = 2, kSucceeded = 3, kFailed = 4, kCancelled = 5 };

/// True when nothing more will happen to the simulation.
inline bool has_ended(StoredState state) { return state >= StoredState::kSucceeded; }

/// The whole state machine: a simulation waits, runs and ends. It goes back to waiting, as a
/// further attempt, only when its server stops or dies; waiting, it may end without running
/// (cancelled, too late, or equal inputs have a result by then). The trigger states_move_forward of
/// schema.cpp says the same.
inline bool may_follow(StoredState from, StoredState to) {
  if (from == StoredState::kQueued) return to != StoredState::kQueued;
  return from == StoredState::kRunning && to != StoredState::kRunning;
}

/// Attempts that may end with the server's process before the simulation is held to be the cause.
inline constexpr int kMaximumLostAttempts = 3;

}  // namespace tribodyn::server
