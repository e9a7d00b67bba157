#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/commands/rig_machine.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// Flags of `screen --rig`, which runs candidates on a rig in place of the axle.
struct ScreenRigFlags {
  std::string machine;  ///< "traction", "film" or "stribeck"; empty: the axle
  RigSettings given;    ///< empty lists: those of the machine
  std::optional<double> radius_x, radius_y, roughness;
  std::string disc;
  std::vector<v1::CandidateObjective> objectives;  ///< --least and --most; at most one is allowed

  /// Returns each flag that describes the rig, and whether it is given.
  std::vector<std::pair<const char*, bool>> stated() const;
};

void add_screen_rig_flags(FlagList& list, ScreenRigFlags& flags);
void check_screen_rig_flags(const ScreenRigFlags& flags, Complaints& complaints);

/// Returns the base at the conditions of the rig. `request` has the model options, and the
/// lubricant and the surface as typed: "surfaces/smooth" is none, and an empty one that of the
/// machine.
v1::EvaluateRigRequest rig_of_screen(const ScreenRigFlags& flags,
                                     const v1::EvaluatePointsRequest& request);

/// Makes a campaign one of this rig.
void set_rig(const v1::EvaluateRigRequest& rig, v1::Campaign& campaign);

/// Returns what a rig campaign is ranked by if no flag says: for films the thickest one, else the
/// least traction.
v1::CandidateObjective usual_objective(const v1::Campaign& campaign);

/// Calls `write` with each row of a rig campaign: the header first, then a row for each candidate
/// at each condition, as texts.
void read_rig_rows(Connection& connection, const v1::Campaign& campaign,
                   const std::function<void(const std::vector<std::string>&)>& write);

}  // namespace tribodyn::client
