#include "client/cpp/commands/command.h"

#include <atomic>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <utility>

#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

ProgressForm CommonOptions::progress_form() const {
  if (progress == ProgressChoice::kLines) return ProgressForm::kLines;
  if (progress == ProgressChoice::kNone) return ProgressForm::kNone;
  return standard_error_is_terminal() ? ProgressForm::kBars : ProgressForm::kNone;
}

Connection CommonOptions::connect(std::chrono::duration<double> timeout) const try {
  Connection out(server_address(server), timeout, project, access_files(access));
  // Calls of several threads may wait.
  out.report_waits([was_told = std::make_shared<std::atomic<bool>>(false)](const std::string& why) {
    if (!was_told->exchange(true)) std::cerr << "tribodyn: waits: " << why << "\n";
  });
  return out;
} catch (const std::invalid_argument& error) {
  throw Failure(kExitUsage, error.what());
}

void add_common_flags(FlagList& flags, CommonOptions& options) {
  flags.group("Every command");
  flags.text(
      "--server", "HOST:PORT",
      "Address of tribodynd; unix:PATH for a Unix socket. Default: TRIBODYN_SERVER, else the "
      "configuration file, else the socket of your own tribodynd, else 127.0.0.1:50651.",
      [&](const std::string& text) { options.server = text; });
  flags.text("--project", "NAME",
             "Project of the resources and jobs; names without a project mean its own. Default: "
             "default.",
             [&](const std::string& text) { options.project = text; });
  flags.text("--token-file", "FILE",
             "File whose first line is the token for the server; a Unix socket of your own "
             "tribodynd needs none. Default: TRIBODYN_TOKEN_FILE.",
             [&](const std::string& text) { options.access.token = text; });
  flags.text("--ca-file", "FILE",
             "PEM file with the certificates of those who sign the server's, for TLS. Default: "
             "TRIBODYN_CA_FILE, else those of the system.",
             [&](const std::string& text) { options.access.authorities = text; });
  flags.text("--certificate-file", "FILE",
             "PEM file with your certificate, for a server that requires one.",
             [&](const std::string& text) { options.access.certificate = text; });
  flags.text("--key-file", "FILE", "PEM file with the private key of your certificate.",
             [&](const std::string& text) { options.access.key = text; });
  flags.number("--timeout-seconds", {"s", "above 0 to 86400", "30"},
               "Time limit of one call; it does not limit the run time of a simulation",
               [&](double value) { options.timeout_seconds = value; });
  flags.choice("--output,-o", {"table", "csv", "json"},
               "Form of the result on standard output; progress and errors go to standard error. "
               "json is the protos' JSON. Default: table.",
               [&](int index) { options.output_format = static_cast<OutputFormat>(index); });
  flags.choice("--progress", {"auto", "lines", "none"},
               "auto: bars on a terminal, nothing elsewhere; lines: occasional lines, for logs. "
               "Default: auto.",
               [&](int index) { options.progress = static_cast<ProgressChoice>(index); });
  flags.choice("--color", {"auto", "always", "never"},
               "auto: on a terminal, unless NO_COLOR is set. Default: auto.",
               [&](int index) { options.colour = static_cast<ColourChoice>(index); });
  flags.toggle("--no-color", "Short for --color never.",
               [&] { options.colour = ColourChoice::kNever; });
}

std::vector<Command> all_commands() {
  std::vector<Command> commands;
  commands.push_back(curve_command());
  commands.push_back(point_command());
  commands.push_back(compare_command());
  commands.push_back(explain_command());
  commands.push_back(report_command());
  commands.push_back(screen_command());
  commands.push_back(design_command());
  commands.push_back(sensitivities_command());
  commands.push_back(history_command());
  commands.push_back(spectrum_command());
  commands.push_back(contact_command());
  commands.push_back(viscosity_command());
  commands.push_back(traction_command());
  commands.push_back(film_command());
  commands.push_back(stribeck_command());
  commands.push_back(cycle_command());
  commands.push_back(roughness_command());
  commands.push_back(paper_command());
  for (const ResourceKind& kind : resource_kinds()) {
    for (Command& command : resource_commands(kind)) commands.push_back(std::move(command));
  }
  commands.push_back(diff_command());
  commands.push_back(validate_command());
  commands.push_back(schema_command());
  commands.push_back(jobs_list_command());
  commands.push_back(jobs_get_command());
  commands.push_back(jobs_watch_command());
  commands.push_back(jobs_wait_command());
  commands.push_back(jobs_cancel_command());
  commands.push_back(jobs_rerun_command());
  commands.push_back(jobs_delete_command());
  commands.push_back(jobs_pin_command());
  commands.push_back(jobs_unpin_command());
  for (Command& command : campaign_commands()) commands.push_back(std::move(command));
  for (Command& command : campaign_decision_commands()) commands.push_back(std::move(command));
  commands.push_back(help_command());
  commands.push_back(completion_command());
  return commands;
}

}  // namespace tribodyn::client
