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

/// Which inputs besides the lubricant differ between simulations.
struct Differences {
  bool sumps = false, surfaces = false, models = false, sweeps = false;
};
Differences differences_of(const std::vector<v1::Simulation>& simulations);

/// Returns e.g. "gear set reference-axle, surface run-in, vehicle passenger-car; sump 40 C, inlet
/// rise 20 K", without what differs. A plot may pass a degree sign for `celsius`; a terminal
/// without UTF-8 cannot show one.
std::string inputs_text(const v1::Simulation& simulation, const char* celsius = "C",
                        const Differences& differences = {});

/// Returns those inputs of a simulation that differ between simulations, e.g. "sump 90 C,
/// isothermal"; an empty text if none differs.
std::string distinction(const v1::Simulation& simulation, const Differences& differences,
                        const char* celsius = "C");

/// Returns what departs from the preset, after "paper, " for that one, e.g. "isothermal, newtonian,
/// as published eq17_atan"; "recommended" or "paper as corrected" if nothing does.
std::string model_options_text(const v1::ModelOptions& options);

/// Returns e.g. "cruise at 72.5 km/h" or "inefficiency curve from 20 to 140 km/h, up-sweep".
std::string study_text(const v1::Simulation& simulation);

/// Returns "up-sweep", "down-sweep" or "independent points".
std::string sweep_text(const v1::InefficiencyCurveStudy& study);

/// Returns e.g. "published" for PROVENANCE_PUBLISHED.
std::string provenance_word(v1::Provenance provenance);

/// Adds model version, input hash and the assumptions: the number of each provenance, or each
/// assumption with `shows_all`.
void add_provenance(const v1::SimulationResult& result, bool shows_all, Sheet& sheet);

/// Adds the warnings about the inputs, one remark per code; no heading if there are none.
using InputWarnings = google::protobuf::RepeatedPtrField<v1::RangeWarning>;
void add_input_warnings(const InputWarnings& warnings, Sheet& sheet);

/// Returns the seconds from start to end; negative if either time is missing.
double run_seconds(const v1::Simulation& simulation);

}  // namespace tribodyn::client
