#pragma once

#include <array>
#include <map>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/gear/mesh_data.h"

namespace tribodyn {

/// A mesh cycle cut into even steps, with everything at their ends and middles that depends on the
/// gear set alone: made once, used by every speed, fluid and sweep. Immutable.
class MeshGrid {
 public:
  /// `steps` in the mesh cycle, at least 1; E' and options as of the contacts. Nodes
  /// refer to the mesh.
  MeshGrid(const MeshData& mesh, int steps, double reduced_modulus, const ModelOptions& options);

  MeshGrid(const MeshGrid&) = delete;
  MeshGrid& operator=(const MeshGrid&) = delete;

  int steps() const { return steps_; }
  /// Node n is at mesh phase n / (2 steps), n = 0 ... 2 steps.
  const MeshPhase& at(int node) const { return nodes_[node]; }
  const std::array<FlankKinematics, kFlankPairs>& flanks(int node) const { return flanks_[node]; }
  /// Flank pair k at node n is contact kFlankPairs n + k.
  const ContactGeometries& geometries() const { return geometries_; }

 private:
  int steps_;
  std::vector<MeshPhase> nodes_;
  std::vector<std::array<FlankKinematics, kFlankPairs>> flanks_;
  ContactGeometries geometries_;
};

/// Grids of one gear set, made when they are first asked for. One thread at a time.
class MeshGrids {
 public:
  /// As MeshGrid; keeps the reference.
  MeshGrids(const MeshData& mesh, double reduced_modulus, const ModelOptions& options)
      : mesh_(mesh), reduced_modulus_(reduced_modulus), options_(options) {}
  const MeshGrid& with_steps(int steps);

 private:
  const MeshData& mesh_;
  double reduced_modulus_;
  ModelOptions options_;
  std::map<int, MeshGrid> grids_;
};

}  // namespace tribodyn
