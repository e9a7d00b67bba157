#pragma once

#include "core/contact/contact_block_tables.h"
#include "core/numerics/digits.h"
#include "core/numerics/instruction_set.h"

namespace tribodyn {

// A block of contacts in SIMD lanes, stage after stage over all of them:
//  1. The load is shared between film and asperities (share_block-inl.h): Newton's method on
//     r = ln(W_EHL/W), as in load_sharing.h.
//  2. Heat conduction makes T_c a line over the mean stress (heat_block-inl.h), and the shear rate
//     and pressure make the stress a function of T_c alone (shear_block-inl.h), whose mean over the
//     contact is a polynomial in two variables (contact_block_tables.h).
//  3. Temperature and the place where the stress meets its limit are found together, by steps of
//     Halley's method: first with half of the digits, then, if wanted, with all. Packs of lanes
//     that have settled take part in no further step.
//  4. certify() proves for each contact that it has one solution, inside of the tables, and that
//     the iteration found it; for any other `certified` is 0, and the scalar kernel must solve it.
// (J. F. Traub, Iterative Methods for the Solution of Equations, 1964, for Halley's method.)

/// Contacts solved together; the most that fit next to their intermediates in a first-level cache.
inline constexpr int kBlockContacts = 32;

/// A number for each contact of a block.
using ContactLanes = double[kBlockContacts];

/// Conditions, and geometry as in ContactGeometries. Arrays of kBlockContacts, of any alignment.
struct ContactBlockInputs {
  const double *load, *x_1, *y_1, *x_2, *y_2;  ///< x and y: velocities of both bodies
  const double* start_temperature;             ///< 0: none
  const double *curvature_x, *curvature_y, *unit_area, *per_semi_x, *per_semi_y, *unit_pressure;
};

struct alignas(64) ContactBlockResults {
  ContactLanes friction, viscous_friction, boundary_friction, contact_temperature, film_thickness,
      film_ratio, maximum_pressure, ellipse_load, asperity_load, sliding_speed, shear_rate,
      mean_shear_stress, limited_area_share;
  ContactLanes limited_at_centre;  ///< 1 or 0
  ContactLanes certified;          ///< 1, or 0: the scalar kernel must solve it
};

/// Solves the first `count` contacts of a block with the given instructions, which the CPU must
/// have. Beyond the count, inputs may be anything but must be there. `digits`: as for
/// FlankContactBatch::solve().
void solve_contact_block(InstructionSet instruction_set, const ContactBlockTables& tables,
                         Digits digits, int count, const ContactBlockInputs& in,
                         ContactBlockResults& out);

/// Films without a boundary part at the inlet temperature, for the fit of the start.
struct alignas(64) StartSamples {
  ContactLanes shear_rate, pressure, gain;
};

/// T_c - T_in of kBlockContacts of them [K], to some eight digits, into an array aligned like a
/// block.
void sample_rises(InstructionSet instruction_set, const ContactBlockTables& tables,
                  const StartSamples& samples, double* rise);

/// Fits tables.start; see StartFit.
void fit_start(InstructionSet instruction_set, ContactBlockTables& tables);

}  // namespace tribodyn
