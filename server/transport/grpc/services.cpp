#include "server/transport/grpc/services.h"

#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/application/call_context.h"
#include "server/application/contacts.h"
#include "server/application/guard.h"
#include "server/application/imports.h"
#include "server/application/log_text.h"
#include "server/application/request_limits.h"
#include "server/application/resources.h"
#include "server/application/schemas.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"
#include "server/transport/byte_budget.h"
#include "server/transport/grpc/contract_service.h"
#include "server/transport/grpc/grpc_status.h"
#include "server/transport/grpc/read_request.h"
#include "server/transport/grpc/stream_reactor.h"
#include "server/transport/workers.h"

namespace tribodyn::server {
namespace {

using Bytes = grpc::ByteBuffer;
using Context = grpc::CallbackServerContext;
using Unary = grpc::ServerUnaryReactor;
using google::protobuf::MethodDescriptor;
using google::protobuf::ServiceDescriptor;
using std::chrono::system_clock;

constexpr char kClientMetadata[] = "tribodyn-client";
constexpr char kRequestIdMetadata[] = "tribodyn-request-id";
constexpr std::size_t kLongestWord = 100;  // of the client and the request id [bytes]
constexpr int kWorkers = 8;                // more only wait for the processors
/// Bytes of requests, of those above kUsualRequestBytes, that are worked on at a time: two of the
/// largest.
constexpr std::size_t kRequestBytesAtATime = 2 * kMaximumRequestBytes;
constexpr int kBusySeconds = 2;  // most batches end sooner

/// What all calls share.
struct Serving {
  Serving(Application& its_application, const TimeLimits& its_limits, LiveStreams& its_live)
      : application(its_application), limits(its_limits), live(its_live) {}

  Application& application;
  const TimeLimits limits;
  LiveStreams& live;
  ByteBudget budget{kRequestBytesAtATime, kUsualRequestBytes};
  Workers workers{kWorkers};
};

/// What its client and the server still allow of a call. A limit of nothing leaves nothing,
/// whatever happens between two looks at the clock.
system_clock::duration time_left(const Context& context, std::chrono::milliseconds limit) {
  return std::min<system_clock::duration>(context.deadline() - system_clock::now(), limit);
}

/// The value of a header as one word; empty: not there.
std::string word_of(const Context& context, const char* header) {
  const auto found = context.client_metadata().find(header);
  if (found == context.client_metadata().end()) return {};
  return log_word({found->second.data(), found->second.size()}, kLongestWord);
}

CallContext call_context(const Context& context, std::chrono::milliseconds limit) {
  static std::atomic<std::uint64_t> count = 0;
  const std::string client = word_of(context, kClientMetadata);
  const std::string id = word_of(context, kRequestIdMetadata);
  return {// Of a Unix socket the peer is a path that the client chose.
          .client = client.empty() ? log_word(context.peer(), kLongestWord) : client,
          .request_id = id.empty() ? std::to_string(++count) : id,
          .limits = {.deadline = CallLimits::Clock::now() + time_left(context, limit)}};
}

/// Which thread answers.
enum class Thread {
  kOfGrpc,
  kOfAWorker,  ///< what waits for the disk
};

struct UnaryMethod {
  const MethodDescriptor& descriptor;
  Thread thread;
  std::function<Outcome<Bytes>(Bytes& request, const CallContext& call)> answer;
};

/// Answers a call under its deadline and within the budget for large requests.
void finish(const UnaryMethod& method, Serving& serving, const Context& context, Unary& reactor,
            Bytes& request, Bytes& response) {
  const CallContext call = call_context(context, serving.limits.call);
  Outcome<Bytes> outcome = guarded<Bytes>([&]() -> Outcome<Bytes> {
    if (call.limits.are_over()) return call_over(call.limits);
    const auto lease = serving.budget.take(request.Length());
    if (!lease) {
      return exhausted(v1::ERROR_REASON_TOO_MANY_LARGE_REQUESTS,
                       "other large requests are being worked on; try again in 2 s", kBusySeconds);
    }
    return method.answer(request, call);
  });
  request.Clear();
  if (!outcome.ok()) return reactor.Finish(to_grpc(outcome.error()));
  response = outcome.message();
  reactor.Finish(grpc::Status::OK);
}

template <class Request, class Response, class Body>
Outcome<Bytes> answer_bytes(const MethodDescriptor& method, Bytes& bytes, const Body& body) {
  Request request;
  if (auto refused = read_request(method, bytes, request)) return *std::move(refused);
  Outcome<Response> outcome = body(request);
  if (!outcome.ok()) return outcome.error();
  Bytes out;
  bool is_own = false;
  const grpc::Status status =
      grpc::SerializationTraits<Response>::Serialize(outcome.message(), &out, &is_own);
  if (status.ok()) return out;
  return internal_error("an answer cannot be serialised: " + status.error_message());
}

/// Binds the methods of a service to their bodies.
class Binder {
 public:
  Binder(std::shared_ptr<Serving> serving, const google::protobuf::Descriptor& message,
         const char* service)
      : serving_(std::move(serving)),
        descriptor_(*message.file()->FindServiceByName(service)),
        service_(std::make_unique<ContractService>()) {}

