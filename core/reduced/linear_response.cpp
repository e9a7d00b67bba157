#include "core/reduced/linear_response.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/numerics/square.h"

namespace tribodyn {
namespace {

using Complex = std::complex<double>;

Complex inverse(const Complex& z) { return std::conj(z) / std::norm(z); }

/// The harmonics 1 ... count of signals at even phases, there and back.
class Harmonics {
 public:
  Harmonics(int phases, int count) : cosine_(phases, count), sine_(phases, count) {
    Eigen::ArrayX2d turn(phases, 2);
    for (int n = 0; n < phases; ++n) {
      const double angle = 2 * std::numbers::pi * n / phases;
      turn(n, 0) = std::cos(angle);
      turn(n, 1) = std::sin(angle);
    }
    for (int h = 0; h < count; ++h) {
      for (int n = 0, at = 0; n < phases; ++n) {
        cosine_(n, h) = turn(at, 0);
        sine_(n, h) = turn(at, 1);
        at += h + 1;
        if (at >= phases) at -= phases;
      }
    }
  }
  int count() const { return static_cast<int>(cosine_.cols()); }

  /// Element h - 1: of harmonic h.
  std::vector<Complex> of(const std::vector<double>& signal) const {
    const Eigen::Map<const Eigen::VectorXd> values(signal.data(), cosine_.rows());
    const double scale = 2.0 / static_cast<double>(cosine_.rows());
    const Eigen::VectorXd real = cosine_.transpose() * values;
    const Eigen::VectorXd imaginary = sine_.transpose() * values;
    std::vector<Complex> out(count());
    for (int h = 0; h < count(); ++h) out[h] = {scale * real(h), -scale * imaginary(h)};
    return out;
  }

  std::vector<double> signal(const std::vector<Complex>& amplitudes) const {
    Eigen::VectorXd real(count()), imaginary(count());
    for (int h = 0; h < count(); ++h) {
      real(h) = amplitudes[h].real();
      imaginary(h) = amplitudes[h].imag();
    }
    std::vector<double> out(cosine_.rows());
    Eigen::Map<Eigen::VectorXd>(out.data(), cosine_.rows()) = cosine_ * real - sine_ * imaginary;
    return out;
  }

 private:
  Eigen::MatrixXd cosine_, sine_;  // of h theta, a column a harmonic
};

/// The two sides of the mesh at one frequency [rad/s].
struct MeshSides {
  Complex per_pinion, per_gear;  ///< 1 / D_p, 1 / D_g [1/(N m)]
  Complex shaft_share;           ///< phi_s over phi_p
  Complex compliance;            ///< Y [m/N]
  Complex mesh;                  ///< k + i Omega c [N/m]
  Complex damper;                ///< i Omega c

