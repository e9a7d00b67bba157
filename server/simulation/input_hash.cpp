#include "server/simulation/input_hash.h"

#include "core/version.h"
#include "server/contract/canonical_text.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/input_fields.h"
#include "server/support/lru_cache.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

bool is_left_out(const google::protobuf::FieldDescriptor& field) {
  const InputRole role = input_role(field);
  return role == InputRole::kLabel || role == InputRole::kOutput;
}

std::string resources_text(const SimulationInputs& inputs) {
  std::string text = std::string("model_version=") + kModelVersion + "\n";
  add_canonical_text(*inputs.lubricant, "lubricant", is_left_out, text);
  text += text_of(fluid_grounds(*inputs.lubricant));
  add_canonical_text(*inputs.gear_set, "gear_set", is_left_out, text);
  add_canonical_text(*inputs.surface, "surface", is_left_out, text);
  add_canonical_text(*inputs.vehicle, "vehicle", is_left_out, text);
  return text;
}

std::string simulation_text(const SimulationInputs& inputs) {
  std::string text;
  add_canonical_text(inputs.effective, "simulation", is_left_out, text);
  return text;
}

}  // namespace

std::string canonical_inputs(const SimulationInputs& inputs) {
  return resources_text(inputs) + simulation_text(inputs);
}

std::string input_hash(const SimulationInputs& inputs) {
  // The text of the resources takes most of the time, and many simulations share resources.
  static LruCache<Resources, Sha256> cache;
  Sha256 hash = cache.get(resources(inputs), [&inputs] {
    Sha256 begun;
    begun.add(resources_text(inputs));
    return begun;
  });
  hash.add(simulation_text(inputs));
  return hash.finish();
}

}  // namespace tribodyn::server
