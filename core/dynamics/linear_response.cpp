#include "core/dynamics/linear_response.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace tribodyn {
namespace {

using Complex = std::complex<double>;

constexpr int kMostHarmonics = 96;

double square(double v) { return v * v; }

/// The harmonics 1 ... count of signals at even phases, there and back.
class Harmonics {
 public:
  Harmonics(int phases, int count) : phases_(phases), count_(count), turns_(phases) {
    for (int n = 0; n < phases; ++n) {
      const double angle = 2 * std::numbers::pi * n / phases;
      turns_[n] = {std::cos(angle), std::sin(angle)};
    }
  }
  int count() const { return count_; }

  /// Element h - 1: of harmonic h.
  std::vector<Complex> of(const std::vector<double>& signal) const {
    std::vector<Complex> out(count_);
    for (int h = 1; h <= count_; ++h) {
      double real = 0, imaginary = 0;
      int turn = 0;
      for (int n = 0; n < phases_; ++n) {
        real += signal[n] * turns_[turn].real();
        imaginary -= signal[n] * turns_[turn].imag();
        turn += h;
        if (turn >= phases_) turn -= phases_;
      }
      out[h - 1] = Complex{real, imaginary} * (2.0 / phases_);
    }
    return out;
  }

  std::vector<double> signal(const std::vector<Complex>& amplitudes) const {
    std::vector<double> out(phases_, 0.0);
    for (int h = 1; h <= count_; ++h) {
      const double real = amplitudes[h - 1].real(), imaginary = amplitudes[h - 1].imag();
      int turn = 0;
      for (int n = 0; n < phases_; ++n) {
        out[n] += real * turns_[turn].real() - imaginary * turns_[turn].imag();
        turn += h;
        if (turn >= phases_) turn -= phases_;
      }
    }
    return out;
  }

 private:
  int phases_, count_;
  std::vector<Complex> turns_;
};

/// The two sides of the mesh at one frequency [rad/s].
struct Driveline {
  Complex pinion, gear;  ///< dynamic stiffnesses D_p, D_g [N m]
  Complex shaft_share;   ///< phi_s over phi_p
  Complex compliance;    ///< Y [m/N]
  Complex mesh;          ///< k + i Omega c [N/m]
  Complex damper;        ///< i Omega c

  Driveline(const GearPairSystem& system, double frequency) {
    const DrivelineDynamics& d = system.dynamics();
    const Complex i{0, 1};
    const double f2 = square(frequency);
    const Complex pinion_shaft = d.pinion_shaft_stiffness + i * frequency * d.pinion_shaft_damping;
    const Complex gear_shaft = d.gear_shaft_stiffness + i * frequency * d.gear_shaft_damping;
    shaft_share = pinion_shaft / (pinion_shaft - f2 * d.pinion_shaft_inertia);
    pinion = -f2 * (d.pinion_inertia + d.pinion_shaft_inertia * shaft_share);
    gear = -f2 * (d.gear_inertia +
                  d.wheel_inertia * gear_shaft / (gear_shaft - f2 * d.wheel_inertia));
    compliance = square(system.mesh().mean_pinion_contact_radius()) / pinion +
                 square(system.mesh().mean_gear_contact_radius()) / gear;
    damper = i * frequency * d.mesh_damping;
    mesh = system.mesh().mean_mesh_stiffness() + damper;
  }
  /// How much of a displacement at the mesh becomes deflection.
  Complex amplification() const { return 1.0 / (1.0 + compliance * mesh); }
};

/// Of the mesh on its mean stiffness, held by nothing but its rotors [rad/s].
double mesh_frequency(const GearPairSystem& system) {
  const DrivelineDynamics& d = system.dynamics();
  return std::sqrt(system.mesh().mean_mesh_stiffness() *
                   (square(system.mesh().mean_pinion_contact_radius()) / d.pinion_inertia +
                    square(system.mesh().mean_gear_contact_radius()) / d.gear_inertia));
}

double length_of(const std::vector<Complex>& v) {
  double sum = 0;
  for (const Complex& c : v) sum += std::norm(c);
  return std::sqrt(sum);
}

}  // namespace

void ImposedMotion::resize(std::size_t count) {
  for (auto* v : {&winding, &transmission_error, &gear_torque, &mesh_stiffness}) v->resize(count);
}

