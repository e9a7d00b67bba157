#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::crash {

using State = v1::Simulation::State;

/// A change of state as a client was told of it.
struct SeenEvent {
  std::int64_t sequence = 0;
  State state = v1::Simulation::STATE_UNSPECIFIED;
  int attempt = 0;
  bool operator==(const SeenEvent&) const = default;
};

/// What one watch told, beginning behind an event; it may have been taken up again many times.
struct SeenWatch {
  std::string name;
  std::int64_t after_sequence = 0;
  std::vector<SeenEvent> events;
};

/// All that clients were told while the server was killed again and again, and what is there in the
/// end. Only what was acknowledged is in it: a call that failed may or may not have had its effect.
struct History {
  struct Submission {
    std::string request_id;
    std::string name;
    std::string scene;  ///< its inputs, by the test's own name for them
  };
  struct Ended {
    std::string name;
    State state = v1::Simulation::STATE_UNSPECIFIED;
  };
  std::vector<Submission> submissions;
  std::vector<Ended> ended;  ///< seen to have ended so
  std::vector<SeenWatch> watches;

  /// In the end, each simulation as the server has it, by name, and all events of it.
  std::map<std::string, v1::Simulation> simulations;
  std::map<std::string, std::vector<SeenEvent>> events;
  /// What a server that nobody killed computes, by scene: the points, serialised.
  std::map<std::string, std::string> undisturbed;
  int requests = 0;  ///< distinct request_ids that were ever sent
};

/// A history that several clients write. Safe for concurrent access.
class Recorder {
 public:
  template <class Write>
  void write(const Write& action) {
    const std::lock_guard lock(mutex_);
    action(history_);
  }
  History& finished() { return history_; }  ///< once nobody writes any more

 private:
  std::mutex mutex_;
  History history_;
};

/// The points of a result: what must be the same bits whoever computed it when.
std::string result_bits(const v1::Simulation& simulation);

/// What must not be, one sentence each: an acknowledged simulation that is gone, two of one
/// request, two results of equal inputs, other bits than an undisturbed server's, an end that did
/// not last, events with gaps, that moved backwards, or that were told otherwise than they are.
std::vector<std::string> violations(const History& history);

}  // namespace tribodyn::crash
