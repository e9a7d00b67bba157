#pragma once

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/outcome.h"
#include "tribodyn/v1/spectra.pb.h"

namespace tribodyn::server {

/// Transforms columns of the stored history of a simulation.
Outcome<v1::ReadSpectrumResponse> read_spectrum(Application& application,
                                                const v1::ReadSpectrumRequest& request,
                                                const CallContext& call);

}  // namespace tribodyn::server
