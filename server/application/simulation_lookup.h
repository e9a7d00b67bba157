#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/errors.h"
#include "server/application/outcome.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {

/// Returns NOT_FOUND for the name of a simulation.
google::rpc::Status does_not_exist(const std::string& name);

/// Returns what `find` returns for the number in the name of a simulation. Returns INVALID_ARGUMENT
/// if `name` does not have the form of a name, and NOT_FOUND if `find` returns nullopt.
template <class Find>
auto find_by_number(const std::string& name, const Find& find)
    -> Outcome<typename std::invoke_result_t<const Find&, std::int64_t>::value_type> {
  const std::optional<std::int64_t> number = simulation_id(name);
  if (!number) {
    return invalid({{"name", "not a name of the form \"simulations/{id}\", id a number"}});
  }
  auto found = find(*number);
  if (!found) return does_not_exist(name);
  return *std::move(found);
}

/// Returns the stored simulation, or an error as find_by_number().
Outcome<StoredSimulation> find_simulation(Application& application, const std::string& name,
                                          const CallContext& call);

}  // namespace tribodyn::server
