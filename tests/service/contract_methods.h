#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

#include "proto/resource_kinds.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/cycles.pb.h"
#include "tribodyn/v1/points.pb.h"
#include "tribodyn/v1/profiles.pb.h"
#include "tribodyn/v1/rigs.pb.h"
#include "tribodyn/v1/schemas.pb.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/spectra.pb.h"
#include "tribodyn/v1/viscosities.pb.h"

namespace tribodyn::server {

/// Returns the messages of all kinds of resources.
inline std::vector<const google::protobuf::Descriptor*> resource_types() {
#define TRIBODYN_TYPE(Resource, field, collection, seed) v1::Resource::descriptor(),
  return {TRIBODYN_RESOURCE_KINDS(TRIBODYN_TYPE)};
#undef TRIBODYN_TYPE
}

/// Returns every method of the contract.
inline std::vector<const google::protobuf::MethodDescriptor*> all_methods() {
  std::vector<const google::protobuf::MethodDescriptor*> out;
  std::vector<const google::protobuf::FileDescriptor*> files = {
      v1::Simulation::descriptor()->file(),
      v1::Schema::descriptor()->file(),
      v1::EvaluateContactRequest::descriptor()->file(),
      v1::EvaluatePointsRequest::descriptor()->file(),
      v1::EvaluateCycleRequest::descriptor()->file(),
      v1::EvaluateProfilesRequest::descriptor()->file(),
      v1::EvaluateRigRequest::descriptor()->file(),
      v1::EvaluateViscosityRequest::descriptor()->file(),
      v1::ReadSpectrumRequest::descriptor()->file(),
      v1::Campaign::descriptor()->file()};
  for (const auto* type : resource_types()) files.push_back(type->file());
  for (const auto* file : files) {
    for (int i = 0; i < file->service_count(); ++i) {
      for (int k = 0; k < file->service(i)->method_count(); ++k) {
        out.push_back(file->service(i)->method(k));
      }
    }
  }
  return out;
}

inline std::string path_of(const google::protobuf::MethodDescriptor& method) {
  return "/" + method.service()->full_name() + "/" + method.name();
}

}  // namespace tribodyn::server
