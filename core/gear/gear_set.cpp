#include "core/gear/gear_set.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/gear/mesh_data.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

/// Where `torque` lies between ascending tabulated torques: left entry and weight of the right one.
template <class Entry>
std::pair<std::size_t, double> locate(const std::vector<Entry>& entries, double torque) {
  if (entries.size() == 1 || torque <= entries.front().pinion_torque) return {0, 0.0};
  for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
    if (torque <= entries[i + 1].pinion_torque) {
      return {i, (torque - entries[i].pinion_torque) /
                     (entries[i + 1].pinion_torque - entries[i].pinion_torque)};
    }
  }
  return {entries.size() - 2, 1.0};
}

std::vector<double> mix(const std::vector<double>& a, const std::vector<double>& b, double t) {
  std::vector<double> out(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double left = i < a.size() ? a[i] : 0, right = i < b.size() ? b[i] : 0;
    out[i] = left + t * (right - left);
  }
  return out;
}

FourierSeries mix(const FourierSeries& a, const FourierSeries& b, double t) {
  return {a.mean + t * (b.mean - a.mean), mix(a.sine, b.sine, t), mix(a.cosine, b.cosine, t)};
}

void check_series(const FourierSeries& series, const char* name, std::string& wrong) {
  bool finite = std::isfinite(series.mean);
  for (const double v : series.sine) finite = finite && std::isfinite(v);
  for (const double v : series.cosine) finite = finite && std::isfinite(v);
  if (!finite) wrong += std::string(name) + " has a coefficient that is not finite; ";
  if (series.sine.size() != series.cosine.size()) {
    wrong += std::string(name) + " has " + std::to_string(series.sine.size()) + " sine and " +
             std::to_string(series.cosine.size()) + " cosine terms; ";
  }
}

}  // namespace

GearSet at_torque(const GearSet& gear_set, double pinion_torque) {
  if (gear_set.series_by_torque.empty() || gear_set.load_share_by_torque.empty()) {
    throw Refusal("NO_LOAD_DEPENDENT_MESH_DATA",
                  "the gear set holds no mesh data by torque: load_dependent_mesh_data needs them");
  }
  GearSet out = gear_set;
  const double torque = std::abs(pinion_torque);
  {
    const auto& sets = gear_set.series_by_torque;
    const auto [i, t] = locate(sets, torque);
    const MeshSeries& a = sets[i].series;
    const MeshSeries& b = sets[std::min(i + 1, sets.size() - 1)].series;
    out.series = {mix(a.pinion_contact_radius, b.pinion_contact_radius, t),
                  mix(a.gear_contact_radius, b.gear_contact_radius, t),
                  mix(a.mesh_stiffness, b.mesh_stiffness, t),
                  mix(a.static_transmission_error, b.static_transmission_error, t)};
    out.series.gear_contact_radius.mean =
        out.series.pinion_contact_radius.mean * gear_set.gear_teeth / gear_set.pinion_teeth;
  }
  const auto& shares = gear_set.load_share_by_torque;
  const auto [i, t] = locate(shares, torque);
  for (int k = 0; k < kFlankPairs; ++k) {
    out.tables.load_share[k] =
        mix(shares[i].load_share[k], shares[std::min(i + 1, shares.size() - 1)].load_share[k], t);
  }
  return out;
}

void check(const GearSet& set) {
  std::string wrong;
  if (set.pinion_teeth < 1 || set.gear_teeth < 1) wrong += "teeth numbers must be positive; ";
  check_series(set.series.pinion_contact_radius, "R_p", wrong);
  check_series(set.series.gear_contact_radius, "R_g", wrong);
  check_series(set.series.mesh_stiffness, "k_m", wrong);
  check_series(set.series.static_transmission_error, "e", wrong);
  const double ratio = set.series.pinion_contact_radius.mean * set.gear_teeth / set.pinion_teeth;
  if (std::abs(set.series.gear_contact_radius.mean / ratio - 1) > 1e-9) {
    wrong += "R_g0 must equal R_p0 N_g/N_p, or the transmission error winds up; ";
  }

  const ToothContactTables& t = set.tables;
  const std::size_t samples = t.load_share[0].size();
  bool ragged = samples < 2;
  for (const FlankColumn& column : kFlankColumns) {
    const SlotTable& table = t.*column.table;
    for (int k = 0; k < kFlankPairs; ++k) {
      const auto& values = table[k];
      const std::string where = std::string(column.name) + " of slot " + std::to_string(k);
      if (values.size() != samples || samples < 2) {
        wrong += where + " has " + std::to_string(values.size()) + " samples; ";
        ragged = true;
        continue;
      }
      for (std::size_t j = 0; j < samples; ++j) {
        if (!std::isfinite(values[j]) || (column.positive && values[j] <= 0)) {
          wrong +=
              where + " sample " + std::to_string(j) + " is " + std::to_string(values[j]) + "; ";
        }
      }
      if (k + 1 < kFlankPairs && table[k + 1].size() == samples &&
          std::abs(values.back() - table[k + 1].front()) >
              1e-6 * (1e-3 + std::abs(values.back()))) {
        wrong += where + " does not hand over to the next slot; ";
      }
    }
  }
  if (!ragged) {
    for (std::size_t j = 0; j < samples; ++j) {
      double sum = 0;
      for (int k = 0; k < kFlankPairs; ++k) {
        if (t.load_share[k][j] < -1e-9) {
          wrong += "load share of slot " + std::to_string(k) + " sample " + std::to_string(j) +
                   " is negative; ";
        }
        sum += t.load_share[k][j];
      }
      if (!(std::abs(sum - 1) < 1e-3)) {
        wrong += "load shares of sample " + std::to_string(j) + " add up to " +
                 std::to_string(sum) + "; ";
      }
    }
  }
  if (wrong.empty()) {
    const MeshData mesh(set);
    for (int i = 0; i < 720; ++i) {
      const MeshFunctions f =
          mesh.functions(i * 3.14159265358979 / 360, i * 3.14159265358979 / 360);
      if (!(f.mesh_stiffness > 0 && f.pinion_contact_radius > 0 && f.gear_contact_radius > 0)) {
        wrong += "k_m, R_p and R_g must stay positive over the mesh cycle; ";
        break;
      }
    }
  }
  const DrivelineDynamics& d = set.dynamics;
  for (const double v : {d.pinion_shaft_inertia, d.pinion_inertia, d.gear_inertia, d.wheel_inertia,
                         d.pinion_shaft_stiffness, d.gear_shaft_stiffness}) {
    if (!(v > 0) || !std::isfinite(v)) {
      wrong += "inertias and shaft stiffnesses must be positive; ";
      break;
    }
  }
  for (const double v :
       {d.pinion_shaft_damping, d.gear_shaft_damping, d.mesh_damping, d.half_backlash}) {
    if (!(v >= 0) || !std::isfinite(v)) {
      wrong += "damping and backlash must not be negative; ";
      break;
    }
  }
  if (!wrong.empty()) {
    wrong.resize(wrong.size() - 2);
    throw Refusal("GEAR_SET", wrong);
  }
}

}  // namespace tribodyn
