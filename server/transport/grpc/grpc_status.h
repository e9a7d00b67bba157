#pragma once

#include <grpcpp/support/status.h>

#include "google/rpc/status.pb.h"

namespace tribodyn::server {

/// Converts an error to gRPC's form, with its details in grpc-status-details-bin.
inline grpc::Status to_grpc(const google::rpc::Status& status) {
  if (status.code() == 0) return grpc::Status::OK;
  return {static_cast<grpc::StatusCode>(status.code()), status.message(),
          status.SerializeAsString()};
}

}  // namespace tribodyn::server
