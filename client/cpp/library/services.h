#pragma once

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "client/cpp/library/status.h"
#include "tribodyn/client/connection.h"
#include "tribodyn/v1/contacts.grpc.pb.h"
#include "tribodyn/v1/gear_sets.grpc.pb.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"
#include "tribodyn/v1/schemas.grpc.pb.h"
#include "tribodyn/v1/simulations.grpc.pb.h"
#include "tribodyn/v1/surfaces.grpc.pb.h"
#include "tribodyn/v1/vehicles.grpc.pb.h"

namespace tribodyn::client {

/// The channel and its stubs.
struct Connection::Services {
  std::string address;
  std::chrono::duration<double> timeout;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::Lubricants::Stub> lubricants;
  std::unique_ptr<v1::GearSets::Stub> gear_sets;
  std::unique_ptr<v1::Surfaces::Stub> surfaces;
  std::unique_ptr<v1::Vehicles::Stub> vehicles;
  std::unique_ptr<v1::Simulations::Stub> simulations;
  std::unique_ptr<v1::Contacts::Stub> contacts;
  std::unique_ptr<v1::Schemas::Stub> schemas;

  /// One call within the time limit.
  template <class Stub, class Request, class Response>
  Response call(Stub& stub,
                grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                const Request& request) const {
    using std::chrono::system_clock;
    const auto deadline =
        system_clock::now() + std::chrono::duration_cast<system_clock::duration>(timeout);
    for (bool is_second_try = false;; is_second_try = true) {
      grpc::ClientContext context;
      context.set_deadline(deadline);
      Response response;
      const grpc::Status status = (stub.*method)(&context, request, &response);
      if (status.ok()) return response;
      if (is_second_try || !never_connected(status) ||
          !channel->WaitForConnected(
              std::min(deadline, system_clock::now() + std::chrono::seconds(1)))) {
        throw service_error(status, address);
      }
    }
  }
};

}  // namespace tribodyn::client
