#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <utility>
#include <vector>

#include "server/application/errors.h"
#include "server/application/list_filter.h"
#include "server/application/paging.h"
#include "server/application/simulation_lookup.h"
#include "server/application/simulations.h"
#include "server/application/stored_messages.h"
#include "server/application/streams.h"

namespace tribodyn::server {
namespace {

using std::chrono::steady_clock;

constexpr double kRetrySeconds = 10;  // for a place among the watches without names

/// A simulation whose end the watch has not reported.
struct Watched {
  std::int64_t id = 0;      ///< its row
  std::int64_t number = 0;  ///< in its project
  // After the last event that was reported; at first as the simulation is, which a client that has
  // all events has received.
  StoredState state = StoredState::kQueued;
  int attempt = 1;
  std::int64_t told = 0;  ///< sequence number of that event
};

/// A running simulation of a watch.
struct Running {
  std::shared_ptr<ProgressChannel> channel;  ///< null: it has none yet, or has ended since
  std::uint64_t told_progress = 0;
};

/// The simulations of a watch, sorted by row.
class Simulations {
 public:
  void add(const Watched& watched) {
    const auto place = place_of(watched.id);
    if (place == all_.end() || place->id != watched.id) all_.insert(place, watched);
  }
  void remove(std::int64_t id) {
    const auto place = place_of(id);
    if (place != all_.end() && place->id == id) all_.erase(place);
  }
  /// Returns null if there is none of this row.
  Watched* find(std::int64_t id) {
    const auto place = place_of(id);
    return place != all_.end() && place->id == id ? &*place : nullptr;
  }
  const std::vector<Watched>& all() const { return all_; }

 private:
  std::vector<Watched>::iterator place_of(std::int64_t id) {
    return std::lower_bound(all_.begin(), all_.end(), id,
                            [](const Watched& each, std::int64_t row) { return each.id < row; });
  }

  std::vector<Watched> all_;
};

/// What a watch begins with.
struct Beginning {
  Simulations simulations;
  std::map<std::int64_t, Running> running = {};  ///< by row
  /// Those of `simulations` that have not ended.
  std::vector<std::shared_ptr<ProgressChannel>> channels = {};

  void add(const Watched& watched, std::shared_ptr<ProgressChannel> channel) {
    simulations.add(watched);
    if (watched.state == StoredState::kRunning) running[watched.id] = {channel};
    if (channel != nullptr) channels.push_back(std::move(channel));
  }
};

/// Events of named simulations or, without names, of those of a project that satisfy restrictions,
/// of all if there are none. Events come in the order of their numbers and each once; between them
/// the latest progress and, if nothing happens, heartbeats. Holds one page of events at most.
class Watch : public MessageSource<v1::SimulationEvent> {
 public:
  /// Of named simulations: those that may still have events after number `after`.
  Watch(Application& application, Beginning named, std::int64_t after, const CallContext& call)
      : store_(application.store),
        jobs_(application.jobs),
        limits_{.cancelled = call.limits.cancelled},
        project_(call.project),
        is_named_(true),
        watched_(std::move(named.simulations)),
        running_(std::move(named.running)),
        channels_(std::move(named.channels)),
        told_through_(after) {}
  /// Of those of the project of the call that satisfy all restrictions; `running` are those that
  /// run now.
  Watch(Application& application, std::vector<Restriction> restrictions, Beginning running,
        std::shared_ptr<void> place, std::int64_t after, const CallContext& call)
      : Watch(application, std::move(running), after, call) {
    is_named_ = false;
    place_ = std::move(place);
    restrictions_ = std::move(restrictions);
  }

  void observe(const std::weak_ptr<Observer>& observer) override {
    observer_ = observer;
    for (const auto& each : std::exchange(channels_, {})) each->observe(observer);
    if (!is_named_) store_.observe(observer);
    jobs_.scheduler().wake(observer);
  }
  bool follows_changes() const override { return true; }

