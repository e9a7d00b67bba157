#pragma once

#include <grpcpp/generic/async_generic_service.h>

namespace tribodyn::server {

/// Answers methods that no service has as everything else is answered: with ErrorInfo.
class UnknownMethods final : public grpc::CallbackGenericService {
 public:
  grpc::ServerGenericBidiReactor* CreateReactor(
      grpc::GenericCallbackServerContext* context) override;
};

}  // namespace tribodyn::server
