#include "client/cpp/commands/arguments.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "client/cpp/commands/flag_errors.h"
#include "client/cpp/commands/help.h"
#include "client/cpp/commands/scenario.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Parses arguments with fresh commands and keeps the results that tests read.
struct Outcome {
  std::string path;
  Complaints complaints;
  bool wants_help;
  bool wants_all_help;
  CommonOptions options;

  explicit Outcome(const std::vector<std::string>& arguments) {
    FlagList common_flags;
    add_common_flags(common_flags, options);
    const std::vector<Command> commands = all_commands();
    const Parsed parsed = parse_arguments(arguments, commands, common_flags);
    if (parsed.command != nullptr) path = parsed.command->path;
    complaints = parsed.complaints;
    wants_help = parsed.wants_help;
    wants_all_help = parsed.wants_all_help;
  }

  bool complains_of(const std::string& part) const {
    return std::any_of(complaints.begin(), complaints.end(), [&](const std::string& complaint) {
      return complaint.find(part) != std::string::npos;
    });
  }
};

TEST(Arguments, AcceptACompletePoint) {
  const Outcome outcome({"point", "--lubricant", "paper-fluid-1", "--speed", "72.5",
                         "--ascent-angle-degrees", "-3", "--isothermal", "--as-published",
                         "eq17,eq20", "-o", "json"});
  EXPECT_EQ(outcome.path, "point");
  EXPECT_TRUE(outcome.complaints.empty()) << outcome.complaints.front();
  EXPECT_EQ(outcome.options.output_format, OutputFormat::kJson);
}

TEST(Arguments, TheClassOfAJobIsItsSchedulingClass) {
  for (const auto& [word, expected] : {std::pair("interactive", v1::SCHEDULING_CLASS_INTERACTIVE),
                                       std::pair("bulk", v1::SCHEDULING_CLASS_BULK)}) {
    Scenario scenario;
    std::vector<Command> commands(1);
    commands[0].path = "point";
    add_scenario_flags(commands[0].flags, scenario);
    parse_arguments({"point", "--class", word}, commands, FlagList());
    EXPECT_EQ(scenario.create.scheduling_class, expected);
  }
  EXPECT_TRUE(Outcome({"point", "--class", "soon"}).complains_of("'soon'"));
}

TEST(Arguments, ReportEveryErrorAtOnce) {
  const Outcome outcome({"point", "--speed", "fast", "--sump", "1e999", "--as-published", "eq99",
                         "--model", "quick", "--pinion-torque-newton-metres", "3", "--lubricnt",
                         "1", "--maximum-mesh-cycles", "2.5"});
  EXPECT_EQ(outcome.complaints.size(), 8U);
  for (const char* part : {"'fast'", "'1e999'", "'eq99'", "'quick'", "--pinion-speed", "--lubricnt",
                           "'2.5'", "--lubricant"}) {
    EXPECT_TRUE(outcome.complains_of(part)) << part;
  }
}

TEST(Arguments, RejectEq46WhereNoProfilesAreRead) {
  for (const char* command : {"point", "curve", "history", "contact"}) {
    EXPECT_TRUE(Outcome({command, "--as-published", "eq17,eq46"}).complains_of("'eq46'"))
        << command;
  }
  const Outcome import({"surfaces", "import", "profile.csv", "--as-published", "eq46"});
  EXPECT_TRUE(import.complaints.empty());
}

