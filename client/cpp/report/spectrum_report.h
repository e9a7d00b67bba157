#pragma once

#include <string>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/spectra.pb.h"

namespace tribodyn::client {

/// Returns the amplitudes in one of the forms of --output: a table or CSV with a line for each
/// order, or the answer as JSON.
std::string spectrum_text(const v1::Simulation& simulation,
                          const v1::ReadSpectrumResponse& spectrum, OutputFormat format);

/// Draws the amplitudes of each column as lines over the orders.
std::string spectrum_plot(const v1::Simulation& simulation,
                          const v1::ReadSpectrumResponse& spectrum);

}  // namespace tribodyn::client
