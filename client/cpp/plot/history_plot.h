#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Small multiples of a history's columns against time, the three flank slots of one quantity in
/// one panel.
std::string history_plot(const v1::Simulation& simulation, const v1::History& history);

/// "mesh_force_newtons" as a title and a factor into a readable unit: {"Mesh force, N", 1}.
struct ColumnTitle {
  std::string title;
  double factor = 1;
};
ColumnTitle column_title(const std::string& column);

}  // namespace tribodyn::client
