#pragma once

namespace tribodyn {

/// Which instructions vectors are worked on with.
enum class InstructionSet {
  kPortable,  ///< what every CPU of the architecture has
  kAvx2,      ///< AVX2 with fused multiply-add
  kAvx512,    ///< AVX-512 F, BW, DQ, VL
};

/// Whether this CPU has them, and this program was compiled for them.
bool has_instructions(InstructionSet instruction_set);

}  // namespace tribodyn
