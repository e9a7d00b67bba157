#pragma once

#include <string>

#include "server/simulation/simulation_inputs.h"

namespace tribodyn::server {

/// The canonical text of all values that a result can depend on, one "path=value" line each in
/// field order: numbers as hexadecimal doubles, enums by name, defaults written out, model version
/// first. Names, descriptions and provenance are left out: equal values make equal text.
std::string canonical_inputs(const SimulationInputs& inputs);

/// SHA-256 of canonical_inputs, 64 hex digits.
std::string input_hash(const SimulationInputs& inputs);

}  // namespace tribodyn::server
