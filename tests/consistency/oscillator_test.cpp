// The march on systems whose solution is known: closed forms, and the gear oscillator of Kahraman
// and Singh.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/integrate/dormand_prince_with_events.h"
#include "core/integrate/graded_phase.h"
#include "tests/support/reference_data.h"

namespace tribodyn {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

MarchOptions steps_of(double tolerance, double maximum_step = kNever) {
  MarchOptions options;
  options.relative_tolerance = tolerance;
  options.maximum_step = maximum_step;
  return options;
}

/// One coordinate and its speed; what the systems below have in common.
struct PlaneSystem {
  static constexpr int kSize = 2, kEvents = 2;
  using State = std::array<double, kSize>;
  double next_breakpoint(double) const { return kNever; }
  void on_breakpoint(double) {}
  double scale(int) const { return 1; }
};

struct Harmonic : PlaneSystem {
  void derivative(double, const State& y, State& dy) const { dy = {y[1], -y[0]}; }
  void events(double, const State&, std::array<double, kEvents>& g) const { g = {-1, -1}; }
  void on_event(int, double, const State&) {}
};

TEST(March, HarmonicOscillatorAtFifthOrderAndFourthOrderBetweenSteps) {
  const auto errors_at = [](double step_length) {
    Harmonic system;
    DormandPrinceWithEvents<Harmonic> march(system, steps_of(1e300, step_length));
    double s = 0, between = 0;
    Harmonic::State y{1, 0};
    const double end = 4 * std::numbers::pi;
    march.run(s, y, end, [&](const MarchStep<2>& step) {
      for (const double theta : {0.25, 0.5, 0.75}) {
        between = std::max(
            between, std::abs(step.at(theta)[0] - std::cos(step.start + theta * step.length)));
      }
    });
    EXPECT_EQ(s, end);
    EXPECT_EQ(march.work().rejected_steps, 0);
    EXPECT_EQ(march.work().right_hand_sides, 6 * march.work().accepted_steps + 1);
    return std::array<double, 2>{std::hypot(y[0] - 1, y[1]), between};
  };
  const auto coarse = errors_at(4 * std::numbers::pi / 50), fine = errors_at(std::numbers::pi / 50);
  EXPECT_NEAR(std::log(coarse[0] / fine[0]) / std::log(4), 5, 0.2);
  EXPECT_GT(std::log(coarse[1] / fine[1]) / std::log(4), 3.9);
}

TEST(March, ErrorOfTheHarmonicOscillatorIsInProportionToTheTolerance) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    Harmonic system;
    DormandPrinceWithEvents<Harmonic> march(system, steps_of(tolerance));
    double s = 0;
    Harmonic::State y{1, 0};
    march.run(s, y, 20 * std::numbers::pi);
    EXPECT_LT(std::hypot(y[0] - 1, y[1]), 100 * tolerance + 1e-13) << tolerance;
  }
}

/// A ball under gravity on a floor that is a spring: every time of contact in closed form.
struct BallOnSpring : PlaneSystem {
  static constexpr double kGravity = 9.81, kFloor = 4e4;  // [m/s2], [1/s2]
  bool contact = false;
  std::vector<double> times;
  void derivative(double, const State& y, State& dy) const {
    dy = {y[1], -kGravity - (contact ? kFloor * y[0] : 0)};
  }
  void events(double, const State& y, std::array<double, kEvents>& g) const {
    g = {contact ? y[0] : -y[0], -1};
  }
  void on_event(int, double s, const State&) {
    contact = !contact;
    times.push_back(s);
  }
};

TEST(March, BouncingBallMeetsTheFloorAtTheExactTimes) {
  for (const double maximum_step : {kNever, 0.013}) {
    BallOnSpring system;
    DormandPrinceWithEvents<BallOnSpring> march(system, steps_of(1e-12, maximum_step));
    double s = 0;
    BallOnSpring::State y{1, 0};
    march.run(s, y, 10);
    const double fall = std::sqrt(2 / BallOnSpring::kGravity);
    const double speed = BallOnSpring::kGravity * fall, omega = std::sqrt(BallOnSpring::kFloor);
    // x = g/w^2 (cos w t - 1) - v/w sin w t returns to zero when tan(w t/2) = -v w/g.
    const double contact =
        2 / omega * (std::numbers::pi - std::atan(speed * omega / BallOnSpring::kGravity));
    ASSERT_GE(system.times.size(), 20u);
    EXPECT_EQ(march.work().events, static_cast<long>(system.times.size()));
    for (std::size_t n = 0; n < system.times.size(); ++n) {
      const std::size_t bounces_before = n / 2;
      const double bounces = static_cast<double>(bounces_before);
      const double exact = fall + bounces * (2 * fall + contact) + (n % 2 == 1 ? contact : 0);
      EXPECT_NEAR(system.times[n], exact, 2e-10) << n;
    }
  }
}

