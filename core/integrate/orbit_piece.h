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

/// The flank pairs at part 0, 1, 2 of a piece: its start, middle, end. `grid`: what the piece's
/// node is of; `off_grid` holds them where the piece has none.
const std::array<FlankKinematics, kFlankPairs>& flanks_of(
    const MeshData& mesh, const MeshGrid& grid, const OrbitPiece& piece, int part,
    std::array<FlankKinematics, kFlankPairs>& off_grid);

/// Fills in the first instant of each of the pieces: where SolvedPieces has it, and the contacts of
/// SolvedContacts in the same order. Returns the number of instants.
int number_instants(const std::vector<OrbitPiece>& pieces, std::vector<int>& first);

}  // namespace tribodyn
