#include "core/driveline/linear_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <complex>

namespace tribodyn {

std::array<LinearMode, 3> linear_modes(const GearPairSystem& system) {
  const DrivelineDynamics& d = system.dynamics();
  const Eigen::Vector4d inertia(d.pinion_shaft_inertia, d.pinion_inertia, d.gear_inertia,
                                d.wheel_inertia);
  // Three springs with dampers, and how far the rotors stretch each.
  Eigen::Matrix<double, 3, 4> stretch = Eigen::Matrix<double, 3, 4>::Zero();
  stretch.row(0) << 1, -1, 0, 0;
  stretch.row(1) << 0, system.mesh().mean_pinion_contact_radius(),
      -system.mesh().mean_gear_contact_radius(), 0;
  stretch.row(2) << 0, 0, 1, -1;
  const Eigen::Vector3d stiffness(d.pinion_shaft_stiffness, system.mesh().mean_mesh_stiffness(),
                                  d.gear_shaft_stiffness);
  const Eigen::Vector3d damping(d.pinion_shaft_damping, d.mesh_damping, d.gear_shaft_damping);
  // In place of angles and speeds of four rotors: three stretches and four speeds.
  Eigen::Matrix<double, 7, 7> motion = Eigen::Matrix<double, 7, 7>::Zero();
  motion.topRightCorner<3, 4>() = stretch;
  const Eigen::Matrix<double, 4, 3> pull =
      (-inertia.cwiseInverse()).asDiagonal() * stretch.transpose();
  motion.bottomLeftCorner<4, 3>() = pull * stiffness.asDiagonal();
  motion.bottomRightCorner<4, 4>() = pull * damping.asDiagonal() * stretch;

  const Eigen::Matrix<std::complex<double>, 7, 1> all =
      Eigen::EigenSolver<Eigen::Matrix<double, 7, 7>>(motion, false).eigenvalues();
  std::array<std::complex<double>, 7> roots;
  std::copy(all.data(), all.data() + 7, roots.begin());
  std::sort(roots.begin(), roots.end(),
            [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
  // The smallest is the rigid rotation; pairs follow, of a product that is the frequency's square.
  std::array<LinearMode, 3> out;
  for (int i = 0; i < 3; ++i) {
    const std::complex<double> one = roots[1 + 2 * i], other = roots[2 + 2 * i];
    out[i].frequency = std::sqrt(std::abs(one) * std::abs(other));
    out[i].damping = -0.5 * (one.real() + other.real()) / out[i].frequency;
  }
  return out;
}

}  // namespace tribodyn