  MeshSides(const GearPairSystem& system, double frequency) {
    const DrivelineDynamics& d = system.dynamics();
    const double f2 = square(frequency);
    const Complex pinion_shaft{d.pinion_shaft_stiffness, frequency * d.pinion_shaft_damping};
    const Complex gear_shaft{d.gear_shaft_stiffness, frequency * d.gear_shaft_damping};
    shaft_share = pinion_shaft * inverse(pinion_shaft - f2 * d.pinion_shaft_inertia);
    per_pinion = inverse(-f2 * (d.pinion_inertia + d.pinion_shaft_inertia * shaft_share));
    const Complex wheel_share = gear_shaft * inverse(gear_shaft - f2 * d.wheel_inertia);
    per_gear = inverse(-f2 * (d.gear_inertia + d.wheel_inertia * wheel_share));
    compliance = square(system.mesh().mean_pinion_contact_radius()) * per_pinion +
                 square(system.mesh().mean_gear_contact_radius()) * per_gear;
    damper = {0, frequency * d.mesh_damping};
    mesh = system.mesh().mean_mesh_stiffness() + damper;
  }
  /// How much of a displacement at the mesh becomes deflection.
  Complex amplification() const { return inverse(1.0 + compliance * mesh); }
};

/// The c for which c / h^2 covers the highest quarter of the harmonics h.
double edge_of(const std::vector<Complex>& v) {
  const int count = static_cast<int>(v.size());
  double edge = 0;
  for (int h = count - count / 4; h <= count; ++h) {
    edge = std::max(edge, std::abs(v[h - 1]) * square(h));
  }
  return edge;
}

double length_of(const std::vector<Complex>& v) {
  double sum = 0;
  for (const Complex& c : v) sum += std::norm(c);
  return std::sqrt(sum);
}

/// What the mesh makes of displacements between its sides.
struct MeshResponse {
  std::vector<Complex> correction;  ///< of x
  std::vector<Complex> ripple;      ///< of the force that the ripple of the stiffness adds
  double growth = 0;                ///< as of InertialCorrection
};

/// The ripple of the stiffness is added `rounds` times, each time to what it made of the last.
MeshResponse mesh_response(const GearPairSystem& system, const Harmonics& harmonics,
                           const std::vector<MeshSides>& at, const std::vector<Complex>& source,
                           const std::vector<double>& stiffness, int rounds) {
  const int count = harmonics.count();
  MeshResponse out;
  std::vector<Complex> amplification(count), plain(count), more(count);
  for (int h = 0; h < count; ++h) {
    amplification[h] = at[h].amplification();
    plain[h] = amplification[h] * source[h];
  }
  out.correction = plain;
  const double length = length_of(plain);
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> force = harmonics.signal(out.correction);
    for (std::size_t n = 0; n < force.size(); ++n) {
      force[n] = (stiffness[n] - system.mesh().mean_mesh_stiffness()) * force[n];
    }
    out.ripple = harmonics.of(force);
    for (int h = 0; h < count; ++h) {
      more[h] = -amplification[h] * at[h].compliance * out.ripple[h];
      out.correction[h] = plain[h] + more[h];
    }
    if (round == 0) out.growth = length > 0 ? length_of(more) / length : 0;
  }
  return out;
}

/// The mean force is that of the torques. Returns the largest |of x| that is left.
double keep_mean_force(const GearPairSystem& system, const std::vector<double>& stiffness,
                       std::vector<double>& transmission_error) {
  const int phases = static_cast<int>(transmission_error.size());
  double mean_force = 0, largest = 0;
  for (int n = 0; n < phases; ++n) mean_force += stiffness[n] * transmission_error[n] / phases;
  for (double& x : transmission_error) {
    x -= mean_force / system.mesh().mean_mesh_stiffness();
    largest = std::max(largest, std::abs(x));
  }
  return largest;
}

}  // namespace

void ImposedMotion::resize(std::size_t count) {
  for (auto* v : {&mesh_approach, &transmission_error, &gear_torque, &mesh_stiffness})
    v->resize(count);
}

