#include <gtest/gtest.h>

#include <new>

#include "core/integrate/mesh_cycle_march.h"
#include "core/study/operating_point.h"
#include "tests/consistency/allocation/counted_new.h"
#include "tests/support/contact_batch.h"
#include "tests/support/realistic_contacts.h"
#include "tests/support/reference_scene.h"

namespace tribodyn {
namespace {

template <class Work>
long allocations_of(Work&& work) {
  const long before = allocation_count();
  work();
  return allocation_count() - before;
}

/// Marches a settled point on. Parameter: vehicle speed [km/h].
class Allocation : public testing::TestWithParam<double> {
 protected:
  Allocation()
      : scene_(reference_scene()),
        mesh_(scene_.gear_set),
        contact_(scene_.lubricant, scene_.solid, scene_.roughness, scene_.boundary,
                 scene_.sump_temperature, scene_.inlet_temperature_rise, scene_.options),
        system_(mesh_, scene_.gear_set.dynamics, scene_.options) {
    OperatingCondition condition;
    condition.vehicle_speed = GetParam() / 3.6;
    const PointResult point = solve_operating_point(scene_, condition, {});
    EXPECT_TRUE(point.settled);
    MarchState state{};
    system_.to_march(point.section_state, state.data());
    at_ = system_.at_section(state, {point.pinion_torque, point.wheel_torque});
    scales_ = march_scales(system_, at_.torques, point.mean_pinion_speed);
  }

  Scene scene_;
  MeshData mesh_;
  FlankContactModel contact_;
  GearPairSystem system_;
  ContactTally tally_;
  ContactSolver contacts_{contact_, tally_};
  MarchScales scales_{};
  SectionPoint at_;
};

// Direct calls: a new-expression whose result is not used may be optimised away.
TEST(AllocationCounter, Counts) {
  EXPECT_EQ(allocations_of([] { ::operator delete(::operator new(16)); }), 1);
  EXPECT_EQ(allocations_of([] { ::operator delete[](::operator new[](1000)); }), 1);
  constexpr std::align_val_t kWide{64};
  EXPECT_EQ(allocations_of([] { ::operator delete(::operator new(64, kWide), kWide); }), 1);
  EXPECT_EQ(allocations_of([] {}), 0);
}

TEST_P(Allocation, NoneInTheRightHandSide) {
  Instant at;
  MarchState rate;
  const auto right_hand_side = [&] {
    for (int i = 0; i < 50; ++i) {
      system_.evaluate((i + 0.3) / mesh_.intervals(), i, at_.regime, at_.state.data(), contacts_,
                       at);
      system_.derivative(at_.state.data(), at, at_.torques, rate.data());
    }
  };
  right_hand_side();  // quadrature rules and the asperity table are made at the first call
  const long contacts = tally_.solutions;
  EXPECT_EQ(allocations_of(right_hand_side), 0);
  EXPECT_GT(tally_.solutions, contacts);
}

TEST_P(Allocation, NoneInAMeshCycle) {
  SolverWork work;
  const MarchOptions options;
  march_mesh_cycle(system_, scales_, options, contacts_, at_, work);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(
        allocations_of([&] { march_mesh_cycle(system_, scales_, options, contacts_, at_, work); }),
        0);
  }
  EXPECT_EQ(work.events > 0, GetParam() < 80);
}

TEST_P(Allocation, NoneInARefusedContact) {
  ContactConditions impossible{2000, -0.015, 0.3, 5, 6, 4, -1};
  EXPECT_EQ(allocations_of([&] { contact_.solve(impossible); }), 0);
}

TEST(BatchAllocation, NoneInASolve) {
  const Scene scene = reference_scene();
  std::vector<ContactConditions> conditions = realistic_contacts(scene, 100, 30).conditions;
  conditions[7].radius_x = -1;  // goes to the scalar kernel
  conditions[9].load = 0;
  ContactArrays arrays(conditions, scene.solid, scene.options);
  for (const InstructionSet set : supported_instruction_sets()) {
    const FlankContactBatch batch(contact_model(scene), set);
    EXPECT_EQ(allocations_of([&] { EXPECT_EQ(arrays.solve(batch), 1u); }), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(SmoothAndVibroImpact, Allocation, testing::Values(100.0, 72.5));

}  // namespace
}  // namespace tribodyn
