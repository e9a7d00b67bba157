#include "tribodyn/client/connection.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
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

/// Throws std::invalid_argument.
std::string read_file(const std::string& path, const char* what) {
  std::stringstream out;
  std::ifstream file(path);
  if (!file || !(out << file.rdbuf())) {
    throw std::invalid_argument(std::string("no ") + what + " can be read from the file " + path);
  }
  return out.str();
}

/// The first word of a file.
std::string read_token(const std::string& path) {
  std::istringstream text(read_file(path, "token"));
  std::string out;
  if (!(text >> out)) throw std::invalid_argument("the file " + path + " holds no token");
  return out;
}

/// True if nothing that is sent to the address leaves this machine.
bool is_local(const std::string& address) {
  return address.starts_with("unix:") || address.starts_with("127.") ||
         address.starts_with("[::1]") || address.starts_with("localhost:") ||
         address == "localhost";
}

std::shared_ptr<grpc::ChannelCredentials> channel_credentials(const std::string& address,
                                                              const AccessFiles& access) {
  if (access.authorities.empty() && is_local(address)) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions options;
  if (!access.authorities.empty()) {
    options.pem_root_certs = read_file(access.authorities, "certificates");
  }
  if (access.certificate.empty() != access.key.empty()) {
    throw std::invalid_argument("a certificate of the client and its key need each other");
  }
  if (!access.certificate.empty()) {
    options.pem_cert_chain = read_file(access.certificate, "certificate");
    options.pem_private_key = read_file(access.key, "key");
  }
  return grpc::SslCredentials(options);
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

AccessFiles access_files(AccessFiles files) {
  const auto complete = [](std::string& path, const char* variable) {
    if (path.empty()) path = environment(variable);
  };
  complete(files.token, "TRIBODYN_TOKEN_FILE");
  complete(files.authorities, "TRIBODYN_CA_FILE");
  complete(files.certificate, "TRIBODYN_CERTIFICATE_FILE");
  complete(files.key, "TRIBODYN_KEY_FILE");
  return files;
}

void Connection::Services::prepare(grpc::ClientContext& context) const {
  if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
}

Connection::Connection(std::string address, std::chrono::duration<double> timeout,
                       std::string project, const AccessFiles& access)
    : services_(std::make_unique<Services>()) {
  grpc::ChannelArguments arguments;
  // With BDP probes, gRPC would buffer megabytes of a watch stream that is not read.
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  // http_proxy is for web sites; a server on loopback or in the local network is not behind it.
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  // As large as the server sends: the candidates of a campaign may take 32 MiB.
  arguments.SetMaxReceiveMessageSize(33 << 20);
  services_->address = std::move(address);
  services_->timeout = timeout;
  services_->project = std::move(project);
  if (!access.token.empty()) services_->token = read_token(access.token);
  services_->channel = grpc::CreateCustomChannel(
      services_->address, channel_credentials(services_->address, access), arguments);
#define TRIBODYN_NEW_STUB(Resource, field, collection, seed) \
  services_->field##s = v1::Resource##Service::NewStub(services_->channel);
  TRIBODYN_RESOURCE_KINDS(TRIBODYN_NEW_STUB)
#undef TRIBODYN_NEW_STUB
  services_->simulations = v1::SimulationService::NewStub(services_->channel);
  services_->campaigns = v1::CampaignService::NewStub(services_->channel);
  services_->points = v1::PointService::NewStub(services_->channel);
  services_->contacts = v1::ContactService::NewStub(services_->channel);
  services_->cycles = v1::CycleService::NewStub(services_->channel);
  services_->profiles = v1::ProfileService::NewStub(services_->channel);
  services_->rigs = v1::RigService::NewStub(services_->channel);
  services_->spectra = v1::SpectrumService::NewStub(services_->channel);
  services_->viscosities = v1::ViscosityService::NewStub(services_->channel);
  services_->schemas = v1::SchemaService::NewStub(services_->channel);
}

Connection::~Connection() = default;

void Connection::report_waits(std::function<void(const std::string&)> report) {
  services_->report_wait = std::move(report);
}

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

v1::EvaluateCycleResponse Connection::evaluate_cycle(const v1::EvaluateCycleRequest& request) {
  return services_->call(*services_->cycles, &v1::CycleService::Stub::EvaluateCycle, request);
}

v1::EvaluateProfilesResponse Connection::evaluate_profiles(
    const v1::EvaluateProfilesRequest& request) {
  return services_->call(*services_->profiles, &v1::ProfileService::Stub::EvaluateProfiles,
                         request);
}

v1::EvaluateRigResponse Connection::evaluate_rig(const v1::EvaluateRigRequest& request) {
  return services_->call(*services_->rigs, &v1::RigService::Stub::EvaluateRig, request);
}

v1::EvaluateViscosityResponse Connection::evaluate_viscosity(
    const v1::EvaluateViscosityRequest& request) {
  return services_->call(*services_->viscosities, &v1::ViscosityService::Stub::EvaluateViscosity,
                         request);
}

v1::ReadSpectrumResponse Connection::read_spectrum(const v1::ReadSpectrumRequest& request) {
  return services_->call(*services_->spectra, &v1::SpectrumService::Stub::ReadSpectrum, request);
}

v1::EvaluatePointsResponse Connection::evaluate_points(const v1::EvaluatePointsRequest& request) {
  return services_->call(*services_->points, &v1::PointService::Stub::EvaluatePoints, request);
}

v1::ComparePointsResponse Connection::compare_points(const v1::ComparePointsRequest& request) {
  return services_->call(*services_->points, &v1::PointService::Stub::ComparePoints, request);
}

v1::ExplainPointsResponse Connection::explain_points(const v1::ExplainPointsRequest& request) {
  return services_->call(*services_->points, &v1::PointService::Stub::ExplainPoints, request);
}

}  // namespace tribodyn::client
