#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "client/cpp/commands/flag_errors.h"
#include "client/cpp/failure.h"
#include "client/cpp/text/colour.h"
#include "client/cpp/text/flags.h"
#include "client/cpp/text/output.h"
#include "client/cpp/text/progress.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

struct ResourceKind;

enum class ProgressChoice { kAuto, kLines, kNone };

/// Options of every command: the server, the project and the form of the output.
struct CommonOptions {
  std::string server;
  std::string project = kDefaultProject;
  AccessFiles access;
  double timeout_seconds = 30;
  OutputFormat output_format = OutputFormat::kTable;
  ColourChoice colour = ColourChoice::kAuto;
  ProgressChoice progress = ProgressChoice::kAuto;
  TypedFlags typed_flags;  ///< flags as typed, for error messages

  ProgressForm progress_form() const;

  Connection connect() const { return connect(std::chrono::duration<double>(timeout_seconds)); }
  /// Throws Failure if a file of `access` cannot be read.
  Connection connect(std::chrono::duration<double> timeout) const;
};

/// A command of the command line. Its closures own the variables to which the flags write.
struct Command {
  std::string path;     ///< "point", "jobs list"
  std::string summary;  ///< one line
  std::string about;    ///< a paragraph of its help
  std::vector<std::string> examples;
  FlagList flags;
  std::function<void(Complaints&)> check;  ///< checks that concern several flags; may be empty
  std::function<int(const CommonOptions&)> run;
  /// Any one name of each flag that --help lists; --help-all lists all flags. Empty: --help lists
  /// all flags of the command.
  std::vector<std::string> main_flags = {};
};

/// Adds the flags of CommonOptions; every command has them.
void add_common_flags(FlagList& flags, CommonOptions& options);

/// Returns every command, in the order of the help.
std::vector<Command> all_commands();

/// Returns list, get, create, update, delete, undelete, purge, revisions, import and export of one
/// kind.
std::vector<Command> resource_commands(const ResourceKind& kind);

Command point_command();
Command curve_command();
Command history_command();
Command spectrum_command();
Command contact_command();
Command viscosity_command();
Command traction_command();
Command film_command();
Command stribeck_command();
Command roughness_command();
Command paper_command();
Command cycle_command();
Command compare_command();
Command screen_command();
Command design_command();
Command explain_command();
Command report_command();
Command sensitivities_command();
Command diff_command();
Command validate_command();
Command schema_command();
Command completion_command();
Command help_command();
/// Returns list, show, pause, resume, cancel, delete and columns of campaigns.
std::vector<Command> campaign_commands();
std::vector<Command> campaign_decision_commands();
Command jobs_list_command();
Command jobs_get_command();
Command jobs_watch_command();
Command jobs_cancel_command();
Command jobs_wait_command();
Command jobs_rerun_command();
Command jobs_delete_command();
Command jobs_pin_command();
Command jobs_unpin_command();

}  // namespace tribodyn::client
