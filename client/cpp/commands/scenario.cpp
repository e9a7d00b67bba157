#include "client/cpp/commands/scenario.h"

#include <algorithm>
#include <iostream>

#include "client/cpp/service/follow.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

void add_solver_flags(FlagList& flags, v1::Simulation& simulation) {
  flags.group("Solver");
  flags.choice(
      "--method", {"automatic", "shooting", "march"},
      "How the steady state is found. automatic: by shooting where that works, else by a time "
      "march; shooting: only by shooting; march: only by a time march",
      [&](int index) {
        constexpr v1::SteadyStateMethod kMethods[] = {v1::STEADY_STATE_METHOD_AUTOMATIC,
                                                      v1::STEADY_STATE_METHOD_SHOOTING,
                                                      v1::STEADY_STATE_METHOD_MARCH};
        simulation.mutable_solver_options()->set_method(kMethods[index]);
      });
  flags.number("--tolerance", {"-", "1e-8 to 0.01", "0.001"},
               "Target of the relative error of inefficiency, torque and transmission error, for "
               "all methods",
               [&](double value) { simulation.mutable_solver_options()->set_tolerance(value); });
  flags.number(
      "--march-step-tolerance", {"-", "1e-11 to 1e-3", "1e-7"},
      "Relative error of each step of the time march; used only where a point is marched",
      [&](double value) { simulation.mutable_solver_options()->set_march_step_tolerance(value); });
  flags.number("--march-settling-tolerance", {"-", "1e-12 to 0.1", "1e-6"},
               "Relative change per period below which a marched response is steady",
               [&](double value) {
                 simulation.mutable_solver_options()->set_march_settling_tolerance(value);
               });
  flags.whole_number("--maximum-mesh-cycles", {"mesh cycles", "1 to 100000", "4000"},
                     "Limit of a march: search for a period and average", [&](int value) {
                       simulation.mutable_solver_options()->set_maximum_mesh_cycles(value);
                     });
  flags.whole_number(
      "--recorded-mesh-cycles", {"mesh cycles", "1 to 1000", "50"},
      "Mesh cycles that are averaged at least if no period is found",
      [&](int value) { simulation.mutable_solver_options()->set_recorded_mesh_cycles(value); });
}

/// Returns e.g. "failed: no steady state [WORK_LIMIT]"; empty if there is a result to show.
std::string failure_text(const v1::Simulation& simulation) {
  if (simulation.state() == v1::Simulation::SUCCEEDED) {
    const auto& points = simulation.result().points();
    const bool has_result = std::any_of(points.begin(), points.end(),
                                        [](const auto& point) { return point.has_result(); });
    return has_result ? "" : "has no result at any speed";
  }
  std::string text = state_text(simulation.state());
  if (simulation.has_error()) {
    text += ": " + simulation.error().message() + " [" + simulation.error().reason() + "]";
  }
  return text;
}

/// Adds the flags of limits that results name beside their figures.
void add_limit_flags(FlagList& flags, v1::StatedLimits& limits) {
  flags.group("Limits to name beside the figures; they change no figure");
  flags.number("--minimum-film-ratio,--film-ratio-limit", {"-", "1e-3 to 1e3", "none"},
               "Smallest film ratio",
               [&limits](double value) { limits.set_minimum_film_ratio(value); });
  flags.number("--pressure-limit-pascals,--pressure-limit", {"Pa", "1e6 to 1e11", "none"},
               "Greatest contact pressure, e.g. 1.8GPa",
               [&limits](double value) { limits.set_pressure_limit_pascals(value); });
  flags.number("--contact-temperature-limit-celsius,--contact-temperature-limit",
               {"C", "1 to 1500", "none"}, "Greatest mean temperature of the film",
               [&limits](double value) { limits.set_contact_temperature_limit_celsius(value); });
  flags.number("--flash-temperature-rise-limit-kelvin,--flash-temperature-limit",
               {"K", "0.1 to 1500", "none"},
               "Greatest rise of the flanks' surfaces above the inlet",
               [&limits](double value) { limits.set_flash_temperature_rise_limit_kelvin(value); });
  flags.text("--limit-source", "TEXT", "Where the limits come from, e.g. 'FZG A/8.3/90'.",
             [&limits](const std::string& text) { limits.set_limit_source(text); });
}

