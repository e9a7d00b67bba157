#include "core/periodic/leading_multiplier.h"

#include <Eigen/Eigenvalues>
#include <complex>

namespace tribodyn {

LeadingMultiplier leading_multiplier(const Eigen::Matrix<double, 7, 7>& monodromy) {
  Eigen::Matrix<std::complex<double>, 7, 1> multipliers =
      Eigen::EigenSolver<Eigen::Matrix<double, 7, 7>>(monodromy, false).eigenvalues();
  Eigen::Index free = 0, largest = 0;
  (multipliers.array() - 1.0).abs().minCoeff(&free);
  multipliers(free) = 0;
  const double modulus = multipliers.cwiseAbs().maxCoeff(&largest);
  return {modulus, multipliers(largest).real() < 0, (multipliers.array() + 1.0).abs().minCoeff(),
          (multipliers.array() - 1.0).abs().minCoeff()};
}

}  // namespace tribodyn
