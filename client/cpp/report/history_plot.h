#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Draws a history's columns against time as small multiples; the three flank slots of one quantity
/// share a panel. `lubricant_title` is the lubricant's display name; if it is empty, the plot shows
/// the id.
std::string history_plot(const v1::Simulation& simulation, const v1::History& history,
                         const std::string& lubricant_title);

/// The title of a column and its conversion to the plot's unit, e.g. {"Mesh force, N", 1, 0} for
/// "mesh_force_newtons". Temperatures are plotted in degrees Celsius.
struct ColumnTitle {
  std::string title;
  double factor = 1;
  double offset = 0;  ///< added after the factor
};
ColumnTitle column_title(const std::string& column);

}  // namespace tribodyn::client
