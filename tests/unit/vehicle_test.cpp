#include "core/vehicle/vehicle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/refusal.h"
#include "tests/support/reference_data.h"
#include "tests/support/refusal_reason.h"

namespace tribodyn {
namespace {

Vehicle reference_vehicle() {
  const nlohmann::json v = load_reference("reference_gear_set.json").at("vehicle");
  return {v.at("m_v"),     v.at("f_r"), v.at("c_a"), v.at("A_f"),
          v.at("rho_air"), v.at("r_w"), v.at("g")};
}

TEST(WheelTorque, IsTheSumOfItsPartsByHand) {
  const Vehicle vehicle{1000, 0.01, 0.5, 2, 1.2, 0.3, 10};
  EXPECT_NEAR(wheel_torque(vehicle, 0, 0, 0), 0.3 * 100, 1e-13);
  EXPECT_NEAR(wheel_torque(vehicle, 10, 0, 0), 0.3 * (100 + 60), 1e-13);
  EXPECT_NEAR(wheel_torque(vehicle, 0, std::numbers::pi / 2, 0), 0.3 * 10000, 1e-10);
  EXPECT_NEAR(wheel_torque(vehicle, 0, 0, 2), 0.3 * (100 + 2000), 1e-12);
  EXPECT_NEAR(wheel_torque(vehicle, 10, 0.1, -1),
              0.3 * (100 * std::cos(0.1) + 10000 * std::sin(0.1) + 60 - 1000), 1e-11);
}

TEST(WheelTorque, IsRefusedForAVehicleThatCannotBe) {
  Vehicle vehicle = reference_vehicle();
  vehicle.wheel_radius = 0;
  EXPECT_EQ(refusal_reason([&] { wheel_torque(vehicle, 20, 0, 0); }), "PARAMETER_OUT_OF_RANGE");
  vehicle = reference_vehicle();
  vehicle.air_density = std::nan("");
  EXPECT_EQ(refusal_reason([&] { wheel_torque(vehicle, 20, 0, 0); }), "PARAMETER_OUT_OF_RANGE");
}

TEST(WheelTorque, MatchesTheReferenceCruise) {
  // Pinion torque T_w N_p/N_g of the reference car on the level, to the digits it is quoted with.
  const Vehicle vehicle = reference_vehicle();
  const double at[][2] = {{20, 17.4}, {53, 25.0}, {65, 29.4}, {80, 36.3}, {100, 47.7}, {140, 77.9}};
  for (const auto& [kilometres_per_hour, pinion_torque] : at) {
    EXPECT_NEAR(wheel_torque(vehicle, kilometres_per_hour / 3.6, 0, 0) * 13 / 36, pinion_torque,
                0.051)
        << kilometres_per_hour;
  }
}

TEST(WheelTorque, SatisfiesItsSymmetries) {
  const Vehicle vehicle = reference_vehicle();
  const double level = wheel_torque(vehicle, 20, 0, 0);
  const double up = wheel_torque(vehicle, 20, 0.05, 0);
  const double down = wheel_torque(vehicle, 20, -0.05, 0);
  EXPECT_GT(up, level);
  EXPECT_LT(down, 0);  // the vehicle drives the axle
  const double weight = vehicle.mass * vehicle.gravity * vehicle.wheel_radius;
  EXPECT_NEAR(up - down, 2 * weight * std::sin(0.05), 1e-10);
  // drag alone grows with the square of the speed
  const double rest = wheel_torque(vehicle, 0, 0, 0);
  EXPECT_NEAR((wheel_torque(vehicle, 40, 0, 0) - rest) / (level - rest), 4, 1e-13);
}

TEST(WheelTorque, RefusesASpeedThatIsNotForward) {
  const Vehicle vehicle = reference_vehicle();
  EXPECT_THROW(wheel_torque(vehicle, -1, 0, 0), Refusal);
  EXPECT_THROW(wheel_torque(vehicle, std::nan(""), 0, 0), Refusal);
  EXPECT_THROW(wheel_torque(vehicle, INFINITY, 0, 0), Refusal);
  EXPECT_NO_THROW(wheel_torque(vehicle, 0, 0, 0));
}

}  // namespace
}  // namespace tribodyn
