#pragma once

#include <array>
#include <vector>

#include "core/contact/contact_sensitivity.h"
#include "core/integrate/piece_adjoint.h"
#include "core/periodic/orbit_friction.h"
#include "core/periodic/periodic_orbit.h"

namespace tribodyn {

/// Sums over the contacts of an instant whose integrals over time the figures are made of.
enum ContactSum { kLossSum, kFrictionTorqueSum, kLoadSum, kFilmRatioLoadSum, kTemperatureLoadSum };
inline constexpr int kContactSums = 5;

/// An instant of an orbit: the sums over its contacts, with derivatives by mesh force [N] and
/// speeds of pinion and gear [rad/s].
struct ContactsAt {
  double mesh_force, transmission_error, transmission_velocity;
  double load = 0;           ///< compression of the flanks [N]
  bool arms_follow = false;  ///< the friction arms follow the motion
  ArmSlopes arm[2]{};        ///< derivatives of the arms of pinion and gear
  double sum[kContactSums] = {};
  ArmSlopes sum_slopes[kContactSums]{};
  int first = 0, count = 0;  ///< contacts
};

/// The contacts of an orbit, differentiated by motion and, backwards, by parameters.
class OrbitContacts {
 public:
  /// Keeps the references. Under less than `light_load` [N] the friction arms are held.
  OrbitContacts(const GearPairSystem& system, const MeshGrid& grid, const FlankContactBatch& batch,
                const ContactSensitivityModel& model, const PeriodicOrbit& orbit,
                double light_load);

  /// Returns false if a contact has no derivatives.
  bool differentiate();
  /// Start, middle or end of a piece.
  const ContactsAt& at(std::size_t piece, int part) const {
    return instants_[first_[piece] + part];
  }
  bool one_sided() const { return one_sided_; }

  /// Groups of kAdjointLanes figures.
  static constexpr int kGroups = 2;
  /// Adds the effect of the friction arms of an instant on the figures of a group.
  void weigh_arms(const ContactsAt& at, int group, const std::array<AdjointRow, 2>& arm);
  /// Adds the effect of the sums of an instant on the figures of the last group: of each sum on the
  /// figure of its number, and of the loss also on figure `other`.
  void weigh_sums(const ContactsAt& at, double weight, int other, double loss_weight);
  /// Of the figures of each group, by the parameters.
  using ByParameters = Eigen::Matrix<double, kGroups * kAdjointLanes, kContactParameters>;
  ByParameters by_parameters() const;

 private:
  /// Of one contact: loads and velocities by motion, sliding speed and arms with derivatives by
  /// both speeds.
  struct Contact {
    double load, load_by_force;
    double velocity_by_speed[4][2];  // of ContactConditions, by pinion and gear
    double sliding_speed, arm[2];
    double sliding_speed_slopes[2], arm_slopes[2][2];
    double friction, film_ratio, temperature;
    int lane;  // in vectors_; or -1 - the place in of_scalar_kernel_
  };

  std::size_t most_contacts() const;
  bool add_contacts_at(const OrbitPiece& piece, int part, ContactsAt& out);
  void add_up(ContactsAt& at) const;
  /// d (an output)/d (mesh force, speeds).
  template <class ByCondition>
  static ArmSlopes by_motion(const Contact& contact, ByCondition&& by);

  const GearPairSystem& system_;
  const MeshGrid& grid_;
  const FlankContactBatch& batch_;
  const ContactSensitivityModel& model_;
  const PeriodicOrbit& orbit_;
  double light_load_;
  bool one_sided_ = false;
  std::vector<int> first_;  // instant of each piece
  std::vector<ContactsAt> instants_;
  std::vector<Contact> contacts_;
  DifferentiatedContacts vectors_;
  ContactGeometries off_grid_;
  std::vector<ContactSensitivity>
      of_scalar_kernel_;  // of contacts that the scalar kernel has solved
  std::array<std::vector<AdjointRow>, kGroups> friction_weight_;
  std::vector<double> film_ratio_weight_, temperature_weight_;
};

}  // namespace tribodyn
