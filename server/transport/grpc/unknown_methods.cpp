#include "server/transport/grpc/unknown_methods.h"

#include "server/application/errors.h"
#include "server/transport/grpc/grpc_status.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kLongestName = 200;

class Refusal final : public grpc::ServerGenericBidiReactor {
 public:
  explicit Refusal(const std::string& method) {
    Finish(to_grpc(error(google::rpc::UNIMPLEMENTED, v1::ERROR_REASON_UNKNOWN_METHOD,
                         "no such method: " + method.substr(0, kLongestName),
                         {{"method", method.substr(0, kLongestName)}})));
  }
  void OnDone() override { delete this; }
};

}  // namespace

grpc::ServerGenericBidiReactor* UnknownMethods::CreateReactor(
    grpc::GenericCallbackServerContext* context) {
  return new Refusal(context->method());  // deletes itself
}

}  // namespace tribodyn::server
