#include "tribodyn/client/connection.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "client/cpp/library/services.h"

namespace tribodyn::client {

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// The socket at which tribodynd listens by default.
std::string own_socket() {
  const std::string runtime = environment("XDG_RUNTIME_DIR"), home = environment("HOME");
  if (!runtime.empty()) return runtime + "/tribodyn/socket";
  return home.empty() ? "" : home + "/.tribodyn/socket";
}

/// Returns the first word of a file. Throws std::invalid_argument.
std::string read_token(const std::string& path) {
  std::ifstream file(path);
  std::string out;
  if (!(file >> out)) throw std::invalid_argument("no token can be read from the file " + path);
  return out;
}

}  // namespace

std::string server_address(const std::string& address) {
  if (!address.empty()) return address;
  if (std::string named = environment(kServerVariable); !named.empty()) return named;
  const std::string socket = own_socket();
  std::error_code missing;
  if (!socket.empty() && std::filesystem::is_socket(socket, missing)) return "unix:" + socket;
  return kDefaultServer;
}

std::string token_file(const std::string& path) {
  return path.empty() ? environment(kTokenFileVariable) : path;
}

void Connection::Services::prepare(grpc::ClientContext& context) const {
  if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
}

Connection::Connection(std::string address, std::chrono::duration<double> timeout,
                       std::string project, const std::string& token)
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
  if (!token.empty()) services_->token = read_token(token);
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
