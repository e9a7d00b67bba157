#include "core/integrate/orbit_piece.h"

#include <algorithm>
#include <cmath>

namespace tribodyn {
namespace {

/// A cycle's end is not the next one's start: the pairs hand over their slots.
double cycle_of(const OrbitPiece& piece) { return std::floor(piece.phase + 1e-9); }

/// Whether a piece starts with the contacts that the one before ends with.
bool goes_on(const OrbitPiece& before, const OrbitPiece& piece) {
  return before.regime == piece.regime && cycle_of(piece) == std::floor(piece.phase - 1e-9);
}

}  // namespace

int number_instants(const std::vector<OrbitPiece>& pieces, std::vector<int>& first) {
  first.resize(pieces.size());
  int count = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i > 0 && goes_on(pieces[i - 1], pieces[i])) --count;
    first[i] = count;
    count += 3;
  }
  return count;
}

const std::array<FlankKinematics, kFlankPairs>& flanks_of(
    const MeshData& mesh, const MeshGrid& grid, const OrbitPiece& piece, int part,
    std::array<FlankKinematics, kFlankPairs>& off_grid) {
  if (piece.node >= 0) return grid.flanks(piece.node + part);
  const double inside = std::min(piece.phase + 0.5 * part * piece.length - cycle_of(piece), 1.0);
  mesh.flanks(mesh.interval_at(inside), inside, off_grid);
  return off_grid;
}

}  // namespace tribodyn
