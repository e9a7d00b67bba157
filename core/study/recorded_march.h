#pragma once

#include "core/integrate/mesh_cycle_march.h"
#include "core/study/history_sampler.h"
#include "core/study/response_record.h"

namespace tribodyn {

/// What a march writes down, mesh cycle by mesh cycle; either may be null.
struct MarchRecorders {
  ResponseRecord* record = nullptr;
  HistorySampler* history = nullptr;  ///< as far as it wants samples
};

/// The number of instants of a step at which a record looks for extremes; integrals need none. Five
/// take a quarter more contacts than three.
enum class ExtremesPerStep { kOfFive, kOfThree };

/// Marches a response at constant torques and records it.
class RecordedMarch {
 public:
  /// Starts at a point of the section, where time and work are zero. Keeps the references.
  RecordedMarch(const GearPairSystem& system, ContactSolver& contacts, const MarchScales& scales,
                const MarchOptions& options, const SectionPoint& start, ExtremesPerStep extremes);

  /// Marches one mesh cycle more. The integrals of the record become those since the start. Adds to
  /// `work`. Throws as march_mesh_cycle does.
  void add_mesh_cycle(const MarchRecorders& recorders, SolverWork& work);

  /// The point reached; kTime and works are those since the start.
  SectionPoint point() const;

 private:
  using Phases = MeshCycleSystem<true>;

  const GearPairSystem& system_;
  ContactSolver& contacts_;
  const MarchScales& scales_;
  const MarchOptions& options_;
  ExtremesPerStep extremes_;
  Torques torques_;
  Phases::State state_{};
  ContactRegime regime_;
  int mesh_cycles_ = 0;
};

}  // namespace tribodyn
