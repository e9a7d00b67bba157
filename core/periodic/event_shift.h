#pragma once

#include <array>

#include "core/integrate/piece_adjoint.h"
#include "core/periodic/orbit_contacts.h"

namespace tribodyn {

/// Integrals over the period that figures are made of: those of the sums of ContactSum, then that
/// of the square of the loss over the speed at which the power comes in.
inline constexpr int kSquaredLoss = kContactSums;
inline constexpr int kIntegrals = kSquaredLoss + 1;

/// What a shift of the events at the ends of a piece does to the piece: its step and its integrals
/// become longer or shorter, and the error of a step depends on its length. Central differences
/// along the motion, which err by about 1e-6 (relative).
class EventShift {
 public:
  /// Keeps the references. Under `no_load` [N] contacts add nothing to the integrals.
  EventShift(const GearPairSystem& system, const MeshGrid& grid, const FlankContactBatch& batch,
             const PeriodicOrbit& orbit, FrozenFriction& friction, const OrbitContacts& contacts,
             double no_load);

  /// Prepares integrands_along() and off_motion_by() for a piece whose start or end, or both, move
  /// with an event. The slopes must stay as they are until the last of these calls. Returns false
  /// if a contact is refused.
  bool follow_motion(std::size_t piece, const PieceSlopes& slopes, bool start_moves,
                     bool end_moves);

  /// How the integrands over phase change with phase along the motion [per cycle], at the start,
  /// middle or end; 0 at a part that does not move or bears no load.
  using Integrands = std::array<double, kIntegrals>;
  const Integrands& integrands_along(int part) const { return along_[part].integrands; }

  /// Time and the seven states at the middle and the end of a piece, or changes of them.
  using Rates = std::array<double, 8>;
  struct MiddleAndEnd {
    Rates middle{}, end{};
  };
  /// Derivatives of the step's middle and end by the phase of its start (1, 0) or of its end
  /// (0, 1), less those of the motion.
  MiddleAndEnd off_motion_by(int of_start, int of_end);

  /// Slope over phase of the mesh force [N per cycle] at the start, middle or end of a piece, by
  /// the parabola through its values there.
  double force_slope(std::size_t piece, int part) const;

  bool has_load(const ContactsAt& at) const { return at.load > no_load_; }

 private:
  struct ChangeAlong {
    Integrands integrands{};
    FrictionArms arms;  ///< 0 where the arms are held
  };

  /// Of central differences [cycles]: a thousandth of a step of the grid. Not a share of the piece,
  /// which may be so short that rounding would decide.
  double small_step() const { return 1e-3 / grid_.steps(); }
  Integrands integrands(const MarchState& y, const Instant& at) const;
  MiddleAndEnd moved_piece(double start_shift, double end_shift);

  const GearPairSystem& system_;
  const MeshGrid& grid_;
  const FlankContactBatch& batch_;
  const PeriodicOrbit& orbit_;
  FrozenFriction& friction_;
  const OrbitContacts& contacts_;
  double no_load_;
  /// Of the piece at hand.
  const OrbitPiece* piece_ = nullptr;
  const PieceSlopes* slopes_ = nullptr;
  ChangeAlong along_[3];
};

}  // namespace tribodyn
