#pragma once

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>

#include "client/cpp/library/project_names.h"
#include "client/cpp/library/retry.h"
#include "client/cpp/library/status.h"
#include "client/cpp/text/text.h"
#include "proto/resource_kinds.h"
#include "tribodyn/client/connection.h"
#include "tribodyn/v1/campaigns.grpc.pb.h"
#include "tribodyn/v1/contacts.grpc.pb.h"
#include "tribodyn/v1/cycles.grpc.pb.h"
#include "tribodyn/v1/gear_sets.grpc.pb.h"
#include "tribodyn/v1/lubricants.grpc.pb.h"
#include "tribodyn/v1/points.grpc.pb.h"
#include "tribodyn/v1/profiles.grpc.pb.h"
#include "tribodyn/v1/rigs.grpc.pb.h"
#include "tribodyn/v1/schemas.grpc.pb.h"
#include "tribodyn/v1/simulations.grpc.pb.h"
#include "tribodyn/v1/spectra.grpc.pb.h"
#include "tribodyn/v1/surfaces.grpc.pb.h"
#include "tribodyn/v1/vehicles.grpc.pb.h"
#include "tribodyn/v1/viscosities.grpc.pb.h"

namespace tribodyn::client {

inline constexpr int kLargestPage = 1000;  ///< most entries that the server lists in one page

/// Waits; returns false if `stop` was requested meanwhile.
bool pause_unless_stopped(std::chrono::milliseconds time, const std::stop_token& stop);

/// The channel and its stubs.
struct Connection::Services {
  std::string address;
  std::chrono::duration<double> timeout;
  std::string project;
  std::string token;  ///< empty: none
  std::shared_ptr<grpc::Channel> channel;
  std::function<void(const std::string&)> report_wait;  ///< may be null
#define TRIBODYN_STUB(Resource, field, collection, seed) \
  std::unique_ptr<v1::Resource##Service::Stub> field##s;
  TRIBODYN_RESOURCE_KINDS(TRIBODYN_STUB)
#undef TRIBODYN_STUB
  std::unique_ptr<v1::SimulationService::Stub> simulations;
  std::unique_ptr<v1::CampaignService::Stub> campaigns;
  std::unique_ptr<v1::ContactService::Stub> contacts;
  std::unique_ptr<v1::CycleService::Stub> cycles;
  std::unique_ptr<v1::ProfileService::Stub> profiles;
  std::unique_ptr<v1::RigService::Stub> rigs;
  std::unique_ptr<v1::PointService::Stub> points;
  std::unique_ptr<v1::SpectrumService::Stub> spectra;
  std::unique_ptr<v1::ViscosityService::Stub> viscosities;
  std::unique_ptr<v1::SchemaService::Stub> schemas;

  /// Adds what every call carries.
  void prepare(grpc::ClientContext& context) const;

  /// Makes one call about the project within the time limit. Retries with pauses where that is
  /// safe: when the server was lost, and when it turned the request away and requests a pause;
  /// without a limit while a quota is spent that lasts no longer than the time limit.
  template <class Stub, class Request, class Response>
  Response call(Stub& stub,
                grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                Request request) const {
    using std::chrono::milliseconds, std::chrono::system_clock;
    add_project(project, request);
    const auto limit = std::chrono::duration_cast<system_clock::duration>(timeout);
    auto deadline = system_clock::now() + limit;
    Backoff backoff;
    bool was_connected = false, was_reported = false;
    milliseconds waited{0};
    for (int tries = 1;; ++tries) {
      grpc::ClientContext context;
      context.set_deadline(deadline);
      prepare(context);
      Response response;
      const grpc::Status status = (stub.*method)(&context, request, &response);
      if (status.ok()) {
        remove_project(project, response);
        return response;
      }
      if (never_connected(status) && !was_connected) {
        // Nothing was sent. Retry once: gRPC may report a connection in progress as failed.
        if (tries == 1 && channel->WaitForConnected(
                              std::min(deadline, system_clock::now() + std::chrono::seconds(1)))) {
          continue;
        }
        throw service_error(status, address);
      }
      was_connected = true;
      const auto requested = retry_delay(status);
      const bool is_gone = (status.error_code() == grpc::StatusCode::UNAVAILABLE || requested) &&
                           (never_connected(status) || may_repeat(request));
      const bool passes = is_over_quota(status) && requested && *requested <= limit;
      if (passes) backoff.reset();
      const auto pause = backoff.next(requested);
      if (passes) {
        tries = 0;
        deadline = system_clock::now() + pause + limit;
      } else if (tries == kTries || !(is_gone || was_turned_away(status)) ||
                 system_clock::now() + pause >= deadline) {
        throw service_error(status, address);
      }
      waited += pause;
      if (passes && !was_reported && waited >= kLongWait) {
        was_reported = true;
        if (report_wait) report_wait(printable(status.error_message()));
      }
      std::this_thread::sleep_for(pause);
    }
  }

  static constexpr int kTries = 8;
  static constexpr std::chrono::seconds kLongWait{2};
};

}  // namespace tribodyn::client
