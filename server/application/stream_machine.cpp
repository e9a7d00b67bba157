#include "server/application/stream_machine.h"

#include <algorithm>
#include <utility>

#include "google/rpc/code.pb.h"
#include "server/application/errors.h"

namespace tribodyn::server {

void StreamMachine::open(ReplySource source, Clock::time_point end) {
  source_ = std::move(source);
  {
    const std::lock_guard lock(mutex_);
    end_ = end;
    is_open_ = true;
    is_stepping_ = true;
  }
  step();
}

void StreamMachine::refuse(const google::rpc::Status& status) {
  finish(std::unique_lock(mutex_), status);
}

void StreamMachine::changed() {
  {
    const std::lock_guard lock(mutex_);
    again_ = true;
    if (!is_idle()) return;
    is_stepping_ = true;
  }
  transport_.run_step();
}

void StreamMachine::close(const google::rpc::Status& status) {
  std::unique_lock lock(mutex_);
  if (closing_ != Closing::kNow) status_ = status;
  closing_ = Closing::kNow;
  if (is_idle()) finish(std::move(lock), status_);
}

void StreamMachine::shut_down(const google::rpc::Status& status) {
  std::unique_lock lock(mutex_);
  const bool follows_changes = is_open_ && source_->follows_changes();
  if (!follows_changes) {
    lock.unlock();
    return close(status);
  }
  if (closing_ != Closing::kNo) return;
  closing_ = Closing::kWhenIdle;
  status_ = status;
  closing_at_last_ = Clock::now() + kLastChanges;
  again_ = true;
  if (!is_idle()) return;
  is_stepping_ = true;
  lock.unlock();
  transport_.run_step();
}

void StreamMachine::written(bool ok) {
  std::unique_lock lock(mutex_);
  is_writing_ = false;
  if (!ok) {
    closing_ = Closing::kNow;
    status_ = error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED, "the client is gone");
  }
  if (is_stepping_) return;  // that step reads what has changed
  if (!ok) return finish(std::move(lock), status_);
  const bool must_end = closing_ != Closing::kNo;
  if (!again_ && !must_end && !prepared_ && !source_->may_continue()) return;
  is_stepping_ = true;
  const bool is_short = prepared_ || source_->is_short();
  lock.unlock();
  is_short ? transport_.run_short_step() : transport_.run_step();
}

void StreamMachine::step() {
  using Step = AnyMessageSource::Step;
  Reply message;
  while (begin_step(message)) {
    if (!message) {
      google::rpc::Status end;
      message.reset(prototype_.New());
      const Step next = next_step(*source_, *message, end);
      if (next == Step::kEnd) close(end);
      if (next == Step::kWait && go_idle()) return;
      if (next != Step::kMessage) continue;
    }
    const bool is_ahead = source_->may_be_ahead();
    if (!begin_write(message, is_ahead)) return;
    if (const auto failed = transport_.write(*message)) {
      return finish(std::unique_lock(mutex_), *failed);
    }
    if (!is_ahead) return;
    // To wake another thread takes longer than a short message.
    if (!source_->is_short()) return transport_.run_step();
  }
}

std::optional<StreamMachine::Clock::time_point> StreamMachine::look_at_clock(
    Clock::time_point now) {
  Clock::time_point next;
  bool has_ended = false, is_stuck = false;
  {
    const std::lock_guard lock(mutex_);
    has_ended = now >= end_;
    is_stuck = now >= end_ + kLastWrite || (is_writing_ && now >= writing_since_ + unread_);
    next = (is_writing_ ? writing_since_ : now) + unread_;
    next = std::min(next, has_ended ? end_ + kLastWrite : end_);
  }
  if (is_stuck) {
    transport_.cut_off();
    return std::nullopt;
  }
  if (has_ended) close(stream_deadline_exceeded());
  return next;
}

bool StreamMachine::is_idle() const {
  return is_open_ && !is_stepping_ && !is_writing_ && !is_finished_;
}

// The status is a copy: during transport_.finish() this object may be destroyed, with status_.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void StreamMachine::finish(std::unique_lock<std::mutex> lock, google::rpc::Status status) {
  is_finished_ = true;
  lock.unlock();
  transport_.finish(status);
}

bool StreamMachine::begin_step(Reply& prepared) {
  std::unique_lock lock(mutex_);
  again_ = false;
  if (closing_ == Closing::kWhenIdle && Clock::now() >= closing_at_last_) closing_ = Closing::kNow;
  if (has_closed(lock)) return false;
  prepared = std::move(prepared_);
  return true;
}

bool StreamMachine::begin_write(Reply& message, bool is_ahead) {
  std::unique_lock lock(mutex_);
  if (has_closed(lock)) return false;
  if (is_writing_) {
    prepared_ = std::move(message);
    is_stepping_ = false;
    return false;
  }
  is_writing_ = true;
  writing_since_ = Clock::now();
  is_stepping_ = is_ahead;
  return true;
}

bool StreamMachine::has_closed(std::unique_lock<std::mutex>& lock) {
  if (closing_ != Closing::kNow) return false;
  is_stepping_ = false;
  if (!is_writing_) finish(std::move(lock), status_);
  return true;
}

bool StreamMachine::go_idle() {
  const std::lock_guard lock(mutex_);
  if (again_) return false;
  if (closing_ == Closing::kWhenIdle) closing_ = Closing::kNow;
  if (closing_ == Closing::kNow) return false;
  is_stepping_ = false;
  return true;
}

}  // namespace tribodyn::server
