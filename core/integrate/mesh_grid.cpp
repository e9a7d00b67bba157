#include "core/integrate/mesh_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/gauss_legendre.h"

namespace tribodyn {
namespace {

static_assert(std::size(kFlankColumns) == kContactRows + 2);  // the radii

/// The gear lags by `lag` more or less [rad]. False where there is no series.
bool set_lane(const MeshData& mesh, const MeshPhase& phase, double lag, int lane,
              Columns& columns) {
  const MeshFunctions& f = phase.pinion;
  double offset = 0;
  const MeshExpansion* const expansion = mesh.nearest_expansion(phase.theta - lag, offset);
  if (expansion == nullptr) return false;
  columns[kPinionRadiusRow][lane] = f.pinion_contact_radius;
  columns[kStiffnessRow][lane] = f.mesh_stiffness;
  columns[kStiffnessSlopeRow][lane] = f.mesh_stiffness_slope;
  columns[kErrorRow][lane] = f.static_transmission_error;
  columns[kErrorSlopeRow][lane] = f.static_transmission_error_slope;
  columns[kOffsetRow][lane] = offset + lag;
  for (int power = 0; power < MeshExpansion::kTerms; ++power) {
    const auto& term = expansion->term[power];
    double* const radius = columns[kSeriesRow + 2 * power];
    double* const integral = columns[kSeriesRow + 2 * power + 1];
    radius[lane] = term[MeshExpansion::kGearRadius];
    integral[lane] = term[MeshExpansion::kGearIntegral];
    if (power > 0) continue;
    radius[lane] += f.gear_contact_radius;
    integral[lane] += f.radius_integral;
  }
  return true;
}

/// sum V_s W^0.8 of the flank pairs at a phase of an interval, under a mesh force and a pinion
/// speed of 1: friction grows more slowly than the load, so that it has a kink wherever a pair
/// takes over, also where the shares add up to 1.
double friction_power(const MeshData& mesh, int interval, double phase) {
  constexpr double kLoadExponent = 0.8;
  std::array<FlankKinematics, kFlankPairs> flanks;
  mesh.flanks(interval, phase, flanks);
  const double ratio = static_cast<double>(mesh.pinion_teeth()) / mesh.gear_teeth();
  double sum = 0;
  for (const FlankKinematics& flank : flanks) {
    if (!(flank.load_share > 0)) continue;
    sum += std::pow(flank.load_share, kLoadExponent) * flank_motion(flank, 1, ratio).sliding_speed;
  }
  return sum;
}

double kink_error_of(const MeshData& mesh, int steps) {
  const int intervals = mesh.intervals();
  if (steps % intervals == 0) return 0;
  constexpr int kNodes = 4;
  const GaussLegendre<kNodes>& rule = gauss_legendre<kNodes>();
  const auto at = [&](double phase) {
    return friction_power(mesh, mesh.interval_at(phase), phase);
  };
  double sum = 0, error = 0;
  for (int i = 0; i < steps; ++i) {
    const double start = static_cast<double>(i) / steps, end = static_cast<double>(i + 1) / steps;
    double exact = 0;
    for (double from = start; from < end - 1e-12;) {
      const int interval = mesh.interval_at(from + 1e-12);
      const double to = std::min(end, static_cast<double>(interval + 1) / intervals);
      for (int n = 0; n < kNodes; ++n) {
        exact += rule.weight(n) * (to - from) *
                 friction_power(mesh, interval, from + rule.node(n) * (to - from));
      }
      from = to;
    }
    const double simpson = (end - start) / 6 * (at(start) + 4 * at(0.5 * (start + end)) + at(end));
    sum += exact;
    error += std::abs(simpson - exact);
  }
  return sum > 0 ? error / sum : 0;
}

}  // namespace

MeshGrid::MeshGrid(const MeshData& mesh, double half_backlash, int steps, double reduced_modulus,
                   const ModelOptions& options)
    : steps_(steps),
      nodes_(2 * steps + 1),
      flanks_(2 * steps + 1),
      contact_(2 * steps + 1),
      contacts_{1, {}, {}, {}, ContactGeometries(reduced_modulus, options)},
      contacts_at_starts_{2, {}, {}, {}, ContactGeometries(reduced_modulus, options)},
      kink_error_(kink_error_of(mesh, steps)),
      series_reach_(2 * mesh.series_reach()) {
  // From flanks that touch on the drive side to those on the coast side.
  const double through_gap =
      -2 * half_backlash * mesh.gear_teeth() / mesh.mean_gear_contact_radius();
  for (MeshColumns* columns : {&drive_, &coast_}) {
    columns->starts.resize(kMeshRows, steps + 1);
    columns->middles.resize(kMeshRows, steps + 1);
  }
  for (int n = 0; n <= 2 * steps; ++n) {
    const double phase = 0.5 * n / steps;
    const double theta = 2 * std::numbers::pi * phase;
    nodes_[n] = mesh.at_phase(theta);
    const auto set = [&](MeshColumns& columns, double lag) {
      return set_lane(mesh, nodes_[n], lag, n / 2, n % 2 == 0 ? columns.starts : columns.middles);
    };
    if (!set(drive_, 0) || !set(coast_, through_gap)) series_reach_ = 0;
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
      c.kinematics[row][i] = loaded[i]->*kFlankColumns[row].value;
    }
    c.geometries.set(i, loaded[i]->radius_x, loaded[i]->radius_y);
  }
}

const MeshGrid& MeshGrids::with_steps(int steps) {
  return grids_.try_emplace(steps, mesh_, half_backlash_, steps, reduced_modulus_, options_)
      .first->second;
}

long MeshGrids::steps_kept() const {
  long steps = 0;
  for (const auto& [of_grid, grid] : grids_) steps += of_grid;
  return steps;
}

}  // namespace tribodyn
