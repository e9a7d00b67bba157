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
    state_ = State::kAsking;
  }
  step();
}

void StreamMachine::refuse(const google::rpc::Status& status) { finish(status); }

void StreamMachine::changed() {
  {
    const std::lock_guard lock(mutex_);
    again_ = true;
    if (state_ != State::kIdle) return;
    state_ = State::kAsking;
  }
  transport_.run_step();
}

void StreamMachine::close(const google::rpc::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    if (state_ == State::kFinished) return;
    if (state_ != State::kIdle) {
      if (!closing_) closing_ = status;
      return;
    }
    state_ = State::kFinished;
  }
  transport_.finish(status);
}

void StreamMachine::written(bool ok) {
  if (!ok) {
    return finish(error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED, "the client is gone"));
  }
  {
    const std::lock_guard lock(mutex_);
    const bool has_reason = again_ || closing_ || source_->may_continue();
    state_ = has_reason ? State::kAsking : State::kIdle;
    if (!has_reason) return;
  }
  source_->is_short() ? transport_.run_short_step() : transport_.run_step();
}

void StreamMachine::step() {
  using Step = AnyMessageSource::Step;
  for (;;) {
    if (const auto closing = begin_step()) return finish(*closing);
    google::rpc::Status end;
    const Reply message(prototype_.New());
    switch (next_step(*source_, *message, end)) {
      case Step::kMessage: {
        {
          const std::lock_guard lock(mutex_);
          state_ = State::kWriting;
          writing_since_ = Clock::now();
        }
        if (const auto failed = transport_.write(*message)) finish(*failed);
        return;
      }
      case Step::kEnd:
        return finish(end);
      case Step::kWait:
        if (go_idle()) return;
    }
  }
}

std::optional<StreamMachine::Clock::time_point> StreamMachine::look_at_clock(
    Clock::time_point now) {
  Clock::time_point next;
  bool has_ended = false, is_stuck = false;
  {
    const std::lock_guard lock(mutex_);
    has_ended = now >= end_;
    is_stuck =
        now >= end_ + kLastWrite || (state_ == State::kWriting && now >= writing_since_ + unread_);
    next = (state_ == State::kWriting ? writing_since_ : now) + unread_;
    next = std::min(next, has_ended ? end_ + kLastWrite : end_);
  }
  if (is_stuck) {
    transport_.cut_off();
    return std::nullopt;
  }
  if (has_ended) close(stream_deadline_exceeded());
  return next;
}

void StreamMachine::finish(const google::rpc::Status& status) {
  {
    const std::lock_guard lock(mutex_);
    state_ = State::kFinished;
  }
  transport_.finish(status);
}

std::optional<google::rpc::Status> StreamMachine::begin_step() {
  const std::lock_guard lock(mutex_);
  again_ = false;
  return closing_;
}

bool StreamMachine::go_idle() {
  const std::lock_guard lock(mutex_);
  if (again_ || closing_) return false;
  state_ = State::kIdle;
  return true;
}

}  // namespace tribodyn::server
