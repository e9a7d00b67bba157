#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace tribodyn::server {

/// A job up to this estimate is interactive: somebody is looking at it [s].
inline constexpr double kInteractiveSeconds = 1;

/// A job that waits.
struct QueuedJob {
  std::int64_t id = 0;
  std::string client = {};  ///< on whose behalf
  double cost_seconds = 0;  ///< estimated, of one processor
  bool alone = false;       ///< may be what killed the server: nothing runs beside it
  bool is_interactive() const { return cost_seconds <= kInteractiveSeconds; }
};

/// Who comes next. Between clients the one who has been served least (start-time fair queueing: a
/// client who comes back has no credit for the time away); of one client the job whose estimate,
/// added to what the client had been served when it came, is least: small ones first, and large
/// ones after as much other work as they are large. Not safe for concurrent access.
class FairQueue {
 public:
  void push(const QueuedJob& job);
  /// Takes out the next one; with `interactive_only` the next of these.
  std::optional<QueuedJob> pop(bool interactive_only);
  /// The same, left where it is.
  const QueuedJob* peek(bool interactive_only) const;
  bool erase(std::int64_t id);
  bool contains(std::int64_t id) const { return places_.contains(id); }

  std::size_t size() const { return places_.size(); }
  double cost_seconds() const { return cost_seconds_; }
  std::size_t size_of(const std::string& client) const;
  double cost_seconds_of(const std::string& client) const;

 private:
  /// Rank, then order of arrival.
  using Place = std::pair<double, std::int64_t>;
  struct Client {
    double served_seconds = 0;  ///< virtual time
    double cost_seconds = 0;    ///< of what waits
    std::map<Place, QueuedJob> interactive;
    std::map<Place, QueuedJob> bulk;
    std::size_t size() const { return interactive.size() + bulk.size(); }
  };
  using Clients = std::map<std::string, Client>;

  static const std::pair<const Place, QueuedJob>* first_of(const Client& client,
                                                           bool interactive_only);
  Clients::const_iterator next_client(bool interactive_only) const;
  void remove(Clients::iterator client, const Place& place, bool is_interactive);

  Clients clients_;  // those with jobs
  std::map<std::int64_t, std::tuple<std::string, Place, bool>> places_;
  double cost_seconds_ = 0;
  double now_ = 0;  // virtual time: what the client who came last had been served before
  std::int64_t arrivals_ = 0;
};

}  // namespace tribodyn::server
