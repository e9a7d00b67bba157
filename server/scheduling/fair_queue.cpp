#include "server/scheduling/fair_queue.h"

#include <algorithm>

namespace tribodyn::server {
namespace {

std::size_t index_of(Lane lane) { return static_cast<std::size_t>(lane); }

}  // namespace

void FairQueue::push(const QueuedJob& job) {
  const auto [found, is_new] = principals_.try_emplace(job.principal);
  Principal& principal = found->second;
  if (is_new) principal.served_seconds = take_debt(job.principal);
  principal.served_seconds = std::max(principal.served_seconds, now_);
  const Place place{principal.served_seconds + job.cost_seconds, ++arrivals_};
  principal.lanes[index_of(job.lane())].emplace(place, job);
  principal.cost_seconds += job.cost_seconds;
  cost_seconds_ += job.cost_seconds;
  places_[job.id] = {job.principal, place, job.lane()};
  set_turns(found);
}

const FairQueue::Jobs::value_type* FairQueue::first_of(const Principal& principal, Lane last) {
  const auto first = [&](Lane lane) {
    const Jobs& jobs = principal.lanes[index_of(lane)];
    return jobs.empty() ? nullptr : &*jobs.begin();
  };
  const auto* stated = first(Lane::kStated);
  if (stated != nullptr || last == Lane::kStated) return stated;
  const auto* small = first(Lane::kSmall);
  const auto* large = last == Lane::kBulk ? first(Lane::kBulk) : nullptr;
  if (small == nullptr || large == nullptr) return small == nullptr ? large : small;
  return small->first < large->first ? small : large;
}

/// Brings the entries of a principal in turns_ up to date.
void FairQueue::set_turns(Principals::iterator principal) {
  for (const Lane last : {Lane::kStated, Lane::kSmall, Lane::kBulk}) {
    std::set<Turn>& turns = turns_[index_of(last)];
    std::optional<Turn>& entry = principal->second.turns[index_of(last)];
    const auto* first = first_of(principal->second, last);
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

const QueuedJob* FairQueue::peek(Lane last) const {
  const std::set<Turn>& turns = turns_[index_of(last)];
  if (turns.empty()) return nullptr;
  return &first_of(principals_.at(std::get<std::string>(*turns.begin())), last)->second;
}

std::optional<QueuedJob> FairQueue::pop(Lane last) {
  const std::set<Turn>& turns = turns_[index_of(last)];
  if (turns.empty()) return std::nullopt;
  const auto principal = principals_.find(std::get<std::string>(*turns.begin()));
  const auto [place, job] = *first_of(principal->second, last);
  now_ = std::max(now_, principal->second.served_seconds);
  principal->second.served_seconds += job.cost_seconds;
  remove(principal, place, job.lane());
  forgive();
  return job;
}

bool FairQueue::erase(std::int64_t id) {
  const auto found = places_.find(id);
  if (found == places_.end()) return false;
  const auto [principal, place, lane] = found->second;
  remove(principals_.find(principal), place, lane);
  return true;
}

void FairQueue::remove(Principals::iterator principal, const Place& place, Lane lane) {
  Jobs& jobs = principal->second.lanes[index_of(lane)];
  const auto job = jobs.find(place);
  cost_seconds_ -= job->second.cost_seconds;
  principal->second.cost_seconds -= job->second.cost_seconds;
  places_.erase(job->second.id);
  jobs.erase(job);
  set_turns(principal);
  if (principal->second.size() == 0) {
    remember(principal->first, principal->second.served_seconds);
    principals_.erase(principal);
  }
  if (places_.empty()) cost_seconds_ = 0;  // no rounding stays behind
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

/// What a principal without jobs has been served; forgotten here. Returns 0 if it owes nothing.
double FairQueue::take_debt(const std::string& principal) {
  const auto found = debts_.find(principal);
  if (found == debts_.end()) return 0;
  const double served_seconds = found->second;
  debts_by_size_.erase({served_seconds, principal});
  debts_.erase(found);
  return served_seconds;
}

/// Forgets those whom the others have caught up with.
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
