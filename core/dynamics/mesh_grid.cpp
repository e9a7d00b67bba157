#include "core/dynamics/mesh_grid.h"

#include <algorithm>
#include <numbers>

namespace tribodyn {
namespace {

constexpr double FlankKinematics::*kContactColumns[] = {&FlankKinematics::load_share,
                                                        &FlankKinematics::pinion_velocity_x,
                                                        &FlankKinematics::pinion_velocity_y,
                                                        &FlankKinematics::gear_velocity_x,
                                                        &FlankKinematics::gear_velocity_y,
                                                        &FlankKinematics::contact_point_velocity_x,
                                                        &FlankKinematics::contact_point_velocity_y,
                                                        &FlankKinematics::pinion_friction_arm,
                                                        &FlankKinematics::gear_friction_arm};
static_assert(std::size(kContactColumns) == kContactRows);

void set_lane(const MeshPhase& phase, int lane, Columns& columns) {
  const MeshFunctions& f = phase.pinion;
  columns[kPinionRadiusRow][lane] = f.pinion_contact_radius;
  columns[kStiffnessRow][lane] = f.mesh_stiffness;
  columns[kStiffnessSlopeRow][lane] = f.mesh_stiffness_slope;
  columns[kErrorRow][lane] = f.static_transmission_error;
  columns[kErrorSlopeRow][lane] = f.static_transmission_error_slope;
  columns[kOffsetRow][lane] = phase.offset;
  for (int power = 0; power < MeshExpansion::kTerms; ++power) {
    const auto& term = phase.expansion->term[power];
    double* const radius = columns[kSeriesRow + 2 * power];
    double* const integral = columns[kSeriesRow + 2 * power + 1];
    radius[lane] = term[MeshExpansion::kGearRadius];
    integral[lane] = term[MeshExpansion::kGearIntegral];
    if (power > 0) continue;
    radius[lane] += f.gear_contact_radius;
    integral[lane] += f.radius_integral;
  }
}

}  // namespace

MeshGrid::MeshGrid(const MeshData& mesh, int steps, double reduced_modulus,
                   const ModelOptions& options)
    : steps_(steps),
      nodes_(2 * steps + 1),
      flanks_(2 * steps + 1),
      contact_(2 * steps + 1),
      contacts_{1, {}, {}, {}, ContactGeometries(reduced_modulus, options)},
      contacts_at_starts_{2, {}, {}, {}, ContactGeometries(reduced_modulus, options)},
      mesh_at_starts_(kMeshRows, steps + 1),
      mesh_at_middles_(kMeshRows, steps + 1),
      series_reach_(mesh.series_reach()) {
  for (int n = 0; n <= 2 * steps; ++n) {
    const double phase = 0.5 * n / steps;
    const double theta = 2 * std::numbers::pi * phase;
    nodes_[n] = mesh.at_phase(theta);
    if (series_reach_ > 0) {
      set_lane(nodes_[n], n / 2, n % 2 == 0 ? mesh_at_starts_ : mesh_at_middles_);
    }
    const int interval = std::min(static_cast<int>(phase * mesh.intervals()), mesh.intervals() - 1);
    mesh.flanks(interval, phase, flanks_[n]);
  }
  list(contacts_);
  list(contacts_at_starts_);
  for (auto& of_node : contact_) of_node.fill(-1);
  int next = 0;
  for (int n = 0; n <= 2 * steps; ++n) {
    for (int k = 0; k < kFlankPairs; ++k) {
      if (flanks_[n][k].load_share > 0) contact_[n][k] = next++;
    }
  }
}

void MeshGrid::list(GridContacts& c) const {
  std::vector<const FlankKinematics*> loaded;
  for (int n = 0; n <= 2 * steps_; n += c.stride) {
    c.first.push_back(static_cast<int>(loaded.size()));
    for (const FlankKinematics& flank : flanks_[n]) {
      if (!(flank.load_share > 0)) continue;
      loaded.push_back(&flank);
      c.node.push_back(n);
    }
  }
  c.first.push_back(static_cast<int>(loaded.size()));
  c.kinematics.resize(kContactRows, loaded.size());
  c.geometries.resize(loaded.size());
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    for (int row = 0; row < kContactRows; ++row) {
      c.kinematics[row][i] = loaded[i]->*kContactColumns[row];
    }
    c.geometries.set(i, loaded[i]->radius_x, loaded[i]->radius_y);
  }
}

const MeshGrid& MeshGrids::with_steps(int steps) {
  return grids_.try_emplace(steps, mesh_, steps, reduced_modulus_, options_).first->second;
}

}  // namespace tribodyn
