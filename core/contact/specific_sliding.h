#pragma once

#include "core/contact/contact_equations.h"

namespace tribodyn {

/// Specific sliding of the surfaces of a contact [-]: the sliding speed over the speed of the
/// surface,
///
///   zeta_i = V_s/|U_i|,   V_s = |U_1 - U_2|.
///
/// Of parallel velocities it is |u_1 - u_2|/|u_i|. It has no sign, because the sliding of hypoid
/// flanks runs across the rolling direction too. 0 without sliding; infinite for a surface at rest
/// under sliding.
struct SpecificSliding {
  double surface_1 = 0;
  double surface_2 = 0;
};

/// The velocities are those that entrain the lubricant.
SpecificSliding specific_sliding(const ContactConditionsOf<double>& conditions);

}  // namespace tribodyn
