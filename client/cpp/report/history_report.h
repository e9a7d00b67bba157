#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

inline constexpr char kTimeColumn[] = "time_seconds";  ///< name of a column

/// Whether a zero in this column only means that the flank carries no load, as in film thickness or
/// temperature of a flank slot, but not in its forces. Such zeros are neither drawn nor averaged.
bool zero_means_no_contact(const std::string& column);

/// Returns "flank_load_newtons" for "flank_load_newtons_flank_1"; other names unchanged.
std::string column_quantity(const std::string& column);

/// Returns minimum, mean and maximum of each column; for flank slots only while they carry load.
std::string history_summary(const v1::History& history);

/// Returns a line per sample; the headers are the columns' names, with units. The last column has
/// `warnings`, codes of the point.
std::string history_csv(const v1::History& history, const std::string& warnings);

}  // namespace tribodyn::client