TEST(Arguments, ComplaintsNameWhatIsMissingUnknownOrContradictory) {
  const struct {
    const char* line;
    std::vector<std::string> named;
  } kWrong[] = {
      {"pointt --speed 3", {"pointt", "point "}},
      {"lubricant list", {"lubricants"}},
      {"lubricants lst", {"lubricants list"}},
      {"lubricants frobnicate", {"frobnicate"}},
      {"lubricants list more", {"more"}},
      {"lubricants create", {"NAME"}},
      {"lubricants update a", {"--"}},
      {"jobs cancel", {"NAME"}},
      {"jobs get a b", {" b"}},
      {"point -l a", {"--speed"}},
      {"point -l a --speed", {"--speed"}},
      {"point -l a --speed 3 --speed 4", {"--speed"}},
      {"point -l a,b --speed 3", {"-l"}},
      {"point -l a --speed 3 --torque 3 --pinion-speed 3", {"--speed", "--torque"}},
      {"point -l a --speed 3 --sump 40,90", {"--sump"}},
      {"explain a b --sump -20,40", {"--sump: '-20,40' has a comma; give one temperature"}},
      {"point -l a --speed 3 --surface run-in,new", {"--surface"}},
      {"curve -l a --speed 20 --last-speed 90", {"--speed", "--last-speed"}},
      {"curve -l a --compare warmer", {"'warmer'"}},
      {"curve -l a --panels film-ratio", {"--plot"}},
      {"curve -l a --independent-points --direction up", {"--direction", "--independent-points"}},
      {"traction", {"tribodyn traction "}},
      {"traction a --load 1 --pressure 2", {"--load", "--pressure"}},
      {"traction a --map load,pressure", {"load", "pressure"}},
      {"traction a --map speed,viscosity", {"'viscosity'", "slide-roll-ratio"}},
      {"viscosity", {"tribodyn viscosity "}},
      {"cycle", {"tribodyn cycle "}},
      {"cycle a --map-tolerance 1", {"--map-tolerance"}},
      {"cycle a --map-tolerance 0", {"--map-tolerance"}},
      {"roughness", {"tribodyn roughness "}},
      {"roughness p.csv --sampling-steps 1,x", {"'x'"}},
      {"roughness wheel,p.csv", {"pinion|gear"}},
      {"paper 17", {"17"}},
      {"compare", {"tribodyn compare "}},
      {"compare a --speed 40,60 --weights 1", {"1 weight", "2 speeds"}},
      {"compare a --sumps 40,90 --sump-weights 1", {"1 weight", "2 sump"}},
      {"explain a", {"tribodyn explain "}},
      {"explain a b --speed 40,60 --weights 1", {"1 weight", "2 speeds"}},
      {"report a", {"--html"}},
      {"design --range pressure-viscosity=18/GPa:14/GPa --method grid --count 3",
       {"--range", "--count"}},
      {"screen t.csv --like a --weights 1,2 --speeds 9 --csv x --jsonl y",
       {"2 weights", "--csv", "--jsonl"}},
      {"screen t.csv --campaign 1 --speeds 20 --tolerance 1e-4",
       {"--campaign", "--speeds", "--tolerance"}},
      {"screen t.csv --like a --rig film --speeds 20 --vehicle v --plot x.svg --least a --most b",
       {"--speeds", "--vehicle", "--plot", "--least", "--most"}},
      {"screen t.csv --like a --srr 10", {"--srr"}},
      {"campaigns show", {"NAME"}},
      {"campaigns pareto 1", {"--least", "--most"}},
      {"campaigns rank 1 --least cost:median --where cost=3", {"--least", "--where"}},
  };
  for (const auto& each : kWrong) {
    const Outcome outcome(split(each.line, ' '));
    for (const std::string& name : each.named) {
      EXPECT_TRUE(outcome.complains_of(name))
          << each.line << ": no " << name << " in " << testing::PrintToString(outcome.complaints);
    }
  }
}

TEST(Arguments, AcceptSeveralLubricantsAndJobs) {
  EXPECT_TRUE(
      Outcome({"curve", "-l", "paper-fluid-1", "--lubricant", "paper-fluid-2,paper-fluid-3"})
          .complaints.empty());
  EXPECT_TRUE(Outcome({"jobs", "watch", "a", "b"}).complaints.empty());
}

