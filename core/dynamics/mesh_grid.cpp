#include "core/dynamics/mesh_grid.h"

#include <algorithm>
#include <numbers>

namespace tribodyn {

MeshGrid::MeshGrid(const MeshData& mesh, int steps, double reduced_modulus,
                   const ModelOptions& options)
    : steps_(steps),
      nodes_(2 * steps + 1),
      flanks_(2 * steps + 1),
      geometries_(reduced_modulus, options, kFlankPairs * (2 * steps + 1)) {
  for (int n = 0; n <= 2 * steps; ++n) {
    const double phase = 0.5 * n / steps;
    const double theta = 2 * std::numbers::pi * phase;
    nodes_[n] = mesh.at_phase(theta);
    const int interval = std::min(static_cast<int>(phase * mesh.intervals()), mesh.intervals() - 1);
    mesh.flanks(interval, phase, flanks_[n]);
    for (int k = 0; k < kFlankPairs; ++k) {
      const FlankKinematics& flank = flanks_[n][k];
      if (flank.load_share > 0) {
        geometries_.set(kFlankPairs * n + k, flank.radius_x, flank.radius_y);
      }
    }
  }
}

const MeshGrid& MeshGrids::with_steps(int steps) {
  return grids_.try_emplace(steps, mesh_, steps, reduced_modulus_, options_).first->second;
}

}  // namespace tribodyn
