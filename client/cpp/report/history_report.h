#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

inline constexpr char kTimeColumn[] = "time_seconds";  ///< a history's column

/// Whether a zero of this column only says that the flank carries no load, so that nothing is to be
/// drawn or averaged: the film, temperature, ... of a flank slot, but not its forces.
bool zero_means_no_contact(const std::string& column);

/// "flank_load_newtons" from "flank_load_newtons_flank_1"; other names as they are.
std::string column_quantity(const std::string& column);

/// Least, mean and largest value of each column; of flank slots while they carry load.
std::string history_summary(const v1::History& history);

/// One line a sample; headers are the columns' names, which carry their units.
std::string history_csv(const v1::History& history);

}  // namespace tribodyn::client
