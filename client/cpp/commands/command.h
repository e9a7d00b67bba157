#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/cpp/commands/flags.h"
#include "client/cpp/failure.h"
#include "client/cpp/service/connection.h"
#include "client/cpp/text/output.h"

namespace tribodyn::client {

/// What every command has: the server and the form of its output.
struct CommonOptions {
  std::string server;
  double timeout_seconds = 30;
  OutputFormat output_format = OutputFormat::kTable;

  Connection connect() const {
    return Connection(server_address(server), std::chrono::duration<double>(timeout_seconds));
  }
};

/// A command as the command line offers it. Its closures own what the flags write to.
struct Command {
  std::string path;     ///< "point", "jobs list"
  std::string summary;  ///< one line
  std::string about;    ///< a paragraph for its help
  std::vector<std::string> examples;
  FlagList flags;
  std::function<void(Complaints&)> check;  ///< what no flag alone can know; may be empty
  std::function<int(const CommonOptions&)> run;
};

/// The flags of CommonOptions, to be added to each command.
void add_common_flags(FlagList& flags, CommonOptions& options);

/// Every command, in the order of the help.
std::vector<Command> all_commands();

Command point_command();
Command curve_command();
Command history_command();
Command contact_command();
Command lubricants_list_command();
Command lubricants_get_command();
Command jobs_list_command();
Command jobs_get_command();
Command jobs_watch_command();
Command jobs_cancel_command();

}  // namespace tribodyn::client