/// Cancels the submitted simulations and throws Failure: one rejected lubricant rejects all.
[[noreturn]] void withdraw(const std::vector<v1::Simulation>& submitted, const Complaints& refusals,
                           Connection& connection) {
  for (const v1::Simulation& simulation : submitted)
    connection.cancel_simulation(simulation.name());
  std::string text;
  for (const std::string& refusal : refusals) text += (text.empty() ? "" : "\n") + refusal;
  if (!submitted.empty()) text += "\n  The others were cancelled.";
  throw Failure(kExitFailed, text);
}

}  // namespace

void add_scenario_flags(FlagList& flags, Scenario& scenario) {
  v1::Simulation& simulation = scenario.simulation;
  flags.group("Fluid, hardware, temperatures");
  flags
      .texts(
          "--lubricant,-l", "NAME",
          "Lubricant, e.g. my-oil or lubricants/my-oil (`tribodyn lubricants list` lists them). A "
          "curve takes several: -l my-oil,paper-fluid-1 or -l my-oil -l paper-fluid-1.",
          [&](const std::string& name) { scenario.lubricants.push_back(name); })
      .collection = "lubricants";
  flags
      .text("--gear-set", "NAME", "Gear set with its driveline. Default: reference-axle.",
            [&](const std::string& name) {
              simulation.set_gear_set(resource_name("gearSets", name));
            })
      .collection = "gearSets";
  flags
      .texts("--surface,--surfaces", "NAME",
             "Surface: composite roughness of the flanks; a curve takes several. Default: run-in.",
             [&](const std::string& name) { scenario.surfaces.push_back(name); })
      .collection = "surfaces";
  flags
      .text(
          "--vehicle", "NAME", "Vehicle: road load. Default: passenger-car.",
          [&](const std::string& name) { simulation.set_vehicle(resource_name("vehicles", name)); })
      .collection = "vehicles";
  flags.numbers("--sump-temperature-celsius,--sump,--sumps", {"C", "-70 to 200", "40"},
                "Temperature of the oil bath; a curve takes several separated by commas",
                [&](double value) { scenario.sumps.push_back(value); });
  flags.number("--inlet-temperature-rise-kelvin", {"K", "0 to 300", "20"},
               "Temperature rise from the oil bath to the inlet of the contact (eq 14)",
               [&](double value) { simulation.set_inlet_temperature_rise_kelvin(value); });
  flags
      .choice("--condition", {"fresh", "sheared"},
              "fresh: the lubricant as it is stated; sheared: as it is after the shear test, by "
              "KV100 after it (--kv100-sheared of the lubricant). Default: fresh.",
              [&](int index) { simulation.set_sheared_lubricant(index == 1); })
      .field = "sheared_lubricant";
  add_limit_flags(flags, *simulation.mutable_stated_limits());
  add_model_flags(flags, *simulation.mutable_model_options());
  add_solver_flags(flags, simulation);
  flags.group("Job");
  flags.text("--display-name", "TEXT", "A title for the job, shown by `tribodyn jobs list`.",
             [&](const std::string& text) { simulation.set_display_name(text); });
  flags.texts("--label", "KEY=VALUE",
              "Attach a label; `tribodyn jobs list --label KEY=VALUE` finds the job.",
              [&](const std::string& text) {
                const std::size_t equals = text.find('=');
                v1::Label& label = *simulation.add_labels();
                label.set_key(text.substr(0, equals));
                if (equals != std::string::npos) label.set_value(text.substr(equals + 1));
              });
  flags.toggle("--detach", "Submit the job and return at once.", [&] { scenario.detach = true; });
  flags.toggle("--validate-only", "Check everything on the server; run nothing.",
               [&] { scenario.create.validate_only = true; });
  flags.toggle("--force", "Compute even if equal inputs have a result.",
               [&] { scenario.create.force = true; });
  flags.choice("--class", {"interactive", "bulk"},
               "How soon the job begins. interactive: before all your other jobs, and beside those "
               "that run; bulk: after small ones. Default: by its estimated cost",
               [&](int index) {
                 scenario.create.scheduling_class =
                     index == 0 ? v1::SCHEDULING_CLASS_INTERACTIVE : v1::SCHEDULING_CLASS_BULK;
               });
  flags.number("--deadline-seconds", {"s", "0.001 to 31622400", "none"},
               "Time from now after which a simulation that has not ended fails",
               [&](double value) { simulation.set_deadline_seconds(value); });
  flags.toggle("--assumptions", "Print every assumption of the result.",
               [&] { scenario.details.assumptions = true; });
}

