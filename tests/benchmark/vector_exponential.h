#pragma once

#include <cstddef>

#include "core/numerics/instruction_set.h"

namespace tribodyn {

/// y = exp(x) for n values, by the library's exponential of that width: the unit of the
/// benchmarks. n must be a multiple of 8, the arrays aligned to 64 bytes.
void vector_exponential(InstructionSet instruction_set, const double* x, double* y, std::size_t n);

}  // namespace tribodyn
