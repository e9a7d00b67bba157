#pragma once

#include "core/contact/contact_block_tables.h"
#include "core/numerics/digits.h"
#include "core/numerics/instruction_set.h"

namespace tribodyn {

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
      film_ratio, maximum_pressure, film_load, asperity_load, sliding_speed, shear_rate,
      mean_shear_stress, limited_area_share;
  ContactLanes limited_at_centre;  ///< 1 or 0
  ContactLanes solved;             ///< 1 or 0: the reference must solve it
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
