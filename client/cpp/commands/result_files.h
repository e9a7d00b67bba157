#pragma once

#include <map>
#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Adds --plot FILE.svg. The path is checked with the command line, before anything is computed: it
/// must end in .svg and be writable.
void add_plot_flag(FlagList& flags, const std::string& description, std::string& path);

/// Adds a flag for a file that a command writes besides its output; the path is checked as for
/// add_plot_flag().
Flag& add_result_file_flag(FlagList& flags, const std::string& name, const std::string& value_name,
                           const std::string& description, std::string& path);

/// Returns the display names of the simulations' lubricants for a plot. Omits lubricants that the
/// server does not return: the plot is useful without their names.
std::map<std::string, std::string> lubricant_titles(const std::vector<v1::Simulation>& simulations,
                                                    Connection& connection);

}  // namespace tribodyn::client
