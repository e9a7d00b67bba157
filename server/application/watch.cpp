#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <utility>

#include "server/application/errors.h"
#include "server/application/simulation_lookup.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"

namespace tribodyn::server {
namespace {

using google::protobuf::util::TimeUtil;
using std::chrono::steady_clock;

constexpr double kRetrySeconds = 10;  // for a place among the watches with a filter

/// What a watch knows of a simulation whose end it has not told.
struct Watched {
  std::shared_ptr<ProgressChannel> channel;
  std::string name;  ///< full name
  // After the last event that was told; at first as the simulation is, which a client that has all
  // events knows.
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  std::int64_t told = 0;  ///< sequence number of that event
  std::int64_t read = 0;  ///< sequence number up to which events were read from the store
  std::uint64_t told_progress = 0;
};
using Simulations = std::map<std::int64_t, Watched>;  // by row

/// Events of named simulations or, without names, of those of a project that satisfy restrictions.
/// Events come from the store in the order of their numbers and each once; between them the latest
/// progress and, if nothing happens, heartbeats. Holds one page of events at most.
class Watch : public MessageSource<v1::SimulationEvent> {
 public:
  /// Of named simulations; the rows in `watched` are those that may still have events after number
  /// `after`.
  Watch(Application& application, Simulations watched, std::int64_t after, const CallContext& call)
      : application_(application),
        limits_{.cancelled = call.limits.cancelled},
        project_(call.project),
        is_named_(true),
        watched_(std::move(watched)),
        told_through_(after) {}
  /// Of those of the project of the call that satisfy the restrictions; `running` are those that
  /// run now.
  Watch(Application& application, std::vector<Restriction> restrictions, Simulations running,
        std::shared_ptr<void> place, std::int64_t after, const CallContext& call)
      : Watch(application, std::move(running), after, call) {
    is_named_ = false;
    place_ = std::move(place);
    restrictions_ = std::move(restrictions);
  }

  void observe(const std::weak_ptr<Observer>& observer) override {
    observer_ = observer;
    for (auto& [id, each] : watched_) each.channel->observe(observer);
    if (!is_named_) application_.store.observe(observer);
    application_.jobs.wake(observer);
  }

  Step next(v1::SimulationEvent& out) override {
    if (is_over()) return Step::kEnd;
    out.Clear();
    const bool is_quiet = steady_clock::now() - last_message_ >= application_.jobs.heartbeat();
    if (events_.empty()) {
      // A heartbeat reads the store too: an event may be on disk although its writer was told that
      // the write failed.
      const std::int64_t before = told_through_;
      if (may_have_events() || is_quiet) read_events();
      if (events_.empty() && may_have_more_ && told_through_ > before) {
        tell_heartbeat(out);  // after a window without any match: says how far the watch has come
        return Step::kMessage;
      }
    }
    if (!events_.empty()) {
      tell_event(events_.front(), out);
      events_.pop_front();
      return Step::kMessage;
    }
    if (tell_progress(out)) return Step::kMessage;
    if (!is_quiet) return Step::kWait;
    tell_heartbeat(out);
    return Step::kMessage;
  }

 private:
  bool is_over() const { return is_named_ && watched_.empty(); }

  bool may_have_events() const {
    if (!is_named_ || may_have_more_) return true;
    return std::any_of(watched_.begin(), watched_.end(), [](const auto& each) {
      return each.second.channel->latest().sequence > each.second.read;
    });
  }

  void read_events() {
    EventQuery query{.project = project_, .restrictions = restrictions_, .after = told_through_};
    if (is_named_) {
      for (auto& [id, each] : watched_) {
        query.simulations.push_back(id);
        each.read = std::max(each.read, each.channel->latest().sequence);
      }
    }
    EventPage page = application_.store.events(query, limits_);
    may_have_more_ = page.more;
    if (page.events.empty()) told_through_ = page.through;
    read_through_ = page.through;
    events_.assign(page.events.begin(), page.events.end());
  }

