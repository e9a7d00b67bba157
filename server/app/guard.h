#pragma once

#include <spdlog/spdlog.h>

#include <exception>

#include "core/refusal.h"
#include "server/app/errors.h"
#include "server/app/outcome.h"
#include "server/store/store_error.h"

namespace tribodyn::server {

/// Runs the body of an RPC; no exception leaves it. What a client sent is never logged.
template <class Message, class Body>
Outcome<Message> guarded(const Body& body) {
  try {
    return body();
  } catch (const Refusal& refusal) {
    return error(google::rpc::INVALID_ARGUMENT, refusal.reason(), refusal.what());
  } catch (const StoreError& failure) {
    if (failure.kind() == StoreError::Kind::kDeadline) {
      return deadline_exceeded();
    }
    spdlog::error("{}", failure.what());
    return store_failed();
  } catch (const std::exception& defect) {
    spdlog::error("an RPC failed on a defect");
    return error(google::rpc::INTERNAL, "INTERNAL", defect.what());
  }
}

}  // namespace tribodyn::server
