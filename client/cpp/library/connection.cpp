#include "tribodyn/client/connection.h"

#include <cstdlib>
#include <utility>

#include "client/cpp/library/services.h"

namespace tribodyn::client {

std::string server_address(const std::string& address) {
  if (!address.empty()) return address;
  const char* environment = std::getenv(kServerVariable);
  return environment != nullptr && *environment != '\0' ? environment : kDefaultServer;
}

Connection::Connection(std::string address, std::chrono::duration<double> timeout,
                       std::string project)
    : services_(std::make_unique<Services>()) {
  grpc::ChannelArguments arguments;
  // With BDP probes, gRPC would buffer megabytes of a watch stream that is not read.
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  // http_proxy is for web sites; a server on loopback or in the local network is not behind it.
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  // As large as the server sends: a gear set may take 15 MiB.
  arguments.SetMaxReceiveMessageSize(16 << 20);
  services_->address = std::move(address);
  services_->timeout = timeout;
  services_->project = std::move(project);
  services_->channel =
      grpc::CreateCustomChannel(services_->address, grpc::InsecureChannelCredentials(), arguments);
  services_->lubricants = v1::LubricantService::NewStub(services_->channel);
  services_->gear_sets = v1::GearSetService::NewStub(services_->channel);
  services_->surfaces = v1::SurfaceService::NewStub(services_->channel);
  services_->vehicles = v1::VehicleService::NewStub(services_->channel);
  services_->simulations = v1::SimulationService::NewStub(services_->channel);
  services_->contacts = v1::ContactService::NewStub(services_->channel);
  services_->schemas = v1::SchemaService::NewStub(services_->channel);
}

Connection::~Connection() = default;
Connection::Connection(Connection&& other) noexcept = default;
Connection& Connection::operator=(Connection&& other) noexcept = default;

const std::string& Connection::address() const { return services_->address; }

const std::string& Connection::project() const { return services_->project; }

v1::Schema Connection::schema(const std::string& message) {
  v1::GetSchemaRequest request;
  request.set_message(message);
  return services_->call(*services_->schemas, &v1::SchemaService::Stub::GetSchema, request);
}

v1::EvaluateContactResponse Connection::evaluate_contact(
    const v1::EvaluateContactRequest& request) {
  return services_->call(*services_->contacts, &v1::ContactService::Stub::EvaluateContact, request);
}

}  // namespace tribodyn::client