  void tell_event(const StoredEvent& event, v1::SimulationEvent& out) {
    // The last event of a page stands for all that was looked at.
    told_through_ = events_.size() == 1 ? read_through_ : event.number;
    set_common(name_of(event), event.state, event.attempt, event.sequence, out);
    out.set_event_number(event.number);
    *out.mutable_time() = TimeUtil::MicrosecondsToTimestamp(event.time);
    out.set_kind(event.state == StoredState::kDeleted ? v1::SimulationEvent::DELETED
                                                      : v1::SimulationEvent::STATE_CHANGE);
    out.set_reason(event.reason);
    if (event.state == StoredState::kSucceeded) out.set_progress_fraction(1);
    if (event.state == StoredState::kFailed) set_error(event.simulation, out);
    note(event);
  }

  /// Begins or ends to watch the progress of the simulation of an event.
  void note(const StoredEvent& event) {
    if (has_ended(event.state) || event.state == StoredState::kDeleted) {
      watched_.erase(event.simulation);
      return;
    }
    const auto found = watched_.find(event.simulation);
    if (found != watched_.end()) {
      found->second.state = event.state;
      found->second.attempt = event.attempt;
      found->second.told = event.sequence;
    } else if (event.state == StoredState::kRunning) {
      auto opened = application_.jobs.watch(event.simulation, limits_);
      if (!opened || opened->simulation.sequence != event.sequence) return;  // an older attempt
      opened->channel->observe(observer_);
      watched_[event.simulation] = {std::move(opened->channel),
                                    name_of(event),
                                    event.state,
                                    event.attempt,
                                    event.sequence,
                                    event.sequence};
    }
  }

  void set_error(std::int64_t id, v1::SimulationEvent& out) {
    const auto failed = application_.store.simulation(id, limits_);
    if (!failed) return;
    out.mutable_error()->set_reason(failed->error_reason);
    out.mutable_error()->set_message(failed->error_message);
  }

  void set_common(const std::string& name, StoredState state, int attempt, std::int64_t sequence,
                  v1::SimulationEvent& out) {
    last_message_ = steady_clock::now();
    out.set_name(name);
    out.set_state(static_cast<v1::Simulation::State>(state));
    out.set_attempt(attempt);
    out.set_sequence(sequence);
    out.set_event_number(told_through_);
  }

  static void set_progress(const Watched& watched, const Progress& progress,
                           v1::SimulationEvent& out) {
    if (watched.state != StoredState::kRunning) return;
    out.set_progress_fraction(progress.fraction);
    out.set_stage(progress.stage);
    if (progress.remaining_seconds) out.set_remaining_seconds(*progress.remaining_seconds);
  }

  /// Tells the progress of one simulation, the next one in turn. Returns false if there is none.
  bool tell_progress(v1::SimulationEvent& out) {
    auto each = watched_.upper_bound(last_in_turn_);
    for (std::size_t i = 0; i < watched_.size(); ++i, ++each) {
      if (each == watched_.end()) each = watched_.begin();
      auto& [id, watched] = *each;
      if (watched.state != StoredState::kRunning) continue;
      const ProgressChannel::Latest latest = watched.channel->latest();
      if (latest.sequence > watched.read || latest.progress_number == watched.told_progress) {
        continue;
      }
      last_in_turn_ = id;
      watched.told_progress = latest.progress_number;
      set_common(watched.name, watched.state, watched.attempt, watched.told, out);
      set_progress(watched, latest.progress, out);
      out.set_kind(v1::SimulationEvent::PROGRESS);
      return true;
    }
    return false;
  }

  /// Of a single named simulation it tells the progress again.
  void tell_heartbeat(v1::SimulationEvent& out) {
    last_message_ = steady_clock::now();
    if (is_named_ && watched_.size() == 1) {
      Watched& watched = watched_.begin()->second;
      const ProgressChannel::Latest latest = watched.channel->latest();
      watched.told_progress = latest.progress_number;
      set_common(watched.name, watched.state, watched.attempt, watched.told, out);
      set_progress(watched, latest.progress, out);
    }
    out.set_kind(v1::SimulationEvent::HEARTBEAT);
    out.set_event_number(told_through_);
  }

