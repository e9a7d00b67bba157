#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Small multiples of a history's columns against time, the three flank slots of one quantity in
/// one panel. `lubricant_title` is the lubricant's display name; empty: its id stands for it.
std::string history_plot(const v1::Simulation& simulation, const v1::History& history,
                         const std::string& lubricant_title);

/// "mesh_force_newtons" as a title and the way into a readable unit: {"Mesh force, N", 1, 0}.
/// Temperatures are drawn in degrees Celsius, as in curves.
struct ColumnTitle {
  std::string title;
  double factor = 1;
  double offset = 0;  ///< added after the factor
};
ColumnTitle column_title(const std::string& column);

}  // namespace tribodyn::client
