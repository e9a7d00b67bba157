#include "server/transport/grpc/services.h"

#include <grpc/grpc_security_constants.h>
#include <grpcpp/impl/codegen/proto_utils.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "server/application/guard.h"
#include "server/transport/call_words.h"
#include "server/transport/grpc/contract_service.h"
#include "server/transport/grpc/grpc_call.h"
#include "server/transport/grpc/grpc_status.h"
#include "server/transport/grpc/stream_reactor.h"

namespace tribodyn::server {
namespace {

using Bytes = grpc::ByteBuffer;
using Context = grpc::CallbackServerContext;

/// Returns the value of a header, or "".
std::string_view header(const Context& context, const char* name) {
  const auto found = context.client_metadata().find(name);
  if (found == context.client_metadata().end()) return {};
  return {found->second.data(), found->second.size()};
}

/// A unary call, from its arrival until OnDone.
class UnaryReactor final : public grpc::ServerUnaryReactor, public GrpcCall<UnaryCall> {
 public:
  UnaryReactor(const Method& its_method, const Context& its_context, const Bytes& request,
               Bytes& response, std::chrono::milliseconds limit)
      : GrpcCall(its_method, its_context, request, limit), response_(response) {}

  void answered(Outcome<Reply> outcome) override {
    if (!outcome.ok()) return Finish(to_grpc(outcome.error()));
    grpc::Status status;
    try {
      bool is_own = false;
      status = grpc::SerializationTraits<google::protobuf::Message>::Serialize(*outcome.message(),
                                                                               &response_, &is_own);
    } catch (...) {
      status = to_grpc(error_of_exception());
    }
    Finish(status);
  }
  void OnCancel() override { set_cancelled(); }
  void OnDone() override { delete this; }

 private:
  /// Lets gRPC call OnCancel and OnDone directly instead of on a thread of its own.
  bool InternalInlineable() override { return true; }

  Bytes& response_;
};

}  // namespace

CallContext call_context(const Context& context, const std::string& peer,
                         std::chrono::milliseconds limit, const std::atomic<bool>& cancelled) {
  using std::chrono::system_clock;
  // A limit of 0 gives a deadline that has passed, whatever the client's.
  const auto left =
      std::min<system_clock::duration>(context.deadline() - system_clock::now(), limit);
  // For a Unix socket the peer is a path that the client chose.
  return call_context({.client = header(context, "tribodyn-client"),
                       .request_id = header(context, "tribodyn-request-id"),
                       .peer = peer},
                      left, cancelled);
}

/// Returns the common name of the client's certificate if TLS has verified it; else "".
std::string certificate_name(const Context& context) {
  const auto connection = context.auth_context();
  if (!connection || !connection->IsPeerAuthenticated()) return {};
  const auto names = connection->FindPropertyValues(GRPC_X509_CN_PROPERTY_NAME);
  return names.size() == 1 ? std::string(names.front().data(), names.front().size()) : "";
}

Credentials credentials_of(const Context& context, const std::string& peer) {
  Credentials out;
  // gRPC writes the kind of the socket in front of the client's own words. The acceptor has closed
  // connections of other users to a Unix socket.
  out.is_owner = peer.starts_with("unix");
  out.authorization = std::string(header(context, "authorization"));
  // A token goes before a certificate, which gRPC copies for each call.
  if (!out.is_owner && out.authorization.empty()) out.certificate = certificate_name(context);
  return out;
}

std::vector<std::unique_ptr<grpc::Service>> grpc_services(
    CallDispatcher& dispatcher, const std::shared_ptr<LiveStreams>& live) {
  std::map<const google::protobuf::ServiceDescriptor*, std::unique_ptr<ContractService>> services;
  for (const Method& method : dispatcher.methods()) {
    auto& service = services[method.descriptor->service()];
    if (!service) service = std::make_unique<ContractService>();
    if (method.open) {
      service->add_stream(
          *method.descriptor, [&dispatcher, &method, live](Context* context, const Bytes* request) {
            return StreamReactor::start(dispatcher, live, method, *context, *request);
          });
    } else {
      service->add_unary(*method.descriptor, [&](Context* context, const Bytes* request,
                                                 Bytes* response) {
        auto* reactor = new UnaryReactor(method, *context, *request, *response,  // deletes itself
                                         dispatcher.limits().call);
        dispatcher.answer(*reactor);
        return reactor;
      });
    }
  }
  std::vector<std::unique_ptr<grpc::Service>> out;
  for (auto& [descriptor, service] : services) out.push_back(std::move(service));
  return out;
}

}  // namespace tribodyn::server
