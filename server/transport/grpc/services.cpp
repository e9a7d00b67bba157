#include "server/transport/grpc/services.h"

#include <grpcpp/impl/codegen/proto_utils.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "server/application/guard.h"
#include "server/application/log_text.h"
#include "server/transport/grpc/contract_service.h"
#include "server/transport/grpc/grpc_call.h"
#include "server/transport/grpc/grpc_status.h"
#include "server/transport/grpc/stream_reactor.h"

namespace tribodyn::server {
namespace {

using Bytes = grpc::ByteBuffer;
using Context = grpc::CallbackServerContext;

constexpr char kClientMetadata[] = "tribodyn-client";
constexpr char kRequestIdMetadata[] = "tribodyn-request-id";
constexpr std::size_t kLongestWord = 100;  // of the client's name and of the request id [bytes]

/// Returns the value of a header as one word; empty if the header is missing.
std::string word_of(const Context& context, const char* header) {
  const auto found = context.client_metadata().find(header);
  if (found == context.client_metadata().end()) return {};
  return log_word({found->second.data(), found->second.size()}, kLongestWord);
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

CallContext call_context(const Context& context, std::chrono::milliseconds limit,
                         const std::atomic<bool>& cancelled) {
  using std::chrono::system_clock;
  static std::atomic<std::uint64_t> count = 0;
  const std::string client = word_of(context, kClientMetadata);
  const std::string id = word_of(context, kRequestIdMetadata);
  // A limit of 0 gives a deadline that has passed, whatever the client's.
  const auto left =
      std::min<system_clock::duration>(context.deadline() - system_clock::now(), limit);
  return {// For a Unix socket the peer is a path that the client chose.
          .client = client.empty() ? log_word(context.peer(), kLongestWord) : client,
          .request_id = id.empty() ? std::to_string(++count) : id,
          .limits = {.deadline = CallLimits::Clock::now() + left, .cancelled = &cancelled}};
}

std::vector<std::unique_ptr<grpc::Service>> grpc_services(CallDispatcher& dispatcher,
                                                          LiveStreams& live) {
  std::map<const google::protobuf::ServiceDescriptor*, std::unique_ptr<ContractService>> services;
  for (const Method& method : dispatcher.methods()) {
    auto& service = services[method.descriptor->service()];
    if (!service) service = std::make_unique<ContractService>();
    if (method.open) {
      service->add_stream(*method.descriptor, [&](Context* context, const Bytes* request) {
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
