#include "server/convert/input_hash.h"

#include <algorithm>
#include <initializer_list>
#include <list>
#include <mutex>
#include <set>

#include "core/version.h"
#include "server/convert/canonical_text.h"
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
  add_canonical_text(inputs.lubricant, "lubricant", is_label, text);
  add_canonical_text(inputs.gear_set, "gear_set", is_label, text);
  add_canonical_text(inputs.surface, "surface", is_label, text);
  add_canonical_text(inputs.vehicle, "vehicle", is_label, text);
  return text;
}

std::string simulation_text(const SimulationInputs& inputs) {
  std::string text;
  add_canonical_text(inputs.effective, "simulation", is_label, text);
  return text;
}

/// The hash of the resources' text, to be gone on with: it is most of the work, and many
/// simulations rest on the same resources. Keeps the latest few. Safe for concurrent access.
class ResourceHashes {
 public:
  Sha256 of(const SimulationInputs& inputs) {
    const std::string key = key_of(inputs);
    {
      const std::lock_guard lock(mutex_);
      const auto found = std::find_if(kept_.begin(), kept_.end(),
                                      [&](const Kept& each) { return each.key == key; });
      if (found != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, found);
        return kept_.front().hash;
      }
    }
    Sha256 hash;
    hash.add(resources_text(inputs));
    const std::lock_guard lock(mutex_);
    kept_.push_front({key, hash});
    if (kept_.size() > kMostKept) kept_.pop_back();
    return hash;
  }

 private:
  static constexpr std::size_t kMostKept = 32;

  struct Kept {
    std::string key;
    Sha256 hash;
  };

  /// The resources themselves: names do not say what a database holds.
  static std::string key_of(const SimulationInputs& inputs) {
    std::string key;
    for (const google::protobuf::Message* each :
         std::initializer_list<const google::protobuf::Message*>{
             &inputs.lubricant, &inputs.gear_set, &inputs.surface, &inputs.vehicle}) {
      key += std::to_string(each->ByteSizeLong()) + ':';
      each->AppendToString(&key);
    }
    return key;
  }

  std::mutex mutex_;
  std::list<Kept> kept_;  // guarded by mutex_; latest first
};

}  // namespace

std::string canonical_inputs(const SimulationInputs& inputs) {
  return resources_text(inputs) + simulation_text(inputs);
}

std::string input_hash(const SimulationInputs& inputs) {
  static ResourceHashes resource_hashes;
  Sha256 hash = resource_hashes.of(inputs);
  hash.add(simulation_text(inputs));
  return hash.finish();
}

}  // namespace tribodyn::server