  template <class Request, class Response>
  void unary(const char* name,
             Outcome<Response> (*body)(Application&, const Request&, const CallContext&),
             Thread thread = Thread::kOfGrpc) {
    const MethodDescriptor& method = checked<Request, Response>(name);
    add({method, thread,
         [serving = serving_.get(), &method, body](Bytes& bytes, const CallContext& call) {
           return answer_bytes<Request, Response>(method, bytes, [&](const Request& request) {
             return body(serving->application, request, call);
           });
         }});
  }

  template <class Message, class Request>
  void stream(const char* name,
              StreamOutcome<Message> (*open)(Application&, const Request&, const CallContext&)) {
    const MethodDescriptor& method = checked<Request, Message>(name);
    const auto open_bytes = [serving = serving_.get(), &method, open](
                                Bytes& bytes, const CallContext& call) -> StreamOutcome<Message> {
      Request request;
      if (auto refused = read_request(method, bytes, request)) return *std::move(refused);
      return open(serving->application, request, call);
    };
    service_->add_stream(
        method, [serving = serving_, open_bytes](Context* context, const Bytes* request) {
          const CallContext call = call_context(*context, serving->limits.stream);
          const auto open_request = [&]() -> StreamOutcome<Message> {
            if (call.limits.are_over()) return call_over(call.limits);
            return guarded<typename StreamReactor<Message>::Source>(
                [&] { return open_bytes(const_cast<Bytes&>(*request), call); });
          };
          return StreamReactor<Message>::start(serving->live, *context,
                                               time_left(*context, serving->limits.stream),
                                               serving->limits.unread, open_request);
        });
  }

  /// Throws std::logic_error if a method has no body.
  std::unique_ptr<grpc::Service> service() {
    if (service_->size() != descriptor_.method_count()) {
      throw std::logic_error("methods without a body in " + descriptor_.full_name());
    }
    return std::move(service_);
  }

 private:
  template <class Request, class Response>
  const MethodDescriptor& checked(const char* name) const {
    const MethodDescriptor* method = descriptor_.FindMethodByName(name);
    if (method == nullptr || method->input_type() != Request::descriptor() ||
        method->output_type() != Response::descriptor()) {
      throw std::logic_error(std::string("the contract has no such method: ") + name);
    }
    return *method;
  }

  void add(UnaryMethod method) {
    const MethodDescriptor& descriptor = method.descriptor;
    service_->add_unary(descriptor, [serving = serving_, method = std::move(method)](
                                        Context* context, const Bytes* request, Bytes* response) {
      Unary* reactor = context->DefaultReactor();
      // The bytes are this call's alone, and are let go as soon as they are parsed.
      auto* bytes = const_cast<Bytes*>(request);
      const auto answer = [&serving = *serving, &method, context, reactor, bytes, response] {
        finish(method, serving, *context, *reactor, *bytes, *response);
      };
      if (method.thread == Thread::kOfGrpc) {
        answer();
      } else {
        serving->workers.run(answer);
      }
      return reactor;
    });
  }

