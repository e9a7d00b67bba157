// Order of the march of the gear pair with friction in the loop: initial-value problems over a few
// mesh cycles, slow enough that steps and not the tables decide the error.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/integrate/mesh_cycle_march.h"
#include "tests/support/coarse_tables.h"
#include "tests/support/paths.h"
#include "tests/support/reference_scene.h"
#include "tests/support/run_length.h"
#include "yardstick_data.h"

namespace tribodyn {
namespace {

/// Released from more deflection than the static one, at constant torques.
struct InitialValueProblem {
  double speed_kilometres_per_hour;
  double pinion_torque;      ///< [N m]
  double excess_deflection;  ///< [m]
  int mesh_cycles;
};

constexpr int kCoarseTables = 8;  ///< samples between those that are kept: 12 intervals are left

struct Outcome {
  MarchState state{};  ///< time and work of all cycles
  SolverWork work;
  MarchScales scales{};
};

class OrderTest : public testing::Test {
 protected:
  OrderTest()
      : scene_(with_coarse_tables(reference_scene(), kCoarseTables)),
        contact_(scene_.lubricant, scene_.solid, scene_.roughness, scene_.boundary,
                 scene_.sump_temperature, scene_.inlet_temperature_rise, scene_.options),
        mesh_(scene_.gear_set) {}