/// A unit oscillator that dips into a wall by `depth` at every turn: x = 1 - depth. Behind the wall
/// a second spring adds (x - wall), so that the orbit closes in closed form.
struct Grazing : PlaneSystem {
  double wall = 0;
  bool inside = false;
  long entries = 0;
  void derivative(double, const State& y, State& dy) const {
    dy = {y[1], -y[0] - (inside ? y[0] - wall : 0)};
  }
  void events(double, const State& y, std::array<double, kEvents>& g) const {
    g = {inside ? wall - y[0] : y[0] - wall, -1};
  }
  void on_event(int, double, const State&) {
    inside = !inside;
    entries += inside ? 1 : 0;
  }
};

TEST(March, GrazingIsFoundOrDoesNoHarm) {
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    for (int decade = 1; decade <= 14; ++decade) {
      const double depth = std::pow(10, -decade);
      Grazing system;
      system.wall = 1 - depth;
      DormandPrinceWithEvents<Grazing> march(system, steps_of(tolerance));
      // From the middle with speed 1: outside the wall a quarter turn and back, inside about
      // x = wall/2 with twice the stiffness.
      const double speed = std::sqrt(1 - system.wall * system.wall);
      const double middle = 0.5 * system.wall;
      const double half_inside =
          std::atan2(speed / std::numbers::sqrt2, middle) / std::numbers::sqrt2;
      const double period = 2 * (std::numbers::pi - std::acos(system.wall) + half_inside);
      double s = 0;
      Grazing::State y{0, 1};
      march.run(s, y, 5 * period);
      const double error = std::hypot(y[0], y[1] - 1);
      EXPECT_LT(error, 100 * tolerance) << depth << " " << tolerance;
      if (depth >= 10 * tolerance) {
        EXPECT_EQ(system.entries, 5) << depth << " " << tolerance;
      }
    }
  }
}

TEST(March, TouchingWithoutCrossingIsNoEvent) {
  Grazing system;
  system.wall = 1 + 1e-6;
  DormandPrinceWithEvents<Grazing> march(system, steps_of(1e-9));
  double s = 0;
  Grazing::State y{0, 1};
  march.run(s, y, 100);
  EXPECT_EQ(march.work().events, 0);
}

/// y' = (1 - s)^0.74 up to an event at s = 1, where the rate jumps: what a load that comes to zero
/// does to friction.
template <bool kTold>
struct EndsInCorner {
  static constexpr int kSize = 1, kEvents = 1;
  using State = std::array<double, kSize>;
  bool behind = false;
  void derivative(double s, const State&, State& dy) const {
    dy = {behind ? 1 : std::pow(std::max(0.0, 1 - s), 0.74)};
  }
  void events(double s, const State&, std::array<double, kEvents>& g) const {
    g = {behind ? -1 : s - 1};
  }
  void on_event(int, double, const State&) { behind = true; }
  double next_breakpoint(double) const { return 2; }
  void on_breakpoint(double) {}
  double scale(int) const { return 1; }
  bool corner_at(int) const requires kTold { return true; }
};

/// Largest over many starts: a single one may be exact by luck.
template <bool kTold>
double error_at_corner(double tolerance) {
  double worst = 0;
  for (int i = 0; i < 50; ++i) {
    EndsInCorner<kTold> system;
    DormandPrinceWithEvents<EndsInCorner<kTold>> march(system, steps_of(tolerance));
    const double start = -0.02 * i;
    double s = start;
    typename EndsInCorner<kTold>::State y{0};
    march.run(s, y, 2);
    worst = std::max(worst, std::abs(y[0] - 1 - std::pow(1 - start, 1.74) / 1.74));
  }
  return worst;
}

TEST(March, EventsAtCornersOfFractionalPowersKeepTheErrorInProportionToTheTolerance) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    EXPECT_LT(error_at_corner<true>(tolerance), 5 * tolerance) << tolerance;
    EXPECT_GT(error_at_corner<false>(tolerance), 10 * tolerance) << "the embedded estimate alone";
  }
}

