// Tests the client library with a real tribodynd on a free port of loopback.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tribodyn/client/connection.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <regex>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "client/cpp/commands/arguments.h"
#include "client/cpp/commands/help_topics.h"
#include "client/cpp/resources/kind.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "tests/service/server_process.h"

namespace tribodyn::client {
namespace {

constexpr int kNotFound = 5;
constexpr int kAborted = 10;

class Library : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::filesystem::temp_directory_path() /
              ("tribodyn_library_test." + std::to_string(getpid()));
    std::filesystem::create_directory(folder_);
    const std::string port_file = folder_ / "port";
    process_ = std::make_unique<server::ServerProcess>(
        std::vector<std::string>{"--listen", "127.0.0.1:0", "--database", folder_ / "db.sqlite",
                                 "--port-file", port_file},
        folder_ / "log");
    address_ = server::wait_for_address(port_file, *process_);
    ASSERT_FALSE(address_.empty()) << process_->log();
  }
  static void TearDownTestSuite() {
    process_.reset();
    std::filesystem::remove_all(folder_);
  }

  static inline std::string address_;
  Connection connection{address_};

 private:
  static inline std::filesystem::path folder_;
  static inline std::unique_ptr<server::ServerProcess> process_;
};

v1::Lubricant data_sheet() {
  v1::Lubricant fluid;
  auto& measured = *fluid.mutable_measurements();
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(73.3);
  measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(8.86);
  measured.set_density_15_celsius_kilograms_per_cubic_metre(870);
  return fluid;
}

template <class Call>
ServiceError refused(const Call& call) {
  try {
    call();
  } catch (const ServiceError& error) {
    EXPECT_EQ(error.kind(), ServiceError::Kind::kRefused) << error.what();
    return error;
  }
  ADD_FAILURE() << "the call succeeded";
  return {ServiceError::Kind::kRefused, ""};
}

TEST_F(Library, EveryRevisionOfALubricantIsReadable) {
  const v1::Lubricant checked = connection.create(data_sheet(), "life", true);
  EXPECT_NEAR(checked.characterisation().viscosity_index(), 92, 0.5);
  EXPECT_EQ(refused([&] { connection.get<v1::Lubricant>("lubricants/life"); }).status_code(),
            kNotFound);

  v1::Lubricant fluid = connection.create(data_sheet(), "life");
  EXPECT_EQ(fluid.revision(), 1);
  const std::string first_etag = fluid.etag();
  fluid.set_display_name("changed");
  UpdateOptions options;
  options.update_mask = {"display_name"};
  EXPECT_EQ(connection.update(fluid, options).revision(), 2);
  EXPECT_EQ(refused([&] { connection.update(fluid, options); }).status_code(), kAborted);
  EXPECT_EQ(connection.get<v1::Lubricant>("lubricants/life@1").display_name(), "");

  v1::Lubricant change;
  change.set_name("lubricants/life");
  change.set_description("no mask");
  const v1::Lubricant kept = connection.update(change);
  EXPECT_EQ(kept.display_name(), "changed");
  EXPECT_TRUE(kept.has_measurements());

  const auto revisions = connection.revisions<v1::Lubricant>("lubricants/life");
  ASSERT_EQ(revisions.resources.size(), 3U);
  EXPECT_EQ(revisions.resources.front().revision(), 3);
  EXPECT_EQ(refused([&] {
              connection.remove<v1::Lubricant>("lubricants/life", first_etag);
            }).status_code(),
            kAborted);
  EXPECT_TRUE(connection.remove<v1::Lubricant>("lubricants/life").has_delete_time());
  for (const auto& each : connection.list<v1::Lubricant>().resources) {
    EXPECT_NE(each.name(), "lubricants/life");
  }
  EXPECT_FALSE(connection.undelete<v1::Lubricant>("lubricants/life").has_delete_time());
}

