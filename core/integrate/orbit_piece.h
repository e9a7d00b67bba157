#pragma once

#include <array>
#include <vector>

#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_grid.h"

namespace tribodyn {

/// A smooth piece of a response: one step, or the part of one up to or from an event. States at
/// its start, middle and end; the middle by the cubic through both ends.
struct OrbitPiece {
  double phase;   ///< of its start [cycles], counted through the whole period
  double length;  ///< [cycles]
  int node;       ///< of the grid at its start, where it is a whole step; or -1
  ContactRegime regime;
  MarchState start, middle, end;
};

/// The state at part 0, 1, 2 of a piece: its start, middle, end.
inline const MarchState& state_of(const OrbitPiece& piece, int part) {
  return part == 0 ? piece.start : part == 1 ? piece.middle : piece.end;
}

/// The flank pairs at part 0, 1, 2 of a piece: its start, middle, end. `grid`: that of the piece's
/// node; `off_grid` holds the flank pairs of a piece without node.
const std::array<FlankKinematics, kFlankPairs>& flanks_of(
    const MeshData& mesh, const MeshGrid& grid, const OrbitPiece& piece, int part,
    std::array<FlankKinematics, kFlankPairs>& off_grid);

/// Sets the number of the first instant of each piece, in the order of SolvedPieces and of
/// SolvedContacts. Returns the number of instants.
int number_instants(const std::vector<OrbitPiece>& pieces, std::vector<int>& first);

}  // namespace tribodyn
