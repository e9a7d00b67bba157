// Order of the march of the gear pair with friction in the loop: initial-value problems over a few
// mesh cycles, slow enough that steps and not the tables decide the error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/dynamics/mesh_cycle_march.h"
#include "run_length.h"
#include "tests/support/reference_scene.h"
#include "yardstick_data.h"

namespace tribodyn {
namespace {

/// Released from more deflection than the static one, at constant torques.
struct InitialValueProblem {
  double speed_kilometers_per_hour;
  double pinion_torque;      ///< [N m]
  double excess_deflection;  ///< [m]
  int mesh_cycles;
};

constexpr int kCoarseTables = 8;  ///< samples between those that are kept: 12 intervals are left

struct Outcome {
  MarchState state{};  ///< time and work of all cycles
  MarchStatistics statistics;
  MarchScales scales{};
};

class OrderTest : public testing::Test {
 protected:
  OrderTest()
      : scene_(coarse(reference_scene())),
        contact_(scene_.lubricant, scene_.solid, scene_.roughness, scene_.boundary,
                 scene_.sump_temperature, scene_.inlet_temperature_rise, scene_.options),
        mesh_(scene_.gear_set) {}

  /// Fewer samples in the tables, so that steps need not end 96 times per cycle.
  static Scene coarse(Scene scene) {
    ToothContactTables& t = scene.gear_set.tables;
    for (SlotTable* table :
         {&t.load_share, &t.radius_x, &t.radius_y, &t.pinion_velocity_x, &t.pinion_velocity_y,
          &t.gear_velocity_x, &t.gear_velocity_y, &t.contact_point_velocity_x,
          &t.contact_point_velocity_y, &t.pinion_friction_arm, &t.gear_friction_arm}) {
      for (std::vector<double>& slot : *table) {
        std::vector<double> kept;
        for (std::size_t i = 0; i < slot.size(); i += kCoarseTables) kept.push_back(slot[i]);
        slot = std::move(kept);
      }
    }
    return scene;
  }

  double mean_speed(const InitialValueProblem& problem) const {
    return problem.speed_kilometers_per_hour / 3.6 / scene_.vehicle.wheel_radius *
           scene_.gear_set.gear_teeth / scene_.gear_set.pinion_teeth;
  }
  double wheel_torque(const InitialValueProblem& problem) const {
    return problem.pinion_torque / 1.01 * scene_.gear_set.gear_teeth / scene_.gear_set.pinion_teeth;
  }

  SectionState start(const InitialValueProblem& problem) const {
    const DrivelineDynamics& d = scene_.gear_set.dynamics;
    const MeshFunctions at = mesh_.functions(0, 0);
    const double speed = mean_speed(problem),
                 force = problem.pinion_torque / at.pinion_contact_radius;
    const double ratio = mesh_.mean_pinion_contact_radius() / mesh_.mean_gear_contact_radius();
    return {problem.pinion_torque / d.pinion_shaft_stiffness,
            force * at.gear_contact_radius / d.gear_shaft_stiffness,
            speed,
            speed,
            speed * (at.pinion_contact_radius - at.static_transmission_error_slope) /
                at.gear_contact_radius,
            speed * ratio,
            d.half_backlash + at.static_transmission_error + force / at.mesh_stiffness +
                problem.excess_deflection};
  }

  Outcome march(const InitialValueProblem& problem, double tolerance,
                double maximum_step = 1) const {
    GearPairSystem system(mesh_, contact_, scene_.gear_set.dynamics, scene_.options);
    system.set_torques({problem.pinion_torque, wheel_torque(problem)});
    Outcome out;
    system.to_march(start(problem), out.state.data());
    system.regime = system.regime_of(0, out.state.data());
    out.scales = march_scales(system, mean_speed(problem));
    MarchOptions options;
    options.relative_tolerance = tolerance;
    options.maximum_step = maximum_step;
    double time = 0, work = 0;
    for (int cycle = 0; cycle < problem.mesh_cycles; ++cycle) {
      march_mesh_cycle(system, out.scales, options, out.state, out.statistics);
      time += out.state[kTime];
      work += out.state[kLossWork];
    }
    out.state[kTime] = time;
    out.state[kLossWork] = work;
    return out;
  }

  struct Errors {
    double
        state;  ///< largest of the seven, in the scales of the error test (DTE: static deflection)
    double work;  ///< of the loss work, relative
  };
  Errors errors(const Outcome& outcome, const Outcome& reference) const {
    Errors e{0, std::abs(outcome.state[kLossWork] / reference.state[kLossWork] - 1)};
    for (int i = kPinionShaftTwist; i <= kWheelSpeed; ++i) {
      e.state = std::max(
          e.state, std::abs(outcome.state[i] - reference.state[i]) / reference.scales.of(mesh_, i));
    }
    return e;
  }

