#include "server/application/simulation_lookup.h"

namespace tribodyn::server {

Outcome<StoredSimulation> find_simulation(Application& application, const std::string& name,
                                          const CallContext& call) {
  return find_by_number(name, [&](std::int64_t number) {
    return application.store.numbered_simulation(call.project, number, call.limits);
  });
}

google::rpc::Status does_not_exist(const std::string& name) {
  return not_found("tribodyn.v1.Simulation", name, name + " does not exist");
}

}  // namespace tribodyn::server