void check_scenario(const Scenario& scenario, bool several_lubricants, Complaints& complaints) {
  if (scenario.lubricants.empty()) {
    complaints.emplace_back("--lubricant is missing, e.g. --lubricant paper-fluid-1");
  }
  if (scenario.lubricants.size() > 1 && !several_lubricants) {
    complaints.emplace_back("--lubricant: give only one (curve accepts several)");
  }
  if (scenario.sumps.size() > 1 && !several_lubricants) {
    complaints.emplace_back("--sump: give only one (curve accepts several)");
  }
  if (scenario.surfaces.size() > 1 && !several_lubricants) {
    complaints.emplace_back("--surface: give only one (curve accepts several)");
  }
}

std::vector<v1::Simulation> simulations_of(const Scenario& scenario) {
  std::vector<v1::Simulation> simulations;
  const auto add = [&](const v1::Simulation& simulation) {
    simulations.push_back(simulation);
    for (const std::string& word : scenario.compared) {
      simulations.push_back(simulation);
      apply_variant(word, simulations.back());
    }
  };
  const auto add_sumps = [&](v1::Simulation simulation) {
    if (scenario.sumps.empty()) add(simulation);
    for (const double sump : scenario.sumps) {
      simulation.set_sump_temperature_celsius(sump);
      add(simulation);
    }
  };
  for (const std::string& lubricant : scenario.lubricants) {
    v1::Simulation simulation = scenario.simulation;
    if (simulation.stated_limits().ByteSizeLong() == 0) simulation.clear_stated_limits();
    simulation.set_lubricant(resource_name("lubricants", lubricant));
    if (scenario.surfaces.empty()) add_sumps(simulation);
    for (const std::string& surface : scenario.surfaces) {
      simulation.set_surface(resource_name("surfaces", surface));
      add_sumps(simulation);
    }
  }
  return simulations;
}

std::vector<v1::Simulation> run_scenario(const Scenario& scenario, Connection& connection,
                                         const CommonOptions& options) {
  std::vector<v1::Simulation> submitted;
  std::vector<std::string> labels;
  Complaints refusals;
  InterruptText interrupts(kNothingSubmitted);
  const std::vector<v1::Simulation> simulations = simulations_of(scenario);
  const auto state_progress = [&] {
    if (scenario.create.validate_only) return;
    interrupts.set(
        interrupted_submission(connection, submitted, submitted.size() == simulations.size()));
  };
  const Differences differences = differences_of(simulations);
  for (const v1::Simulation& simulation : simulations) {
    state_progress();
    try {
      submitted.push_back(connection.create_simulation(simulation, scenario.create));
      const std::string apart = distinction(simulation, differences);
      labels.push_back(simulation.lubricant() + (apart.empty() ? "" : ", " + apart));
    } catch (const ServiceError& error) {
      if (error.kind() != ServiceError::Kind::kRefused) throw;
      const std::string refusal = Failure(with_flag_names(error, options.typed_flags)).what();
      if (std::find(refusals.begin(), refusals.end(), refusal) == refusals.end()) {
        refusals.push_back(refusal);
      }
    }
  }
  state_progress();
  if (scenario.create.validate_only) {
    if (!refusals.empty()) throw Failure(kExitFailed, joined(refusals, "\n"));
    for (const v1::Simulation& each : submitted) {
      std::cout << "valid, not run: " << each.lubricant() << "  about "
                << duration_text(each.cost_estimate().processor_seconds())
                << " of a processor; inputs " << each.input_hash() << "\n";
    }
    return {};
  }
  if (!refusals.empty()) withdraw(submitted, refusals, connection);
  if (!scenario.detach) return follow(connection, submitted, labels, options.progress_form());
  for (const v1::Simulation& simulation : submitted) {
    std::cout << simulation.name() << "  " << state_text(simulation.state())
              << "  watch: " << program_of(connection) << " jobs watch "
              << resource_id(simulation.name()) << "\n";
  }
  return {};
}

int report_failures(const std::vector<v1::Simulation>& simulations) {
  int exit_code = kExitOk;
  for (const v1::Simulation& simulation : simulations) {
    const std::string why = failure_text(simulation);
    if (why.empty()) continue;
    exit_code = kExitFailed;
    std::cerr << "tribodyn: " << printable(simulation.name()) << " ("
              << printable(simulation.lubricant()) << ") " << printable(why) << "\n";
  }
  return exit_code;
}

}  // namespace tribodyn::client