TEST(Help, EveryCommandHasExamplesThatParse) {
  for (const Command& command : all_commands()) {
    EXPECT_FALSE(command.examples.empty()) << command.path;
  }
  // Flags keep what they have read: the nth example of each command is parsed by fresh commands.
  bool is_any_left = true;
  for (std::size_t n = 0; is_any_left; ++n) {
    CommonOptions options;
    FlagList common_flags;
    add_common_flags(common_flags, options);
    const std::vector<Command> commands = all_commands();
    is_any_left = false;
    for (const Command& command : commands) {
      if (n >= command.examples.size()) continue;
      is_any_left = true;
      const std::string& example = command.examples[n];
      std::vector<std::string> words = split(example, ' ');
      words.erase(words.begin());
      const Parsed parsed = parse_arguments(words, commands, common_flags);
      EXPECT_EQ(parsed.command, &command) << example;
      EXPECT_TRUE(parsed.complaints.empty()) << example << ": " << parsed.complaints.front();
    }
  }
}

TEST(ModelFlags, CoverEveryFieldOfModelOptions) {
  v1::ModelOptions options;
  FlagList list;
  add_model_flags(list, options);
  Complaints complaints;
  for (const Flag& flag : list.flags()) {
    EXPECT_NE(flag.description, "See ModelOptions.") << flag.names;
    if (flag.is_switch) flag.read({"true"}, complaints);
    if (flag.names == "--pressure-viscosity-index") flag.read({"houpert"}, complaints);
    if (flag.names == "--model-preset") flag.read({"paper"}, complaints);
    if (flag.names == "--as-published") {
      flag.read({"eq17,eq20,eq22", "eq31", "eq43"}, complaints);
    }
  }
  EXPECT_TRUE(complaints.empty());
  const auto every_field_set = [](const google::protobuf::Message& message) {
    const auto* descriptor = message.GetDescriptor();
    for (int i = 0; i < descriptor->field_count(); ++i) {
      // A flag of `surfaces import`, where it applies.
      if (descriptor->field(i)->name() == "eq46_square_root_of_sum") continue;
      EXPECT_TRUE(message.GetReflection()->HasField(message, descriptor->field(i)))
          << descriptor->field(i)->full_name();
    }
  };
  every_field_set(options);
  every_field_set(options.as_published());
}

/// Returns the value that a flag sets; NaN if it adds a complaint.
double read_as(const std::string& unit, const std::string& text) {
  FlagList list;
  double value = std::numeric_limits<double>::quiet_NaN();
  list.number("--quantity", {unit, "0 to 1", ""}, "A quantity", [&](double got) { value = got; });
  Complaints complaints;
  list.flags().front().read({text}, complaints);
  EXPECT_EQ(complaints.empty(), !std::isnan(value)) << text;
  return value;
}

TEST(Numbers, AcceptEveryUnitOfTheirDimension) {
  EXPECT_EQ(read_as("km/h", "-1.5e-3"), -1.5e-3);
  EXPECT_EQ(read_as("km/h", "+4"), 4);
  EXPECT_EQ(read_as("km/h", "20m/s"), 72);
  EXPECT_EQ(read_as("C", "90C"), 90);
  EXPECT_EQ(read_as("C", "363.15 K"), 90);
  EXPECT_EQ(read_as("s", "2min"), 120);
  EXPECT_EQ(read_as("-", "0.1%"), 0.001);
  EXPECT_EQ(read_as("degrees", "100%"), 45);
}

TEST(Numbers, RejectTrailingText) {
  for (const char* text : {"", "1,5", "nan", "inf", "0x10", "+-3", "1e999", "3 V", "3 kg"}) {
    EXPECT_TRUE(std::isnan(read_as("km/h", text))) << text;
  }
}

