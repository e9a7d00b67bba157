#include "server/storage/deadline.h"

#include <algorithm>

namespace tribodyn::server {
namespace {

thread_local std::optional<DeadlineScope::Clock::time_point> thread_end;

}  // namespace

DeadlineScope::DeadlineScope(Clock::time_point end) : outer_(thread_end) {
  thread_end = outer_ ? std::min(*outer_, end) : end;
}

DeadlineScope::~DeadlineScope() { thread_end = outer_; }

bool DeadlineScope::has_passed() { return thread_end && Clock::now() >= *thread_end; }

}  // namespace tribodyn::server
