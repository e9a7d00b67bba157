#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

#include "core/contact/flank_contact.h"
#include "core/refusal.h"
#include "tests/support/reference_scene.h"
#include "tests/support/run_length.h"

namespace tribodyn {

/// Random states per test.
inline constexpr int kRandomStates = kShortRun ? 100 : 400;

/// One flank contact with all that it depends on. The default is a typical one of the reference
/// set.
struct ContactCase {
  Lubricant lubricant = reference_lubricant();
  Solid solid{206e9, 0.3, 46, 7850, 470};
  Roughness roughness{2.5e9, 40e-6, 0.4e-6};
  BoundaryFriction boundary{2e6, 0.17};
  double sump_temperature = 313.15;
  double inlet_temperature_rise = 20;
  ModelOptions options;
  ContactConditions conditions{2000, 0.015, 0.3, 5, 6, 4, -1};

  double inlet_temperature() const { return sump_temperature + inlet_temperature_rise; }
  FlankContactModel model() const {
    return {lubricant, solid, roughness, boundary, sump_temperature, inlet_temperature_rise,
            options};
  }
  ContactSolution solve() const { return model().solve(conditions); }
};

/// Random numbers from a seed that TRIBODYN_TEST_SEED overrides. Print seed() with every failure.
class Draw {
 public:
  explicit Draw(std::uint64_t stream) : stream_(stream), engine_(base() + stream) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double log_between(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  /// Of either sign.
  double signed_log_between(double low, double high) {
    return (engine_() & 1 ? 1 : -1) * log_between(low, high);
  }
  std::string seed() const {
    return "TRIBODYN_TEST_SEED=" + std::to_string(base()) + ", stream " + std::to_string(stream_);
  }

 private:
  static std::uint64_t base() {
    const char* text = std::getenv("TRIBODYN_TEST_SEED");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 20200331;
  }
  std::uint64_t stream_;
  std::mt19937_64 engine_;
};

/// A contact far beyond what gears do, but inside every law: loads of 10 mN to 20 kN, ellipses 2.5
/// times wider than long to 1000 times longer than wide, oils from water-like to grease-like.
/// alpha_HN beta_HN stays below 0.8, so that there is one thermal equilibrium.
inline ContactCase random_contact_case(Draw& draw) {
  ContactCase c;
  c.lubricant = {
      draw.log_between(3e-5, 5e-4), draw.between(700, 1150),  draw.between(140, 170),
      draw.between(0.8e-8, 3e-8),   draw.between(293, 333),   draw.log_between(1e-9, 1e-4),
      draw.between(0.5, 1),         draw.between(0.1, 0.8),   draw.between(313, 373),
      draw.between(0, 1e7),         draw.between(0.005, 0.1), draw.between(0.1, 0.3),
      draw.between(950, 1100),      draw.between(-0.7, -0.5)};
  c.solid = {draw.log_between(70e9, 400e9), draw.between(0.2, 0.35), draw.log_between(5, 200),
             draw.between(2500, 9000), draw.between(300, 900)};
  c.roughness.asperity_radius = draw.log_between(5e-6, 100e-6);
  c.roughness.composite_rms_height = draw.log_between(0.03e-6, 4e-6);
  c.roughness.asperity_density =
      draw.between(0.02, 0.1) / (c.roughness.asperity_radius * c.roughness.composite_rms_height);
  c.boundary = {draw.between(0, 5e6), draw.between(0, 0.3)};
  c.sump_temperature = draw.between(253.15, 403.15);
  c.inlet_temperature_rise = draw.between(0, 40);
  ContactConditions& k = c.conditions;
  k.radius_x = draw.log_between(3e-3, 60e-3);
  k.radius_y = k.radius_x * draw.log_between(0.4, 1000);
  k.load = draw.log_between(0.01, 2e4);
  k.velocity_1_x = draw.signed_log_between(0.01, 30);
  k.velocity_1_y = draw.signed_log_between(0.01, 30);
  k.velocity_2_x = draw.signed_log_between(0.01, 30);
  k.velocity_2_y = draw.signed_log_between(0.01, 30);
  return c;
}

}  // namespace tribodyn
