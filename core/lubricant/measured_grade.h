#pragma once

#include "core/lubricant/characterisation.h"

namespace tribodyn {

/// SAE J306 grade of a fluid from its measurements: KV100 after the shear test where given, else
/// fresh, and the Brookfield viscosities with other viscosities measured below 0 C. A cold
/// viscosity that contradicts the law (gross_errors.h) proves no W grade. The note says what is
/// missing. `known` has its laws, kinematic viscosities and measured viscosities.
GearViscosityGrade measured_grade(const FluidMeasurements& fluid, const CharacterisedFluid& known);

}  // namespace tribodyn
