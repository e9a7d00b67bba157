#pragma once

#include <cstddef>

#include "core/contact/contact_block_tables.h"
#include "core/contact/contact_level.h"
#include "core/numerics/columns.h"
#include "core/numerics/instruction_set.h"

namespace tribodyn {

/// Rows of contacts that are differentiated: conditions and geometry as in ContactBlockInputs, and
/// what a solution has found.
enum SolvedContactRow {
  kSolvedLoad,
  kSolvedVelocity1X,
  kSolvedVelocity1Y,
  kSolvedVelocity2X,
  kSolvedVelocity2Y,
  kSolvedCurvatureX,
  kSolvedCurvatureY,
  kSolvedUnitArea,
  kSolvedPerSemiX,
  kSolvedPerSemiY,
  kSolvedUnitPressure,
  kSolvedEllipseLoad,         ///< W_EHL [N]
  kSolvedContactTemperature,  ///< T_c [K]
  kSolvedMeanShearStress,     ///< tau_bar [Pa]
  kSolvedLimitedAreaShare,    ///< [-]
  kSolvedContactRows
};

/// Rows of derivatives: by the load [N] and the velocities [m/s] of ContactConditions, then by
/// ContactLevel.
inline constexpr int kConditionSlopes = 5;
inline constexpr int kContactSlopes = kConditionSlopes + kContactLevels;

inline constexpr int kFilmSlopes = kConditionSlopes + kDirectLevels;

/// Derivatives of contacts side by side.
struct ContactSlopes {
  Columns friction;     ///< of F_fr [N], kContactSlopes rows
  Columns temperature;  ///< of T_c [K], kContactSlopes rows
  Columns film_ratio;   ///< of lambda_s [-], kFilmSlopes rows: the others are 0
  Columns edge;         ///< one row: A_asp/A_EHL [-]; at 1 derivatives are those of one side

  void resize_for_overwrite(std::size_t count);
};

/// Differentiates the first `count` contacts, which the vector code has solved with the same
/// tables. As contact_sensitivity.h in dual numbers, but side by side: solved, they need no
/// iteration. Beyond the count, up to a multiple of kColumnLanes, `solved` must hold contacts too.
void differentiate_contacts(InstructionSet instruction_set, const ContactBlockTables& tables,
                            std::size_t count, const Columns& solved, ContactSlopes& slopes);

}  // namespace tribodyn
