#include "server/simulation/campaign_scene.h"

#include <optional>
#include <utility>

#include "core/refusal.h"
#include "server/mapping/to_core.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/study_checks.h"

namespace tribodyn::server {
namespace {

class AxleScene final : public CampaignScene {
 public:
  AxleScene(const PointEvaluation& points, std::function<bool()> goes_on)
      : points_(points),
        scene_(points, std::move(goes_on)),
        evaluated_(static_cast<std::size_t>(points.conditions)) {}

  void set_candidate(int candidate) override { scene_.set_candidate(candidate); }
  void set_inputs(const UncertainInputs& inputs) override {
    scene_.set_resources(inputs.lubricant, inputs.surface);
  }
  std::size_t groups() const override { return points_.groups.size(); }

  void evaluate(std::size_t group, const GearSetPointer& gear_set,
                std::vector<CampaignRow>& out) override {
    scene_.evaluate(points_.groups[group], gear_set, evaluated_);
    for (const auto& [position, condition] : points_.groups[group].conditions) {
      const auto at = static_cast<std::size_t>(position);
      out[at].set(points_, evaluated_[at]);
    }
  }

  GearSetPointer take_gear_set(PreparedGearSets& gear_sets) const override {
    return gear_sets.take(points_.base.gear_set, scene_.scene());
  }
  void give_back(PreparedGearSets& gear_sets, GearSetPointer gear_set) const override {
    if (gear_set) {
      gear_sets.give_back(points_.base.gear_set, scene_.scene().options, std::move(gear_set));
    }
  }

 private:
  const PointEvaluation& points_;
  CandidateScene scene_;
  std::vector<EvaluatedPoint> evaluated_;  // by condition
};

class CandidateRig final : public CampaignScene {
 public:
  CandidateRig(const CampaignInputs& inputs, std::function<bool()> goes_on)
      : points_(inputs.points),
        rig_(*inputs.rig),
        goes_on_(std::move(goes_on)),
        resources_{*rig_.rig.lubricant, rig_.rig.surface ? *rig_.rig.surface : v1::Surface()},
        scene_(rig_.rig.scene),
        grounds_(fluid_grounds(*rig_.rig.lubricant)) {}

  void set_candidate(int candidate) override {
    resources_.set(points_, candidate);
    set_scene();
  }
  void set_inputs(const UncertainInputs& inputs) override {
    resources_ = {inputs.lubricant, inputs.surface};
    set_scene();
  }

  std::size_t groups() const override { return rig_.groups.size(); }

  void evaluate(std::size_t number, const GearSetPointer&, std::vector<CampaignRow>& out) override {
    const RigPoints::Group& group = rig_.groups[number];
    const std::optional<Rig> rig = prepared(group, out);
    if (!rig) return;
    for (const auto& [position, condition] : group.conditions) {
      if (!goes_on_()) throw Cancelled();
      CampaignRow& row = out[static_cast<std::size_t>(position)];
      try {
        const RigPoint point = rig->at(condition);
        row.set(point,
                rig_warnings(scene_, grounds_, group.supply_temperature_celsius, point, false));
      } catch (const Refusal& refusal) {
        row.refuse(refusal.reason(), refusal.what());
      }
    }
  }

  GearSetPointer take_gear_set(PreparedGearSets&) const override { return nullptr; }
  void give_back(PreparedGearSets&, GearSetPointer) const override {}

 private:
  /// Returns the rig at the temperature of a group. Returns nullopt if the candidate is refused
  /// there; then its rows are refused.
  std::optional<Rig> prepared(const RigPoints::Group& group, std::vector<CampaignRow>& out) const {
    const auto refuse = [&](const std::string& reason, const std::string& message) {
      for (const auto& [position, condition] : group.conditions) {
        out[static_cast<std::size_t>(position)].refuse(reason, message);
      }
      return std::nullopt;
    };
    const double celsius = group.supply_temperature_celsius;
    if (const auto [reason, message] = refusal_at_inlet(resources_.lubricant, celsius, 0);
        !reason.empty()) {
      return refuse(reason, message);
    }
    try {
      return Rig(scene_, celsius + kZeroCelsius);
    } catch (const Refusal& refusal) {
      return refuse(refusal.reason(), refusal.what());
    }
  }

  void set_scene() {
    set_lubricant(resources_.lubricant, scene_);
    grounds_ = fluid_grounds(resources_.lubricant);
    if (!rig_.rig.surface) return;
    set_surface(resources_.surface, rig_.rig.composite_rms_height, scene_);
  }

  const PointEvaluation& points_;
  const RigPoints& rig_;
  const std::function<bool()> goes_on_;
  CandidateResources resources_;
  RigScene scene_;
  FluidGrounds grounds_;
};

}  // namespace

std::unique_ptr<CampaignScene> campaign_scene(const CampaignInputs& inputs,
                                              std::function<bool()> goes_on) {
  if (inputs.rig) return std::make_unique<CandidateRig>(inputs, std::move(goes_on));
  return std::make_unique<AxleScene>(inputs.points, std::move(goes_on));
}

}  // namespace tribodyn::server
