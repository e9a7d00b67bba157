#include "server/transport/grpc/grpc_server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <grpcpp/server_builder.h>

#include <chrono>
#include <memory>
#include <utility>

#include "server/transport/grpc/protobuf_log.h"

namespace tribodyn::server {
namespace {

using ExternalConnections = grpc::experimental::ExternalConnectionAcceptor;

/// Memory of gRPC for all connections [bytes]: two of the largest requests, and open streams.
/// Beyond it gRPC ends calls with RESOURCE_EXHAUSTED.
constexpr std::size_t kGrpcBytes = 2 * kMaximumRequestBytes + (32 << 20);
constexpr int kMaximumStreamsPerConnection = 1000;
constexpr std::size_t kMaximumOpenStreams = 10'000;
/// Calls on a connection beyond which it is closed. Twice the limit above, because gRPC counts a
/// call for some time after it has ended, when its client may have begun the next one.
constexpr long kMaximumCallsPerConnection = 2 * kMaximumStreamsPerConnection;
/// Calls on all connections, those included whose requests have not arrived: twice as many as
/// streams may be open. gRPC keeps about 12 kB for each.
constexpr long kMaximumOpenCalls = 20'000;
constexpr int kMaximumReflectionThreads = 16;   // only reflection uses blocking threads
constexpr int kHandshakeMilliseconds = 10'000;  // then a silent connection is closed
constexpr int kIdleMilliseconds = 600'000;      // then a connection without calls is closed
/// Age at which a connection accepts no further calls; clients connect again by themselves. It is
/// closed when its streams must have ended, so that an unfinished request is not kept for ever.
constexpr int kConnectionAgeMilliseconds = 3'600'000;
constexpr unsigned kReloadSeconds = 2;  // interval of looks at the TLS files
constexpr auto kShutdownGrace = std::chrono::seconds(1);

/// Credentials of TLS 1.2 and later, with files that are read again when they change. gRPC goes on
/// with the former ones while the new key is not that of the new certificate.
std::shared_ptr<grpc::ServerCredentials> tls_credentials(const TlsFiles& files) {
  using grpc::experimental::FileWatcherCertificateProvider;
  require_usable(files);
  const auto provider = std::make_shared<FileWatcherCertificateProvider>(
      files.key, files.certificate, files.client_authorities, kReloadSeconds);
  grpc::experimental::TlsServerCredentialsOptions options(provider);
  options.watch_identity_key_cert_pairs();
  if (!files.client_authorities.empty()) {
    options.watch_root_certs();
    options.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return grpc::experimental::TlsServerCredentials(options);
}

}  // namespace

GrpcServer::GrpcServer(CallDispatcher& dispatcher, const std::vector<ListenAddress>& addresses,
                       const TlsFiles& tls)
    : live_(std::make_shared<LiveStreams>(kMaximumOpenStreams)),
      services_(grpc_services(dispatcher, live_)) {
  for (const ListenAddress& each : addresses) {
    require_tls(each, tls);
    acceptors_.emplace_back(each);
  }
  log_protobuf_reports();
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  const auto add_connections = [&builder](std::shared_ptr<grpc::ServerCredentials> credentials) {
    return std::shared_ptr<ExternalConnections>(
        builder.experimental().AddExternalConnectionAcceptor(
            grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD,
            std::move(credentials)));
  };
  const auto local = add_connections(grpc::InsecureServerCredentials());
  const auto remote = tls.is_set() ? add_connections(tls_credentials(tls)) : local;
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaximumStreamsPerConnection);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshakeMilliseconds);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, kIdleMilliseconds);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, kConnectionAgeMilliseconds);
  builder.AddChannelArgument(
      GRPC_ARG_MAX_CONNECTION_AGE_GRACE_MS,
      static_cast<int>((dispatcher.limits().stream + dispatcher.limits().call).count()));
  builder.SetMaxReceiveMessageSize(static_cast<int>(kMaximumRequestBytes));
  builder.SetMaxSendMessageSize(static_cast<int>(kMaximumResponseBytes));
  grpc::ResourceQuota quota("tribodynd");
  quota.SetMaxThreads(kMaximumReflectionThreads);
  quota.Resize(kGrpcBytes);
  builder.SetResourceQuota(quota);
  builder.SetSyncServerOption(grpc::ServerBuilder::NUM_CQS, 1);  // else one for each processor
  for (const auto& each : services_) builder.RegisterService(each.get());
  builder.RegisterCallbackGenericService(&unknown_methods_);
  server_ = builder.BuildAndStart();
  if (!server_) throw ListenError("gRPC cannot start");
  open_calls_.emplace(OpenCallWatch::Limits{kMaximumCallsPerConnection, kMaximumOpenCalls});
  set_serving(false);
  for (Acceptor& each : acceptors_) {
    each.start(
        [connections = each.address().is_remote() ? remote : local](int listener, int connection) {
          ExternalConnections::NewConnectionParameters accepted;
          accepted.listener_fd = listener;
          accepted.fd = connection;
          connections->HandleNewConnection(&accepted);
        });
  }
}

std::vector<std::string> GrpcServer::addresses() const {
  std::vector<std::string> out;
  for (const Acceptor& each : acceptors_) out.push_back(to_text(each.address()));
  return out;
}

GrpcServer::~GrpcServer() { shutdown(); }

void GrpcServer::set_serving(bool serving) {
  is_serving_ = serving;
  server_->GetHealthCheckService()->SetServingStatus(serving);
}

void GrpcServer::shutdown() {
  if (!server_) return;
  for (Acceptor& each : acceptors_) each.stop();
  set_serving(false);
  open_calls_.reset();
  live_->shut_down();
  server_->Shutdown(std::chrono::system_clock::now() + kShutdownGrace);
  server_->Wait();
  server_.reset();
}

}  // namespace tribodyn::server