/// y' = 1 over phase, marched over the graded variable s; also f = distance^0.74 from each corner.
struct Graded {
  static constexpr int kSize = 2, kEvents = 1;
  using State = std::array<double, kSize>;
  GradedPhase piece;
  bool at_start, at_end;
  void derivative(double s, const State&, State& dy) const {
    const double phase = piece.phase(s), slope = piece.slope(s);
    double power = 1;
    if (at_start) power *= std::pow(phase - 1, 0.74);
    if (at_end) power *= std::pow(1.5 - phase, 0.74);
    dy = {slope, slope * power};
  }
  void events(double, const State&, std::array<double, kEvents>& g) const { g = {-1}; }
  void on_event(int, double, const State&) {}
  double next_breakpoint(double) const { return 1.5; }
  void on_breakpoint(double) {}
  double scale(int) const { return 1; }
};

TEST(March, GradedPiecesKeepTheFifthOrderOfEvenStepsAtCornersInKnownPlaces) {
  struct Case {
    bool at_start, at_end;
    double exact;
  };
  const double one = std::pow(0.5, 1.74) / 1.74;
  const double both =
      std::pow(0.5, 2.48) * std::tgamma(1.74) * std::tgamma(1.74) / std::tgamma(3.48);
  for (const Case c : {Case{true, false, one}, {false, true, one}, {true, true, both}}) {
    const auto error = [&](double steps, bool graded) {
      const GradedPhase piece(0.7, 1, 1.5, graded && c.at_start, graded && c.at_end);
      Graded system{piece, c.at_start, c.at_end};
      DormandPrinceWithEvents<Graded> march(system, steps_of(1e300, 0.8 / steps * (1 + 1e-12)));
      double s = 0.7;
      Graded::State y{0, 0};
      march.run(s, y, 1.5);
      EXPECT_NEAR(y[0], 0.5, 1e-4);
      return std::abs(y[1] - c.exact);
    };
    EXPECT_NEAR(std::log2(error(8, true) / error(32, true)) / 2, 5, 0.5);
    EXPECT_LT(std::log2(error(8, false) / error(32, false)) / 2, 2);
  }
}

TEST(March, PhaseAndProgressOfAGradedPieceAreEachOthersInverse) {
  for (const bool at_start : {false, true}) {
    for (const bool at_end : {false, true}) {
      const GradedPhase piece(0.7, 1, 1.5, at_start, at_end);
      EXPECT_EQ(piece.phase(1.5), 1.5);
      EXPECT_EQ(piece.phase(0.7), 1);
      for (const double phase : {1.0, 1.001, 1.1, 1.25, 1.4, 1.499, 1.5}) {
        EXPECT_NEAR(piece.phase(piece.s_of(phase)), phase, 4e-16);
      }
      for (const double at : {0.75, 1.1, 1.45}) {
        EXPECT_NEAR((piece.phase(at + 1e-6) - piece.phase(at - 1e-6)) / 2e-6, piece.slope(at),
                    1e-8);
      }
    }
  }
}

/// NaN in one component only, from s = 0.5 on.
struct Undefined : PlaneSystem {
  void derivative(double s, const State&, State& dy) const {
    dy = {s > 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1.0, 1};
  }
  void events(double, const State&, std::array<double, kEvents>& g) const { g = {-1, -1}; }
  void on_event(int, double, const State&) {}
};

TEST(March, NoStepIsTakenOnNotANumber) {
  Undefined system;
  DormandPrinceWithEvents<Undefined> march(system, steps_of(1e-6));
  double s = 0;
  Undefined::State y{0, 0};
  try {
    march.run(s, y, 1);
    FAIL() << "went on to " << s;
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.reason(), "NOT_FINITE");
  }
  EXPECT_TRUE(std::isfinite(y[0]));
  EXPECT_NEAR(s, 0.5, 1e-12);
}

/// x'' + 2 z x' + g(x) = Fm + Fah W^2 sin(W t), g = x - 1 above 1, 0 between, x + 1 below -1.
struct GearOscillator : PlaneSystem {
  double damping = 0, mean = 0, alternating = 0, frequency = 1;
  int side = 1;
  void derivative(double t, const State& y, State& dy) const {
    dy = {y[1], mean + alternating * frequency * frequency * std::sin(frequency * t) -
                    2 * damping * y[1] - (side == 0 ? 0 : y[0] - side)};
  }
  void events(double, const State& y, std::array<double, kEvents>& g) const {
    if (side == 0) {
      g = {y[0] - 1, -1 - y[0]};
    } else {
      g = {1 - side * y[0], -1};
    }
  }
  void on_event(int index, double, const State&) { side = side != 0 ? 0 : index == 0 ? 1 : -1; }
};

