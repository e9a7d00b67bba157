#pragma once

#include <optional>
#include <type_traits>
#include <utility>

#include "server/storage/store.h"

namespace tribodyn::server {

// How the functions of Store use its connections. Included by the sources of Store only.

template <class Action>
auto Store::write(const CallLimits& limits, const Action& action) {
  std::optional<std::invoke_result_t<const Action&, Connection&>> out;
  run_write(limits, [&](Connection& db) { out.emplace(action(db)); });
  return *std::move(out);
}

template <class Action>
auto Store::read(const CallLimits& limits, const Action& action) {
  std::optional<std::invoke_result_t<const Action&, Connection&>> out;
  run_read(limits, [&](Connection& db) { out.emplace(action(db)); });
  return *std::move(out);
}

}  // namespace tribodyn::server