TEST(Arguments, SpeedAndSumpHaveOneMeaningInAllCommands) {
  for (const char* command : {"point", "curve", "history"}) {
    const Outcome outcome({command, "-l", "paper-fluid-1", "--speed", "20m/s", "--sump", "90C"});
    EXPECT_TRUE(outcome.complaints.empty()) << command << ": " << outcome.complaints.front();
  }
  EXPECT_TRUE(Outcome({"contact", "--sump", "90"}).complaints.empty());
  EXPECT_TRUE(Outcome({"curve", "-l", "paper-fluid-1", "--speed", "20,40", "--speed", "100"})
                  .complaints.empty());
}

TEST(Arguments, OnlyACurveTakesSeveralSumpTemperatures) {
  EXPECT_TRUE(Outcome({"curve", "-l", "paper-fluid-1", "--sumps", "40,90"}).complaints.empty());
  Scenario scenario;
  scenario.lubricants = {"a", "b"};
  scenario.sumps = {40, 90};
  const std::vector<v1::Simulation> simulations = simulations_of(scenario);
  ASSERT_EQ(simulations.size(), 4U);
  EXPECT_EQ(simulations[1].lubricant(), "lubricants/a");
  EXPECT_EQ(simulations[1].sump_temperature_celsius(), 90);
  EXPECT_EQ(simulations[2].lubricant(), "lubricants/b");
  EXPECT_EQ(simulations[2].sump_temperature_celsius(), 40);
}

TEST(Arguments, ACurveIsComputedOnEachSurfaceAndWithEachVariant) {
  EXPECT_TRUE(Outcome({"curve", "-l", "paper-fluid-1", "--surfaces", "run-in,new", "--compare",
                       "isothermal,no-boundary,eq17,houpert,down"})
                  .complaints.empty());
  Scenario scenario;
  scenario.lubricants = {"a"};
  scenario.surfaces = {"run-in", "new"};
  scenario.compared = {"no-boundary", "down"};
  const std::vector<v1::Simulation> simulations = simulations_of(scenario);
  ASSERT_EQ(simulations.size(), 6U);
  EXPECT_EQ(simulations[0].surface(), "surfaces/run-in");
  EXPECT_FALSE(simulations[0].model_options().no_boundary_friction());
  EXPECT_TRUE(simulations[1].model_options().no_boundary_friction());
  EXPECT_EQ(simulations[2].inefficiency_curve().direction(), v1::SWEEP_DIRECTION_DOWN);
  EXPECT_FALSE(simulations[2].model_options().no_boundary_friction());
  EXPECT_EQ(simulations[3].surface(), "surfaces/new");
}

TEST(Arguments, VariantsChangeWhatAPresetDecides) {
  v1::Simulation simulation;
  ASSERT_TRUE(apply_variant("no-inlet-shear-heating", simulation));
  EXPECT_TRUE(simulation.model_options().has_inlet_shear_heating());
  EXPECT_FALSE(simulation.model_options().inlet_shear_heating());
  ASSERT_TRUE(apply_variant("inlet-shear-heating", simulation));
  EXPECT_TRUE(simulation.model_options().inlet_shear_heating());
  EXPECT_FALSE(simulation.model_options().has_closed_load_sharing());
  ASSERT_TRUE(apply_variant("paper", simulation));
  EXPECT_EQ(simulation.model_options().preset(), v1::ModelOptions::PAPER);
}

TEST(Arguments, ASwitchMayBeSetToFalse) {
  for (const char* flag : {"--inlet-shear-heating", "--inlet-shear-heating=false",
                           "--closed-load-sharing=true", "--isothermal=false"}) {
    EXPECT_TRUE(Outcome({"compare", "a", "--speed", "60", flag}).complaints.empty()) << flag;
  }
  EXPECT_TRUE(Outcome({"compare", "a", "--speed", "60", "--closed-load-sharing=maybe"})
                  .complains_of("--closed-load-sharing: 'maybe'"));
  EXPECT_TRUE(
      Outcome({"compare", "a", "--speed", "60", "--model-preset", "paper"}).complaints.empty());
}

