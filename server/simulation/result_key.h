#pragma once

#include <string>

#include "server/simulation/simulation_inputs.h"
#include "server/storage/stored_simulation.h"

namespace tribodyn::server {

/// What decides the last bits of a result beside its inputs and the model: the instruction set and
/// the C library, whose functions pick their variant when the program starts. E.g.
/// "x86-64 avx2 fma, glibc 2.36".
const std::string& platform();

/// Of the present model on this processor.
ResultKey result_key(const SimulationInputs& inputs);

}  // namespace tribodyn::server
