#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/contact/solved_contacts.h"
#include "core/driveline/frozen_friction.h"
#include "core/driveline/gear_pair_system.h"
#include "core/integrate/mesh_grid.h"
#include "core/integrate/orbit_piece.h"
#include "core/integrate/step_block.h"

namespace tribodyn {

/// Everything at the starts, middles and ends of an orbit's pieces. A piece that continues the one
/// before shares its end.
struct SolvedPieces {
  std::vector<Instant> instants;
  std::vector<int> first;  ///< instant of each piece
  std::span<const Instant, 3> of(std::size_t piece) const {
    return std::span<const Instant, 3>(instants.data() + first[piece], 3);
  }
  bool goes_on(std::size_t piece) const { return piece > 0 && first[piece] < first[piece - 1] + 3; }
};

/// `grid`: that of the pieces' nodes; `contacts`: all contacts of the pieces, which `model`
/// completes.
SolvedPieces solved_pieces(const GearPairSystem& system, const MeshGrid& grid,
                           const std::vector<OrbitPiece>& pieces, const SolvedContacts& contacts,
                           const FlankContactModel& model);

/// The scalar outputs of an orbit whose changes measure the error of grids and of the Picard
/// iteration.
struct OrbitFigures {
  /// Of sum V_s F_fr / GearPairSystem::input_speed() [N m]: eq 30 but for the torque
  double loss_rms = 0;
  double loss_energy = 0;  ///< sum V_s F_fr over the period [J]
  double dte_minimum = 0;  ///< x [m]
  double dte_maximum = 0;
  double torque = 0;  ///< the unknown one [N m]
  /// The largest relative difference; of the extremes of x over the larger one's modulus.
  double distance(const OrbitFigures& other) const;
};

/// Relative; ten times the largest error of FlankContactBatch with half of the digits.
inline constexpr double kHalfDigitsTolerance = 3e-4;

/// Evaluates friction on a whole orbit: all its contacts are solved together.
class OrbitFriction {
 public:
  /// Keeps the references. `tolerance`: of the orbit's figures, relative; from
  /// kHalfDigitsTolerance on contacts are solved with half of the digits. With a `coefficient`
  /// friction is Coulomb's, and no contact is solved.
  OrbitFriction(const GearPairSystem& system, const FlankContactBatch& contacts,
                ContactTally& tally, double tolerance,
                std::optional<double> coefficient = std::nullopt);

  /// Evaluates friction on the pieces of an orbit, and all figures but the torque. Where the load
  /// is below `light` [N], the friction arms are held constant. `grid`: that of the pieces' nodes.
  /// Returns false if a contact has been refused; the tally has the reason.
  bool evaluate(const MeshGrid& grid, const std::vector<OrbitPiece>& pieces, const Torques& torques,
                double light, FrozenFriction& friction, OrbitFigures& figures);
  /// The same on a completed cycle whose flanks are in compression all the time. `contacts`: those
  /// of the block's grid at which friction is evaluated.
  bool evaluate(const StepBlock& block, const GridContacts& contacts, const CycleResponse& response,
                FrozenFriction& friction, OrbitFigures& figures);
  /// The smallest compression of touching flanks at the instants of the last evaluation [N];
  /// negative: tension.
  double least_pressing_force() const { return least_pressing_force_; }
  InstructionSet instruction_set() const { return contacts_.instruction_set(); }
  /// Hands over the contacts of the last evaluation.
  std::shared_ptr<const SolvedContacts> take_contacts() {
    return std::exchange(solved_, std::make_shared<SolvedContacts>());
  }

 private:
  struct Sample {
    double mesh_force, transmission_error, transmission_velocity;
    double load;
    int first, count;  // contacts
  };
  /// Returns the number of contacts.
  int gather(const MeshGrid& grid, const std::vector<OrbitPiece>& pieces);
  /// Solves the contacts of `gathered_`. Returns false if one is refused.
  bool solve_contacts(const ContactGeometries& geometries, int count);

  const GearPairSystem& system_;
  const FlankContactBatch& contacts_;
  ContactTally& tally_;
  const Digits digits_;
  const std::optional<double> coefficient_;
  ContactGeometries geometries_;
  std::vector<int> first_;       // sample of each piece
  std::vector<Sample> samples_;  // shared as the instants of SolvedPieces
  Columns gathered_;             // GatheredRow
  std::shared_ptr<SolvedContacts> solved_ = std::make_shared<SolvedContacts>();
  std::vector<ContactStatus> status_;
  double least_pressing_force_ = 0;
};

}  // namespace tribodyn
