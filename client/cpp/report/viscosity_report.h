#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/output.h"
#include "tribodyn/v1/viscosities.pb.h"

namespace tribodyn::client {

/// The request and the answer for one lubricant; the requests of a study differ in the lubricant
/// alone.
struct ViscosityAnswer {
  v1::EvaluateViscosityRequest request;
  v1::EvaluateViscosityResponse answer;
};

/// Returns the figures in one of the forms of --output: a table for each lubricant, a line of CSV
/// for each lubricant, temperature and pressure, or the answers as JSON.
std::string viscosity_text(const std::vector<ViscosityAnswer>& answers, OutputFormat format);

/// Draws dynamic viscosity against temperature, a line for each lubricant and pressure.
std::string viscosity_plot(const std::vector<ViscosityAnswer>& answers);

}  // namespace tribodyn::client