TEST(Arguments, AClassOfBaseOilHasAnyUsualSpelling) {
  for (const char* word : {"group-iii", "GROUP-III", "Gr. III", "Group IV", "PAO", "pag"}) {
    EXPECT_TRUE(Outcome({"lubricants", "create", "x", "--base-oil-class", word}).complaints.empty())
        << word;
  }
  EXPECT_TRUE(Outcome({"lubricants", "create", "x", "--base-oil-class", "Group IX"})
                  .complains_of("--base-oil-class: 'Group IX'"));
}

TEST(Arguments, ALubricantMayHaveBoundaryFrictionOfItsOwn) {
  EXPECT_TRUE(Outcome({"lubricants", "create", "x", "--asperity-friction-coefficient", "0.11",
                       "--tribofilm-shear-strength", "2MPa", "--asperity-friction-by-temperature",
                       "40=0.12", "--asperity-friction-by-temperature", "100C=0.09"})
                  .complaints.empty());
  EXPECT_TRUE(Outcome({"lubricants", "create", "x", "--asperity-friction-by-temperature", "0.12"})
                  .complains_of("--asperity-friction-by-temperature: '0.12'"));
}

TEST(Arguments, QuantitiesOfALubricantNeedNoUnit) {
  const Outcome outcome({"lubricants", "create", "x", "--kv40", "103", "--kv100", "15.1cSt",
                         "--pressure-viscosity", "20", "--pressure-viscosity-temperature", "40",
                         "--uncertainty", "pressure-viscosity=0.5", "--relaxation-time", "0.45"});
  EXPECT_TRUE(outcome.complaints.empty()) << outcome.complaints.front();
}

TEST(Arguments, ComplaintsNameTheTypedFlag) {
  EXPECT_TRUE(
      Outcome({"point", "-l", "paper-fluid-1", "--speed", "fast"}).complains_of("--speed: 'fast'"));
  EXPECT_TRUE(Outcome({"point", "-l", "paper-fluid-1", "--speed-kilometres-per-hour", "fast"})
                  .complains_of("--speed-kilometres-per-hour: 'fast'"));
  const Outcome wrong({"lubricants", "create", "x", "--kv40", "73,3", "--density", "868"});
  EXPECT_TRUE(wrong.complains_of("--kv40: '73,3'"));
  EXPECT_TRUE(wrong.complains_of("--density: '868'"));
  EXPECT_EQ(wrong.complaints.size(), 2U) << "a flag that cannot be read counts as given";
}

TEST(Arguments, RefuseZeroWhereTheServerWouldTakeTheDefault) {
  const auto history = [](const std::string& flag, const std::string& value) {
    return Outcome({"history", "-l", "paper-fluid-1", "--speed", "60", flag, value});
  };
  EXPECT_TRUE(history("--mesh-cycles", "0").complains_of("--mesh-cycles: '0'"));
  EXPECT_TRUE(history("--mesh-cycles", "2").complaints.empty());
  EXPECT_TRUE(
      Outcome({"traction", "my-oil", "--radius-y-metres", "0", "--draws", "0"}).complaints.empty())
      << "0 has a meaning there";
}

/// Returns the message for a violation of the server if the user typed these arguments.
std::string message_for(const std::vector<std::string>& arguments,
                        const FieldViolation& violation) {
  CommonOptions options;
  FlagList common_flags;
  add_common_flags(common_flags, options);
  const std::vector<Command> commands = all_commands();
  const Parsed parsed = parse_arguments(arguments, commands, common_flags);
  EXPECT_TRUE(parsed.complaints.empty()) << parsed.complaints.front();
  const ServiceError error("1 invalid value [INVALID_FIELDS]\n  " + violation.description, 3,
                           "INVALID_FIELDS", {violation}, std::nullopt);
  const std::string text = with_flag_names(error, parsed.typed_flags).what();
  return text.substr(text.find('\n') + 3);
}

