#pragma once

#include <memory>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/message_source.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

template <class Message>
using StreamOutcome = Outcome<std::shared_ptr<MessageSource<Message>>>;

/// Events of a simulation until its end: the present one at once, then each change.
StreamOutcome<v1::SimulationEvent> watch_simulation(Application& application,
                                                    const v1::WatchSimulationRequest& request,
                                                    const CallContext& call = {});

/// Events of many simulations, in the order of their numbers: those named, those that satisfy a
/// filter, or all of the project.
StreamOutcome<v1::SimulationEvent> watch_simulations(Application& application,
                                                     const v1::WatchSimulationsRequest& request,
                                                     const CallContext& call = {});

/// The schema of a history or an overview of it, then its rows.
StreamOutcome<v1::ReadHistoryResponse> read_history(Application& application,
                                                    const v1::ReadHistoryRequest& request,
                                                    const CallContext& call = {});

inline constexpr std::int64_t kChunkValues = 32'768;         ///< 256 KiB of doubles
inline constexpr std::int64_t kOpenHistoryValues = 524'288;  ///< 4 MiB, in chunks under way

}  // namespace tribodyn::server