  Application application_;
  std::shared_ptr<void> place_;  // of a filter, else null
  const CallLimits limits_;      // the end of the stream is its transport's
  const std::string project_;
  bool is_named_;
  std::vector<Restriction> restrictions_;
  Simulations watched_;
  std::weak_ptr<Observer> observer_;
  std::deque<StoredEvent> events_;  // read and not told
  bool may_have_more_ = true;       // the store has more, or was not asked yet
  std::int64_t told_through_;       // all events up to this number were told
  std::int64_t read_through_ = 0;   // the same once events_ are told
  std::int64_t last_in_turn_ = 0;   // row of the last simulation whose progress was told
  steady_clock::time_point last_message_ = steady_clock::now();
};

using Source = std::shared_ptr<MessageSource<v1::SimulationEvent>>;

Watched watched(SimulationJobs::Watched opened) {
  const StoredSimulation& now = opened.simulation;
  return {
      std::move(opened.channel), name_of(now), now.state, now.attempt, now.sequence, now.sequence};
}

/// Returns true if a simulation has an event after that number, or will have one.
bool has_events_after(Store& store, const StoredSimulation& simulation, std::int64_t number,
                      const CallLimits& limits) {
  if (!has_ended(simulation.state) || number == 0) return true;
  const auto last = store.next_event(simulation.id, simulation.sequence - 1, limits);
  return !last || last->number > number;  // without it: deleted meanwhile
}

/// Why a watch cannot resume after an event; nullopt if it can.
std::optional<google::rpc::Status> unresumable(Store& store, std::int64_t after,
                                               const CallContext& call) {
  const EventRange range = store.event_range(call.project, call.limits);
  if (after < 0 || after > range.latest) {
    return invalid({{"after_event_number", fmt::format("after_event_number = {}; allowed: 0 to {}",
                                                       after, range.latest)}});
  }
  if (after == 0 || after >= range.forgotten) return std::nullopt;
  return error(google::rpc::OUT_OF_RANGE, v1::ERROR_REASON_EVENTS_FORGOTTEN,
               fmt::format("deletions of simulations after event {} are no longer kept; list the "
                           "simulations and watch after the event_number of the list",
                           after),
               {{"after_event_number", std::to_string(after)},
                {"forgotten", std::to_string(range.forgotten)}});
}

/// Adds the simulation with this number, unless all its events up to the last one have numbers up
/// to `after`. Returns false if there is no such simulation.
bool add_named(Application& application, std::int64_t number, std::int64_t after,
               const CallContext& call, Simulations& simulations) {
  Store& store = application.store;
  const auto stored = store.numbered_simulation(call.project, number, call.limits);
  auto opened = stored ? application.jobs.watch(stored->id, call.limits) : std::nullopt;
  if (opened) {
    if (has_events_after(store, opened->simulation, after, call.limits)) {
      simulations[stored->id] = watched(std::move(*opened));
    }
    return true;
  }
  // Of one that was deleted since, the deletion is told to a client that resumes.
  if (after == 0) return false;
  const auto deletion = store.deletion(call.project, number, call.limits);
  if (deletion && deletion->number > after) {
    simulations[deletion->simulation] = {std::make_shared<ProgressChannel>(), name_of(*deletion)};
  }
  return deletion.has_value();
}

Outcome<Source> watch_named(Application& application, const v1::WatchSimulationsRequest& request,
                            const CallContext& call) {
  Violations violations;
  for (int i = 0; i < request.names_size(); ++i) {
    if (simulation_id(request.names(i))) continue;
    violations.push_back(
        {fmt::format("names[{}]", i), "not a name of the form \"simulations/{id}\", id a number"});
  }
  if (!violations.empty()) return invalid(violations);
  const std::int64_t after = request.after_event_number();
  Simulations simulations;
  for (const std::string& name : request.names()) {
    if (!add_named(application, *simulation_id(name), after, call, simulations)) {
      return does_not_exist(name);
    }
  }
  return Source(std::make_shared<Watch>(application, std::move(simulations), after, call));
}

/// Returns a place among kMostFilters, which is free again when the last copy is destroyed; null if
/// there is none.
std::shared_ptr<void> take_place(const std::shared_ptr<std::atomic<int>>& open) {
  if (++*open > kMostFilters) {
    --*open;
    return nullptr;
  }
  return {open.get(), [open](void*) { --*open; }};
}

Outcome<Source> watch_filtered(Application& application, const v1::WatchSimulationsRequest& request,
                               const CallContext& call) {
  Violations violations;
  SimulationQuery running{.project = call.project,
                          .restrictions = simulation_restrictions(request.filter(), violations)};
  for (const Restriction& each : running.restrictions) {
    if (each.key == "state" || each.key == "end_time" || each.key == "pinned") {
      violations.push_back(
          {"filter", each.key + " changes with events; filter the events instead"});
    }
  }
  if (!violations.empty()) return invalid(violations);
  std::shared_ptr<void> place = take_place(application.open_filters);
  if (!place) {
    return exhausted(v1::ERROR_REASON_TOO_MANY_STREAMS,
                     fmt::format("{} watches with a filter are open, which is the limit; try again "
                                 "in {} s",
                                 kMostFilters, kRetrySeconds),
                     kRetrySeconds);
  }
  std::vector<Restriction> restrictions = running.restrictions;
  running.restrictions.push_back(
      {"state", Restriction::Comparison::kEqual, std::int64_t{v1::Simulation::RUNNING}});
  running.limit = 1000;
  running.byte_limit = kMaximumPageBytes;
  Simulations simulations;
  for (const StoredSimulation& each : application.store.simulations(running, call.limits).rows) {
    auto opened = application.jobs.watch(each.id, call.limits);
    if (!opened || opened->simulation.state != StoredState::kRunning) continue;
    simulations[each.id] = watched(std::move(*opened));
  }
  return Source(std::make_shared<Watch>(application, std::move(restrictions),
                                        std::move(simulations), std::move(place),
                                        request.after_event_number(), call));
}

}  // namespace

StreamOutcome<v1::SimulationEvent> watch_simulations(Application& application,
                                                     const v1::WatchSimulationsRequest& request,
                                                     const CallContext& call) {
  if ((request.names_size() > 0) == !request.filter().empty()) {
    return invalid({{"names", "state either names or a filter"}});
  }
  if (auto refused = unresumable(application.store, request.after_event_number(), call)) {
    return *std::move(refused);
  }
  return request.names_size() > 0 ? watch_named(application, request, call)
                                  : watch_filtered(application, request, call);
}

StreamOutcome<v1::SimulationEvent> watch_simulation(Application& application,
                                                    const v1::WatchSimulationRequest& request,
                                                    const CallContext& call) {
  const auto found = find_simulation(application, request.name(), call);
  if (!found.ok()) return found.error();
  auto opened = application.jobs.watch(found.message().id, call.limits);
  if (!opened) return does_not_exist(request.name());
  const StoredSimulation simulation = opened->simulation;
  const std::int64_t after = request.after_sequence();
  if (after < 0 || after > simulation.sequence) {
    return invalid({{"after_sequence", fmt::format("after_sequence = {}; allowed: 0 to {}", after,
                                                   simulation.sequence)}});
  }
  Simulations simulations;
  if (!has_ended(simulation.state) || after < simulation.sequence) {
    simulations[simulation.id] = watched(std::move(*opened));
  }
  std::int64_t number = 0;
  if (after > 0) {
    const auto last = application.store.next_event(simulation.id, after - 1, call.limits);
    if (!last) return does_not_exist(request.name());
    number = last->number;
  }
  return Source(std::make_shared<Watch>(application, std::move(simulations), number, call));
}

}  // namespace tribodyn::server
