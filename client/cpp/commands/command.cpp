#include "client/cpp/commands/command.h"

namespace tribodyn::client {

void add_common_flags(FlagList& flags, CommonOptions& options) {
  flags.group("Every command");
  flags.text("--server", "HOST:PORT",
             "Where tribodynd listens; unix:PATH for a socket. Default: TRIBODYN_SERVER, else "
             "127.0.0.1:50651.",
             [&](const std::string& text) { options.server = text; });
  flags.number("--timeout-seconds", {"s", "above 0 to 86400", "30"},
               "Longest wait for one answer; a simulation may take as long as it needs",
               [&](double value) { options.timeout_seconds = value; });
  flags.choice("--output,-o", {"table", "csv", "json"},
               "Form of the result on standard output; progress and errors go to standard error. "
               "json is the protos' JSON. Default: table.",
               [&](int index) { options.output_format = static_cast<OutputFormat>(index); });
}

std::vector<Command> all_commands() {
  std::vector<Command> commands;
  commands.push_back(point_command());
  commands.push_back(curve_command());
  commands.push_back(history_command());
  commands.push_back(contact_command());
  commands.push_back(lubricants_list_command());
  commands.push_back(lubricants_get_command());
  commands.push_back(jobs_list_command());
  commands.push_back(jobs_get_command());
  commands.push_back(jobs_watch_command());
  commands.push_back(jobs_cancel_command());
  return commands;
}

}  // namespace tribodyn::client
