#pragma once

#include <string>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Least, mean and largest value of each column.
std::string history_summary(const v1::HistoryChunk& history);

/// One line a sample; headers are the columns' names, which carry their units.
std::string history_csv(const v1::HistoryChunk& history);

}  // namespace tribodyn::client
