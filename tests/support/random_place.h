#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/study/operating_point.h"
#include "tests/support/cruise.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {

/// A random scene from the ranges of the validation table and beyond: every part of the driveline
/// and of the model varies, and so does the description of the gear set.
struct RandomPlace {
  Scene scene;
  OperatingCondition condition;
  int kind = 0;  ///< [0, kRandomKinds): what was varied most
};
inline constexpr int kRandomKinds = 14;

/// The tables with another number of intervals; between samples by the straight line, or, with
/// `steep`, loads that pass from pair to pair within one interval.
inline void resample_tables(ToothContactTables& t, int intervals, bool steep) {
  const auto resampled = [&](const std::vector<double>& v) {
    std::vector<double> out;
    for (int i = 0; i <= intervals; ++i) {
      const double at = static_cast<double>(i) / intervals * static_cast<double>(v.size() - 1);
      const std::size_t left = std::min(static_cast<std::size_t>(at), v.size() - 2);
      const double share = at - static_cast<double>(left);
      out.push_back((1 - share) * v[left] + share * v[left + 1]);
    }
    return out;
  };
  for (SlotTable* table :
       {&t.load_share, &t.radius_x, &t.radius_y, &t.pinion_velocity_x, &t.pinion_velocity_y,
        &t.gear_velocity_x, &t.gear_velocity_y, &t.contact_point_velocity_x,
        &t.contact_point_velocity_y, &t.pinion_friction_arm, &t.gear_friction_arm}) {
    for (std::vector<double>& slot : *table) slot = resampled(slot);
  }
  for (int i = 0; i <= intervals; ++i) {
    double sum = 0;
    for (std::vector<double>& slot : t.load_share) {
      double& share = slot[static_cast<std::size_t>(i)];
      if (steep) share = share > 0.05 ? 1 : 0;
      sum += share;
    }
    for (std::vector<double>& slot : t.load_share) slot[static_cast<std::size_t>(i)] /= sum;
  }
}

inline RandomPlace random_place(std::mt19937_64& random, double kilometres_per_hour) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto change = [&](double& value, double most) { value *= std::exp(between(-most, most)); };
  const auto even_in_logarithm = [&](double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  };
  const int fluid = static_cast<int>(between(1, 4));
  const int kind = static_cast<int>(between(0, kRandomKinds));
  RandomPlace place{reference_scene(fluid, between(-30, 140)), cruise(kilometres_per_hour), kind};
  Scene& scene = place.scene;
  if (kind == 4) scene.gear_set = reference_gear_set("B");
  GearSet& set = scene.gear_set;
  DrivelineDynamics& d = set.dynamics;
  FourierSeries& k = set.series.mesh_stiffness;
  const auto pinion_speed_at = [&](double ratio) {
    return kilometres_per_hour / 3.6 / scene.vehicle.wheel_radius * ratio;
  };
  const auto scale_ripple = [&](double factor) {
    for (std::vector<double>* series : {&k.sine, &k.cosine}) {
      for (double& c : *series) c *= factor;
    }
  };
  if (kind == 1) change(d.mesh_damping, 1.6);
  if (kind == 2) {
    const double factor = std::exp(between(-2.3, 2.3));
    k.mean *= factor;
    scale_ripple(factor);
  }
  if (kind == 3) d.half_backlash *= between(0, 3);
  if (kind == 5) place.condition = prescribed(between(-60, 150), pinion_speed_at(36.0 / 13));
  if (kind == 6) {
    scene.options.energy_consistent = between(0, 1) < 0.5;
    scene.options.damping_in_contact_only = between(0, 1) < 0.5;
    scene.options.isothermal = between(0, 1) < 0.5;
    scene.options.newtonian = between(0, 1) < 0.5;
  }
  // Up to threefold: the first order is then half of the mean stiffness.
  if (kind == 6 || kind == 8) scale_ripple(even_in_logarithm(0.1, 3));
  if (kind == 7) {
    for (double* part : {&d.pinion_shaft_stiffness, &d.gear_shaft_stiffness, &d.pinion_inertia,
                         &d.gear_inertia, &d.wheel_inertia}) {
      change(*part, 1);
    }
  }
  if (kind == 7 || kind == 9) {
    d.pinion_shaft_damping *= even_in_logarithm(0.01, 10);
    d.gear_shaft_damping *= even_in_logarithm(0.01, 10);
  }
  if (kind == 10 || kind == 13) {
    // A spectrum of 4 to 64 orders that falls like a power of the order.
    const auto orders = static_cast<std::size_t>(even_in_logarithm(4, 65));
    const double power = between(1, 2);
    for (FourierSeries* series :
         {&set.series.pinion_contact_radius, &set.series.gear_contact_radius, &k,
          &set.series.static_transmission_error}) {
      const double first = 0.5 * std::hypot(series->sine[0], series->cosine[0]);
      const std::size_t given = series->sine.size();
      series->sine.resize(orders, 0);
      series->cosine.resize(orders, 0);
      for (std::size_t i = given; i < orders; ++i) {
        const double size = first / std::pow(static_cast<double>(i + 1), power);
        const double phase = between(0, 2 * std::numbers::pi);
        series->sine[i] = size * std::sin(phase);
        series->cosine[i] = size * std::cos(phase);
      }
    }
  }
  if (kind == 11) {
    // One order of the error of a tooth flank, of some ten nanometres.
    const auto order = static_cast<std::size_t>(between(9, 131));
    FourierSeries& e = set.series.static_transmission_error;
    e.sine.resize(order, 0);
    e.cosine.resize(order, 0);
    e.sine[order - 1] = even_in_logarithm(3e-9, 1e-7);
  }
  if (kind == 12 || kind == 13) {
    resample_tables(set.tables, static_cast<int>(even_in_logarithm(16, 385)), between(0, 1) < 0.25);
  }
  if (kind == 12) {
    // Other tooth numbers, at the same pitch radius of the pinion.
    const double before = static_cast<double>(set.gear_teeth) / set.pinion_teeth;
    set.pinion_teeth = static_cast<int>(between(7, 18));
    set.gear_teeth = static_cast<int>(between(30, 48));
    const double scale = static_cast<double>(set.gear_teeth) / set.pinion_teeth / before;
    FourierSeries& r = set.series.gear_contact_radius;
    r.mean = set.series.pinion_contact_radius.mean * set.gear_teeth / set.pinion_teeth;
    for (std::vector<double>* series : {&r.sine, &r.cosine}) {
      for (double& c : *series) c *= scale;
    }
    for (SlotTable* table : {&set.tables.gear_velocity_x, &set.tables.gear_velocity_y}) {
      for (std::vector<double>& slot : *table) {
        for (double& a : slot) a *= scale;
      }
    }
    set.series_by_torque.clear();
    set.load_share_by_torque.clear();
  }
  if (kind == 13 && between(0, 1) < 0.3) {
    // Torques through zero.
    const double torque = even_in_logarithm(1e-3, 20);
    place.condition =
        prescribed(between(0, 1) < 0.5 ? torque : -torque,
                   pinion_speed_at(static_cast<double>(set.gear_teeth) / set.pinion_teeth));
  }
  if (between(0, 1) < 0.15) scene.lubricant.limiting_shear_stress_at_zero_pressure = 0;
  return place;
}

}  // namespace tribodyn
