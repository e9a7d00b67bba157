#include "server/api/services.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/api/grpc_status.h"
#include "server/api/stream_reactor.h"
#include "server/api/workers.h"
#include "server/app/contacts.h"
#include "server/app/imports.h"
#include "server/app/resources.h"
#include "server/app/schemas.h"
#include "server/app/simulations.h"
#include "server/app/streams.h"
#include "server/store/deadline.h"
#include "tribodyn/v1/contacts.grpc.pb.h"
#include "tribodyn/v1/gear_sets.grpc.pb.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"
#include "tribodyn/v1/schemas.grpc.pb.h"
#include "tribodyn/v1/simulations.grpc.pb.h"
#include "tribodyn/v1/surfaces.grpc.pb.h"
#include "tribodyn/v1/vehicles.grpc.pb.h"

namespace tribodyn::server {
namespace {

using Context = grpc::CallbackServerContext;
using Unary = grpc::ServerUnaryReactor;
using std::chrono::system_clock;

constexpr char kClientMetadata[] = "tribodyn-client";
constexpr std::size_t kLongestClient = 100;
constexpr int kWorkers = 8;  // more only wait for the processors

/// What its client and the server still allow of a call. A limit of nothing leaves nothing,
/// whatever happens between two looks at the clock.
system_clock::duration time_left(const Context& context, std::chrono::milliseconds limit) {
  return std::min<system_clock::duration>(context.deadline() - system_clock::now(), limit);
}

/// The client that the call names, else its connection.
Caller caller(const Context& context) {
  const auto named = context.client_metadata().find(kClientMetadata);
  if (named == context.client_metadata().end()) return {context.peer()};
  std::string name(named->second.data(), std::min(named->second.size(), kLongestClient));
  // It goes into the log, where a line is made of words.
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c <= ' ' || c > '~' || c == '='; }, '_');
  return {name};
}

/// Bodies of unary methods, each under its deadline.
class UnaryService {
 public:
  UnaryService(Application& application, const TimeLimits& limits)
      : application_(application), limit_(limits.call) {}

 protected:
  template <class Message, class Body>
  Unary* answer(Context* context, Message* response, const Body& body) const {
    Unary* reactor = context->DefaultReactor();
    finish(context, reactor, response, body);
    return reactor;
  }

  /// The same by a worker, of what waits for the disk.
  template <class Message, class Body>
  Unary* answer_later(Workers& workers, Context* context, Message* response,
                      const Body& body) const {
    Unary* reactor = context->DefaultReactor();
    workers.run([=, this] { finish(context, reactor, response, body); });
    return reactor;
  }

  Application& application_;

 private:
  template <class Message, class Body>
  void finish(Context* context, Unary* reactor, Message* response, const Body& body) const {
    const DeadlineScope deadline(DeadlineScope::Clock::now() + time_left(*context, limit_));
    Outcome<Message> outcome =
        DeadlineScope::has_passed() ? Outcome<Message>(deadline_exceeded()) : body();
    if (outcome.ok()) {
      *response = std::move(outcome.message());
      reactor->Finish(grpc::Status::OK);
    } else {
      reactor->Finish(to_grpc(outcome.error()));
    }
  }

  const std::chrono::milliseconds limit_;
};

