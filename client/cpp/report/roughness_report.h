#pragma once

#include <string>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/profiles.pb.h"

namespace tribodyn::client {

/// Returns the moments of each flank and direction, the parameters by sampling interval, and the
/// warnings. CSV: one line for each sampling interval; JSON: the answer.
std::string roughness_text(const v1::EvaluateProfilesResponse& answer, OutputFormat format);

/// Draws the four parameters against the sampling interval, with bands of their standard
/// uncertainties.
std::string roughness_plot(const v1::EvaluateProfilesResponse& answer);

}  // namespace tribodyn::client