  /// Least squares of log(error) against log(steps) for errors from 1e-4 to 1e-9 (1e-7 in a short
  /// run).
  class Fit {
   public:
    void add(double log_steps, double log_error) {
      if (log_error > std::log(1e-4) || log_error < std::log(kSmallest)) return;
      n_ += 1;
      x_ += log_steps;
      y_ += log_error;
      xx_ += log_steps * log_steps;
      xy_ += log_steps * log_error;
    }
    double points() const { return n_; }
    double order() const { return -(n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }
    static constexpr double kSmallest = kShortRun ? 1e-7 : 1e-9;

   private:
    double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
  };

  /// Errors must fall like steps^-5. Steps follow the tolerance, so that they crowd at the corners
  /// where a flank takes up its load. A single error may be small by luck: geometric means over
  /// problems that differ in the start.
  void expect_fifth_order(const std::vector<InitialValueProblem>& problems,
                          long least_events) const {
    std::vector<Outcome> references;
    for (const InitialValueProblem& problem : problems) {
      references.push_back(march(problem, 1e-13));
      EXPECT_GE(references.back().statistics.events, least_events);
      if (least_events == 0) {
        EXPECT_EQ(references.back().statistics.events, 0);
      }
      const Errors floor = errors(march(problem, 4e-13), references.back());
      EXPECT_LT(floor.state, 1e-10);
      EXPECT_LT(floor.work, 1e-10);
    }
    Fit state, work;
    const double count = static_cast<double>(problems.size());
    for (double tolerance = 1e-2;; tolerance *= std::pow(2, -1.25)) {
      double steps = 0, state_error = 0, work_error = 0;
      for (std::size_t i = 0; i < problems.size(); ++i) {
        const Outcome outcome = march(problems[i], tolerance);
        const Errors e = errors(outcome, references[i]);
        // However coarse, the error is that of the tolerance.
        EXPECT_LT(e.state, 300 * tolerance) << tolerance;
        EXPECT_LT(e.work, 10 * tolerance) << tolerance;
        steps += std::log(outcome.statistics.accepted_steps) / count;
        state_error += std::log(e.state) / count;
        work_error += std::log(e.work) / count;
      }
      state.add(steps, state_error);
      work.add(steps, work_error);
      if (std::max(state_error, work_error) < std::log(Fit::kSmallest)) break;
      ASSERT_GT(tolerance, 1e-13) << "errors do not fall";
    }
    const double margin = kShortRun ? 0.8 : 0.3;
    EXPECT_GT(state.points(), 5);
    EXPECT_GT(work.points(), 5);
    EXPECT_NEAR(state.order(), 5, margin);
    EXPECT_NEAR(work.order(), 5, margin);
    RecordProperty("order_of_state", std::to_string(state.order()));
    RecordProperty("order_of_loss_work", std::to_string(work.order()));
  }

  /// The same where nothing but the table ends the steps: m even steps per table interval, and a
  /// tolerance that falls as m^-5 for the corners where a pair takes up its load.
  void expect_fifth_order_of_even_steps(const InitialValueProblem& problem) const {
    const Outcome reference = march(problem, 1e-13);
    EXPECT_EQ(reference.statistics.events, 0);
    Fit state, work;
    for (double m = 4; m < 400; m *= 1.25) {
      const double even = std::round(m);
      const Outcome outcome =
          march(problem, 0.3 * std::pow(even, -5), 1.0 / mesh_.intervals() / even * (1 + 1e-9));
      const Errors e = errors(outcome, reference);
      state.add(std::log(even), std::log(e.state));
      work.add(std::log(even), std::log(e.work));
      if (std::max(e.state, e.work) < Fit::kSmallest) break;
    }
    EXPECT_GT(state.points(), kShortRun ? 3 : 5);
    EXPECT_GT(work.points(), kShortRun ? 1 : 3);
    EXPECT_NEAR(state.order(), 5, kShortRun ? 0.8 : 0.3);
    // The work is a quadrature of a power 0.74 at each corner, small at once and then slower.
    if (!kShortRun) {
      EXPECT_GT(work.order(), 3.3);
    }
    RecordProperty("order_of_state", std::to_string(state.order()));
    RecordProperty("order_of_loss_work", std::to_string(work.order()));
  }