class LubricantsService final : public v1::Lubricants::CallbackService, UnaryService {
 public:
  using UnaryService::UnaryService;
  Unary* CreateLubricant(Context* context, const v1::CreateLubricantRequest* request,
                         v1::Lubricant* response) override {
    return answer(context, response, [&] { return create_lubricant(application_, *request); });
  }
  Unary* BatchCreateLubricants(Context* context, const v1::BatchCreateLubricantsRequest* request,
                               v1::BatchCreateLubricantsResponse* response) override {
    return answer(context, response,
                  [&] { return batch_create_lubricants(application_, *request); });
  }
  Unary* ImportLubricant(Context* context, const v1::ImportLubricantRequest* request,
                         v1::Lubricant* response) override {
    return answer(context, response, [&] { return import_lubricant(application_, *request); });
  }
  Unary* GetLubricant(Context* context, const v1::GetLubricantRequest* request,
                      v1::Lubricant* response) override {
    return answer(context, response, [&] { return get_lubricant(application_, *request); });
  }
  Unary* ListLubricants(Context* context, const v1::ListLubricantsRequest* request,
                        v1::ListLubricantsResponse* response) override {
    return answer(context, response, [&] { return list_lubricants(application_, *request); });
  }
  Unary* UpdateLubricant(Context* context, const v1::UpdateLubricantRequest* request,
                         v1::Lubricant* response) override {
    return answer(context, response, [&] { return update_lubricant(application_, *request); });
  }
  Unary* BatchUpdateLubricants(Context* context, const v1::BatchUpdateLubricantsRequest* request,
                               v1::BatchUpdateLubricantsResponse* response) override {
    return answer(context, response,
                  [&] { return batch_update_lubricants(application_, *request); });
  }
  Unary* ListLubricantRevisions(Context* context, const v1::ListLubricantRevisionsRequest* request,
                                v1::ListLubricantRevisionsResponse* response) override {
    return answer(context, response,
                  [&] { return list_lubricant_revisions(application_, *request); });
  }
  Unary* DeleteLubricant(Context* context, const v1::DeleteLubricantRequest* request,
                         v1::Lubricant* response) override {
    return answer(context, response, [&] { return delete_lubricant(application_, *request); });
  }
  Unary* UndeleteLubricant(Context* context, const v1::UndeleteLubricantRequest* request,
                           v1::Lubricant* response) override {
    return answer(context, response, [&] { return undelete_lubricant(application_, *request); });
  }
};

class GearSetsService final : public v1::GearSets::CallbackService, UnaryService {
 public:
  using UnaryService::UnaryService;
  Unary* CreateGearSet(Context* context, const v1::CreateGearSetRequest* request,
                       v1::GearSet* response) override {
    return answer(context, response, [&] { return create_gear_set(application_, *request); });
  }
  Unary* BatchCreateGearSets(Context* context, const v1::BatchCreateGearSetsRequest* request,
                             v1::BatchCreateGearSetsResponse* response) override {
    return answer(context, response,
                  [&] { return batch_create_gear_sets(application_, *request); });
  }
  Unary* ImportGearSet(Context* context, const v1::ImportGearSetRequest* request,
                       v1::GearSet* response) override {
    return answer(context, response, [&] { return import_gear_set(application_, *request); });
  }
  Unary* GetGearSet(Context* context, const v1::GetGearSetRequest* request,
                    v1::GearSet* response) override {
    return answer(context, response, [&] { return get_gear_set(application_, *request); });
  }
  Unary* ListGearSets(Context* context, const v1::ListGearSetsRequest* request,
                      v1::ListGearSetsResponse* response) override {
    return answer(context, response, [&] { return list_gear_sets(application_, *request); });
  }
  Unary* UpdateGearSet(Context* context, const v1::UpdateGearSetRequest* request,
                       v1::GearSet* response) override {
    return answer(context, response, [&] { return update_gear_set(application_, *request); });
  }
  Unary* BatchUpdateGearSets(Context* context, const v1::BatchUpdateGearSetsRequest* request,
                             v1::BatchUpdateGearSetsResponse* response) override {
    return answer(context, response,
                  [&] { return batch_update_gear_sets(application_, *request); });
  }
  Unary* ListGearSetRevisions(Context* context, const v1::ListGearSetRevisionsRequest* request,
                              v1::ListGearSetRevisionsResponse* response) override {
    return answer(context, response,
                  [&] { return list_gear_set_revisions(application_, *request); });
  }
  Unary* DeleteGearSet(Context* context, const v1::DeleteGearSetRequest* request,
                       v1::GearSet* response) override {
    return answer(context, response, [&] { return delete_gear_set(application_, *request); });
  }
  Unary* UndeleteGearSet(Context* context, const v1::UndeleteGearSetRequest* request,
                         v1::GearSet* response) override {
    return answer(context, response, [&] { return undelete_gear_set(application_, *request); });
  }
};

