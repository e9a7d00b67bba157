#pragma once

#include <string>

#include "server/simulation/simulation_inputs.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// Returns what decides the last bits of a result besides its inputs and the model: the instruction
/// set and the C library, which chooses its functions when the program starts. E.g. "x86-64 avx2
/// fma, glibc 2.36".
const std::string& platform();

/// Returns the key of a result that this process would compute.
ResultKey result_key(const SimulationInputs& inputs);

}  // namespace tribodyn::server
