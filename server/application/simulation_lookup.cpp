#include "server/application/simulation_lookup.h"

#include <optional>

#include "server/application/errors.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {

Outcome<StoredSimulation> find_simulation(Application& application, const std::string& name,
                                          const CallContext& call) {
  const std::optional<std::int64_t> id = simulation_id(name);
  if (!id) {
    return invalid({{"name", "not a name of the form \"simulations/{id}\", id a number"}});
  }
  std::optional<StoredSimulation> stored = application.store.simulation(*id, call.limits);
  if (!stored) return does_not_exist(name);
  return std::move(*stored);
}

google::rpc::Status does_not_exist(const std::string& name) {
  return not_found("tribodyn.v1.Simulation", name, name + " does not exist");
}

}  // namespace tribodyn::server
