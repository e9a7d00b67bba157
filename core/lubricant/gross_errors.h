#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/lubricant/characterisation.h"

namespace tribodyn {

/// A limit beyond which a measurement is taken for a slip of the pen and not for a property of a
/// lubricant.
struct GrossErrorLimit {
  const char* code;   ///< of the GrossError
  double least;       ///< of the quantity
  double most;        ///< of the quantity
  const char* bound;  ///< what a sentence says of the limit
};

/// The table of all limits.
///
/// VISCOSITY_CONTRADICTED: measured viscosity over that of the law fitted to all. Two laboratories
/// that each have the 5 % of a Brookfield viscosity (assumed in characterise()) differ by less than
/// 14 % in 19 cases of 20, and a law of three parameters misses polymer-thickened oils by up to
/// some 15 % between -40 and 100 C (assumed). Their sum is about 30 %; the smallest slip of a unit
/// is a factor of 100.
/// LAW_CONTRADICTED: measured kinematic viscosity over that of a law that is stated beside it. ASTM
/// D445 reproduces within 1 %, an estimated density is within 3 % (one standard deviation), and a
/// T_0 rounded to 1 K shifts the viscosity at 40 C by at most 2 %: 10 % is about three times their
/// root sum of squares. Dynamic viscosities have the limit of VISCOSITY_CONTRADICTED.
/// VISCOSITY_IMPLAUSIBLE: kinematic viscosity at 100 C [m2/s], measured or by the law fitted to a
/// table. Spindle oils have 0.9 mm2/s, the thickest polyalphaolefins 1000, polyisobutylenes more
/// (assumed). A table in the wrong one of mPa s and Pa s is off by 1000.
/// VISCOSITY_INDEX_IMPLAUSIBLE: ASTM D2270 of the same law at 40 and 100 C. Aromatic extracts,
/// which no gear oil is made of, come down to about -100, silicones up to about 500 (assumed).
/// COLD_VISCOSITY_IMPLAUSIBLE: viscosity below 10 C over that of ASTM D341 through the viscosities
/// measured at higher temperatures. Six oils on the market have 1.5 to 2.6 from -12 to -40 C;
/// polymers and waxes can shift that by a factor of some 3 (assumed).
/// SHEARED_THICKER_THAN_FRESH: KV100 after the KRL test over that before it. Shear breaks polymers
/// and cannot mend them; 2 % is the reproducibility of ASTM D445 twice.
inline constexpr GrossErrorLimit kGrossErrorLimits[] = {
    {"VISCOSITY_CONTRADICTED", 1 / 1.3, 1.3, "30 %, the scatter of laboratories and of the law"},
    {"LAW_CONTRADICTED", 1 / 1.1, 1.1, "10 %, that of a rounded law and an estimated density"},
    {"VISCOSITY_IMPLAUSIBLE", 0.5e-6, 1500e-6, "0.5 to 1500 mm2/s"},
    {"VISCOSITY_INDEX_IMPLAUSIBLE", -100, 500, "-100 (aromatic extracts) to 500 (silicones)"},
    {"COLD_VISCOSITY_IMPLAUSIBLE", 1 / 3.0, 30, "from a third of it to 30 times as much"},
    {"SHEARED_THICKER_THAN_FRESH", 0, 1.02, "2 %, twice the reproducibility of ASTM D445"}};

/// The row of a code, which must be there.
const GrossErrorLimit& gross_error_limit(const std::string& code);

/// Where a fluid's measurements are beyond a limit of the table; the sentence names the value, the
/// limit and, where there is one, the likely slip. `known` is what characterise() made of them.
std::vector<GrossError> gross_errors(const FluidMeasurements& fluid,
                                     const CharacterisedFluid& known);

/// Whether a measured viscosity is beyond the limit for the ratio of measurement to law; a larger
/// stated uncertainty widens the limit to three standard deviations.
bool contradicts(const GrossErrorLimit& limit, const ViscosityPoint& measured, double law);

/// " Did you mean 150 Pa s (150000 mPa s) at -40 C?" where the viscosities cannot be fitted as they
/// are but can with one of them, or all that are of a kind, in another unit or at the opposite
/// temperature; empty otherwise.
std::string likely_slip(std::span<const MeasuredViscosity> viscosities);

}  // namespace tribodyn