TEST_F(Library, ABatchWritesAllResourcesOrNone) {
  std::vector<v1::Lubricant> fluids(2, data_sheet());
  fluids[0].set_name("lubricants/batch-drained");
  fluids[0].set_derived_from("lubricants/batch-filled");
  fluids[1].set_name("lubricants/batch-filled");
  BatchOptions check;
  check.validate_only = true;
  check.read_mask = {"name"};
  const auto checked = connection.create_all(fluids, check);
  ASSERT_EQ(checked.size(), 2U);
  EXPECT_EQ(checked[1].name(), "lubricants/batch-filled");
  EXPECT_FALSE(checked[1].has_characterisation()) << "not asked for";
  const std::vector<v1::Lubricant> created = connection.create_all(fluids);
  ASSERT_EQ(created.size(), 2U);
  EXPECT_EQ(created[1].name(), "lubricants/batch-filled");
  EXPECT_EQ(created[0].name(), "lubricants/batch-drained");
  EXPECT_NEAR(created[1].characterisation().viscosity_index(), 92, 0.5);

  v1::Lubricant renamed = created[0];
  renamed.set_display_name("renamed");
  v1::Lubricant wrong = created[1];
  wrong.set_relaxation_time_seconds(-1);
  const ServiceError error = refused([&] {
    connection.update_all<v1::Lubricant>({{renamed, {"display_name"}}, {wrong, {}}});
  });
  ASSERT_EQ(error.violations().size(), 1U) << error.what();
  EXPECT_EQ(error.violations()[0].field, "requests[1].lubricant.relaxation_time_seconds");
  EXPECT_EQ(connection.get<v1::Lubricant>(renamed.name()).revision(), 1);
  v1::Lubricant other = data_sheet();
  other.set_name("lubricants/batch-new");
  BatchOptions options;
  options.allow_missing = true;
  const auto updated =
      connection.update_all<v1::Lubricant>({{renamed, {"display_name"}}, {other, {}}}, options);
  EXPECT_EQ(updated[0].revision(), 2);
  EXPECT_EQ(updated[1].revision(), 1);
}

TEST_F(Library, AllViolationsAreReportedAtOnce) {
  v1::Lubricant fluid = data_sheet();
  fluid.mutable_measurements()->set_density_15_celsius_kilograms_per_cubic_metre(0.87);
  fluid.set_thermal_conductivity_watts_per_metre_kelvin(1e6);
  const ServiceError error = refused([&] { connection.create(fluid, "wrong"); });
  EXPECT_EQ(error.violations().size(), 2U) << error.what();
  EXPECT_FALSE(error.reason().empty());
}

TEST_F(Library, AListReadsAllPages) {
  for (int i = 0; i < 12; ++i) connection.create(data_sheet(), "page-" + std::to_string(i));
  ListOptions options;
  options.filter = "name:page-";
  EXPECT_EQ(connection.list<v1::Lubricant>(options).resources.size(), 12U);
  options.limit = 5;
  options.order_by = "name desc";
  const auto some = connection.list<v1::Lubricant>(options);
  ASSERT_EQ(some.resources.size(), 5U);
  EXPECT_TRUE(some.has_more);
  EXPECT_EQ(some.resources.front().name(), "lubricants/page-9");
  options.page_token = some.next_page_token;
  options.limit = 0;
  const auto others = connection.list<v1::Lubricant>(options);
  EXPECT_EQ(others.resources.size(), 7U);
  EXPECT_EQ(others.resources.front().name(), "lubricants/page-4");
  EXPECT_TRUE(others.next_page_token.empty());
  options.order_by = "name";
  EXPECT_EQ(refused([&] { connection.list<v1::Lubricant>(options); }).violations()[0].field,
            "page_token");
}

TEST_F(Library, EveryKindCanBeCopied) {
  auto gear_set = connection.get<v1::GearSet>("gearSets/reference-axle");
  clear_output_only(gear_set);
  gear_set.set_name("");
  EXPECT_EQ(connection.create(gear_set, "copy").name(), "gearSets/copy");
  ListOptions basic;
  basic.basic = true;
  for (const auto& each : connection.list<v1::GearSet>(basic).resources) {
    EXPECT_EQ(each.flank_slots_size(), 0);
  }
  auto surface = connection.get<v1::Surface>("surfaces/run-in");
  clear_output_only(surface);
  surface.set_name("");
  EXPECT_EQ(connection.create(surface, "copy").name(), "surfaces/copy");
  auto vehicle = connection.get<v1::Vehicle>("vehicles/passenger-car");
  clear_output_only(vehicle);
  vehicle.set_name("");
  EXPECT_EQ(connection.create(vehicle, "copy").name(), "vehicles/copy");
}

