#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <utility>

#include "client/cpp/library/services.h"

namespace tribodyn::client {
namespace {

using std::chrono::milliseconds;

constexpr std::chrono::duration<double> kLongestWatch = std::chrono::seconds(60);
constexpr milliseconds kBetweenWatches(250);
constexpr std::size_t kMostWatched = 1000;  // simulations that the server watches in one stream
constexpr int kWatchRetries =
    20;  // about 40 s in all: long enough for a server that drains and restarts

}  // namespace

bool pause_unless_stopped(milliseconds time, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, time, [] { return false; });
  return !stop.stop_requested();
}

bool has_ended(v1::Simulation::State state) {
  return state == v1::Simulation::SUCCEEDED || state == v1::Simulation::FAILED ||
         state == v1::Simulation::CANCELLED;
}

v1::Simulation Connection::create_simulation(const v1::Simulation& simulation,
                                             const CreateOptions& options) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = simulation;
  request.set_validate_only(options.validate_only);
  request.set_force(options.force);
  request.set_scheduling_class(options.scheduling_class);
  request.set_request_id(options.request_id.empty() ? new_request_id() : options.request_id);
  return services_->call(*services_->simulations, &v1::SimulationService::Stub::CreateSimulation,
                         request);
}

v1::Simulation Connection::get_simulation(const std::string& name) {
  v1::GetSimulationRequest request;
  request.set_name(name);
  request.set_view(v1::SIMULATION_VIEW_FULL);
  return services_->call(*services_->simulations, &v1::SimulationService::Stub::GetSimulation,
                         request);
}

v1::Simulation Connection::cancel_simulation(const std::string& name) {
  v1::CancelSimulationRequest request;
  request.set_name(name);
  return services_->call(*services_->simulations, &v1::SimulationService::Stub::CancelSimulation,
                         request);
}

void Connection::delete_simulation(const std::string& name, const DeleteOptions& options) {
  v1::DeleteSimulationRequest request;
  request.set_name(name);
  request.set_cancel(options.cancel);
  request.set_allow_missing(options.allow_missing);
  request.set_etag(options.etag);
  services_->call(*services_->simulations, &v1::SimulationService::Stub::DeleteSimulation, request);
}

v1::Simulation Connection::pin_simulation(const std::string& name) {
  v1::PinSimulationRequest request;
  request.set_name(name);
  return services_->call(*services_->simulations, &v1::SimulationService::Stub::PinSimulation,
                         request);
}

v1::Simulation Connection::unpin_simulation(const std::string& name) {
  v1::UnpinSimulationRequest request;
  request.set_name(name);
  return services_->call(*services_->simulations, &v1::SimulationService::Stub::UnpinSimulation,
                         request);
}

Listing<v1::Simulation> Connection::list_simulations(const ListOptions& options) {
  Listing<v1::Simulation> all;
  v1::ListSimulationsRequest request;
  request.set_filter(options.filter);
  request.set_order_by(options.order_by);
  request.set_page_token(options.page_token);
  const int limit = options.limit;
  do {
    const int missing = limit - static_cast<int>(all.resources.size());
    request.set_page_size(limit == 0 ? kLargestPage : std::min(missing, kLargestPage));
    const auto page = services_->call(*services_->simulations,
                                      &v1::SimulationService::Stub::ListSimulations, request);
    all.resources.insert(all.resources.end(), page.simulations().begin(), page.simulations().end());
    all.total_size = page.total_size();
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty() &&
           (limit == 0 || static_cast<int>(all.resources.size()) < limit));
  all.next_page_token = request.page_token();
  all.has_more = !all.next_page_token.empty();
  return all;
}

void Connection::watch(const std::vector<std::string>& names,
                       const std::function<void(const v1::SimulationEvent&)>& on_event,
                       const std::stop_token& stop) {
  std::map<std::string, std::vector<std::string>> by_project;  // relative names
  for (const std::string& each : names) {
    ProjectAndName parts = split_name(services_->project, each);
    by_project[parts.project].push_back(std::move(parts.relative));
  }
  for (const auto& [project, all] : by_project) {
    for (std::size_t i = 0; i < all.size() && !stop.stop_requested(); i += kMostWatched) {
      const std::size_t end = std::min(all.size(), i + kMostWatched);
      watch_some(project,
                 {all.begin() + static_cast<std::ptrdiff_t>(i),
                  all.begin() + static_cast<std::ptrdiff_t>(end)},
                 on_event, stop);
    }
  }
}

void Connection::watch_some(const std::string& project, std::set<std::string> open,
                            const std::function<void(const v1::SimulationEvent&)>& on_event,
                            const std::stop_token& stop) {
  using std::chrono::system_clock;
  // Restarts a watch that does not end, to notice a connection that died silently.
  const auto one_watch = std::chrono::duration_cast<system_clock::duration>(
      std::min(kLongestWatch, 2 * services_->timeout));
  const std::string parent = "projects/" + project;
  v1::WatchSimulationsRequest request;
  request.set_parent(parent);
  Backoff backoff;
  for (int tries_left = kWatchRetries; !open.empty() && !stop.stop_requested();) {
    request.clear_names();
    for (const std::string& name : open) request.add_names(name);
    grpc::ClientContext context;
    services_->prepare(context);
    context.set_deadline(system_clock::now() + one_watch);
    const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
    const auto reader = services_->simulations->WatchSimulations(&context, request);
    bool was_silent = true;
    v1::SimulationEvent event;
    while (reader->Read(&event)) {
      was_silent = false;
      tries_left = kWatchRetries;
      backoff.reset();
      request.set_after_event_number(event.event_number());
      if (has_ended(event.state()) || event.kind() == v1::SimulationEvent::DELETED) {
        open.erase(split_name(kDefaultProject, event.name()).relative);
      }
      remove_project(services_->project, event);
      if (on_event && event.kind() != v1::SimulationEvent::HEARTBEAT) on_event(event);
    }
    const grpc::Status status = reader->Finish();
    if (open.empty() || stop.stop_requested()) return;
    const auto requested = retry_delay(status);
    if (status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED) {
      // A watch without any message, not even a heartbeat, was too short for one, or its server is
      // frozen. These calls throw if the server does not answer.
      while (was_silent && !open.empty() &&
             has_ended(get_simulation(parent + "/" + *open.begin()).state())) {
        open.erase(open.begin());
      }
      if (open.empty()) return;
    } else {
      const bool broken = status.ok() || status.error_code() == grpc::StatusCode::UNAVAILABLE;
      if (!broken && !requested) throw service_error(status, address());
      if (!requested && tries_left-- == 0) {
        throw ServiceError(ServiceError::Kind::kCannotConnect, "lost the server at " + address());
      }
    }
    if (!pause_unless_stopped(backoff.next(requested.value_or(kBetweenWatches)), stop)) return;
  }
}

v1::Simulation Connection::wait_for_end(
    const std::string& name, const std::function<void(const v1::SimulationEvent&)>& on_event,
    const std::stop_token& stop) {
  watch({name}, on_event, stop);
  return get_simulation(name);
}

}  // namespace tribodyn::client
