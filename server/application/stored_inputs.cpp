#include "server/application/stored_inputs.h"

#include "core/version.h"
#include "server/simulation/input_hash.h"

namespace tribodyn::server {

std::optional<std::string> hash_stored_inputs(const v1::Simulation& request,
                                              const std::string& model_version,
                                              const FindRevision& find) {
  if (model_version != kModelVersion) return std::nullopt;
  const ResourceLookup lookup = {[&find](const RevisionName& name) -> std::optional<FoundResource> {
                                   auto body = find(name.name, name.revision);
                                   if (!body) return std::nullopt;
                                   return FoundResource{name.revision, false, std::move(*body)};
                                 },
                                 [](const std::string&) { return std::vector<std::string>(); }};
  Violations violations;
  const auto inputs = read_simulation(request, lookup, "simulation", violations);
  return inputs ? input_hash(*inputs) : std::string();
}

}  // namespace tribodyn::server
