#include "server/scheduling/fair_queue.h"

#include <algorithm>

namespace tribodyn::server {
namespace {

std::size_t index_of(Urgency urgency) { return static_cast<std::size_t>(urgency); }

}  // namespace

std::size_t FairQueue::group_of(const QueuedJob& job) {
  return campaign_part(job.id) ? kSlices : index_of(job.urgency());
}

void FairQueue::push(const QueuedJob& job) {
  const auto [found, is_new] = principals_.try_emplace(job.principal);
  Principal& principal = found->second;
  if (is_new) principal.served_seconds = take_debt(job.principal);
  principal.served_seconds = std::max(principal.served_seconds, now_);
  const Place place{principal.served_seconds + job.cost_seconds, ++arrivals_};
  principal.groups[group_of(job)].emplace(place, job);
  principal.cost_seconds += job.cost_seconds;
  cost_seconds_ += job.cost_seconds;
  if (!campaign_part(job.id)) {
    ++simulations_.size;
    simulations_.cost_seconds += job.cost_seconds;
  }
  places_[job.id] = {job.principal, place, group_of(job)};
  set_turns(found);
}

const FairQueue::Jobs::value_type* FairQueue::first_of(const Principal& principal, Urgency least) {
  const auto first = [&](std::size_t group) {
    const Jobs& jobs = principal.groups[group];
    return jobs.empty() ? nullptr : &*jobs.begin();
  };
  const auto* interactive = first(index_of(Urgency::kInteractive));
  if (interactive != nullptr || least == Urgency::kInteractive) return interactive;
  const auto* small = first(index_of(Urgency::kSmall));
  const auto* slice = first(kSlices);
  const auto* large = least == Urgency::kBulk ? first(index_of(Urgency::kBulk)) : nullptr;
  if (slice != nullptr &&
      (small == nullptr || slice->first.first + kSlicePatienceSeconds < small->first.first)) {
    small = slice;
  }
  if (small == nullptr || large == nullptr) return small == nullptr ? large : small;
  return small->first < large->first ? small : large;
}

/// Updates the entries of a principal in turns_.
void FairQueue::set_turns(Principals::iterator principal) {
  for (const Urgency least : {Urgency::kInteractive, Urgency::kSmall, Urgency::kBulk}) {
    std::set<Turn>& turns = turns_[index_of(least)];
    std::optional<Turn>& entry = principal->second.turns[index_of(least)];
    const auto* first = first_of(principal->second, least);
    std::optional<Turn> turn;
    if (first != nullptr) {
      turn = {principal->second.served_seconds, first->first.second, principal->first};
    }
    if (turn == entry) continue;
    if (entry) turns.erase(*entry);
    if (turn) turns.insert(*turn);
    entry = std::move(turn);
  }
}

const QueuedJob* FairQueue::peek(Urgency least) const {
  const std::set<Turn>& turns = turns_[index_of(least)];
  if (turns.empty()) return nullptr;
  return &first_of(principals_.at(std::get<std::string>(*turns.begin())), least)->second;
}

std::optional<QueuedJob> FairQueue::pop(Urgency least) {
  const std::set<Turn>& turns = turns_[index_of(least)];
  if (turns.empty()) return std::nullopt;
  const auto principal = principals_.find(std::get<std::string>(*turns.begin()));
  const auto [place, job] = *first_of(principal->second, least);
  now_ = std::max(now_, principal->second.served_seconds);
  principal->second.served_seconds += job.cost_seconds;
  remove(principal, place, group_of(job));
  forgive();
  return job;
}

bool FairQueue::erase(std::int64_t id) {
  const auto found = places_.find(id);
  if (found == places_.end()) return false;
  const auto [principal, place, group] = found->second;
  remove(principals_.find(principal), place, group);
  return true;
}

void FairQueue::remove(Principals::iterator principal, const Place& place, std::size_t group) {
  Jobs& jobs = principal->second.groups[group];
  const auto job = jobs.find(place);
  cost_seconds_ -= job->second.cost_seconds;
  principal->second.cost_seconds -= job->second.cost_seconds;
  if (!campaign_part(job->second.id)) {
    --simulations_.size;
    simulations_.cost_seconds -= job->second.cost_seconds;
  }
  places_.erase(job->second.id);
  jobs.erase(job);
  set_turns(principal);
  if (principal->second.size() == 0) {
    remember(principal->first, principal->second.served_seconds);
    principals_.erase(principal);
  }
  // Removes the rounding errors.
  if (places_.empty()) cost_seconds_ = 0;
  if (simulations_.size == 0) simulations_.cost_seconds = 0;
}

void FairQueue::charge(const std::string& principal, double seconds) {
  const auto found = principals_.find(principal);
  if (found == principals_.end()) {
    remember(principal, std::max(take_debt(principal), now_) + seconds);
    return;
  }
  found->second.served_seconds = std::max(now_, found->second.served_seconds + seconds);
  set_turns(found);
}

void FairQueue::remember(const std::string& principal, double served_seconds) {
  take_debt(principal);
  if (served_seconds <= now_) return;
  debts_[principal] = served_seconds;
  debts_by_size_.emplace(served_seconds, principal);
  if (debts_.size() <= kMostDebtors) return;
  debts_.erase(debts_by_size_.begin()->second);
  debts_by_size_.erase(debts_by_size_.begin());
}

/// Removes and returns the service that a principal without jobs has received. Returns 0 if the
/// principal owes nothing.
double FairQueue::take_debt(const std::string& principal) {
  const auto found = debts_.find(principal);
  if (found == debts_.end()) return 0;
  const double served_seconds = found->second;
  debts_by_size_.erase({served_seconds, principal});
  debts_.erase(found);
  return served_seconds;
}

/// Forgets the principals whose debt is paid: the others have received as much service.
void FairQueue::forgive() {
  while (!debts_by_size_.empty() && debts_by_size_.begin()->first <= now_) {
    debts_.erase(debts_by_size_.begin()->second);
    debts_by_size_.erase(debts_by_size_.begin());
  }
}

std::size_t FairQueue::size_of(const std::string& principal) const {
  const auto found = principals_.find(principal);
  return found == principals_.end() ? 0 : found->second.size();
}

double FairQueue::cost_seconds_of(const std::string& principal) const {
  const auto found = principals_.find(principal);
  return found == principals_.end() ? 0 : found->second.cost_seconds;
}

}  // namespace tribodyn::server