  double mean_speed(const InitialValueProblem& problem) const {
    return problem.speed_kilometres_per_hour / 3.6 / scene_.vehicle.wheel_radius *
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
    const GearPairSystem system(mesh_, scene_.gear_set.dynamics, scene_.options);
    ContactTally tally;
    ContactSolver contacts(contact_, tally);
    const Torques torques{problem.pinion_torque, wheel_torque(problem)};
    Outcome out;
    system.to_march(start(problem), out.state.data());
    SectionPoint at = system.at_section(out.state, torques);
    out.scales = march_scales(system, torques, mean_speed(problem));
    MarchOptions options;
    options.relative_tolerance = tolerance;
    options.maximum_step = maximum_step;
    double time = 0, work = 0;
    for (int cycle = 0; cycle < problem.mesh_cycles; ++cycle) {
      march_mesh_cycle(system, out.scales, options, contacts, at, out.work);
      time += at.state[kTime];
      work += at.state[kLossWork];
    }
    out.state = at.state;
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

  /// Least squares of log(error) against the logarithm of steps, for errors from 1e-4 to 1e-9.
  class Fit {
   public:
    void add(double log_steps, double log_error) {
      if (log_error > std::log(1e-4) || log_error < std::log(1e-9)) return;
      n_ += 1;
      x_ += log_steps;
      y_ += log_error;
      xx_ += log_steps * log_steps;
      xy_ += log_steps * log_error;
    }
    double points() const { return n_; }
    double order() const { return -(n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }

   private:
    double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
  };

  /// Errors of the problems, geometric means: a single error may be small by luck.
  struct MeanErrors {
    double log_steps = 0, log_state = 0, log_work = 0;
  };

  /// Fits errors(0), errors(1), ... until both are below 1e-9. Sanitizers take a few, without fit.
  template <class ErrorsOf>
  static void expect_fifth_order(ErrorsOf&& errors_of) {
    Fit state, work;
    for (int i = 0; i < (kShortRun ? 5 : 40); ++i) {
      const MeanErrors e = errors_of(i);
      state.add(e.log_steps, e.log_state);
      work.add(e.log_steps, e.log_work);
      if (std::max(e.log_state, e.log_work) < std::log(1e-9)) break;
    }
    if (kShortRun) return;
    EXPECT_GT(state.points(), 8);
    EXPECT_GT(work.points(), 8);
    EXPECT_NEAR(state.order(), 5, 0.3);
    EXPECT_NEAR(work.order(), 5, 0.3);
    RecordProperty("order_of_state", std::to_string(state.order()));
    RecordProperty("order_of_loss_work", std::to_string(work.order()));
  }

  std::vector<Outcome> references(const std::vector<InitialValueProblem>& problems) const {
    std::vector<Outcome> out;
    for (const InitialValueProblem& problem : problems) {
      out.push_back(march(problem, 1e-13));
      if (kShortRun) continue;
      const Errors floor = errors(march(problem, 4e-13), out.back());
      EXPECT_LT(floor.state, 1e-10);
      EXPECT_LT(floor.work, 1e-10);
    }
    return out;
  }

  /// Adds what one outcome tells to the means over `count` problems. However coarse, the error is
  /// that of the tolerance.
  void add(const Outcome& outcome, const Outcome& reference, double tolerance, double count,
           MeanErrors& mean) const {
    const Errors e = errors(outcome, reference);
    EXPECT_LT(e.state, 300 * tolerance) << tolerance;
    EXPECT_LT(e.work, 10 * tolerance) << tolerance;
    mean.log_state += std::log(e.state) / count;
    mean.log_work += std::log(e.work) / count;
  }

  /// Steps follow the tolerance.
  void expect_fifth_order_of_steps_by_tolerance(const std::vector<InitialValueProblem>& problems,
                                                long least_events) const {
    const std::vector<Outcome> exact = references(problems);
    for (const Outcome& one : exact) EXPECT_GE(one.work.events, least_events);
    const double count = static_cast<double>(problems.size());
    expect_fifth_order([&](int i) {
      const double tolerance = 1e-2 * std::pow(2, -1.25 * i);
      MeanErrors mean;
      for (std::size_t k = 0; k < problems.size(); ++k) {
        const Outcome outcome = march(problems[k], tolerance);
        mean.log_steps += std::log(outcome.work.accepted_steps) / count;
        add(outcome, exact[k], tolerance, count, mean);
      }
      return mean;
    });
  }

  /// m even steps per table interval, 3 m where a pair takes or gives up its load (the tolerance
  /// falls as m^-5 and sees to it).
  void expect_fifth_order_of_even_steps(const std::vector<InitialValueProblem>& problems) const {
    const std::vector<Outcome> exact = references(problems);
    for (const Outcome& one : exact) EXPECT_EQ(one.work.events, 0);
    const double count = static_cast<double>(problems.size());
    expect_fifth_order([&](int i) {
      const double even = std::round(3 * std::pow(1.25, i));
      const double tolerance = 0.3 * std::pow(even, -5);
      MeanErrors mean{.log_steps = std::log(even)};
      for (std::size_t k = 0; k < problems.size(); ++k) {
        add(march(problems[k], tolerance, 1.0 / mesh_.intervals() / even * (1 + 1e-9)), exact[k],
            tolerance, count, mean);
      }
      return mean;
    });
  }

  /// CVODE from the same start over the same cycles.
  void expect_yardstick_agrees(const InitialValueProblem& problem) const {
    namespace ys = yardstick;
    const nlohmann::json file = ys::read_json_file(test_data_file("reference_gear_set.json"));
    const nlohmann::json worked = ys::read_json_file(test_data_file("worked_points.json"));
    ys::GearPairParameters gear_pair = ys::read_gear_pair(file);
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
    const ys::GearPairSystem system(
        gear_pair, ys::read_vehicle(file),
        ys::read_orbit_friction(worked.at("orbit_inputs").at("values")));
    const SectionState s = start(problem);
    ys::SectionState section{s.pinion_shaft_twist, s.gear_shaft_twist, s.pinion_shaft_speed,
                             s.pinion_speed,       s.gear_speed,       s.wheel_speed,
                             s.mesh_deflection};
    double time = 0, work = 0;
    for (int cycle = 0; cycle < problem.mesh_cycles; ++cycle) {
      const ys::MeshCycle done =
          ys::integrate_mesh_cycle(system, section, problem.pinion_torque, wheel_torque(problem));
      const double turned = 2 * std::numbers::pi / scene_.gear_set.pinion_teeth +
                            done.end.pinion_shaft_twist - section.pinion_shaft_twist;
      work += done.energy_mean_inefficiency / 100 * problem.pinion_torque * turned;
      time += done.period;
      section = done.end;
    }
    const Outcome product = march(problem, 1e-11);
    Outcome other = product;
    const GearPairSystem to_march(mesh_, scene_.gear_set.dynamics, scene_.options);
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
std::vector<InitialValueProblem> problems(double speed, double torque, double excess, int cycles) {
  std::vector<InitialValueProblem> out;
  const int count = kShortRun ? 1 : 8;
  for (int i = 0; i < count; ++i) out.push_back({speed, torque, excess * (1 + 0.05 * i), cycles});
  return out;
}

TEST_F(OrderTest, InContact) { expect_fifth_order_of_even_steps(problems(15, 6, 1e-6, 3)); }

TEST_F(OrderTest, InContactWithLittleDamping) {
  if (!full_run()) GTEST_SKIP() << "takes a minute: only with TRIBODYN_FULL=1";
  scene_.gear_set.dynamics.mesh_damping *= 0.1;
  expect_fifth_order_of_even_steps(problems(3, 6, 1e-6, 3));
}

// Each loss is three events: load ends, flanks part, flanks meet.
TEST_F(OrderTest, AcrossLossesOfContact) {
  expect_fifth_order_of_steps_by_tolerance(problems(8, 1.5, 0.675e-6, 2), 3);
}

TEST_F(OrderTest, AcrossManyLossesOfContact) {
  if (!full_run()) GTEST_SKIP() << "takes half a minute: only with TRIBODYN_FULL=1";
  expect_fifth_order_of_steps_by_tolerance(problems(3, 1.5, 0.675e-6, 2), 6);
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
  EXPECT_GT(reference.work.events, 9);
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