class KahramanSingh : public testing::Test {
 protected:
  KahramanSingh() : block_(load_reference("published_checks.json").at("gear_oscillator")) {
    system_.damping = block_.at("z");
    system_.mean = block_.at("Fm");
    system_.alternating = block_.at("Fah");
  }

  struct Range {
    double minimum = kNever, maximum = -kNever;
  };

  /// Marches whole periods of the excitation; the time starts from zero in each.
  Range run(double frequency, int periods) {
    system_.frequency = frequency;
    Range range;
    for (int period = 0; period < periods; ++period) {
      DormandPrinceWithEvents<GearOscillator> march(system_, steps_of(1e-10));
      double t = 0;
      march.run(t, state_, 2 * std::numbers::pi / frequency, [&](const MarchStep<2>& step) {
        // Inside a step x turns where v = 0.
        const auto see = [&range](double x) {
          range.minimum = std::min(range.minimum, x);
          range.maximum = std::max(range.maximum, x);
        };
        see(step.to[0]);
        if (step.from[1] * step.to[1] >= 0) return;
        double low = 0, high = 1;
        for (int i = 0; i < 50; ++i) {
          const double middle = 0.5 * (low + high);
          (step.at(middle)[1] * step.from[1] > 0 ? low : high) = middle;
        }
        see(step.at(low)[0]);
      });
    }
    return range;
  }

  /// Settles, then looks at one period.
  Range settled(double frequency, int periods) {
    run(frequency, periods);
    return run(frequency, 1);
  }

  void expect_swept(const nlohmann::json& points, double from, double step) {
    const double tolerance = block_.at("sweep_relative_tolerance");
    std::size_t next = 0;
    for (int i = 0; next < points.size(); ++i) {
      const double frequency = from + i * step;
      run(frequency, 60);
      if (std::abs(frequency - points[next].at("W").get<double>()) > 1e-9) continue;
      const Range range = settled(frequency, 200);
      const double maximum = points[next].at("max"), minimum = points[next].at("min");
      EXPECT_NEAR(range.maximum / maximum, 1, tolerance) << frequency;
      EXPECT_NEAR(range.minimum / minimum, 1, tolerance) << frequency;
      ++next;
    }
  }

  nlohmann::json block_;
  GearOscillator system_;
  GearOscillator::State state_{1.1, 0};
};

TEST_F(KahramanSingh, LinearResponseTouchesTheEdgeAtTheClosedForm) {
  // Amplitude Fah W^2 / sqrt((1 - W^2)^2 + (2 z W)^2) reaches Fm.
  const double r = system_.alternating / system_.mean;
  const double a = 1 - r * r, half_b = 1 - 2 * system_.damping * system_.damping;
  const double root = std::sqrt(half_b * half_b - a);
  const std::array<double, 2> closed = {std::sqrt((half_b - root) / a),
                                        std::sqrt((half_b + root) / a)};
  for (int i = 0; i < 2; ++i) {
    const double w = block_.at("closed_form_contact_loss_at_W").at(i);
    EXPECT_NEAR(w / closed[i], 1, block_.at("relative_tolerance").get<double>());

    // On the linear response at that frequency the march comes down to x = 1 and no further.
    const double phase = std::atan2(2 * system_.damping * w, 1 - w * w);
    const double amplitude = system_.mean;
    state_ = {1 + system_.mean - amplitude * std::sin(phase), amplitude * w * std::cos(phase)};
    system_.side = 1;
    const Range range = run(w, 3);
    EXPECT_NEAR(range.minimum, 1, 1e-9) << w;
    EXPECT_NEAR(range.maximum, 1 + 2 * system_.mean, 1e-9) << w;
  }
}

TEST_F(KahramanSingh, UpSweep) { expect_swept(block_.at("sweep_up"), 0.70, 0.0025); }

TEST_F(KahramanSingh, DownSweepStaysOnTheLargeBranchUntilItEnds) {
  expect_swept(block_.at("sweep_down"), 0.85, -0.002);
}

TEST_F(KahramanSingh, LargeBranchEndsWherePublished) {
  const double gone = block_.at("large_branch_ends_between_W").at(0);
  const double there = block_.at("large_branch_ends_between_W").at(1);
  for (int i = 0; 0.85 - 0.002 * i > there + 1e-9; ++i) run(0.85 - 0.002 * i, 60);
  EXPECT_LT(settled(there, 600).minimum, 1);
  EXPECT_GT(settled(gone, 600).minimum, 1);
}

}  // namespace
}  // namespace tribodyn
