#include "client/cpp/service/connection.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "client/cpp/service/errors.h"

namespace tribodyn::client {
namespace {

constexpr std::chrono::seconds kSecondTry(1);

/// Whether nothing was sent, so that even a call that is not idempotent may be tried again.
/// gRPC 1.51 reads errno too late after connect(): now and then a connection in progress passes for
/// a failed one (seen where /sys is not mounted, with "No such file or directory").
bool never_connected(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNAVAILABLE &&
         status.error_message().rfind("failed to connect to all addresses", 0) == 0;
}

}  // namespace

std::string server_address(const std::string& flag) {
  if (!flag.empty()) return flag;
  const char* environment = std::getenv("TRIBODYN_SERVER");
  return environment != nullptr && *environment != '\0' ? environment : kDefaultServer;
}

Connection::Connection(std::string address, std::chrono::duration<double> timeout)
    : address_(std::move(address)), timeout_(timeout) {
  grpc::ChannelArguments arguments;
  // An unread watch stream must not make the transport buffer megabytes of it.
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  // http_proxy is for the web; a server on loopback or in the same plant is not behind it.
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  channel_ = grpc::CreateCustomChannel(address_, grpc::InsecureChannelCredentials(), arguments);
  simulations_ = v1::Simulations::NewStub(channel_);
  lubricants_ = v1::Lubricants::NewStub(channel_);
  contacts_ = v1::Contacts::NewStub(channel_);
}

template <class Stub, class Request, class Response>
Response Connection::call(Stub& stub,
                          grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&,
                                                       Response*),
                          const Request& request) {
  using std::chrono::system_clock;
  const auto deadline =
      system_clock::now() + std::chrono::duration_cast<system_clock::duration>(timeout_);
  bool is_second_try = false;
  for (;;) {
    grpc::ClientContext context;
    context.set_deadline(deadline);
    Response response;
    const grpc::Status status = (stub.*method)(&context, request, &response);
    if (status.ok()) return response;
    if (is_second_try || !never_connected(status) ||
        !channel_->WaitForConnected(std::min(deadline, system_clock::now() + kSecondTry))) {
      throw to_failure(status, address_);
    }
    is_second_try = true;
  }
}

v1::Simulation Connection::create_simulation(const v1::Simulation& simulation) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = simulation;
  return call(*simulations_, &v1::Simulations::Stub::CreateSimulation, request);
}

v1::Simulation Connection::get_simulation(const std::string& name) {
  v1::GetSimulationRequest request;
  request.set_name(name);
  return call(*simulations_, &v1::Simulations::Stub::GetSimulation, request);
}

v1::Simulation Connection::cancel_simulation(const std::string& name) {
  v1::CancelSimulationRequest request;
  request.set_name(name);
  return call(*simulations_, &v1::Simulations::Stub::CancelSimulation, request);
}

v1::ListSimulationsResponse Connection::list_simulations(int limit) {
  v1::ListSimulationsResponse all;
  v1::ListSimulationsRequest request;
  do {
    request.set_page_size(std::min(limit - all.simulations_size(), 1000));
    const auto page = call(*simulations_, &v1::Simulations::Stub::ListSimulations, request);
    all.mutable_simulations()->MergeFrom(page.simulations());
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty() && all.simulations_size() < limit);
  all.set_next_page_token(request.page_token());
  return all;
}

v1::Lubricant Connection::get_lubricant(const std::string& name) {
  v1::GetLubricantRequest request;
  request.set_name(name);
  return call(*lubricants_, &v1::Lubricants::Stub::GetLubricant, request);
}

v1::ListLubricantsResponse Connection::list_lubricants() {
  v1::ListLubricantsResponse all;
  v1::ListLubricantsRequest request;
  do {
    const auto page = call(*lubricants_, &v1::Lubricants::Stub::ListLubricants, request);
    all.mutable_lubricants()->MergeFrom(page.lubricants());
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return all;
}

v1::EvaluateContactResponse Connection::evaluate_contact(
    const v1::EvaluateContactRequest& request) {
  return call(*contacts_, &v1::Contacts::Stub::EvaluateContact, request);
}

grpc::Status Connection::watch(const std::string& name, grpc::ClientContext& context,
                               const std::function<void(const v1::SimulationEvent&)>& on_event) {
  v1::WatchSimulationRequest request;
  request.set_name(name);
  const auto reader = simulations_->WatchSimulation(&context, request);
  v1::SimulationEvent event;
  while (reader->Read(&event)) on_event(event);
  return reader->Finish();
}

v1::HistoryChunk Connection::read_history(const std::string& name) {
  v1::ReadHistoryRequest request;
  request.set_name(name);
  grpc::ClientContext context;
  const auto reader = simulations_->ReadHistory(&context, request);
  v1::HistoryChunk all;
  v1::HistoryChunk chunk;
  while (reader->Read(&chunk)) {
    if (all.columns_size() == 0) {
      all = chunk;
      continue;
    }
    for (int c = 0; c < std::min(all.columns_size(), chunk.columns_size()); ++c) {
      all.mutable_columns(c)->mutable_values()->MergeFrom(chunk.columns(c).values());
    }
  }
  const grpc::Status status = reader->Finish();
  if (!status.ok()) throw to_failure(status, address_);
  return all;
}

}  // namespace tribodyn::client