class SurfacesService final : public v1::Surfaces::CallbackService, UnaryService {
 public:
  using UnaryService::UnaryService;
  Unary* CreateSurface(Context* context, const v1::CreateSurfaceRequest* request,
                       v1::Surface* response) override {
    return answer(context, response, [&] { return create_surface(application_, *request); });
  }
  Unary* BatchCreateSurfaces(Context* context, const v1::BatchCreateSurfacesRequest* request,
                             v1::BatchCreateSurfacesResponse* response) override {
    return answer(context, response, [&] { return batch_create_surfaces(application_, *request); });
  }
  Unary* ImportSurfaceProfiles(Context* context, const v1::ImportSurfaceProfilesRequest* request,
                               v1::Surface* response) override {
    return answer(context, response,
                  [&] { return import_surface_profiles(application_, *request); });
  }
  Unary* GetSurface(Context* context, const v1::GetSurfaceRequest* request,
                    v1::Surface* response) override {
    return answer(context, response, [&] { return get_surface(application_, *request); });
  }
  Unary* ListSurfaces(Context* context, const v1::ListSurfacesRequest* request,
                      v1::ListSurfacesResponse* response) override {
    return answer(context, response, [&] { return list_surfaces(application_, *request); });
  }
  Unary* UpdateSurface(Context* context, const v1::UpdateSurfaceRequest* request,
                       v1::Surface* response) override {
    return answer(context, response, [&] { return update_surface(application_, *request); });
  }
  Unary* BatchUpdateSurfaces(Context* context, const v1::BatchUpdateSurfacesRequest* request,
                             v1::BatchUpdateSurfacesResponse* response) override {
    return answer(context, response, [&] { return batch_update_surfaces(application_, *request); });
  }
  Unary* ListSurfaceRevisions(Context* context, const v1::ListSurfaceRevisionsRequest* request,
                              v1::ListSurfaceRevisionsResponse* response) override {
    return answer(context, response,
                  [&] { return list_surface_revisions(application_, *request); });
  }
  Unary* DeleteSurface(Context* context, const v1::DeleteSurfaceRequest* request,
                       v1::Surface* response) override {
    return answer(context, response, [&] { return delete_surface(application_, *request); });
  }
  Unary* UndeleteSurface(Context* context, const v1::UndeleteSurfaceRequest* request,
                         v1::Surface* response) override {
    return answer(context, response, [&] { return undelete_surface(application_, *request); });
  }
};

class VehiclesService final : public v1::Vehicles::CallbackService, UnaryService {
 public:
  using UnaryService::UnaryService;
  Unary* CreateVehicle(Context* context, const v1::CreateVehicleRequest* request,
                       v1::Vehicle* response) override {
    return answer(context, response, [&] { return create_vehicle(application_, *request); });
  }
  Unary* BatchCreateVehicles(Context* context, const v1::BatchCreateVehiclesRequest* request,
                             v1::BatchCreateVehiclesResponse* response) override {
    return answer(context, response, [&] { return batch_create_vehicles(application_, *request); });
  }
  Unary* GetVehicle(Context* context, const v1::GetVehicleRequest* request,
                    v1::Vehicle* response) override {
    return answer(context, response, [&] { return get_vehicle(application_, *request); });
  }
  Unary* ListVehicles(Context* context, const v1::ListVehiclesRequest* request,
                      v1::ListVehiclesResponse* response) override {
    return answer(context, response, [&] { return list_vehicles(application_, *request); });
  }
  Unary* UpdateVehicle(Context* context, const v1::UpdateVehicleRequest* request,
                       v1::Vehicle* response) override {
    return answer(context, response, [&] { return update_vehicle(application_, *request); });
  }
  Unary* BatchUpdateVehicles(Context* context, const v1::BatchUpdateVehiclesRequest* request,
                             v1::BatchUpdateVehiclesResponse* response) override {
    return answer(context, response, [&] { return batch_update_vehicles(application_, *request); });
  }
  Unary* ListVehicleRevisions(Context* context, const v1::ListVehicleRevisionsRequest* request,
                              v1::ListVehicleRevisionsResponse* response) override {
    return answer(context, response,
                  [&] { return list_vehicle_revisions(application_, *request); });
  }
  Unary* DeleteVehicle(Context* context, const v1::DeleteVehicleRequest* request,
                       v1::Vehicle* response) override {
    return answer(context, response, [&] { return delete_vehicle(application_, *request); });
  }
  Unary* UndeleteVehicle(Context* context, const v1::UndeleteVehicleRequest* request,
                         v1::Vehicle* response) override {
    return answer(context, response, [&] { return undelete_vehicle(application_, *request); });
  }
};

class SchemasService final : public v1::Schemas::CallbackService, UnaryService {
 public:
  using UnaryService::UnaryService;
  Unary* GetSchema(Context* context, const v1::GetSchemaRequest* request,
                   v1::Schema* response) override {
    return answer(context, response, [&] { return get_schema(application_, *request); });
  }
};