TEST(ServerErrors, NameTheFlagOfASettingOfARig) {
  const FieldViolation load = {"grid.loads_newtons[1]",
                               "loads_newtons = -5 N; allowed: 1e-6 to 1e6 N"};
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"traction", "my-oil", "--load", "35,-5"},
        {"traction", "my-oil", "--load", "35", "--load", "-5"}}) {
    EXPECT_EQ(message_for(arguments, load), "--load = -5 N; allowed: 1e-6 to 1e6 N");
  }
  EXPECT_EQ(message_for({"screen", "--lubricants", "a,b", "--rig", "traction", "--srr", "5,900"},
                        {"campaign.rig.grid.slide_roll_ratios_percent[1]",
                         "slide_roll_ratios_percent = 900 %; allowed: -200 to 200 %"}),
            "--srr = 900 %; allowed: -200 to 200 %");
  EXPECT_EQ(message_for({"film", "my-oil", "--pressure", "0.5GPa,2kPa"},
                        {"grid.mean_pressures_pascals[1]",
                         "mean_pressures_pascals = 2000 Pa; allowed: 10000 to 1e11 Pa"}),
            "--pressure 2kPa = 2000 Pa; allowed: 10000 to 1e11 Pa");
}

TEST(ServerErrors, NameTheArgumentThatIsWrong) {
  EXPECT_EQ(message_for({"lubricants", "create", "my oil", "--kv40", "100"},
                        {"lubricant_id", "\"my oil\"; did you mean \"my-oil\"?"}),
            "NAME: \"my oil\"; did you mean \"my-oil\"?");
  const FieldViolation column = {"objective.figure.column",
                                 "no such column here; did you mean \"cost\"?"};
  EXPECT_EQ(message_for({"campaigns", "rank", "12", "--least", "cots"}, column),
            "--least cots: no such column here; did you mean \"cost\"?");
  EXPECT_EQ(message_for({"campaigns", "rank", "12", "--where", "cost<=3", "--where", "cots<=3"},
                        {"constraints[1].figure.column", column.description}),
            "--where cots<=3: no such column here; did you mean \"cost\"?");
}

TEST(Arguments, RangesAndUncertaintiesAreOfParameters) {
  for (const std::string flag : {"--range", "--uncertainty"}) {
    const std::string value = flag == "--range" ? "=0.1:0.2" : "=10%";
    const auto complains = [&](const std::string& parameter, const std::string& part) {
      return Outcome({"screen", "--like", "my-oil", "--count", "9", flag, parameter + value})
          .complains_of(part);
    };
    EXPECT_TRUE(complains("asperity-frictoin-coefficient", "asperity-friction-coefficient"));
    EXPECT_TRUE(complains("cost", "'cost'"));
    EXPECT_FALSE(complains("surface.asperity_friction_coefficient", "friction"));
  }
}

TEST(ServerErrors, NameTheTypedFlagAndTheCorrectSpelling) {
  const FieldViolation density = {
      "lubricant.measurements.density_15_celsius_kilograms_per_cubic_metre",
      "density_15_celsius_kilograms_per_cubic_metre = 0.895 kg/m3; allowed: 500 to 2000 kg/m3 (eq "
      "26)"};
  EXPECT_EQ(
      message_for({"lubricants", "create", "x", "--density15", "0.895"}, density),
      "--density15 = 0.895 kg/m3; allowed: 500 to 2000 kg/m3 (eq 26); 0.895 looks like g/cm3: "
      "write 0.895g/cm3 or 895");
  EXPECT_EQ(message_for({"lubricants", "create", "x", "--kv40", "100"}, density),
            density.description);
  EXPECT_EQ(message_for({"point", "-l", "paper-fluid-1", "--speed=-5"},
                        {"simulation.operating_point.cruise.speed_kilometres_per_hour",
                         "speed_kilometres_per_hour = -5 km/h; allowed: 0.1 to 400 km/h (eq 7)"}),
            "--speed = -5 km/h; allowed: 0.1 to 400 km/h (eq 7)");
  EXPECT_EQ(message_for({"curve", "-l", "paper-fluid-1", "--speed", "20,900"},
                        {"simulation.inefficiency_curve.speeds_kilometres_per_hour[1]",
                         "speeds_kilometres_per_hour = 900 km/h; allowed: 0.1 to 400 km/h (eq 7)"}),
            "--speed = 900 km/h; allowed: 0.1 to 400 km/h (eq 7)");
  EXPECT_EQ(message_for({"lubricants", "create", "x", "--kv40", "1", "--brookfield", "-40=9",
                         "--brookfield", "-400=9"},
                        {"lubricant.measurements.brookfield_viscosities[1].temperature_celsius",
                         "temperature_celsius = -400 C; allowed: -70 to 200 C (eq 34)"}),
            "--brookfield -400=9: temperature_celsius = -400 C; allowed: -70 to 200 C (eq 34)");
}

