#include "server/scheduling/fair_queue.h"

#include <algorithm>

namespace tribodyn::server {

void FairQueue::push(const QueuedJob& job) {
  Client& client = clients_[job.client];
  client.served_seconds = std::max(client.served_seconds, now_);
  const Place place{client.served_seconds + job.cost_seconds, ++arrivals_};
  (job.is_interactive() ? client.interactive : client.bulk).emplace(place, job);
  client.cost_seconds += job.cost_seconds;
  cost_seconds_ += job.cost_seconds;
  places_[job.id] = {job.client, place, job.is_interactive()};
}

const std::pair<const FairQueue::Place, QueuedJob>* FairQueue::first_of(const Client& client,
                                                                        bool interactive_only) {
  const auto* small = client.interactive.empty() ? nullptr : &*client.interactive.begin();
  const auto* large = interactive_only || client.bulk.empty() ? nullptr : &*client.bulk.begin();
  if (small == nullptr || large == nullptr) return small == nullptr ? large : small;
  return small->first < large->first ? small : large;
}

FairQueue::Clients::const_iterator FairQueue::next_client(bool interactive_only) const {
  auto best = clients_.end();
  Place least;
  for (auto each = clients_.begin(); each != clients_.end(); ++each) {
    const auto* first = first_of(each->second, interactive_only);
    if (first == nullptr) continue;
    const Place place{each->second.served_seconds, first->first.second};
    if (best == clients_.end() || place < least) {
      best = each;
      least = place;
    }
  }
  return best;
}

const QueuedJob* FairQueue::peek(bool interactive_only) const {
  const auto client = next_client(interactive_only);
  return client == clients_.end() ? nullptr : &first_of(client->second, interactive_only)->second;
}

std::optional<QueuedJob> FairQueue::pop(bool interactive_only) {
  const auto found = next_client(interactive_only);
  if (found == clients_.end()) return std::nullopt;
  const auto client = clients_.find(found->first);
  const auto [place, job] = *first_of(client->second, interactive_only);
  now_ = std::max(now_, client->second.served_seconds);
  client->second.served_seconds += job.cost_seconds;
  remove(client, place, job.is_interactive());
  return job;
}

bool FairQueue::erase(std::int64_t id) {
  const auto found = places_.find(id);
  if (found == places_.end()) return false;
  const auto [client, place, is_interactive] = found->second;
  remove(clients_.find(client), place, is_interactive);
  return true;
}

void FairQueue::remove(Clients::iterator client, const Place& place, bool is_interactive) {
  auto& jobs = is_interactive ? client->second.interactive : client->second.bulk;
  const auto job = jobs.find(place);
  cost_seconds_ -= job->second.cost_seconds;
  client->second.cost_seconds -= job->second.cost_seconds;
  places_.erase(job->second.id);
  jobs.erase(job);
  if (client->second.size() == 0) clients_.erase(client);
  if (places_.empty()) cost_seconds_ = 0;  // no rounding stays behind
}

std::size_t FairQueue::size_of(const std::string& client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? 0 : found->second.size();
}

double FairQueue::cost_seconds_of(const std::string& client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? 0 : found->second.cost_seconds;
}

}  // namespace tribodyn::server
