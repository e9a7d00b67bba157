#pragma once

#include "core/lubricant/thermal_expansion.h"
#include "core/lubricant/viscosity_temperature.h"

namespace tribodyn {

/// T_0 [K] of the Vogel law that passes through the line's viscosities at 40 and 100 C, times the
/// density law, and follows it most closely in between and around: least squares of ln eta from -10
/// to 150 C, T_0 from 50 to 250 K.
///
/// That law stays within 1 % of D341 from 40 to 100 C and 3.6 % from -10 to 150 C for oils of up to
/// 16 mm2/s at 100 C and VI of 90 to 190, within 7 % for the thicker ones tried (19 to 55 mm2/s).
/// D341 itself is only a habit of oils: for the paper's fluids it wants 130 to 146 K where 157 to
/// 160 K is used, so take its T_0 to be known within about 15 K.
double walther_reference_temperature(const ViscosityTemperatureLine& line,
                                     const DensityLaw& density);

}  // namespace tribodyn
