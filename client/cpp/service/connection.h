#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "tribodyn/v1/contacts.grpc.pb.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"
#include "tribodyn/v1/simulations.grpc.pb.h"

namespace tribodyn::client {

/// The address to use: the flag, else TRIBODYN_SERVER, else 127.0.0.1:50651.
std::string server_address(const std::string& flag);
inline constexpr char kDefaultServer[] = "127.0.0.1:50651";

/// A server and its services. Safe for concurrent use. Calls throw Failure (see errors.h); nothing
/// is sent before the first call.
class Connection {
 public:
  /// `timeout` bounds every call but watch() and read_history().
  Connection(std::string address, std::chrono::duration<double> timeout);

  v1::Simulation create_simulation(const v1::Simulation& simulation);
  v1::Simulation get_simulation(const std::string& name);
  v1::Simulation cancel_simulation(const std::string& name);
  /// Newest first, at most `limit`, over as many pages as it takes.
  v1::ListSimulationsResponse list_simulations(int limit);
  v1::Lubricant get_lubricant(const std::string& name);
  v1::ListLubricantsResponse list_lubricants();
  v1::EvaluateContactResponse evaluate_contact(const v1::EvaluateContactRequest& request);

  /// Streams the events of a simulation until it ends. Does not throw: a broken stream is an
  /// everyday event for its caller. `context` allows another thread to cancel it.
  grpc::Status watch(const std::string& name, grpc::ClientContext& context,
                     const std::function<void(const v1::SimulationEvent&)>& on_event);
  /// All rows of all columns, joined into one chunk.
  v1::HistoryChunk read_history(const std::string& name);

  const std::string& address() const { return address_; }

 private:
  template <class Stub, class Request, class Response>
  Response call(Stub& stub,
                grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                const Request& request);

  std::string address_;
  std::chrono::duration<double> timeout_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::Simulations::Stub> simulations_;
  std::unique_ptr<v1::Lubricants::Stub> lubricants_;
  std::unique_ptr<v1::Contacts::Stub> contacts_;
};

}  // namespace tribodyn::client
