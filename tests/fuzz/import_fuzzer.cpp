// libFuzzer: an import accepts or refuses any bytes without a crash, a hang or an unlimited answer.
// An accepted resource is accepted again unchanged.
#include <google/protobuf/util/json_util.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/resources/accept_resource.h"
#include "server/resources/imports/import_gear_set.h"
#include "server/resources/imports/import_lubricant.h"
#include "server/resources/imports/import_surface.h"
#include "server/resources/lubricant_parameters.h"
#include "server/storage/seeds.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kMostViolations = 1000;

/// Returns a lookup of the seeds.
const ResourceLookup& lookup() {
  static const std::vector<NewResource> kSeeds = seed_resources();
  static const ResourceLookup kLookup = {
      [](const RevisionName& name) -> std::optional<FoundResource> {
        for (const NewResource& seed : kSeeds) {
          if (seed.name == name.name) return FoundResource{1, false, seed.body};
        }
        return std::nullopt;
      },
      [](const std::string& collection) {
        std::vector<std::string> out;
        for (const NewResource& seed : kSeeds) {
          if (seed.name.starts_with(collection + "/")) out.push_back(seed.name);
        }
        return out;
      }};
  return kLookup;
}

void require(bool condition) {
  if (!condition) std::abort();
}

/// Checks that an accepted resource is accepted a second time, byte for byte, and that a refusal
/// has a reason.
template <class Resource>
void judge(const std::optional<Resource>& accepted, const Violations& violations) {
  require(accepted.has_value() == violations.empty());
  require(violations.size() <= kMostViolations);
  if (!accepted) return;
  Violations none;
  const auto again =
      accept(*accepted, static_cast<const Resource*>(nullptr), lookup(), "again", none);
  require(again && again->SerializeAsString() == accepted->SerializeAsString());
}

void import_gear_set_text(const std::string& text) {
  static const v1::GearSet kRest = [] {
    v1::GearSet rest;
    rest.ParseFromString(lookup().find({"gearSets/reference-axle-loaded-error", 0})->body);
    rest.clear_flank_slots();
    return rest;
  }();
  v1::ImportGearSetRequest request;
  *request.mutable_gear_set() = kRest;
  const std::size_t split = text.find('\0');
  request.set_tooth_contact_csv(text.substr(0, split));
  if (split != std::string::npos) request.set_series_csv(text.substr(split + 1));
  Violations violations;
  const auto accepted = import_gear_set(request, "gearSets/x", lookup(), violations);
  judge(accepted, violations);
}

void import_surface_text(const std::string& text) {
  v1::ImportSurfaceProfilesRequest request;
  request.mutable_surface()->set_tribofilm_shear_strength_pascals(2e6);
  request.mutable_surface()->set_asperity_friction_coefficient(0.17);
  request.add_profiles()->set_csv(text);
  Violations violations;
  const auto accepted = import_surface(request, "surfaces/x", lookup(), violations);
  judge(accepted, violations);
}

void import_lubricant_text(const std::string& text) {
  v1::ImportLubricantRequest request;
  request.mutable_lubricant()->set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  request.set_viscosity_table_csv(text);
  Violations violations;
  const auto accepted = import_lubricant(request, "lubricants/x", lookup(), violations);
  judge(accepted, violations);
  if (accepted) characterisation(*accepted);
}

template <class Resource>
void import_json(const std::string& text, const std::string& name) {
  Resource stated;
  if (!google::protobuf::util::JsonStringToMessage(text, &stated).ok()) return;
  stated.set_name(name);
  Violations violations;
  const auto accepted =
      accept(stated, static_cast<const Resource*>(nullptr), lookup(), "resource", violations);
  judge(accepted, violations);
}

}  // namespace
}  // namespace tribodyn::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tribodyn::server;
  namespace v1 = tribodyn::v1;
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0]) {
    case 'g':
      import_gear_set_text(text);
      break;
    case 's':
      import_surface_text(text);
      break;
    case 'v':
      import_lubricant_text(text);
      break;
    case 'L':
      import_json<v1::Lubricant>(text, "lubricants/x");
      break;
    case 'G':
      import_json<v1::GearSet>(text, "gearSets/x");
      break;
    case 'S':
      import_json<v1::Surface>(text, "surfaces/x");
      break;
    default:
      import_json<v1::Vehicle>(text, "vehicles/x");
  }
  return 0;
}
