#include "server/storage/resource_types.h"

#include "proto/resource_kinds.h"
#include "server/contract/resource_names.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

using google::protobuf::Message;

std::string collection_of(std::string_view full_name) {
  const std::string name = relative_name(full_name);
  return name.substr(0, name.find('/'));
}

std::string full_collection_of(std::string_view full_name) {
  return std::string(full_name.substr(0, full_name.rfind('/')));
}

std::unique_ptr<Message> new_resource(std::string_view collection) {
#define TRIBODYN_NEW(Resource, field, kind, seed) \
  if (collection == #kind) return std::make_unique<v1::Resource>();
  TRIBODYN_RESOURCE_KINDS(TRIBODYN_NEW)
#undef TRIBODYN_NEW
  if (collection == kSimulations) return std::make_unique<v1::Simulation>();
  if (collection == kCampaigns) return std::make_unique<v1::Campaign>();
  return nullptr;
}

}  // namespace tribodyn::server
