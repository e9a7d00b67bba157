#include "server/simulation/campaign_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "core/version.h"
#include "server/contract/canonical_text.h"
#include "server/contract/check_message.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/input_fields.h"

namespace tribodyn::server {
namespace {

/// Returns the request of EvaluateRig for the base.
v1::EvaluateRigRequest base_rig_request(const v1::Campaign& campaign) {
  const v1::CampaignRig& rig = campaign.rig();
  v1::EvaluateRigRequest out;
  out.set_lubricant(campaign.lubricant());
  out.set_surface(campaign.surface());
  if (campaign.has_model_options()) *out.mutable_model_options() = campaign.model_options();
  out.set_composite_rms_height_metres(rig.composite_rms_height_metres());
  out.set_radius_x_metres(rig.radius_x_metres());
  out.set_radius_y_metres(rig.radius_y_metres());
  if (rig.has_body_1()) *out.mutable_body_1() = rig.body_1();
  if (rig.has_body_2()) *out.mutable_body_2() = rig.body_2();
  *out.mutable_conditions() = rig.conditions();
  if (rig.has_grid()) *out.mutable_grid() = rig.grid();
  return out;
}

/// Adds a violation for each field that concerns the axle alone.
void refuse_axle_fields(const v1::Campaign& campaign, Violations& violations) {
  const auto refuse = [&](bool is_set, const char* field, const char* what) {
    if (!is_set) return;
    violations.add(field, "set together with rig; allowed: one of the two, as a rig has no {}",
                   what);
  };
  refuse(!campaign.gear_set().empty(), "gear_set", "gear set");
  refuse(!campaign.vehicle().empty(), "vehicle", "vehicle");
  refuse(campaign.tolerance() != 0, "tolerance", "solver with a tolerance");
  refuse(!campaign.conditions().empty(), "conditions",
         "conditions of driving; its own are rig.conditions or rig.grid");
  refuse(campaign.contact_figures(), "contact_figures",
         "further figures: those of its contact are columns of every rig");
  refuse(!campaign.elasticity_parameters().empty(), "elasticity_parameters", "elasticities");
  refuse(!campaign.elasticity_figures().empty(), "elasticity_figures", "elasticities");
}

std::vector<RigPoints::Group> rig_groups(const std::vector<v1::RigCondition>& conditions) {
  std::map<double, std::size_t> positions;
  std::vector<RigPoints::Group> out;
  int position = 0;
  for (const v1::RigCondition& each : conditions) {
    const double celsius = each.supply_temperature_celsius();
    const auto [at, is_new] = positions.emplace(celsius, out.size());
    if (is_new) out.push_back({celsius, {}});
    out[at->second].conditions.emplace_back(
        position++, RigCondition{each.load_newtons(), each.entrainment_speed_metres_per_second(),
                                 0.01 * each.slide_roll_ratio_percent()});
  }
  return out;
}

bool is_no_input(const google::protobuf::FieldDescriptor& field) {
  const InputRole role = input_role(field);
  return role == InputRole::kLabel || role == InputRole::kOutput;
}

}  // namespace

int condition_count(const v1::Campaign& campaign) {
  if (!campaign.has_rig()) return campaign.conditions_size();
  // A grid that is not checked may be of any size.
  return static_cast<int>(std::min(rig_condition_count(base_rig_request(campaign)), 1e9));
}

bool has_smooth_specimens(const v1::Campaign& campaign) {
  return campaign.has_rig() && campaign.surface().empty();
}

std::string no_effect_text(const v1::Campaign& campaign, const std::string& path) {
  if (!campaign.has_rig() || !path.starts_with("surface.")) return {};
  if (campaign.surface().empty()) {
    return fmt::format("\"{}\" has no effect: the specimens are smooth, as surface is not set",
                       path);
  }
  if (campaign.rig().composite_rms_height_metres() == 0 ||
      path != "surface.composite_rms_height_metres") {
    return {};
  }
  return fmt::format(
      "\"{}\" has no effect: rig.composite_rms_height_metres replaces it; state one of the two",
      path);
}

std::vector<v1::RigCondition> rig_conditions(const v1::Campaign& campaign) {
  return rig_conditions(base_rig_request(campaign));
}

std::optional<RigPoints> read_rig_points(const v1::Campaign& campaign,
                                         const v1::EvaluatePointsRequest& columns,
                                         const ResourceLookup& lookup, int most,
                                         Violations& violations, PointEvaluation& points) {
  const std::size_t before = violations.size();
  refuse_axle_fields(campaign, violations);
  check_message(columns, "", violations);
  points.columns = read_columns(columns, violations);
  for (int i = 0; i < columns.candidate_columns_size(); ++i) {
    const std::string text = no_effect_text(campaign, columns.candidate_columns(i).path());
    if (!text.empty()) violations.add(fmt::format("candidate_columns[{}].path", i), text);
  }
  Violations of_rig;
  auto rig = read_rig(base_rig_request(campaign), lookup, of_rig, kMaximumCampaignConditions);
  for (const Violation& each : of_rig) {
    const bool is_of_campaign = each.field == "lubricant" || each.field == "surface" ||
                                each.field.starts_with("model_options");
    violations.add(is_of_campaign ? each.field : "rig." + each.field, each.description);
  }
  if (!points.columns.empty()) {
    points.candidates = static_cast<int>(points.columns.front().values.size());
  }
  points.conditions = condition_count(campaign);
  if (points.conditions > 0 && points.candidates > most / points.conditions) {
    violations.add("rig",
                   "{} candidates at {} conditions are {} points; allowed: at most {} in "
                   "one campaign; make several",
                   points.candidates, points.conditions,
                   static_cast<long>(points.candidates) * points.conditions, most);
  }
  if (rig) check_columns_of_base(columns, *rig->lubricant, violations);
  if (!rig || violations.size() > before) return std::nullopt;
  points.base.lubricant = rig->lubricant;
  points.base.surface = rig->surface;
  points.base.effective.set_lubricant_revision(rig->lubricant_revision);
  points.base.effective.set_surface_revision(rig->surface_revision);
  return RigPoints{std::move(*rig), rig_groups(rig_conditions(campaign))};
}

std::string canonical_rig(const v1::Campaign& campaign, const RigPoints& points) {
  std::string text = std::string("rig\nmodel_version=") + kModelVersion + "\n";
  const auto add = [&text](const google::protobuf::Message& message, const char* path) {
    add_canonical_text(message, path, is_no_input, text);
  };
  add(*points.rig.lubricant, "lubricant");
  text += text_of(fluid_grounds(*points.rig.lubricant));
  if (points.rig.surface) add(*points.rig.surface, "surface");
  v1::ModelOptions options = campaign.model_options();
  fill_model_options(options);
  add(options, "model_options");
  v1::CampaignRig rig = campaign.rig();
  const std::vector<v1::RigCondition> conditions = rig_conditions(campaign);
  *rig.mutable_conditions() = {conditions.begin(), conditions.end()};
  if (rig.radius_y_metres() == 0) rig.set_radius_y_metres(rig.radius_x_metres());
  add(rig, "rig");
  return text;
}

}  // namespace tribodyn::server
