#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "server/simulation/campaign_columns.h"
#include "server/simulation/campaign_inputs.h"
#include "server/simulation/input_errors.h"
#include "server/simulation/prepared_gear_sets.h"

namespace tribodyn::server {

/// The candidates of a campaign, one at a time, on the axle or on a rig. Not safe for concurrent
/// access.
class CampaignScene {
 public:
  using GearSetPointer = std::shared_ptr<PreparedGearSet>;

  CampaignScene() = default;
  virtual ~CampaignScene() = default;
  CampaignScene(const CampaignScene&) = delete;
  CampaignScene& operator=(const CampaignScene&) = delete;

  /// Makes the scene that of a candidate, counted from 0.
  virtual void set_candidate(int candidate) = 0;
  /// Makes it that of any lubricant and surface.
  virtual void set_inputs(const UncertainInputs& inputs) = 0;
  /// Returns the number of groups of conditions.
  virtual std::size_t groups() const = 0;
  /// Computes the candidate at one group of conditions, and writes the rows to their positions in
  /// `out`. Throws Cancelled as soon as the campaign is not to go on; then the gear set may be half
  /// prepared.
  virtual void evaluate(std::size_t group, const GearSetPointer& gear_set,
                        std::vector<CampaignRow>& out) = 0;

  /// Returns the prepared gear set for evaluate(); null for a rig.
  virtual GearSetPointer take_gear_set(PreparedGearSets& gear_sets) const = 0;
  /// Stores what take_gear_set() has returned for the next study; null: nothing.
  virtual void give_back(PreparedGearSets& gear_sets, GearSetPointer gear_set) const = 0;
};

/// Returns the candidates of a campaign. `inputs` must outlive the object. `goes_on` is called at
/// least once for each row.
std::unique_ptr<CampaignScene> campaign_scene(const CampaignInputs& inputs,
                                              std::function<bool()> goes_on);

}  // namespace tribodyn::server
