#pragma once

#include <string>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/cycles.pb.h"

namespace tribodyn::client {

/// A drive cycle and what lubricants lose over it.
struct CycleRun {
  std::string name;  ///< "NEDC" or a file
  v1::EvaluateCycleResponse answer;
};

/// Returns energies, inefficiency and where the loss arises, for all lubricants side by side; the
/// others are compared with the first. JSON is the answer of the server.
std::string cycle_text(const CycleRun& run, OutputFormat format);

/// Returns a line for each lubricant without figures.
std::string cycle_refusals(const CycleRun& run);

/// Returns one line for each piece: time, speed, torque, and the loss of each lubricant.
std::string cycle_pieces_csv(const CycleRun& run);

/// Draws speed and loss power over time.
std::string cycle_plot(const CycleRun& run);

}  // namespace tribodyn::client
