#pragma once

#include <string>

#include "server/simulation/simulation_inputs.h"

namespace tribodyn::server {

/// Returns the canonical text of all values that a result can depend on: the model version, then
/// one line "path=value" for each value in field order. Numbers are hexadecimal doubles, enum
/// values are names, defaults are written out. Names, descriptions and provenance are left out, so
/// that equal values have equal texts.
std::string canonical_inputs(const SimulationInputs& inputs);

/// Returns the SHA-256 hash of canonical_inputs() as 64 hexadecimal digits.
std::string input_hash(const SimulationInputs& inputs);

}  // namespace tribodyn::server
