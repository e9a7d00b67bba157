#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include "core/dynamics/mesh_cycle_march.h"
#include "core/study/operating_point.h"
#include "tests/support/reference_scene.h"

// Every allocation of this executable passes through here and is counted.
namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded > 0 ? rounded : alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

constexpr std::size_t kPlain = alignof(std::max_align_t);
}  // namespace

void* operator new(std::size_t size) { return counted(size, kPlain); }
void* operator new[](std::size_t size) { return counted(size, kPlain); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace tribodyn {
namespace {

template <class Work>
long allocations_of(Work&& work) {
  const long before = allocations;
  work();
  return allocations - before;
}

/// Marches a settled point on, at a smooth speed (0) and in vibro-impact (1).
class Allocation : public testing::TestWithParam<double> {
 protected:
  Allocation()
      : scene_(reference_scene()),
        mesh_(scene_.gear_set),
        contact_(scene_.lubricant, scene_.solid, scene_.roughness, scene_.boundary,
                 scene_.sump_temperature, scene_.inlet_temperature_rise, scene_.options),
        system_(mesh_, contact_, scene_.gear_set.dynamics, scene_.options) {
    OperatingCondition condition;
    condition.vehicle_speed = GetParam() / 3.6;
    const PointResult point = solve_operating_point(scene_, condition, {});
    EXPECT_TRUE(point.settled);
    system_.set_torques({point.pinion_torque, point.wheel_torque});
    system_.to_march(point.section_state, state_.data());
    system_.regime = system_.regime_of(0, state_.data());
    scales_ = march_scales(system_, point.mean_pinion_speed);
  }

  Scene scene_;
  MeshData mesh_;
  FlankContactModel contact_;
  GearPairSystem system_;
  MarchScales scales_{};
  MarchState state_{};
};

TEST(AllocationCounter, Counts) {
  EXPECT_EQ(allocations_of([] { delete new int(1); }), 1);
  EXPECT_GE(allocations_of([] { std::vector<double> v(1000); }), 1);
  EXPECT_EQ(allocations_of([] {}), 0);
}

TEST_P(Allocation, NoneInTheRightHandSide) {
  Instant at;
  MarchState rate;
  const auto right_hand_side = [&] {
    for (int i = 0; i < 50; ++i) {
      system_.set_interval(i);
      system_.evaluate((i + 0.3) / mesh_.intervals(), state_.data(), at);
      system_.derivative(state_.data(), at, false, rate.data());
    }
  };
  right_hand_side();  // quadrature rules and the asperity table are made at the first call
  const long contacts = system_.contact_solutions();
  EXPECT_EQ(allocations_of(right_hand_side), 0);
  EXPECT_GT(system_.contact_solutions(), contacts);
}

TEST_P(Allocation, NoneInAMeshCycle) {
  MarchStatistics statistics;
  const MarchOptions options;
  march_mesh_cycle(system_, scales_, options, state_, statistics);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(
        allocations_of([&] { march_mesh_cycle(system_, scales_, options, state_, statistics); }),
        0);
  }
  EXPECT_EQ(statistics.events > 0, GetParam() < 80);
}

TEST_P(Allocation, NoneInARefusedContact) {
  ContactConditions impossible{2000, -0.015, 0.3, 5, 6, 4, -1};
  EXPECT_EQ(allocations_of([&] { contact_.solve(impossible); }), 0);
}

INSTANTIATE_TEST_SUITE_P(SmoothAndVibroImpact, Allocation, testing::Values(100.0, 72.5));

}  // namespace
}  // namespace tribodyn