TEST_F(Library, ASimulationIsWatchedUntilItEnds) {
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/paper-fluid-1");
  auto& study = *simulation.mutable_operating_point();
  study.mutable_cruise()->set_speed_kilometres_per_hour(50);
  study.set_model(v1::POINT_MODEL_QUASI_STATIC);
  CreateOptions check;
  check.validate_only = true;
  EXPECT_GT(connection.create_simulation(simulation, check).cost_estimate().processor_seconds(), 0);
  EXPECT_TRUE(connection.list_simulations().resources.empty());
  int events = 0;
  const v1::Simulation ended =
      connection.wait_for_end(connection.create_simulation(simulation).name(),
                              [&](const v1::SimulationEvent&) { ++events; });
  EXPECT_EQ(ended.state(), v1::Simulation::SUCCEEDED);
  EXPECT_GT(events, 0);
  EXPECT_EQ(ended.lubricant_revision(), "lubricants/paper-fluid-1@1");
  EXPECT_EQ(connection.list_simulations({.limit = 1}).resources.size(), 1U);
}

TEST_F(Library, TheSchedulingClassReachesTheServer) {
  v1::Simulation simulation;
  simulation.set_lubricant("lubricants/paper-fluid-1");
  simulation.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(50);
  CreateOptions options;
  options.validate_only = true;
  options.scheduling_class = v1::SCHEDULING_CLASS_INTERACTIVE;
  connection.create_simulation(simulation, options);
  options.scheduling_class = static_cast<v1::SchedulingClass>(3);
  try {
    connection.create_simulation(simulation, options);
    FAIL() << "an unknown class is accepted";
  } catch (const ServiceError& error) {
    EXPECT_NE(std::string(error.what()).find("scheduling_class = 3"), std::string::npos)
        << error.what();
  }
}

// The client derives units from the names of fields; the server's table of constraints states them.
TEST_F(Library, UnitsFromNamesAgreeWithTheServer) {
  const v1::Schema schema = connection.schema();
  EXPECT_GT(schema.constraints_size(), 80);
  int compared = 0;
  for (const v1::Constraint& row : schema.constraints()) {
    const std::string unit = unit_of_field(row.field());
    if (unit.empty()) continue;
    if (unit == "C") {  // no ratio: its zero differs
      EXPECT_EQ(row.unit(), unit) << row.field();
      continue;
    }
    EXPECT_EQ(unit_ratio(unit, row.unit() == "degrees" ? "deg" : row.unit()), 1)
        << row.message() << "." << row.field() << ": " << unit << ", server " << row.unit();
    ++compared;
  }
  EXPECT_GT(compared, 50);
  for (const ResourceKind& kind : resource_kinds()) {
    EXPECT_GT(connection.schema(kind.prototype->GetDescriptor()->name()).constraints_size(), 3);
  }
}