InertialCorrection inertial_correction(const GearPairSystem& system, double mean_pinion_speed,
                                       const ImposedMotion& motion) {
  const int phases = static_cast<int>(motion.winding.size());
  const Harmonics harmonics(phases, std::min(phases / 2 - 1, kMostHarmonics));
  const int count = harmonics.count();
  const double first = mean_pinion_speed * system.mesh().pinion_teeth();
  const double pinion_radius = system.mesh().mean_pinion_contact_radius();
  const double gear_radius = system.mesh().mean_gear_contact_radius();
  const Complex i{0, 1};

  const std::vector<Complex> winding = harmonics.of(motion.winding);
  const std::vector<Complex> error = harmonics.of(motion.transmission_error);
  const std::vector<Complex> gear_torque = harmonics.of(motion.gear_torque);
  std::vector<Complex> pinion_torque(count);
  if (!motion.pinion_torque.empty()) pinion_torque = harmonics.of(motion.pinion_torque);

  std::vector<Complex> correction(count), velocity(count), pinion(count), shaft(count);
  std::vector<Complex> answer(count);  // of x to a force at the mesh
  double edge = 0;                     // sources of the highest harmonics, as if they were the last
  const int highest = count - count / 4;
  for (int h = 1; h <= count; ++h) {
    const double frequency = first * h;
    const Driveline at(system, frequency);
    const Complex amplification = at.amplification();
    const Complex source = -winding[h - 1] - at.compliance * at.damper * error[h - 1] +
                           pinion_radius * pinion_torque[h - 1] / at.pinion -
                           gear_radius * gear_torque[h - 1] / at.gear;
    const Complex dx = amplification * source;
    const Complex force = at.mesh * dx + at.damper * error[h - 1];
    const Complex angle = (pinion_torque[h - 1] - pinion_radius * force) / at.pinion;
    correction[h - 1] = dx;
    velocity[h - 1] = i * frequency * (dx + error[h - 1]);
    pinion[h - 1] = i * frequency * angle;
    shaft[h - 1] = i * frequency * angle * at.shaft_share;
    answer[h - 1] = -at.compliance * amplification;
    if (h > highest) edge = std::max(edge, std::abs(source) * square(static_cast<double>(h) / count));
  }

  InertialCorrection out;
  out.transmission_error = harmonics.signal(correction);
  out.transmission_velocity = harmonics.signal(velocity);
  out.pinion_speed = harmonics.signal(pinion);
  out.pinion_shaft_speed = harmonics.signal(shaft);
  for (const double dx : out.transmission_error) out.largest = std::max(out.largest, std::abs(dx));

  // What the stiffness that is not the mean makes of it.
  std::vector<double> force(phases);
  for (int n = 0; n < phases; ++n) {
    force[n] = (motion.mesh_stiffness[n] - system.mesh().mean_mesh_stiffness()) *
               out.transmission_error[n];
  }
  std::vector<Complex> next = harmonics.of(force);
  for (int h = 0; h < count; ++h) next[h] *= answer[h];
  const double length = length_of(correction);
  out.growth = length > 0 ? length_of(next) / length : 0;

  const int last = static_cast<int>(std::min(1.5 * mesh_frequency(system) / first, 1e4));
  for (int h = count + 1; h <= last; ++h) {
    const double source = edge * square(static_cast<double>(count) / h);
    out.unresolved += source * std::abs(Driveline(system, first * h).amplification());
  }
  return out;
}

bool parametric_resonance_possible(const GearPairSystem& system, double mean_pinion_speed,
                                   const std::vector<double>& stiffness) {
  const int phases = static_cast<int>(stiffness.size());
  const Harmonics harmonics(phases, std::min(phases / 2 - 1, kMostHarmonics));
  const std::vector<Complex> ripple = harmonics.of(stiffness);
  const double natural = mesh_frequency(system);
  const double mean = system.mesh().mean_mesh_stiffness();
  const double damping = 0.5 * system.dynamics().mesh_damping * natural / mean;  // of critical
  for (int h = 1; h <= harmonics.count(); ++h) {
    const double size = std::abs(ripple[h - 1]) / mean;
    if (size < 2 * damping) continue;  // it takes 4
    const double detuning =
        std::abs(0.5 * h * mean_pinion_speed * system.mesh().pinion_teeth() / natural - 1);
    if (detuning < 0.03 + 0.5 * size) return true;
  }
  return false;
}

}  // namespace tribodyn