  const std::shared_ptr<Serving> serving_;
  const ServiceDescriptor& descriptor_;
  std::unique_ptr<ContractService> service_;
};

std::unique_ptr<grpc::Service> lubricants(const std::shared_ptr<Serving>& serving) {
  Binder bind(serving, *v1::Lubricant::descriptor(), "LubricantService");
  bind.unary("CreateLubricant", create_lubricant);
  bind.unary("BatchCreateLubricants", batch_create_lubricants);
  bind.unary("ImportLubricant", import_lubricant);
  bind.unary("GetLubricant", get_lubricant);
  bind.unary("ListLubricants", list_lubricants);
  bind.unary("UpdateLubricant", update_lubricant);
  bind.unary("BatchUpdateLubricants", batch_update_lubricants);
  bind.unary("ListLubricantRevisions", list_lubricant_revisions);
  bind.unary("DeleteLubricant", delete_lubricant);
  bind.unary("UndeleteLubricant", undelete_lubricant);
  return bind.service();
}

std::unique_ptr<grpc::Service> gear_sets(const std::shared_ptr<Serving>& serving) {
  Binder bind(serving, *v1::GearSet::descriptor(), "GearSetService");
  bind.unary("CreateGearSet", create_gear_set);
  bind.unary("BatchCreateGearSets", batch_create_gear_sets);
  bind.unary("ImportGearSet", import_gear_set);
  bind.unary("GetGearSet", get_gear_set);
  bind.unary("ListGearSets", list_gear_sets);
  bind.unary("UpdateGearSet", update_gear_set);
  bind.unary("BatchUpdateGearSets", batch_update_gear_sets);
  bind.unary("ListGearSetRevisions", list_gear_set_revisions);
  bind.unary("DeleteGearSet", delete_gear_set);
  bind.unary("UndeleteGearSet", undelete_gear_set);
  return bind.service();
}

std::unique_ptr<grpc::Service> surfaces(const std::shared_ptr<Serving>& serving) {
  Binder bind(serving, *v1::Surface::descriptor(), "SurfaceService");
  bind.unary("CreateSurface", create_surface);
  bind.unary("BatchCreateSurfaces", batch_create_surfaces);
  bind.unary("ImportSurfaceProfiles", import_surface_profiles);
  bind.unary("GetSurface", get_surface);
  bind.unary("ListSurfaces", list_surfaces);
  bind.unary("UpdateSurface", update_surface);
  bind.unary("BatchUpdateSurfaces", batch_update_surfaces);
  bind.unary("ListSurfaceRevisions", list_surface_revisions);
  bind.unary("DeleteSurface", delete_surface);
  bind.unary("UndeleteSurface", undelete_surface);
  return bind.service();
}

std::unique_ptr<grpc::Service> vehicles(const std::shared_ptr<Serving>& serving) {
  Binder bind(serving, *v1::Vehicle::descriptor(), "VehicleService");
  bind.unary("CreateVehicle", create_vehicle);
  bind.unary("BatchCreateVehicles", batch_create_vehicles);
  bind.unary("GetVehicle", get_vehicle);
  bind.unary("ListVehicles", list_vehicles);
  bind.unary("UpdateVehicle", update_vehicle);
  bind.unary("BatchUpdateVehicles", batch_update_vehicles);
  bind.unary("ListVehicleRevisions", list_vehicle_revisions);
  bind.unary("DeleteVehicle", delete_vehicle);
  bind.unary("UndeleteVehicle", undelete_vehicle);
  return bind.service();
}

std::unique_ptr<grpc::Service> schemas(const std::shared_ptr<Serving>& serving) {
  Binder bind(serving, *v1::Schema::descriptor(), "SchemaService");
  bind.unary("GetSchema", get_schema);
  return bind.service();
}

std::unique_ptr<grpc::Service> contacts(const std::shared_ptr<Serving>& serving) {
  Binder bind(serving, *v1::EvaluateContactRequest::descriptor(), "ContactService");
  bind.unary("EvaluateContact", evaluate_contact);
  return bind.service();
}

std::unique_ptr<grpc::Service> simulations(const std::shared_ptr<Serving>& serving) {
  Binder bind(serving, *v1::Simulation::descriptor(), "SimulationService");
  bind.unary("CreateSimulation", create_simulation, Thread::kOfAWorker);
  bind.unary("GetSimulation", get_simulation);
  bind.unary("ListSimulations", list_simulations);
  bind.unary("CancelSimulation", cancel_simulation, Thread::kOfAWorker);
  bind.unary("UpdateSimulation", update_simulation, Thread::kOfAWorker);
  bind.unary("PinSimulation", pin_simulation);
  bind.unary("UnpinSimulation", unpin_simulation);
  bind.stream("WatchSimulation", watch_simulation);
  bind.stream("ReadHistory", read_history);
  return bind.service();
}

}  // namespace

std::vector<std::unique_ptr<grpc::Service>> grpc_services(Application& application,
                                                          LiveStreams& live,
                                                          const TimeLimits& limits) {
  const auto serving = std::make_shared<Serving>(application, limits, live);
  std::vector<std::unique_ptr<grpc::Service>> out;
  for (const auto& service :
       {lubricants, gear_sets, surfaces, vehicles, schemas, contacts, simulations}) {
    out.push_back(service(serving));
  }
  return out;
}

}  // namespace tribodyn::server
