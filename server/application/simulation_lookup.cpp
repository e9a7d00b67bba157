#include "server/application/simulation_lookup.h"

#include <optional>

#include "server/application/errors.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {

Outcome<StoredSimulation> find_simulation(Application& application, const std::string& name,
                                          const CallContext& call) {
  const std::optional<std::int64_t> number = simulation_id(name);
  if (!number) {
    return invalid({{"name", "not a name of the form \"simulations/{id}\", id a number"}});
  }
  std::optional<StoredSimulation> stored =
      application.store.numbered_simulation(call.project, *number, call.limits);
  if (!stored) return does_not_exist(name);
  return std::move(*stored);
}

google::rpc::Status does_not_exist(const std::string& name) {
  return not_found("tribodyn.v1.Simulation", name, name + " does not exist");
}

}  // namespace tribodyn::server