TEST(ResultFiles, AreCheckedBeforeAnythingIsComputed) {
  const auto complains = [](const std::string& line, const std::string& part) {
    return Outcome(split(line, ' ')).complains_of(part);
  };
  EXPECT_TRUE(complains("curve -l a --plot out.png", "--plot out.svg"));
  EXPECT_TRUE(complains("history -l a --speed 3 --plot a.b/out.PDF", "a.b/out.svg"));
  EXPECT_FALSE(complains("curve -l a --plot /dev/null", ""));
  for (const std::string flag : {"--plot", "--csv", "--npy"}) {
    EXPECT_TRUE(complains("history -l a --speed 3 " + flag + " /nonexistent/x.svg", flag + ": "));
  }
  EXPECT_TRUE(complains("curve -l a --csv /tmp", "/tmp"));
  std::string many = "curve --plot x.svg";
  for (int i = 0; i < 25; ++i) many += " -l " + std::to_string(i);
  EXPECT_TRUE(complains(many, "25 "));
}

TEST(Help, IsShortWithoutHelpAll) {
  constexpr std::size_t kMostOptions = 15;
  FlagList common_flags;
  CommonOptions options;
  add_common_flags(common_flags, options);
  const auto lines_with = [](const std::string& text, const std::string& start) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("\n" + start, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  for (const Command& command : all_commands()) {
    const std::string brief = help_text(command, common_flags, nullptr, HelpLength::kShort);
    const std::string whole = help_text(command, common_flags, nullptr, HelpLength::kAll);
    EXPECT_LE(lines_with(brief, "  -"), kMostOptions) << command.path;
    EXPECT_NE(brief.find("\n  tribodyn " + command.path), std::string::npos) << "examples";
    for (const Flag& flag : command.flags.flags()) {
      EXPECT_FALSE(flag.description.empty()) << flag.names;
      if (flag.is_hidden || flag.is_positional()) continue;
      EXPECT_NE(whole.find("\n  " + flag.first_name()), std::string::npos)
          << command.path << " " << flag.names;
    }
    EXPECT_NE(whole.find("\n  --server"), std::string::npos) << command.path;
    EXPECT_EQ(brief.find("--as-published"), std::string::npos) << "concerns only the paper";
  }
  EXPECT_TRUE(Outcome({"curve", "--help-all"}).wants_all_help);
  EXPECT_FALSE(Outcome({"curve", "--help"}).wants_all_help);
}

TEST(Help, EveryMainFlagIsAFlagOfItsCommand) {
  for (const Command& command : all_commands()) {
    for (const std::string& name : command.main_flags) {
      if (command.path.ends_with(" import")) continue;  // all kinds share one list
      const auto& flags = command.flags.flags();
      EXPECT_TRUE(std::any_of(flags.begin(), flags.end(),
                              [&](const Flag& flag) {
                                return ("," + flag.names + ",").find("," + name + ",") !=
                                       std::string::npos;
                              }))
          << command.path << " " << name;
    }
  }
}

}  // namespace
}  // namespace tribodyn::client
