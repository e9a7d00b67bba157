#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::crash {

using State = v1::Simulation::State;

/// A change of state, as a client read it from a watch.
struct SeenEvent {
  std::int64_t sequence = 0;
  State state = v1::Simulation::STATE_UNSPECIFIED;
  int attempt = 0;
  bool operator==(const SeenEvent&) const = default;
};

/// All events that one watch delivered. The client may have resumed the watch many times.
struct SeenWatch {
  std::string name;
  std::int64_t after_sequence = 0;  ///< the watch was asked for events after this one
  std::vector<SeenEvent> events;
};

/// Everything that clients read while the server was killed again and again, and everything that
/// the server holds in the end. A call that failed is not in it: it may or may not have had an
/// effect.
struct History {
  /// A request that the server acknowledged.
  struct Submission {
    std::string request_id;
    std::string name;   ///< of the simulation, in the acknowledgement
    std::string scene;  ///< the test's own name for the inputs
  };
  struct Ended {
    std::string name;
    State state = v1::Simulation::STATE_UNSPECIFIED;
  };
  /// A revision of a resource that the server acknowledged.
  struct Revision {
    std::string name;     ///< "lubricants/{id}@{revision}"
    std::string content;  ///< its display name; no two updates of a resource send the same
  };
  /// Resources that a client sent in one batch.
  struct Batch {
    std::vector<std::string> names;
    bool is_acknowledged = false;
  };
  std::vector<Submission> submissions;
  std::vector<Ended> ended;  ///< simulations that a client saw in a final state
  std::vector<SeenWatch> watches;
  std::vector<std::string> refusals;  ///< sentences; clients send nothing that is to be refused
  std::vector<Revision> revisions;
  std::vector<Batch> batches;  ///< acknowledged or not
  int requests = 0;            ///< distinct request_ids that clients sent, acknowledged or not

  /// What the server holds in the end, by the simulation's name.
  std::map<std::string, v1::Simulation> simulations;
  std::map<std::string, std::vector<SeenEvent>> events;
  std::map<std::string, std::string> histories;       ///< bytes of all columns, where there are any
  std::map<std::string, std::string> kept_revisions;  ///< contents by the revision's name
  /// result_bits() of each scene from a server that nobody killed, with the bytes of its history.
  std::map<std::string, std::string> undisturbed;
};

/// A history that several clients write. Safe for concurrent access.
class Recorder {
 public:
  template <class Write>
  void write(const Write& action) {
    const std::lock_guard lock(mutex_);
    action(history_);
  }
  /// Requires that no other thread writes any more.
  History& finished() { return history_; }

 private:
  std::mutex mutex_;
  History history_;
};

/// The part of a result that equal inputs determine bit for bit: all but the assumptions, which
/// belong to the request, the platform, and the input hash, which violations() compares by itself.
std::string result_bits(const v1::Simulation& simulation);

/// Returns one sentence for each promise of the server that the history breaks:
/// - an acknowledged simulation exists, belongs to the request that the acknowledgement answered,
///   and is the only one of that request; no request makes two simulations;
/// - every simulation ends, stays as it ended, and fails only because the server died repeatedly or
///   its deadline was over;
/// - equal inputs have equal results, a result belongs to the simulation's own inputs, and it has
///   the same bits as on a server that nobody killed;
/// - events are numbered without gaps, only move forward, end in the simulation's state, and no
///   client was sent an event that the server does not hold;
/// - no client is refused anything;
/// - an acknowledged revision of a resource exists as it was sent, no update makes two revisions,
/// and
///   of a batch all resources exist or none; of an acknowledged one all.
std::vector<std::string> violations(const History& history);

}  // namespace tribodyn::crash
