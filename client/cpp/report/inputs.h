#pragma once

#include <string>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// The inputs of a simulation with the server's defaults filled in.
struct Inputs {
  std::string lubricant, gear_set, surface, vehicle;
  double sump_temperature_celsius;
  double inlet_temperature_rise_kelvin;
};
Inputs inputs_of(const v1::Simulation& simulation);

/// "gear set A, surface run-in, vehicle passenger-car; sump 40 C, inlet rise 20 K". A picture can
/// take a degree sign, a terminal without UTF-8 cannot.
std::string inputs_text(const v1::Simulation& simulation, const char* celsius = "C");

/// "isothermal, newtonian, as published eq17_atan"; "as corrected" when nothing departs from it.
std::string model_options_text(const v1::ModelOptions& options);

/// "cruise at 72.5 km/h", "inefficiency curve from 20 to 140 km/h, up-sweep", ...
std::string study_text(const v1::Simulation& simulation);

/// "up-sweep", "down-sweep" or "independent points".
std::string sweep_text(const v1::InefficiencyCurveStudy& study);

/// "published" of PROVENANCE_PUBLISHED.
std::string provenance_word(v1::Provenance provenance);

/// Model version, input hash, and the assumptions: how many of each provenance, or, with
/// `shows_all`, every one.
void add_provenance(const v1::SimulationResult& result, bool shows_all, Sheet& sheet);

/// What to know of the inputs before relying on the result, a remark a code; nothing when there is
/// nothing.
using InputWarnings = google::protobuf::RepeatedPtrField<v1::RangeWarning>;
void add_input_warnings(const InputWarnings& warnings, Sheet& sheet);

/// Seconds from start to end; negative when either is missing.
double run_seconds(const v1::Simulation& simulation);

}  // namespace tribodyn::client