// Help lists lengths by stem and unit: "radius_x_metres", "each also in _millimetres".
TEST_F(Library, HelpNamesEveryColumnThatTheServerReads) {
  std::string help;
  for (const HelpTopic& topic : help_topics()) help += topic.text;
  const v1::Schema schema = connection.schema();
  int compared = 0;
  for (const v1::Vocabulary& vocabulary : schema.vocabularies()) {
    if (!vocabulary.name().ends_with("csv")) continue;
    for (const std::string& column : vocabulary.words()) {
      const std::size_t unit = column.rfind('_');
      const bool is_length = column.ends_with("metres") && unit != std::string::npos;
      const std::string stem = is_length ? column.substr(0, unit) : column;
      EXPECT_NE(help.find(stem), std::string::npos) << vocabulary.name() << " " << column;
      const std::string ending = is_length ? column.substr(unit) : "";
      EXPECT_NE(help.find(ending), std::string::npos) << column;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(LibraryAlone, AMissingServerIsAConnectionError) {
  Connection nobody("127.0.0.1:9", std::chrono::seconds(2), kDefaultProject, {});
  try {
    nobody.list<v1::Vehicle>();
    FAIL() << "a call succeeded without a server";
  } catch (const ServiceError& error) {
    EXPECT_EQ(error.kind(), ServiceError::Kind::kCannotConnect);
  }
}

v1::Simulation quick_point(double speed_kilometres_per_hour) {
  v1::Simulation out;
  out.set_lubricant("lubricants/paper-fluid-1");
  auto* point = out.mutable_operating_point();
  point->mutable_cruise()->set_speed_kilometres_per_hour(speed_kilometres_per_hour);
  return out;
}

/// Returns a simulation that runs until it is cancelled.
v1::Simulation endless_curve() {
  v1::Simulation out;
  out.set_lubricant("lubricants/paper-fluid-1");
  auto* curve = out.mutable_inefficiency_curve();
  curve->set_first_speed_kilometres_per_hour(60);
  curve->set_last_speed_kilometres_per_hour(80);
  curve->set_speed_step_kilometres_per_hour(0.0201);
  auto* solver = out.mutable_solver_options();
  solver->set_method(v1::STEADY_STATE_METHOD_MARCH);
  solver->set_march_step_tolerance(1e-11);
  solver->set_march_settling_tolerance(1e-12);
  solver->set_maximum_mesh_cycles(10'000);
  return out;
}

TEST(TurnedAway, AClientThatRetriesAfterTheRequestedPauseIsServed) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("tribodyn_turned_away_test." + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  server::ServerProcess process(
      {"--listen", "127.0.0.1:0", "--database", folder / "db.sqlite", "--port-file",
       folder / "port", "--waiting-simulations", "4", "--threads", "1"},
      folder / "log");
  const std::string address = server::wait_for_address(folder / "port", process);
  ASSERT_FALSE(address.empty()) << process.log();
  const auto until = [](const auto& holds) {
    while (!holds()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  Connection connection(address, std::chrono::seconds(120));
  const std::string endless = connection.create_simulation(endless_curve()).name();
  until([&] { return connection.get_simulation(endless).state() == v1::Simulation::RUNNING; });
  // The queue accepts three of them: one client may use three quarters of it.
  constexpr int kClients = 6;
  std::vector<v1::Simulation::State> states(kClients);
  std::vector<std::thread> clients;
  for (int i = 0; i < kClients; ++i) {
    clients.emplace_back([&, i] {
      try {
        const auto name = connection.create_simulation(quick_point(40 + i)).name();
        states[i] = connection.wait_for_end(name).state();
      } catch (const ServiceError& error) {
        ADD_FAILURE() << error.what();
      }
    });
  }
  until([&] { return process.log().find("simulation_not_added") != std::string::npos; });
  connection.cancel_simulation(endless);
  for (std::thread& client : clients) client.join();
  EXPECT_THAT(states, testing::Each(v1::Simulation::SUCCEEDED));
  std::filesystem::remove_all(folder);
}

/// A campaign of candidates with relaxation times from 1 ns on, at two speeds.
v1::Campaign campaign_of_times(int candidates) {
  v1::Campaign out;
  out.set_lubricant("lubricants/paper-fluid-1");
  v1::CandidateColumn& column = *out.add_candidate_columns();
  column.set_path("lubricant.relaxation_time_seconds");
  for (int i = 1; i <= candidates; ++i) column.add_values(1e-9 * i);
  for (const double speed : {20.0, 60.0}) {
    out.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  return out;
}

TEST_F(Library, ACampaignIsFollowedToItsEndAndReadByRanges) {
  const v1::Campaign request = campaign_of_times(700);
  const v1::Campaign checked = connection.create_campaign(request, {.validate_only = true});
  EXPECT_EQ(checked.name(), "");
  EXPECT_EQ(checked.points(), 1400);
  const v1::Campaign made = connection.create_campaign(request, {.request_id = "followed"});
  EXPECT_EQ(connection.create_campaign(request, {.request_id = "followed"}).name(), made.name());
  int looks = 0, done = 0;
  const v1::Campaign ended = connection.follow_campaign(made.name(), [&](const v1::Campaign& each) {
    ++looks;
    EXPECT_GE(each.points_done(), done);
    done = each.points_done();
  });
  EXPECT_EQ(ended.state(), v1::Campaign::SUCCEEDED);
  EXPECT_EQ(done, 1400);
  EXPECT_GE(looks, 1);
  CampaignRowsOptions part;
  part.columns = {"candidate", "inefficiency_energy_mean_percent"};
  part.start_row = 600;
  part.row_count = 700;
  std::vector<double> candidates, figures;
  v1::HistorySchema schema;
  connection.stream_campaign(
      made.name(), part, [&](const v1::HistorySchema& found) { schema = found; },
      [&](const HistoryRows& rows) {
        EXPECT_EQ(rows.first_row, static_cast<std::int64_t>(candidates.size()));
        candidates.insert(candidates.end(), rows.columns[0].begin(), rows.columns[0].end());
        figures.insert(figures.end(), rows.columns[1].begin(), rows.columns[1].end());
      });
  EXPECT_EQ(schema.total_rows(), 1400);
  ASSERT_EQ(candidates.size(), 700U);
  EXPECT_EQ(candidates.front(), 300);
  EXPECT_EQ(candidates.back(), 649);
  v1::EvaluatePointsRequest one;
  one.set_lubricant(request.lubricant());
  *one.mutable_conditions() = request.conditions();
  v1::CandidateColumn& column = *one.add_candidate_columns();
  column.set_path(request.candidate_columns(0).path());
  column.add_values(request.candidate_columns(0).values(300));
  const auto answer = connection.evaluate_points(one);
  EXPECT_NEAR(figures[0] / answer.inefficiency_energy_mean_percent(0), 1, 1e-3);
  EXPECT_EQ(connection.list_campaigns({.limit = 1}).resources.at(0).name(), made.name());
  connection.delete_campaign(made.name());
  EXPECT_EQ(refused([&] { connection.get_campaign(made.name()); }).status_code(), kNotFound);
  connection.delete_campaign(made.name(), {.allow_missing = true});
}

TEST_F(Library, ACampaignIsPausedResumedAndCancelled) {
  const v1::Campaign made = connection.create_campaign(campaign_of_times(50000));
  EXPECT_EQ(connection.pause_campaign(made.name()).state(), v1::Campaign::PAUSED);
  EXPECT_EQ(connection.follow_campaign(made.name()).stop().reason(), "PAUSE_REQUESTED");
  v1::CampaignBudget budget;
  budget.set_points(1000);
  EXPECT_EQ(connection.resume_campaign(made.name(), budget).state(), v1::Campaign::RUNNING);
  const v1::Campaign spent = connection.follow_campaign(made.name());
  EXPECT_EQ(spent.stop().reason(), "BUDGET_SPENT");
  EXPECT_GE(spent.points_done(), 1000);
  std::stop_source stop;
  connection.resume_campaign(made.name(), v1::CampaignBudget());
  const v1::Campaign running = connection.follow_campaign(
      made.name(), [&](const v1::Campaign&) { stop.request_stop(); }, stop.get_token());
  EXPECT_EQ(running.state(), v1::Campaign::RUNNING);
  EXPECT_EQ(connection.cancel_campaign(made.name()).state(), v1::Campaign::CANCELLED);
  EXPECT_TRUE(has_ended(connection.follow_campaign(made.name()).state()));
  connection.delete_campaign(made.name());
}

/// The bounds in "... allowed: 0.1 to 400 km/h"; empty if there are none.
std::vector<double> range_in(const std::string& text) {
  static const std::regex kRange("[Aa]llowed: (?:0, or )?([-+.0-9e]+) to ([-+.0-9e]+)");
  std::smatch found;
  if (!std::regex_search(text, found, kRange)) return {};
  return {std::stod(found[1]), std::stod(found[2].str())};
}

/// Returns the range that the server states when a number of the flag is above `highest`; empty if
/// the server does not refuse it.
std::vector<double> refused_range(const std::string& address, const std::string& path,
                                  std::vector<std::string> words, const std::string& flag,
                                  double highest) {
  const auto given = std::find(words.begin(), words.end(), flag);
  if (given != words.end()) words.erase(given, given + 2);
  words.insert(words.end(), {flag, shortest(highest + 2)});
  CommonOptions options;
  options.server = address;
  FlagList common_flags;
  add_common_flags(common_flags, options);
  std::vector<Command> commands = all_commands();
  std::erase_if(commands, [&](const Command& each) { return each.path != path; });
  const Parsed parsed = parse_arguments(words, commands, common_flags);
  if (!parsed.complaints.empty()) return {};
  options.typed_flags = parsed.typed_flags;
  std::string error;
  try {
    parsed.command->run(options);
  } catch (const ServiceError& refusal) {
    error = with_flag_names(refusal, parsed.typed_flags).what();
  } catch (const Failure& failure) {
    error = failure.what();
  }
  const std::size_t line = error.find("\n  " + flag + " ");
  if (line == std::string::npos) return {};
  return range_in(error.substr(line + 1, error.find('\n', line + 1) - line - 1));
}

// One number above the range of every flag that states one: the server states the same range.
TEST_F(Library, RangesInTheHelpAreThoseOfTheServer) {
  const std::string campaign = connection.create_campaign(campaign_of_times(3)).name();
  connection.follow_campaign(campaign);
  const std::string points =
      " paper-fluid-1 paper-fluid-2 --speed-kilometres-per-hour 50"
      " --sump-temperature-celsius 40 --condition-weights 1";
  const std::string screened = "screen --lubricants paper-fluid-1,paper-fluid-2";
  const std::vector<std::string> lines = {
      "point -l paper-fluid-1 --speed-kilometres-per-hour 50",
      "point -l paper-fluid-1 --pinion-torque-newton-metres 1 --pinion-speed-radians-per-second 1",
      "history -l paper-fluid-1 --speed-kilometres-per-hour 50",
      "history -l paper-fluid-1 --pinion-torque-newton-metres 1"
      " --pinion-speed-radians-per-second 1",
      "spectrum -l paper-fluid-1 --speed-kilometres-per-hour 50",
      "spectrum -l paper-fluid-1 --pinion-torque-newton-metres 1"
      " --pinion-speed-radians-per-second 1",
      "curve -l paper-fluid-1",
      "report paper-fluid-1 --html /dev/null",
      "compare" + points,
      "explain" + points,
      screened + " --speed-kilometres-per-hour 50 --uncertainty pressure-viscosity=5%",
      screened + " --rig traction",
      "sensitivities paper-fluid-1 --speed-kilometres-per-hour 50",
      "sensitivities paper-fluid-1 --pinion-torque-newton-metres 1"
      " --pinion-speed-radians-per-second 1",
      "contact",
      "viscosity paper-fluid-1",
      "traction paper-fluid-1",
      "film paper-fluid-1",
      "stribeck paper-fluid-1",
      "cycle paper-fluid-1",
      "campaigns rank " + campaign,
      "campaigns pareto " + campaign + " --least mesh_loss_power_watts",
      "campaigns effects " + campaign,
      "campaigns resume " + campaign,
  };
  std::set<std::string> own;  // flags with a range that the server does not state
  int compared = 0;
  for (const Command& command : all_commands()) {
    for (const Flag& flag : command.flags.flags()) {
      const std::vector<double> stated = range_in(flag.description);
      if (stated.empty()) continue;
      std::vector<double> range;
      for (const std::string& line : lines) {
        if (!range.empty() || !(line + " ").starts_with(command.path + " ")) continue;
        range =
            refused_range(address_, command.path, split(line, ' '), flag.first_name(), stated[1]);
      }
      if (range.empty()) {
        own.insert(flag.first_name());
        continue;
      }
      EXPECT_EQ(range, stated) << command.path << " " << flag.first_name();
      ++compared;
    }
  }
  std::cout << compared << " ranges compared\n";
  // The client itself checks or scales these; the budgets apply to existing campaigns.
  EXPECT_EQ(own, (std::set<std::string>{"--budget-points", "--budget-processor-seconds",
                                        "--condition-weights", "--confidence", "--count",
                                        "--levels", "--limit", "--map-tolerance", "--seed",
                                        "--sump-weights", "--top"}));
  EXPECT_GE(compared, 190);
}

}  // namespace
}  // namespace tribodyn::client
