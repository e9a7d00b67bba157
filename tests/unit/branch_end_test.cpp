// The end of a branch on responses in closed form.
#include "core/periodic/branch_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tribodyn {
namespace {

constexpr double kKilometresPerHour = 1 / 3.6;  // [m/s]
constexpr double kResolution = 0.04 * kKilometresPerHour;

BranchPoint response(double speed, double swing, int period = 1) {
  BranchPoint out{speed, swing, true, 0, {}};
  out.state.period = period;
  return out;
}

/// A wide branch up to a fold [m/s] and a narrow one at every speed: from the wide branch the
/// response jumps beyond the fold, and never back.
struct Hysteresis {
  double fold;
  int calls = 0;

  static BranchPoint wide(double speed) { return response(speed, 3 + 0.1 * speed); }
  static BranchPoint narrow(double speed) { return response(speed, 1 + 0.1 * speed); }
  SolveOnBranch solve() {
    return [this](double speed, const BranchPoint& from) -> std::optional<BranchPoint> {
      ++calls;
      const bool is_wide = from.swing > 2 + 0.1 * from.speed;
      return is_wide && speed <= fold ? wide(speed) : narrow(speed);
    };
  }
};

TEST(BranchEnd, AFoldIsLocatedToTheSpeedResolutionWhereverItLies) {
  for (const double fold : {5.001, 5.2, 6.0, 7.3, 7.999}) {
    Hysteresis model{fold};
    const auto end =
        find_branch_end(Hysteresis::wide(5), Hysteresis::narrow(8), {model.solve(), model.solve()});
    ASSERT_TRUE(end) << fold;
    EXPECT_LE(end->followed_to, fold);
    EXPECT_GT(end->gone_at, fold);
    EXPECT_LE(end->gone_at - end->followed_to, 1.001 * kResolution) << fold;
    EXPECT_LE(model.calls, 12) << "3 m/s are halved nine times";
  }
}

TEST(BranchEnd, AFoldIsLocatedInADescendingSweepToo) {
  const auto wide_above = [](double speed, const BranchPoint& from) -> std::optional<BranchPoint> {
    return from.swing > 2 && speed >= 6.1 ? response(speed, 3) : response(speed, 1);
  };
  const auto end = find_branch_end(response(8, 3), response(5, 1), {wide_above, wide_above});
  ASSERT_TRUE(end);
  EXPECT_GE(end->followed_to, 6.1);
  EXPECT_LT(end->gone_at, 6.1);
  EXPECT_LE(end->followed_to - end->gone_at, 1.001 * kResolution);
}

TEST(BranchEnd, AFoldIsLocatedByMarchingAlone) {
  Hysteresis model{6.2};
  const auto end = find_branch_end(Hysteresis::wide(5), Hysteresis::narrow(8), {{}, model.solve()});
  ASSERT_TRUE(end);
  EXPECT_LE(end->followed_to, model.fold);
  EXPECT_GT(end->gone_at, model.fold);
  EXPECT_LE(end->gone_at - end->followed_to, 1.001 * kResolution);
}

TEST(BranchEnd, ASteepBranchHasNoEnd) {
  const auto steep = [](double speed) { return response(speed, 2 + std::tanh(4 * (speed - 6.5))); };
  const SolveOnBranch solve = [&](double speed, const BranchPoint&) { return steep(speed); };
  EXPECT_FALSE(find_branch_end(steep(5), steep(8), {solve, solve}));
}

TEST(BranchEnd, OneSolutionShowsThatFlanksBeginToPartWithoutAJump) {
  int calls = 0;
  const auto grazing = [](double speed) {
    BranchPoint out = response(speed, 20 + speed);
    out.state.contact_loss = speed > 6.3;
    return out;
  };
  const SolveOnBranch solve = [&](double speed, const BranchPoint&) {
    ++calls;
    return grazing(speed);
  };
  EXPECT_FALSE(find_branch_end(grazing(5), grazing(8), {solve, solve}));
  EXPECT_FALSE(find_branch_end(grazing(8), grazing(5), {solve, solve}));
  EXPECT_EQ(calls, 2);
}

TEST(BranchEnd, AJumpWithWhichFlanksPartIsLocatedWhereverItLies) {
  // A jump by 12 % of the wider swing.
  for (const double fold : {5.3, 6.45, 6.55, 7.7}) {
    const SolveOnBranch solve = [&](double speed,
                                    const BranchPoint&) -> std::optional<BranchPoint> {
      BranchPoint out = response(speed, speed > fold ? 10 : 8.8);
      out.state.contact_loss = speed > fold;
      return out;
    };
    const BranchPoint quiet = *solve(5, {}), loud = *solve(8, {});
    for (const bool up : {true, false}) {
      const auto end = find_branch_end(up ? quiet : loud, up ? loud : quiet, {solve, solve});
      ASSERT_TRUE(end) << fold;
      EXPECT_LE(std::abs(end->gone_at - end->followed_to), 1.001 * kResolution);
      EXPECT_LE(std::min(end->gone_at, end->followed_to), fold);
      EXPECT_GE(std::max(end->gone_at, end->followed_to), fold);
    }
  }
}

TEST(BranchEnd, MarchingDecidesWhereShootingFindsNothing) {
  Hysteresis model{6.5};
  const SolveOnBranch shooting = [&](double speed, const BranchPoint& from) {
    return std::abs(speed - model.fold) < 0.1 ? std::nullopt : model.solve()(speed, from);
  };
  const auto end =
      find_branch_end(Hysteresis::wide(5), Hysteresis::narrow(8), {shooting, model.solve()});
  ASSERT_TRUE(end);
  EXPECT_LE(end->followed_to, model.fold);
  EXPECT_GT(end->gone_at, model.fold);
  EXPECT_LE(end->gone_at - end->followed_to, 1.001 * kResolution);
  EXPECT_FALSE(find_branch_end(Hysteresis::wide(5), Hysteresis::narrow(8), {shooting, {}}))
      << "shooting alone does not find what is beyond";
}

TEST(BranchEnd, TheOtherBranchDecidesWhereThePeriodChanges) {
  // Twice the period from 6.4 m/s on; shooting finds no response of one cycle beyond. Marching is
  // the last resort.
  int marched = 0;
  const SolveOnBranch shooting = [](double speed, const BranchPoint& from) {
    if (from.state.period == 1 && speed > 6.4) return std::optional<BranchPoint>();
    if (from.state.period == 2 && speed < 6.4) return std::optional<BranchPoint>();
    return std::optional(response(speed, from.state.period == 1 ? 1 : 2, from.state.period));
  };
  const SolveOnBranch any_method = [&](double speed, const BranchPoint& from) {
    ++marched;
    return shooting(speed, from);
  };
  const auto end = find_branch_end(response(5, 1), response(8, 2, 2), {shooting, any_method});
  ASSERT_TRUE(end);
  EXPECT_LE(end->followed_to, 6.4);
  EXPECT_GT(end->gone_at, 6.4);
  EXPECT_EQ(marched, 0);
}

TEST(BranchEnd, MarchingEndsAfterSomeHundredCycles) {
  int marched = 0;
  const SolveOnBranch nothing = [](double, const BranchPoint&) { return std::nullopt; };
  const SolveOnBranch slow = [&](double speed, const BranchPoint&) {
    BranchPoint found = response(speed, 1);
    found.settled = false;
    found.marched_cycles = kMostBranchCycles;
    ++marched;
    return found;
  };
  const auto end = find_branch_end(response(5, 3), response(8, 1), {nothing, slow});
  ASSERT_TRUE(end);
  EXPECT_EQ(end->followed_to, 5);
  EXPECT_LE(marched, 2);
}

TEST(BranchEnd, NeighboursOfOneKindAndSwingAreNotTwoBranches) {
  EXPECT_FALSE(may_be_branches(response(5, 1), response(6, 1.4)));
  EXPECT_TRUE(may_be_branches(response(5, 1), response(6, 1.5)));
  EXPECT_TRUE(may_be_branches(response(5, 1), response(6, 1, 2)));
  BranchPoint parting = response(6, 1);
  parting.state.contact_loss = true;
  EXPECT_TRUE(may_be_branches(response(5, 1), parting));
  parting.settled = false;
  EXPECT_FALSE(may_be_branches(response(5, 1), parting));
}

}  // namespace
}  // namespace tribodyn
