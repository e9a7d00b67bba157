#pragma once

#include <array>
#include <map>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/gear/mesh_data.h"
#include "core/numerics/columns.h"

namespace tribodyn {

/// Rows of the terms of eqs 8, 9, 10 and 11 that the pinion's angle alone decides, at many phases.
enum MeshRow {
  kPinionRadiusRow,    ///< R_p [m]
  kStiffnessRow,       ///< k_m [N/m]
  kStiffnessSlopeRow,  ///< dk_m/dphi_p [N/m/rad]
  kErrorRow,           ///< e [m]
  kErrorSlopeRow,      ///< de/dphi_p [m/rad]
  kOffsetRow,          ///< from where the series are around [rad]
  kSeriesRow,          ///< of R_g and of the radius integral, in turn, for each power
  kMeshRows = kSeriesRow + 2 * MeshExpansion::kTerms
};

/// Rows of the loaded contacts of a grid, as kFlankColumns without the radii.
enum ContactRow {
  kLoadShareRow,
  kPinionVelocityXRow,
  kPinionVelocityYRow,
  kGearVelocityXRow,
  kGearVelocityYRow,
  kContactPointVelocityXRow,
  kContactPointVelocityYRow,
  kPinionArmRow,
  kGearArmRow,
  kContactRows
};

/// The loaded contacts at every node of a grid or at every other, the steps' starts.
struct GridContacts {
  int stride;              ///< of the nodes: 1 or 2
  std::vector<int> node;   ///< of each contact
  std::vector<int> first;  ///< contact of each of the nodes; at last their number
  Columns kinematics;      ///< kContactRows
  ContactGeometries geometries;
};

/// A mesh cycle cut into even steps, with everything at their ends and middles that depends on the
/// gear set alone: made once, used by every speed, fluid and sweep. Immutable.
class MeshGrid {
 public:
  /// half_backlash b [m]; `steps` in the mesh cycle, at least 1; E' [Pa] and options as of the
  /// contacts. Nodes refer to the mesh.
  MeshGrid(const MeshData& mesh, double half_backlash, int steps, double reduced_modulus,
           const ModelOptions& options);

  MeshGrid(const MeshGrid&) = delete;
  MeshGrid& operator=(const MeshGrid&) = delete;

  int steps() const { return steps_; }
  /// Node n is at mesh phase n / (2 steps), n = 0 ... 2 steps.
  const MeshPhase& at(int node) const { return nodes_[node]; }
  const std::array<FlankKinematics, kFlankPairs>& flanks(int node) const { return flanks_[node]; }
  /// The contact of flank pair k at node n among contacts(); -1: it has no load.
  int contact(int node, int k) const { return contact_[node][k]; }
  const GridContacts& contacts() const { return contacts_; }
  const GridContacts& contacts_at_starts() const { return contacts_at_starts_; }
  /// The mesh functions (eqs 8, 9, 10 and 11) where flanks touch on one side.
  struct MeshColumns {
    /// kMeshRows at the steps' starts, one more for the end of the cycle, and at their middles.
    Columns starts, middles;
  };
  const MeshColumns& mesh_columns(int side) const { return side > 0 ? drive_ : coast_; }
  /// The relative error of Simpson's rule for the friction power of a mesh cycle at even loads, by
  /// kinks of the tables inside of steps; the errors of single steps are added without regard to
  /// sign. 0 where all steps end on samples.
  double kink_error() const { return kink_error_; }
  /// Up to which distance the series there serve, to 4e-11 of the highest harmonic [rad]; 0: there
  /// are none.
  double series_reach() const { return series_reach_; }

 private:
  void list(GridContacts& contacts) const;

  int steps_;
  std::vector<MeshPhase> nodes_;
  std::vector<std::array<FlankKinematics, kFlankPairs>> flanks_;
  std::vector<std::array<int, kFlankPairs>> contact_;
  GridContacts contacts_, contacts_at_starts_;
  MeshColumns drive_, coast_;
  double kink_error_;
  double series_reach_;
};

/// Grids of one gear set, made when they are first asked for. One thread at a time.
class MeshGrids {
 public:
  /// As MeshGrid; keeps the reference.
  MeshGrids(const MeshData& mesh, double half_backlash, double reduced_modulus,
            const ModelOptions& options)
      : mesh_(mesh),
        half_backlash_(half_backlash),
        reduced_modulus_(reduced_modulus),
        options_(options) {}
  const MeshGrid& with_steps(int steps);
  /// Steps of all grids made so far: what they hold in memory grows with it.
  long steps_kept() const;

 private:
  const MeshData& mesh_;
  double half_backlash_;
  double reduced_modulus_;
  ModelOptions options_;
  std::map<int, MeshGrid> grids_;
};

}  // namespace tribodyn