class ContactsService final : public v1::Contacts::CallbackService, UnaryService {
 public:
  using UnaryService::UnaryService;
  Unary* EvaluateContact(Context* context, const v1::EvaluateContactRequest* request,
                         v1::EvaluateContactResponse* response) override {
    return answer(context, response, [&] { return evaluate_contact(application_, *request); });
  }
};

/// The streams of bytes, see StreamReactor.
using SimulationStreams = v1::Simulations::WithRawCallbackMethod_WatchSimulation<
    v1::Simulations::WithRawCallbackMethod_ReadHistory<v1::Simulations::CallbackService>>;

class SimulationsService final : public SimulationStreams, UnaryService {
 public:
  SimulationsService(Application& application, const TimeLimits& limits, LiveStreams& live)
      : UnaryService(application, limits), limits_(limits), live_(live), workers_(kWorkers) {}
  Unary* CreateSimulation(Context* context, const v1::CreateSimulationRequest* request,
                          v1::Simulation* response) override {
    return answer_later(workers_, context, response, [this, context, request] {
      return create_simulation(application_, *request, caller(*context));
    });
  }
  Unary* GetSimulation(Context* context, const v1::GetSimulationRequest* request,
                       v1::Simulation* response) override {
    return answer(context, response, [&] { return get_simulation(application_, *request); });
  }
  Unary* ListSimulations(Context* context, const v1::ListSimulationsRequest* request,
                         v1::ListSimulationsResponse* response) override {
    return answer(context, response, [&] { return list_simulations(application_, *request); });
  }
  Unary* CancelSimulation(Context* context, const v1::CancelSimulationRequest* request,
                          v1::Simulation* response) override {
    return answer_later(workers_, context, response,
                        [this, request] { return cancel_simulation(application_, *request); });
  }
  Unary* PinSimulation(Context* context, const v1::PinSimulationRequest* request,
                       v1::Simulation* response) override {
    return answer(context, response, [&] { return pin_simulation(application_, *request); });
  }
  Unary* UnpinSimulation(Context* context, const v1::UnpinSimulationRequest* request,
                         v1::Simulation* response) override {
    return answer(context, response, [&] { return unpin_simulation(application_, *request); });
  }
  grpc::ServerWriteReactor<grpc::ByteBuffer>* WatchSimulation(
      Context* context, const grpc::ByteBuffer* bytes) override {
    return stream<v1::SimulationEvent>(context, bytes, watch_simulation);
  }
  grpc::ServerWriteReactor<grpc::ByteBuffer>* ReadHistory(Context* context,
                                                          const grpc::ByteBuffer* bytes) override {
    return stream<v1::ReadHistoryResponse>(context, bytes, read_history);
  }

 private:
  template <class Message, class Request>
  grpc::ServerWriteReactor<grpc::ByteBuffer>* stream(
      Context* context, const grpc::ByteBuffer* bytes,
      StreamOutcome<Message> (*open)(Application&, const Request&)) {
    const auto opened = [&]() -> StreamOutcome<Message> {
      grpc::ByteBuffer copy = *bytes;  // of the references only
      Request request;
      if (!grpc::SerializationTraits<Request>::Deserialize(&copy, &request).ok()) {
        return invalid({{"", "the request cannot be read"}});
      }
      return open(application_, request);
    };
    return StreamReactor<Message>::start(live_, *context, time_left(*context, limits_.stream),
                                         limits_.unread, opened);
  }

  const TimeLimits limits_;
  LiveStreams& live_;
  Workers workers_;
};

}  // namespace

std::vector<std::unique_ptr<grpc::Service>> grpc_services(Application& application,
                                                          LiveStreams& live,
                                                          const TimeLimits& limits) {
  std::vector<std::unique_ptr<grpc::Service>> out;
  out.push_back(std::make_unique<LubricantsService>(application, limits));
  out.push_back(std::make_unique<GearSetsService>(application, limits));
  out.push_back(std::make_unique<SurfacesService>(application, limits));
  out.push_back(std::make_unique<VehiclesService>(application, limits));
  out.push_back(std::make_unique<SchemasService>(application, limits));
  out.push_back(std::make_unique<ContactsService>(application, limits));
  out.push_back(std::make_unique<SimulationsService>(application, limits, live));
  return out;
}

}  // namespace tribodyn::server
