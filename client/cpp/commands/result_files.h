#pragma once

#include <map>
#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// --plot FILE.svg. The path is checked with the command line, before anything is computed: a
/// picture of another format is refused, and so is a file that cannot be written.
void add_plot_flag(FlagList& flags, const std::string& description, std::string& path);

/// A file that a command writes beside its output; checked as above.
Flag& add_result_file_flag(FlagList& flags, const std::string& name, const std::string& value_name,
                           const std::string& description, std::string& path);

/// The display names of the simulations' lubricants, for a picture. One that the server does not
/// tell is left out: a picture without it is still a picture.
std::map<std::string, std::string> lubricant_titles(const std::vector<v1::Simulation>& simulations,
                                                    Connection& connection);

}  // namespace tribodyn::client
