#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/contact/flank_contact_batch.h"
#include "core/dynamics/gear_pair_system.h"
#include "core/dynamics/lagged_friction.h"
#include "core/dynamics/mesh_grid.h"
#include "core/dynamics/step_block.h"

namespace tribodyn {

/// A smooth piece of a response: one step, or the part of one up to or from an event. States at
/// its start, middle and end; the middle by the cubic through both ends.
struct OrbitPiece {
  double phase;   ///< of its start [cycles], counted through the whole period
  double length;  ///< [cycles]
  int node;       ///< of the grid at its start, where it is a whole step; or -1
  ContactRegime regime;
  MarchState start, middle, end;
};

/// The state at part 0, 1, 2 of a piece: its start, middle, end.
inline const MarchState& state_of(const OrbitPiece& piece, int part) {
  return part == 0 ? piece.start : part == 1 ? piece.middle : piece.end;
}

/// The flank pairs at part 0, 1, 2 of a piece: its start, middle, end. `grid`: what the piece's
/// node is of; `off_grid` holds them where the piece has none.
const std::array<FlankKinematics, kFlankPairs>& flanks_of(
    const MeshData& mesh, const MeshGrid& grid, const OrbitPiece& piece, int part,
    std::array<FlankKinematics, kFlankPairs>& off_grid);

/// Figures of the contacts of a response, in the order of its instants and of their flank pairs.
class SolvedContacts {
 public:
  /// Nothing is kept: all figures are 0 at first.
  void resize(std::size_t count);
  /// Nothing is kept: figures mean nothing before a batch puts them there.
  void resize_for_overwrite(std::size_t count);
  /// Where a batch puts them, all but the status.
  FlankContactBatchResults results();
  const double* friction() const { return rows_[0]; }
  void copy(std::size_t i, ContactFigures& to) const;
  double film_load(std::size_t i) const;                               ///< W_EHL [N]
  bool by_reference(std::size_t i) const { return by_reference_[i]; }  ///< not by the vector code

 private:
  Columns rows_;
  std::unique_ptr<bool[]> limiting_stress_at_centre_, by_reference_;
  std::size_t size_ = 0;
};

/// Everything at the starts, middles and ends of a response's pieces. What goes on from the piece
/// before shares its end.
struct SolvedPieces {
  std::vector<Instant> instants;
  std::vector<int> first;  ///< instant of each piece
  std::span<const Instant, 3> of(std::size_t piece) const {
    return std::span<const Instant, 3>(instants.data() + first[piece], 3);
  }
  bool goes_on(std::size_t piece) const { return piece > 0 && first[piece] < first[piece - 1] + 3; }
};

/// `grid`: what the pieces' nodes are of; `contacts`: all of theirs. Changes the system's regime.
SolvedPieces solved_pieces(GearPairSystem& system, const MeshGrid& grid,
                           const std::vector<OrbitPiece>& pieces, const SolvedContacts& contacts);

/// Fills in the first instant of each of the pieces: where SolvedPieces has it, and the contacts of
/// SolvedContacts in the same order. Returns the number of instants.
int number_instants(const std::vector<OrbitPiece>& pieces, std::vector<int>& first);

/// What a sweep reports of a response: enough to tell how much an answer moved.
struct OrbitFigures {
  /// Of sum V_s F_fr / GearPairSystem::input_speed() [N m]: eq 30 but for the torque
  double loss_rms = 0;
  double loss_energy = 0;  ///< sum V_s F_fr over the period [J]
  double dte_minimum = 0;  ///< x [m]
  double dte_maximum = 0;
  double torque = 0;  ///< the unknown one [N m]
  /// Largest relative difference of any.
  double distance(const OrbitFigures& other) const;
};

/// The contacts of a whole response, solved together.
class OrbitFriction {
 public:
  /// Keeps the references. With a `coefficient` friction is Coulomb's, and no contact is solved.
  OrbitFriction(GearPairSystem& system, const FlankContactBatch& contacts,
                std::optional<double> coefficient = std::nullopt);

  /// Friction on the pieces of a response, not told per newton below `light` [N], and all of its
  /// figures but the torque. `grid`: what the pieces' nodes are of. False when a contact is
  /// refused; the system tells why.
  bool evaluate(const MeshGrid& grid, const std::vector<OrbitPiece>& pieces, double light,
                LaggedFriction& friction, OrbitFigures& figures);
  /// The same on a response, filled, whose flanks press together all the time. `contacts`: those of
  /// the block's grid at which friction is evaluated.
  bool evaluate(const StepBlock& block, const GridContacts& contacts, const CycleResponse& response,
                LaggedFriction& friction, OrbitFigures& figures);
  /// Smallest force that pressed touching flanks together at the instants of the last evaluation;
  /// negative: they were held together [N].
  double least_pressing_force() const { return least_pressing_force_; }
  InstructionSet instruction_set() const { return contacts_.instruction_set(); }
  /// The contacts of the last evaluation, to keep.
  std::shared_ptr<const SolvedContacts> take_contacts() {
    return std::exchange(solved_, std::make_shared<SolvedContacts>());
  }

 private:
  struct Place {
    double mesh_force, transmission_error, transmission_velocity;
    double load;
    int first, count;  // contacts
  };
  /// Returns the number of contacts.
  int gather(const MeshGrid& grid, const std::vector<OrbitPiece>& pieces);
  /// The contacts of `seen_`. False when one is refused.
  bool solve_contacts(const ContactGeometries& geometries, int count);

  GearPairSystem& system_;
  const FlankContactBatch& contacts_;
  const std::optional<double> coefficient_;
  ContactGeometries geometries_;
  std::vector<int> first_;     // place of each piece
  std::vector<Place> places_;  // shared as the instants of SolvedPieces
  Columns seen_;               // SeenRow
  std::shared_ptr<SolvedContacts> solved_ = std::make_shared<SolvedContacts>();
  std::vector<ContactStatus> status_;
  double least_pressing_force_ = 0;
};

}  // namespace tribodyn
