#include "server/storage/seeds.h"

#include <google/protobuf/util/json_util.h>

#include <stdexcept>
#include <string_view>

#include "server/storage/embedded_seeds.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"

namespace tribodyn::server {
namespace {

template <class Resource>
NewResource parse(std::string_view file, std::string_view json) {
  Resource resource;
  const auto status = google::protobuf::util::JsonStringToMessage(
      google::protobuf::StringPiece(json.data(), json.size()), &resource);
  if (!status.ok()) {
    throw std::logic_error("seed " + std::string(file) + ": " + status.ToString());
  }
  return {resource.name(), resource.SerializeAsString()};
}

NewResource parse(std::string_view file, std::string_view json) {
  if (file.starts_with("lubricant_")) return parse<v1::Lubricant>(file, json);
  if (file.starts_with("gear_set_")) return parse<v1::GearSet>(file, json);
  if (file.starts_with("surface_")) return parse<v1::Surface>(file, json);
  if (file.starts_with("vehicle_")) return parse<v1::Vehicle>(file, json);
  throw std::logic_error("seed " + std::string(file) + " has an unknown kind");
}

}  // namespace

std::vector<NewResource> seed_resources() {
  std::vector<NewResource> out;
  for (const EmbeddedSeed& seed : embedded_seeds()) out.push_back(parse(seed.file, seed.json));
  return out;
}

}  // namespace tribodyn::server