  /// CVODE from the same start over the same cycles.
  void expect_yardstick_agrees(const InitialValueProblem& problem) const {
    namespace ys = yardstick;
    const nlohmann::json file = ys::ReadJsonFile(TRIBODYN_TEST_DATA "/reference_gear_set.json");
    const nlohmann::json worked = ys::ReadJsonFile(TRIBODYN_TEST_DATA "/worked_points.json");
    ys::GearPairParameters gear_pair = ys::ReadGearPair(file);
    for (ys::SlotTable* table : {&gear_pair.load_share, &gear_pair.radius_x, &gear_pair.radius_y,
                                 &gear_pair.pinion_velocity_x, &gear_pair.pinion_velocity_y,
                                 &gear_pair.gear_velocity_x, &gear_pair.gear_velocity_y}) {
      for (auto& slot : *table) {  // straight lines over the samples that are left out
        for (int i = 0; i < ys::kIntervals; ++i) {
          const int left = i / kCoarseTables * kCoarseTables;
          const double t = static_cast<double>(i - left) / kCoarseTables;
          if (t > 0) slot[i] = slot[left] + t * (slot[left + kCoarseTables] - slot[left]);
        }
      }
    }
    const ys::GearPairSystem system(gear_pair, ys::ReadVehicle(file),
                                    ys::ReadOrbitFriction(worked.at("orbit_inputs").at("values")));
    const SectionState s = start(problem);
    ys::SectionState section{s.pinion_shaft_twist, s.gear_shaft_twist, s.pinion_shaft_speed,
                             s.pinion_speed,       s.gear_speed,       s.wheel_speed,
                             s.mesh_deflection};
    double time = 0, work = 0;
    for (int cycle = 0; cycle < problem.mesh_cycles; ++cycle) {
      const ys::MeshCycle done =
          ys::IntegrateMeshCycle(system, section, problem.pinion_torque, wheel_torque(problem));
      const double turned = 2 * std::numbers::pi / scene_.gear_set.pinion_teeth +
                            done.end.pinion_shaft_twist - section.pinion_shaft_twist;
      work += done.energy_mean_inefficiency / 100 * problem.pinion_torque * turned;
      time += done.period;
      section = done.end;
    }
    const Outcome product = march(problem, 1e-11);
    Outcome other = product;
    GearPairSystem to_march(mesh_, contact_, scene_.gear_set.dynamics, scene_.options);
    to_march.to_march({section.pinion_shaft_twist, section.gear_shaft_twist,
                       section.pinion_shaft_speed, section.pinion_speed, section.gear_speed,
                       section.gear_shaft_speed, section.advance_with_error},
                      other.state.data());
    other.state[kLossWork] = work;
    const Errors e = errors(product, other);
    EXPECT_LT(e.state, 1e-7);
    EXPECT_LT(e.work, 1e-7);
    EXPECT_NEAR(product.state[kTime] / time, 1, 1e-9);
  }

  Scene scene_;
  FlankContactModel contact_;
  MeshData mesh_;
};

// Loads stay where no film reaches its limiting stress: that onset is a kink of the second
// derivative of friction which is left to the error test.
std::vector<InitialValueProblem> problems(double speed, double torque, double least, double step,
                                          int cycles) {
  std::vector<InitialValueProblem> out;
  for (int i = 0; i < (kShortRun ? 2 : 8); ++i)
    out.push_back({speed, torque, least + i * step, cycles});
  return out;
}

// Lightly damped over many cycles: errors gather while steps are short, so that the fifth order of
// the decay shows and not the sixth of the phase.
TEST_F(OrderTest, InContact) {
  scene_.gear_set.dynamics.mesh_damping *= 0.1;
  expect_fifth_order_of_even_steps({20, 6, 1e-6, 16});  // no film reaches its limiting stress
}

// Each loss is three events: load ends, flanks part, flanks meet.
TEST_F(OrderTest, AcrossLossesOfContact) {
  expect_fifth_order(problems(15, 8, 3e-6, 0.3e-6, 3), 3);
}

constexpr InitialValueProblem kInContact{5, 17, 2e-6, 2};
constexpr InitialValueProblem kSeveralLosses{12, 6, 3e-6, 4};

TEST_F(OrderTest, EndsWhereAnIndependentIntegratorEndsInContact) {
  expect_yardstick_agrees(kInContact);
}

TEST_F(OrderTest, EndsWhereAnIndependentIntegratorEndsAfterLosses) {
  expect_yardstick_agrees(kSeveralLosses);
}

TEST_F(OrderTest, ViolentImpactsIntoTheLimitingStressKeepTheErrorNearTheTolerance) {
  const InitialValueProblem violent{5, 17, 20e-6, 2};
  const Outcome reference = march(violent, 1e-13);
  EXPECT_GT(reference.statistics.events, 9);
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    const Errors e = errors(march(violent, tolerance), reference);
    EXPECT_LT(e.state, 300 * tolerance) << tolerance;
    EXPECT_LT(e.work, 30 * tolerance) << tolerance;
  }
}

TEST_F(OrderTest, TrialStagesOfAStepThatIsTooLongAreNoRefusal) {
  // The first step tried is a table interval, 6 ms: its stages see forces that no contact bears.
  EXPECT_NO_THROW(march({2, 17, 40e-6, 1}, 1e-7));
}

TEST_F(OrderTest, AStoppingPinionIsRefusedByName) {
  try {
    march({0.05, 6, 5e-6, 1}, 1e-7);  // the vibration is faster than the train
    FAIL() << "went on";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.reason(), "NO_FORWARD_ROTATION");
  }
}

}  // namespace
}  // namespace tribodyn
