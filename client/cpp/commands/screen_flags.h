#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/cpp/commands/condition_flags.h"
#include "client/cpp/commands/design_flags.h"
#include "client/cpp/commands/screen_rig.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::client {

/// What the command line of `screen` states.
struct ScreenFlags {
  std::string path;
  std::string campaign;  ///< name of a campaign in place of a table
  // Candidates that the server makes or finds, in place of a table.
  DesignFlags design;
  std::vector<std::string> lubricants;
  std::string lubricant_filter;
  std::optional<v1::CampaignBudget> budget;
  v1::EvaluatePointsRequest request;  ///< without conditions
  ConditionFlags conditions;
  ScreenRigFlags rig;
  std::vector<std::string> carried;
  int top = 20;
  std::string csv_path, json_lines_path, plot_path;
  std::vector<v1::ParameterUncertainty> uncertainties;
  double confidence = 0.95;
  bool leaves_out_uncertainty = false;
  std::string pareto_column;
  bool wants_most = false;
  bool wants_effects = false;

  bool has_design() const { return design.has_ranges || design.has_method; }
  bool has_lubricants() const { return !lubricants.empty() || !lubricant_filter.empty(); }
};

void add_screen_flags(FlagList& list, ScreenFlags& flags);
void check_screen_flags(const ScreenFlags& flags, Complaints& complaints);

/// Adds a complaint for each flag that concerns the axle alone.
void check_rig_screen(const ScreenFlags& flags, Complaints& complaints);

}  // namespace tribodyn::client
