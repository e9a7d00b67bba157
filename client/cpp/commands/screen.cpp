#include <memory>

#include "client/cpp/commands/screen_run.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

int run_screen(ScreenFlags& flags, const CommonOptions& options) {
  const bool has_decisions = !flags.pareto_column.empty() || flags.wants_effects;
  if (options.output_format == OutputFormat::kCsv && has_decisions && flags.plot_path.empty()) {
    throw Failure(
        kExitUsage,
        "--output csv is the ranking alone; use --output json for --pareto and --effects, "
        "or draw them with --plot");
  }
  InterruptText interrupts(kNothingSubmitted);
  Connection connection = options.connect();
  if (!flags.campaign.empty() && connection.get_campaign(flags.campaign).has_rig()) {
    Complaints complaints;
    check_rig_screen(flags, complaints);
    if (!complaints.empty()) throw Failure(kExitUsage, joined(complaints, "\n"));
    return run_rig_screen(flags, connection, options, interrupts);
  }
  if (!flags.rig.machine.empty()) return run_rig_screen(flags, connection, options, interrupts);
  if (!flags.rig.objectives.empty()) {
    throw Failure(kExitUsage, "--least and --most: " + flags.campaign +
                                  " is of the axle, which is ranked by "
                                  "its inefficiency; `campaigns rank` ranks by any figure");
  }
  return run_axle_screen(flags, connection, options, interrupts);
}

}  // namespace

Command screen_command() {
  const auto flags = std::make_shared<ScreenFlags>();
  Command command{
      "screen",
      "rank candidates of a table by their inefficiency",
      "Evaluates variants of a lubricant, one a row of a table, at every speed and sump "
      "temperature "
      "and ranks them by the weighted mean of the inefficiency. Columns override parameters of the "
      "lubricant and of the surface, or hold measurements; others are carried along. The server "
      "computes the table as a campaign and keeps its figures: after an interruption of either "
      "side "
      "the same command goes on where it ended, and once it is complete reads the figures.",
      {"tribodyn screen candidates.csv --like my-oil --speeds 20,40,60 --sumps 40,90",
       "tribodyn screen candidates.csv --like my-oil --speeds 20,60 --weights 1,2 --csv all.csv",
       "tribodyn screen oils.csv --like my-oil --uncertainty pressure-viscosity=3% --pareto cost",
       "tribodyn screen oils.csv --like my-oil --effects --plot screening.svg",
       "tribodyn screen oils.csv --like my-oil --contact-figures --csv all.csv",
       "tribodyn screen candidates.csv --like my-oil --output csv",
       "tribodyn screen --lubricants my-oil,your-oil,paper-fluid-2 --speeds 20,60",
       "tribodyn screen --like my-oil --range relaxation-time=0.2us:0.6us --count 128",
       "tribodyn screen --campaign 12 --weights 2,1,1",
       "tribodyn screen candidates.csv --like my-oil --rig traction --load 35 --srr 5,20,50",
       std::string("tribodyn screen candidates.csv --like my-oil --rig stribeck --pareto ") +
           "12/inefficiency_energy_mean_percent"},
      {},
      {},
      {}};
  add_screen_flags(command.flags, *flags);
  command.check = [flags](Complaints& complaints) { check_screen_flags(*flags, complaints); };
  command.main_flags = {"table",     "--like",        "--speeds",     "--sumps",
                        "--weights", "--uncertainty", "--pareto",     "--plot",
                        "--effects", "--top",         "--csv",        "--surface",
                        "--range",   "--campaign",    "--lubricants", "--rig"};
  command.run = [flags](const CommonOptions& options) { return run_screen(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