InertialCorrection inertial_correction(const GearPairSystem& system, double mean_pinion_speed,
                                       const ImposedMotion& motion) {
  const int phases = static_cast<int>(motion.mesh_approach.size());
  const Harmonics harmonics(phases, std::min(phases / 2 - 1, kMostCorrectedHarmonics));
  const int count = harmonics.count();
  const double first = mean_pinion_speed * system.mesh().pinion_teeth();
  const double pinion_radius = system.mesh().mean_pinion_contact_radius();
  const double gear_radius = system.mesh().mean_gear_contact_radius();

  const std::vector<Complex> approach = harmonics.of(motion.mesh_approach);
  const std::vector<Complex> error = harmonics.of(motion.transmission_error);
  const std::vector<Complex> gear_torque = harmonics.of(motion.gear_torque);
  std::vector<Complex> pinion_torque(count);
  if (!motion.pinion_torque.empty()) pinion_torque = harmonics.of(motion.pinion_torque);

  std::vector<MeshSides> at;
  std::vector<Complex> source(count);
  at.reserve(count);
  for (int h = 1; h <= count; ++h) {
    const MeshSides& here = at.emplace_back(system, first * h);
    source[h - 1] = -approach[h - 1] - here.compliance * here.damper * error[h - 1] +
                    pinion_radius * pinion_torque[h - 1] * here.per_pinion -
                    gear_radius * gear_torque[h - 1] * here.per_gear;
  }
  const MeshResponse response =
      mesh_response(system, harmonics, at, source, motion.mesh_stiffness, 1);

  InertialCorrection out;
  const std::vector<Complex>&correction = response.correction, &ripple = response.ripple;
  std::vector<Complex> velocity(count), pinion(count), shaft(count);
  for (int h = 0; h < count; ++h) {
    const Complex rate = Complex{0, first * (h + 1)};
    const Complex whole_force = at[h].mesh * correction[h] + at[h].damper * error[h] + ripple[h];
    const Complex angle = (pinion_torque[h] - pinion_radius * whole_force) * at[h].per_pinion;
    velocity[h] = rate * (correction[h] + error[h]);
    pinion[h] = rate * angle;
    shaft[h] = pinion[h] * at[h].shaft_share;
  }
  out.growth = response.growth;
  out.transmission_error = harmonics.signal(correction);
  out.transmission_velocity = harmonics.signal(velocity);
  out.pinion_speed = harmonics.signal(pinion);
  out.pinion_shaft_speed = harmonics.signal(shaft);
  out.largest = keep_mean_force(system, motion.mesh_stiffness, out.transmission_error);

  // Beyond the highest harmonic the imposed motion falls as kinks make it, and the response to each
  // is known.
  const double asked_approach = edge_of(approach), asked_torque = edge_of(gear_torque),
               asked_pinion_torque = edge_of(pinion_torque);
  // Up to 1.5 times the frequency of the mesh, beyond which it hardly answers: with 1 the median of
  // estimate over error of the quasi-static scenes of core/README.md is 2.06 in place of 2.13, with
  // 3 it is the same.
  const int last = static_cast<int>(std::min(1.5 * system.mesh_frequency() / first, 1e4));
  for (int h = count + 1; h <= last && motion.tail; ++h) {
    const MeshSides here(system, first * h);
    const double asked = asked_approach +
                         pinion_radius * asked_pinion_torque * std::abs(here.per_pinion) +
                         gear_radius * asked_torque * std::abs(here.per_gear);
    out.unresolved += asked * square(1.0 / h) * std::abs(here.amplification());
  }
  return out;
}

bool parametric_resonance_possible(const GearPairSystem& system, double mean_pinion_speed,
                                   const std::vector<double>& stiffness) {
  const int phases = static_cast<int>(stiffness.size());
  const Harmonics harmonics(phases, std::min(phases / 2 - 1, kMostCorrectedHarmonics));
  const std::vector<Complex> ripple = harmonics.of(stiffness);
  const double natural = system.mesh_frequency();
  const double mean = system.mesh().mean_mesh_stiffness();
  const double damping = 0.5 * system.dynamics().mesh_damping * natural / mean;  // of critical
  for (int h = 1; h <= harmonics.count(); ++h) {
    const double size = std::abs(ripple[h - 1]) / mean;
    // Half of the ripple that it takes, twice the width, and 0.03 more: guesses that no test has
    // contradicted. With 1 and 4 in place of 2, 0 in place of 0.03 and 0.25 in place of 0.5 the
    // same of the quasi-static scenes of core/README.md take the quasi-static model at 1e-2.
    if (size < 2 * damping) continue;
    const double detuning =
        std::abs(0.5 * h * mean_pinion_speed * system.mesh().pinion_teeth() / natural - 1);
    if (detuning < 0.03 + 0.5 * size) return true;
  }
  return false;
}

}  // namespace tribodyn
