#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/cycles.pb.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/points.pb.h"
#include "tribodyn/v1/profiles.pb.h"
#include "tribodyn/v1/rigs.pb.h"
#include "tribodyn/v1/schemas.pb.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/spectra.pb.h"
#include "tribodyn/v1/surfaces.pb.h"
#include "tribodyn/v1/vehicles.pb.h"
#include "tribodyn/v1/viscosities.pb.h"

namespace tribodyn::server {

/// Returns every method of the contract.
inline std::vector<const google::protobuf::MethodDescriptor*> all_methods() {
  std::vector<const google::protobuf::MethodDescriptor*> out;
  for (const auto* file :
       {v1::Lubricant::descriptor()->file(), v1::GearSet::descriptor()->file(),
        v1::Surface::descriptor()->file(), v1::Vehicle::descriptor()->file(),
        v1::Simulation::descriptor()->file(), v1::Schema::descriptor()->file(),
        v1::EvaluateContactRequest::descriptor()->file(),
        v1::EvaluatePointsRequest::descriptor()->file(),
        v1::EvaluateCycleRequest::descriptor()->file(),
        v1::EvaluateProfilesRequest::descriptor()->file(),
        v1::EvaluateRigRequest::descriptor()->file(),
        v1::EvaluateViscosityRequest::descriptor()->file(),
        v1::ReadSpectrumRequest::descriptor()->file(), v1::Campaign::descriptor()->file()}) {
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
