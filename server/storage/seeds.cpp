#include "server/storage/seeds.h"

#include <google/protobuf/util/json_util.h>

#include <stdexcept>
#include <string_view>

#include "proto/resource_kinds.h"
#include "server/storage/embedded_seeds.h"

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
#define TRIBODYN_SEED(Resource, field, collection, seed) \
  if (file.starts_with(#field "_")) return parse<v1::Resource>(file, json);
  TRIBODYN_RESOURCE_KINDS(TRIBODYN_SEED)
#undef TRIBODYN_SEED
  throw std::logic_error("seed " + std::string(file) + " has an unknown kind");
}

}  // namespace

std::vector<NewResource> seed_resources() {
  std::vector<NewResource> out;
  for (const EmbeddedSeed& seed : embedded_seeds()) out.push_back(parse(seed.file, seed.json));
  return out;
}

}  // namespace tribodyn::server