  Step next(v1::SimulationEvent& out) override {
    if (is_over()) return Step::kEnd;
    out.Clear();
    const bool is_quiet = steady_clock::now() - last_message_ >= jobs_.heartbeat();
    if (events_.empty()) {
      const std::int64_t before = told_through_;
      if (may_have_more_ || store_.changes() != seen_changes_ || is_quiet) {
        read_events(is_quiet);
      }
      if (events_.empty() && may_have_more_ && told_through_ > before) {
        tell_heartbeat(out);  // after a window without any match: says how far the watch has come
        return Step::kMessage;
      }
    }
    if (!events_.empty()) {
      tell_event(events_.back(), out);
      events_.pop_back();
      if (events_.empty()) events_.shrink_to_fit();  // a watch lasts long
      return Step::kMessage;
    }
    if (tell_progress(out)) return Step::kMessage;
    if (!is_quiet) return Step::kWait;
    tell_heartbeat(out);
    return Step::kMessage;
  }

  bool may_continue() const override {
    return is_over() || !events_.empty() || may_have_more_ ||
           std::any_of(running_.begin(), running_.end(), [](const auto& each) {
             const Running& running = each.second;
             return running.channel == nullptr ||
                    running.channel->progress_number() != running.told_progress;
           });
  }

 private:
  bool is_over() const { return is_named_ && watched_.all().empty(); }

  /// Reads the next page of events, from memory or, if the memory does not reach back so far or
  /// `is_quiet`, from the database: a heartbeat also finds events on disk that nothing announced.
  void read_events(bool is_quiet) {
    seen_changes_ = store_.changes();
    if (!is_quiet) {
      auto recent = store_.recent_events(project_, told_through_, limits_);
      if (recent && is_named_) {
        std::erase_if(recent->events, [this](const StoredEvent& each) {
          return watched_.find(each.simulation) == nullptr;
        });
      }
      // Whether a simulation satisfies restrictions, only the database can say.
      if (recent && (restrictions_.empty() || recent->events.empty())) {
        return take(*std::move(recent));
      }
    }
    EventQuery query{.project = project_, .restrictions = restrictions_, .after = told_through_};
    if (is_named_) {
      for (const Watched& each : watched_.all()) query.simulations.push_back(each.id);
    }
    take(store_.events(query, limits_));
  }

  void take(EventPage page) {
    may_have_more_ = page.more;
    if (page.events.empty()) told_through_ = page.through;
    read_through_ = page.through;
    events_ = std::move(page.events);
    std::ranges::reverse(events_);
  }

  void tell_event(const StoredEvent& event, v1::SimulationEvent& out) {
    // The last event of a page stands for all that was looked at.
    told_through_ = events_.size() == 1 ? read_through_ : event.number;
    set_common(name_of(event), event.state, event.attempt, event.sequence, out);
    out.set_event_number(event.number);
    *out.mutable_time() = timestamp_of(event.time);
    out.set_kind(event.state == StoredState::kDeleted ? v1::SimulationEvent::DELETED
                                                      : v1::SimulationEvent::STATE_CHANGE);
    out.set_reason(event.reason);
    if (event.state == StoredState::kSucceeded) out.set_progress_fraction(1);
    if (event.state == StoredState::kFailed) set_error(event.simulation, out);
    note(event);
  }

  /// Begins or ends to watch the progress of the simulation of an event.
  void note(const StoredEvent& event) {
    running_.erase(event.simulation);
    if (has_ended(event.state) || event.state == StoredState::kDeleted) {
      return watched_.remove(event.simulation);
    }
    const bool runs = event.state == StoredState::kRunning;
    if (Watched* found = watched_.find(event.simulation)) {
      found->state = event.state;
      found->attempt = event.attempt;
      found->told = event.sequence;
    } else if (runs) {
      watched_.add(
          {event.simulation, event.simulation_number, event.state, event.attempt, event.sequence});
    }
    if (runs) running_[event.simulation] = {find_channel(event.simulation)};
  }

  /// Of a named simulation the channel that it had at the beginning is observed already.
  std::shared_ptr<ProgressChannel> find_channel(std::int64_t id) {
    auto out = jobs_.channel(id);
    if (out != nullptr && !is_named_) out->observe(observer_);
    return out;
  }

