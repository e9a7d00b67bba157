#pragma once

#include <grpcpp/generic/async_generic_service.h>

namespace tribodyn::server {

/// Answers calls of unknown methods with UNIMPLEMENTED and an ErrorInfo.
class UnknownMethods final : public grpc::CallbackGenericService {
 public:
  grpc::ServerGenericBidiReactor* CreateReactor(
      grpc::GenericCallbackServerContext* context) override;
};

}  // namespace tribodyn::server
