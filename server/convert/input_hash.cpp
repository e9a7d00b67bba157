#include "server/convert/input_hash.h"

#include <set>

#include "core/version.h"
#include "server/convert/canonical_text.h"
#include "server/convert/latest_few.h"
#include "server/convert/output_only.h"
#include "server/hash/sha256.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;

/// Fields that say what a thing is called, where it comes from or what only the server sets; never
/// what the model computes with.
bool is_label(const FieldDescriptor& field) {
  static const std::set<std::string> kLabels = {"name",
                                                "display_name",
                                                "description",
                                                "provenance",
                                                "lubricant",
                                                "gear_set",
                                                "surface",
                                                "vehicle",
                                                "labels",
                                                "derived_from",
                                                "condition",
                                                "base_oil_class",
                                                "measurements",
                                                "lims_id",
                                                "external_sample_id",
                                                "deadline_seconds"};
  // Constant lines in the text of every simulation; without them stored hashes would be others.
  static const std::set<std::string> kConstant = {"state", "progress_fraction"};
  return kLabels.contains(field.name()) ||
         (is_output_only(field) && !kConstant.contains(field.name()));
}

std::string resources_text(const SimulationInputs& inputs) {
  std::string text = std::string("model_version=") + kModelVersion + "\n";
  add_canonical_text(*inputs.lubricant, "lubricant", is_label, text);
  add_canonical_text(*inputs.gear_set, "gear_set", is_label, text);
  add_canonical_text(*inputs.surface, "surface", is_label, text);
  add_canonical_text(*inputs.vehicle, "vehicle", is_label, text);
  return text;
}

std::string simulation_text(const SimulationInputs& inputs) {
  std::string text;
  add_canonical_text(inputs.effective, "simulation", is_label, text);
  return text;
}

}  // namespace

std::string canonical_inputs(const SimulationInputs& inputs) {
  return resources_text(inputs) + simulation_text(inputs);
}

std::string input_hash(const SimulationInputs& inputs) {
  // The resources' text is most of the work, and many simulations rest on the same ones.
  static LatestFew<Resources, Sha256> kept;
  Sha256 hash = kept.get(resources(inputs), [&inputs] {
    Sha256 begun;
    begun.add(resources_text(inputs));
    return begun;
  });
  hash.add(simulation_text(inputs));
  return hash.finish();
}

}  // namespace tribodyn::server
