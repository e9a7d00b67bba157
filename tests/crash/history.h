#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/crash/campaign_history.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::crash {

using State = v1::Simulation::State;

/// A change of state that a client read from a watch.
struct SeenEvent {
  std::int64_t sequence = 0;
  State state = v1::Simulation::STATE_UNSPECIFIED;
  int attempt = 0;
  bool operator==(const SeenEvent&) const = default;
};

/// All events of one watch. The client may have resumed it many times.
struct SeenWatch {
  std::string name;
  std::int64_t after_sequence = 0;  ///< the client asked for events after this one
  std::vector<SeenEvent> events;
};

/// Everything that clients read while the server was killed repeatedly, and all data of the server
/// at the end. Failed calls are not included: they may or may not have had an effect.
struct History {
  /// A request that the server acknowledged.
  struct Submission {
    std::string request_id;
    std::string name;   ///< name of the simulation in the acknowledgement
    std::string scene;  ///< name of the inputs in the test
  };
  struct Ended {
    std::string name;
    State state = v1::Simulation::STATE_UNSPECIFIED;
  };
  /// A revision of a resource that the server acknowledged.
  struct Revision {
    std::string name;     ///< "lubricants/{id}@{revision}"
    std::string content;  ///< its display name; it differs in all updates of a resource
  };
  /// Resources that a client sent in one batch.
  struct Batch {
    std::vector<std::string> names;
    bool is_acknowledged = false;
  };
  std::vector<Submission> submissions;
  std::vector<Ended> ended;  ///< simulations that a client saw in a final state
  std::vector<SeenWatch> watches;
  std::vector<std::string> refusals;  ///< sentences; clients send only valid requests
  std::vector<Revision> revisions;
  std::vector<Batch> batches;  ///< acknowledged or not
  int requests = 0;            ///< distinct request_ids that clients sent, acknowledged or not

  /// Simulations of the server at the end, by name.
  std::map<std::string, v1::Simulation> simulations;
  std::map<std::string, std::vector<SeenEvent>> events;
  std::map<std::string, std::string> histories;       ///< bytes of all columns, if there are any
  std::map<std::string, std::string> kept_revisions;  ///< contents by the revision's name
  /// result_bits() and history bytes of each scene from a server that was not killed.
  std::map<std::string, std::string> undisturbed;

  CampaignHistory campaigns;
};

/// A history that several clients write. Safe for concurrent access.
class Recorder {
 public:
  template <class Write>
  void write(const Write& action) {
    const std::lock_guard lock(mutex_);
    action(history_);
  }
  /// Returns the history. Requires that no other thread writes any more.
  History& finished() { return history_; }

 private:
  std::mutex mutex_;
  History history_;
};

/// Returns the part of a result that equal inputs determine bit for bit. Left out are the
/// assumptions, which belong to the request, the platform, and the input hash, which violations()
/// compares separately.
std::string result_bits(const v1::Simulation& simulation);

/// Returns one sentence for each promise of the server that the history breaks:
/// - an acknowledged simulation exists, belongs to the acknowledged request, and is the only
///   simulation of that request; no request makes two simulations;
/// - every simulation ends, keeps its final state, and fails only because the server died
///   repeatedly or its deadline passed;
/// - equal inputs have equal results, a result belongs to the inputs of its simulation, and it has
///   the same bits as on a server that was not killed;
/// - events are numbered without gaps, only move forward, end in the simulation's state, and the
///   server has every event that it sent to a client;
/// - no client is refused anything;
/// - an acknowledged revision of a resource exists with its content, no update makes two revisions,
///   and of a batch all resources or none exist, of an acknowledged batch all;
/// - those of campaign_violations().
std::vector<std::string> violations(const History& history);

}  // namespace tribodyn::crash