  void set_error(std::int64_t id, v1::SimulationEvent& out) {
    const auto failed = store_.simulation(id, limits_);
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

  /// Describes a simulation as it is after the last event that was reported.
  void set_present(const Watched& watched, const Progress* progress, v1::SimulationEvent& out) {
    set_common(simulation_name(project_, watched.number), watched.state, watched.attempt,
               watched.told, out);
    if (progress == nullptr) return;
    out.set_progress_fraction(progress->fraction);
    out.set_stage(progress->stage);
    if (progress->remaining_seconds) out.set_remaining_seconds(*progress->remaining_seconds);
  }

  /// Reports the progress of one simulation, the next one in turn. Returns false if there is none.
  bool tell_progress(v1::SimulationEvent& out) {
    auto each = running_.upper_bound(last_in_turn_);
    for (std::size_t i = 0; i < running_.size(); ++i, ++each) {
      if (each == running_.end()) each = running_.begin();
      auto& [id, running] = *each;
      if (running.channel == nullptr) running.channel = find_channel(id);
      if (running.channel == nullptr ||
          running.channel->progress_number() == running.told_progress) {
        continue;
      }
      const Watched& watched = *watched_.find(id);
      const ProgressChannel::Latest latest = running.channel->latest();
      if (latest.sequence > watched.told) continue;  // progress after an event that comes first
      last_in_turn_ = id;
      running.told_progress = latest.progress_number;
      set_present(watched, &latest.progress, out);
      out.set_kind(v1::SimulationEvent::PROGRESS);
      return true;
    }
    return false;
  }

  /// Of a single named simulation it tells the progress again.
  void tell_heartbeat(v1::SimulationEvent& out) {
    last_message_ = steady_clock::now();
    if (is_named_ && watched_.all().size() == 1) {
      const Watched& watched = watched_.all().front();
      const auto running = running_.find(watched.id);
      if (running != running_.end() && running->second.channel != nullptr) {
        const ProgressChannel::Latest latest = running->second.channel->latest();
        running->second.told_progress = latest.progress_number;
        set_present(watched, &latest.progress, out);
      } else {
        set_present(watched, nullptr, out);
      }
    }
    out.set_kind(v1::SimulationEvent::HEARTBEAT);
    out.set_event_number(told_through_);
  }

  Store& store_;
  SimulationJobs& jobs_;
  std::shared_ptr<void> place_;  // among the watches without names, else null
  const CallLimits limits_;      // the end of the stream is its transport's
  const std::string project_;
  bool is_named_;
  std::vector<Restriction> restrictions_;
  Simulations watched_;                                     // without names: those that run
  std::map<std::int64_t, Running> running_;                 // by row; each is in watched_
  std::vector<std::shared_ptr<ProgressChannel>> channels_;  // until observe()
  std::weak_ptr<Observer> observer_;
  std::vector<StoredEvent> events_;  // read but not sent, the latest first
  bool may_have_more_ = true;        // there are more events, or none was read yet
  std::uint64_t seen_changes_ = 0;   // Store::changes() before the last read
  std::int64_t told_through_;        // all events up to this number were sent
  std::int64_t read_through_ = 0;    // the same after events_ are sent
  std::int64_t last_in_turn_ = 0;    // row of the simulation whose progress was sent last
  steady_clock::time_point last_message_ = steady_clock::now();
};

using Source = std::shared_ptr<MessageSource<v1::SimulationEvent>>;

Watched watched(const StoredSimulation& now) {
  return {now.id, now.number, now.state, now.attempt, now.sequence};
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

/// Adds the deletion of a simulation that no longer exists, if it comes after number `after`.
/// Returns false if the client cannot have heard of such a simulation.
bool add_deleted(Application& application, std::int64_t number, std::int64_t after,
                 const CallContext& call, Beginning& beginning) {
  if (after == 0) return false;
  const auto deletion = application.store.deletion(call.project, number, call.limits);
  if (deletion && deletion->number > after) {
    beginning.simulations.add({.id = deletion->simulation, .number = number});
  }
  return deletion.has_value();
}

Outcome<Source> watch_named(Application& application, const v1::WatchSimulationsRequest& request,
                            const CallContext& call) {
  Violations violations;
  std::vector<std::int64_t> numbers;
  for (int i = 0; i < request.names_size(); ++i) {
    const auto number = simulation_id(request.names(i));
    numbers.push_back(number.value_or(0));
    if (number) continue;
    violations.push_back(
        {fmt::format("names[{}]", i), "not a name of the form \"simulations/{id}\", id a number"});
  }
  if (!violations.empty()) return invalid(violations);
  const std::int64_t after = request.after_event_number();
  auto opened = application.jobs.watch(call.project, numbers, call.limits);
  Beginning beginning;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto& now = opened.states[i];
    if (!now) {
      if (add_deleted(application, numbers[i], after, call, beginning)) continue;
      return does_not_exist(request.names(static_cast<int>(i)));
    }
    if (has_ended(now->state) && after > 0 && now->event_number <= after) continue;
    beginning.add({now->id, numbers[i], now->state, now->attempt, now->sequence},
                  std::move(opened.channels[i]));
  }
  return Source(std::make_shared<Watch>(application, std::move(beginning), after, call));
}

Outcome<Source> watch_project(Application& application, const v1::WatchSimulationsRequest& request,
                              const CallContext& call) {
  Violations violations;
  SimulationQuery running{
      .project = call.project,
      .restrictions = parse_job_filter(request.filter(), kSimulations, violations)};
  for (const Restriction& each : running.restrictions) {
    if (each.key == "state" || each.key == "end_time" || each.key == "pinned") {
      violations.push_back(
          {"filter", each.key + " changes with events; filter the events instead"});
    }
  }
  if (!violations.empty()) return invalid(violations);
  std::shared_ptr<void> place =
      application.project_watches.take(call.grant->principal, call.project);
  if (!place) {
    return exhausted(v1::ERROR_REASON_TOO_MANY_STREAMS,
                     fmt::format("{} watches without names may be open, three quarters of them by "
                                 "one principal or of one project; try again in {} s",
                                 kMostProjectWatches, kRetrySeconds),
                     kRetrySeconds);
  }
  std::vector<Restriction> restrictions = running.restrictions;
  running.restrictions.push_back(
      {"state", Restriction::Comparison::kEqual, std::int64_t{v1::Simulation::RUNNING}});
  running.limit = 1000;
  running.byte_limit = kMaximumPageBytes;
  Beginning beginning;
  for (const StoredSimulation& each : application.store.simulations(running, call.limits).rows) {
    auto opened = application.jobs.watch(each.id, call.limits);
    if (!opened || opened->simulation.state != StoredState::kRunning) continue;
    beginning.add(watched(opened->simulation), std::move(opened->channel));
  }
  return Source(std::make_shared<Watch>(application, std::move(restrictions), std::move(beginning),
                                        std::move(place), request.after_event_number(), call));
}

}  // namespace

StreamOutcome<v1::SimulationEvent> watch_simulations(Application& application,
                                                     const v1::WatchSimulationsRequest& request,
                                                     const CallContext& call) {
  if (request.names_size() > 0 && !request.filter().empty()) {
    return invalid({{"filter", "stands beside names; allowed: one of the two"}});
  }
  if (auto refused = unresumable(application.store, request.after_event_number(), call)) {
    return *std::move(refused);
  }
  return request.names_size() > 0 ? watch_named(application, request, call)
                                  : watch_project(application, request, call);
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
  Beginning beginning;
  if (!has_ended(simulation.state) || after < simulation.sequence) {
    beginning.add(watched(simulation), std::move(opened->channel));
  }
  std::int64_t number = 0;
  if (after > 0) {
    const auto last = application.store.next_event(simulation.id, after - 1, call.limits);
    if (!last) return does_not_exist(request.name());
    number = last->number;
  }
  return Source(std::make_shared<Watch>(application, std::move(beginning), number, call));
}

}  // namespace tribodyn::server
