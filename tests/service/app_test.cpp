// Tests of the whole service without gRPC.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "core/periodic/orbit_sensitivity.h"
#include "core/study/history.h"
#include "core/study/warning_kinds.h"
#include "google/rpc/error_details.pb.h"
#include "proto/field_behavior.h"
#include "server/application/contacts.h"
#include "server/application/errors.h"
#include "server/application/schemas.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"
#include "server/contract/constraints.h"
#include "server/scheduling/janitor.h"
#include "server/storage/maintenance.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

class AppTest : public testing::Test {
 protected:
  template <class Request>
  Request named(const std::string& name) const {
    Request request;
    request.set_name(name);
    return request;
  }

  std::string finished(const v1::Simulation& simulation) {
    std::string name = bench_.create(simulation);
    EXPECT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
    return name;
  }

  Bench bench_;
  Application app_ = bench_.application();
};

TEST_F(AppTest, EveryErrorHasAReasonInErrorInfo) {
  for (const auto& status :
       {get_lubricant(app_, named<v1::GetLubricantRequest>("lubricants/paper-fluid-9")).error(),
        get_gear_set(app_, named<v1::GetGearSetRequest>("x")).error(),
        create_simulation(app_, {}).error(),
        get_simulation(app_, named<v1::GetSimulationRequest>("simulations/77")).error(),
        cancel_simulation(app_, named<v1::CancelSimulationRequest>("")).error(),
        watch_simulation(app_, named<v1::WatchSimulationRequest>("simulations/0")).error(),
        read_history(app_, named<v1::ReadHistoryRequest>("simulations/77")).error(),
        evaluate_contact(app_, {}).error(), shutting_down(),
        exhausted(v1::ERROR_REASON_TOO_MANY_STREAMS, "later", 1)}) {
    const auto info = detail<google::rpc::ErrorInfo>(status);
    ASSERT_TRUE(info) << status.message();
    EXPECT_EQ(info->domain(), kErrorDomain);
    v1::ErrorReason reason = v1::ERROR_REASON_UNSPECIFIED;
    EXPECT_TRUE(v1::ErrorReason_Parse("ERROR_REASON_" + info->reason(), &reason))
        << info->reason() << " is not in the contract";
    if (reason != v1::ERROR_REASON_SHUTTING_DOWN) {
      EXPECT_FALSE(info->metadata().empty()) << status.message();
    }
    EXPECT_NE(status.code(), google::rpc::OK);
    EXPECT_FALSE(status.message().empty());
  }
}

TEST_F(AppTest, TheSchemaDescribesEveryColumnOfResults) {
  const auto schema = get_schema(app_, {}, {});
  ASSERT_TRUE(schema.ok());
  int figures = 0, columns = 0, known = 0;
  for (const v1::ColumnDescription& column : schema.message().columns()) {
    EXPECT_NE(column.description(), "") << column.name();
    (column.table() == "PointResult" ? figures : columns) += 1;
    if (column.name() == "mesh_loss_power_watts" ||
        column.name() == "flank_losses_2_viscous_watts") {
      EXPECT_EQ(column.unit(), "W");
      ++known;
    }
    if (column.name() == "flank_losses_0_friction_coefficient" ||
        column.name() == "pinion_specific_sliding") {
      EXPECT_EQ(column.unit(), "");
      ++known;
    }
  }
  EXPECT_GT(figures, 30);
  EXPECT_EQ(columns, kHistoryColumns);
  EXPECT_EQ(known, 5);
}

TEST_F(AppTest, ResultsNameTheLimitsOfTheirFiguresAndThoseThatAreStated) {
  v1::Simulation simulation = point_simulation();
  const std::string plain = finished(simulation);
  v1::StatedLimits& stated = *simulation.mutable_stated_limits();
  stated.set_pressure_limit_pascals(1.8e9);
  stated.set_contact_temperature_limit_celsius(180);
  stated.set_limit_source("FZG A/8.3/90");
  const std::string limited = finished(simulation);
  const auto limits = [&](const std::string& name) {
    std::map<std::string, std::vector<v1::FigureLimit>> out;
    const v1::Simulation ended = bench_.get(name);
    for (const auto& each : ended.result().limits()) out[each.figure()].push_back(each);
    return out;
  };
  EXPECT_EQ(limits(plain)["film_ratio.minimum"].size(), 2U);
  EXPECT_EQ(limits(plain)["maximum_pressure_pascals.maximum"].size(), 1U);
  const auto pressure = limits(limited)["maximum_pressure_pascals.maximum"];
  ASSERT_EQ(pressure.size(), 2U);
  EXPECT_EQ(pressure[1].maximum(), 1.8e9);
  EXPECT_FALSE(pressure[1].has_minimum());
  EXPECT_EQ(pressure[1].source(), "stated: FZG A/8.3/90");
  EXPECT_EQ(limits(limited)["contact_temperature_kelvin.maximum"].back().maximum(), 453.15);
  EXPECT_EQ(bench_.get(limited).result().input_hash(), bench_.get(plain).result().input_hash())
      << "limits change no figure";
}

TEST_F(AppTest, AStatedLimitOutsideItsRangeIsRefused) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  request.mutable_simulation()->mutable_stated_limits()->set_pressure_limit_pascals(-1);
  const auto status = create_simulation(app_, request).error();
  EXPECT_EQ(status.code(), google::rpc::INVALID_ARGUMENT);
  EXPECT_EQ(detail<google::rpc::BadRequest>(status)->field_violations(0).field(),
            "simulation.stated_limits.pressure_limit_pascals");
}

TEST_F(AppTest, MetadataHasTheVariablesOfAMessage) {
  const auto metadata = [](const google::rpc::Status& status) {
    const auto info = detail<google::rpc::ErrorInfo>(status).value_or(google::rpc::ErrorInfo());
    std::map<std::string, std::string> out(info.metadata().begin(), info.metadata().end());
    out["reason"] = info.reason();
    return out;
  };
  using testing::IsSupersetOf;
  using testing::Pair;
  EXPECT_THAT(
      metadata(get_simulation(app_, named<v1::GetSimulationRequest>("simulations/77")).error()),
      testing::UnorderedElementsAre(Pair("reason", "NOT_FOUND"), Pair("name", "simulations/77")));
  EXPECT_THAT(metadata(create_simulation(app_, {}).error()),
              testing::UnorderedElementsAre(Pair("reason", "INVALID_FIELDS"),
                                            Pair("field", "simulation"), Pair("violations", "1")));
  v1::UpdateLubricantRequest stale;
  stale.mutable_lubricant()->set_name("lubricants/paper-fluid-1");
  stale.mutable_lubricant()->set_etag("0123");
  EXPECT_THAT(metadata(update_lubricant(app_, stale).error()),
              testing::UnorderedElementsAre(Pair("reason", "ETAG_MISMATCH"),
                                            Pair("name", "lubricants/paper-fluid-1"),
                                            Pair("etag", "0123")));
  EXPECT_THAT(metadata(exhausted(v1::ERROR_REASON_TOO_MANY_WAITING, "later", 0.25)),
              testing::UnorderedElementsAre(Pair("reason", "TOO_MANY_WAITING"),
                                            Pair("retry_seconds", "0.25")));
  const std::string name = finished(point_simulation());
  const auto without = read_history(app_, named<v1::ReadHistoryRequest>(name)).error();
  EXPECT_THAT(metadata(without), testing::UnorderedElementsAre(Pair("reason", "NO_HISTORY"),
                                                               Pair("name", name + "/history")));
  const auto resource = detail<google::rpc::ResourceInfo>(without);
  ASSERT_TRUE(resource);
  EXPECT_EQ(resource->resource_type(), "tribodyn.v1.History");
  EXPECT_EQ(resource->resource_name(), name + "/history");
}

TEST_F(AppTest, ResourcesAreReadAndListed) {
  EXPECT_EQ(get_lubricant(app_, named<v1::GetLubricantRequest>("lubricants/paper-fluid-2"))
                .message()
                .vogel_temperature_coefficient_kelvin(),
            1105);
  EXPECT_EQ(get_gear_set(app_, named<v1::GetGearSetRequest>("gearSets/reference-axle-loaded-error"))
                .message()
                .gear_teeth(),
            36);
  EXPECT_EQ(get_surface(app_, named<v1::GetSurfaceRequest>("surfaces/run-in")).message().name(),
            "surfaces/run-in");
  EXPECT_EQ(list_vehicles(app_, v1::ListVehiclesRequest()).message().vehicles_size(), 1);
  EXPECT_EQ(list_surfaces(app_, v1::ListSurfacesRequest()).message().surfaces_size(), 1);
  EXPECT_EQ(list_gear_sets(app_, v1::ListGearSetsRequest()).message().gear_sets_size(), 3);
}

TEST_F(AppTest, ListsArePaged) {
  v1::ListLubricantsRequest request;
  request.set_page_size(2);
  const auto first = list_lubricants(app_, request).message();
  ASSERT_EQ(first.lubricants_size(), 2);
  ASSERT_FALSE(first.next_page_token().empty());
  request.set_page_token(first.next_page_token());
  const auto second = list_lubricants(app_, request).message();
  ASSERT_EQ(second.lubricants_size(), 2);
  EXPECT_EQ(second.lubricants(0).name(), "lubricants/paper-fluid-3");
  EXPECT_TRUE(second.next_page_token().empty());
  request.set_page_token("nonsense");
  request.set_page_size(-1);
  const auto bad = detail<google::rpc::BadRequest>(list_lubricants(app_, request).error());
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->field_violations_size(), 2);
}

TEST_F(AppTest, AnUnknownNameIsNotFoundAndTheNearestOneIsSuggested) {
  const auto status =
      get_lubricant(app_, named<v1::GetLubricantRequest>("lubricants/paper-fluid-33")).error();
  EXPECT_EQ(status.code(), google::rpc::NOT_FOUND);
  EXPECT_THAT(status.message(), testing::HasSubstr("lubricants/paper-fluid-3"));
  EXPECT_EQ(detail<google::rpc::ResourceInfo>(status)->resource_name(),
            "lubricants/paper-fluid-33");
}

TEST_F(AppTest, ASimulationIsAcceptedListedAndRead) {
  const std::string first = finished(point_simulation());
  const std::string second = finished(curve_simulation());
  v1::ListSimulationsRequest request;
  request.set_page_size(1);
  const auto page = list_simulations(app_, request).message();
  ASSERT_EQ(page.simulations_size(), 1);
  EXPECT_EQ(page.simulations(0).name(), second) << "newest first";
  EXPECT_FALSE(page.simulations(0).has_result());
  request.set_page_token(page.next_page_token());
  EXPECT_EQ(list_simulations(app_, request).message().simulations(0).name(), first);
  const v1::Simulation curve = bench_.get(second);
  EXPECT_EQ(curve.result().points_size(), 13);
  EXPECT_EQ(curve.result().direction(), v1::SWEEP_DIRECTION_UP);
  EXPECT_TRUE(curve.has_create_time() && curve.has_start_time() && curve.has_end_time());
  EXPECT_EQ(curve.inefficiency_curve().speed_step_kilometres_per_hour(), 10) << "as requested";
}

/// A history that was read: its schema and its complete columns.
struct ReadHistory {
  v1::HistorySchema schema;
  std::vector<std::vector<double>> columns;
  std::vector<v1::HistoryChunk> chunks;
};

ReadHistory read_all(const StreamOutcome<v1::ReadHistoryResponse>& outcome) {
  ReadHistory out;
  v1::ReadHistoryResponse part;
  while (outcome.message()->next(part) == MessageSource<v1::ReadHistoryResponse>::Step::kMessage) {
    if (part.has_schema()) {
      EXPECT_TRUE(out.chunks.empty());
      out.schema = part.schema();
      out.columns.resize(out.schema.columns_size());
      continue;
    }
    const v1::HistoryChunk& chunk = part.chunk();
    std::vector<double>& column = out.columns.at(chunk.column());
    EXPECT_EQ(chunk.first_row(), column.size());
    const std::size_t count = chunk.values().size() / sizeof(double);
    column.resize(column.size() + count);
    std::memcpy(column.data() + column.size() - count, chunk.values().data(),
                chunk.values().size());
    out.chunks.push_back(chunk);
  }
  EXPECT_EQ(outcome.message()->error().code(), 0);
  for (const auto& column : out.columns) EXPECT_EQ(column.size(), out.schema.row_count());
  return out;
}

v1::Simulation with_history(int cycles, int samples) {
  v1::Simulation simulation = point_simulation();
  v1::HistoryRequest* history = simulation.mutable_operating_point()->mutable_history();
  history->add_columns("mesh_force_newtons");
  history->add_columns("flank_load_newtons");
  history->set_mesh_cycles(cycles);
  history->set_samples_per_mesh_cycle(samples);
  return simulation;
}

v1::Simulation labelled(const std::string& project, double speed) {
  v1::Simulation out = point_simulation();
  out.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(speed);
  v1::Label* label = out.add_labels();
  label->set_key("project");
  label->set_value(project);
  return out;
}

TEST_F(AppTest, SimulationsAreFoundByStateLubricantTimeAndLabel) {
  const std::string axle = finished(labelled("axle", 30));
  const std::string other = finished(labelled("other", 31));
  const std::string curve = finished(curve_simulation());
  const auto names = [&](const std::string& filter, const std::string& order = "") {
    v1::ListSimulationsRequest request;
    request.set_filter(filter);
    request.set_order_by(order);
    std::vector<std::string> out;
    const auto page = list_simulations(app_, request);
    EXPECT_TRUE(page.ok()) << filter << ": " << page.error().message();
    for (const auto& each : page.message().simulations()) out.push_back(each.name());
    return out;
  };
  using testing::ElementsAre;
  EXPECT_THAT(names(""), ElementsAre(curve, other, axle));
  EXPECT_THAT(names("", "create_time"), ElementsAre(axle, other, curve));
  EXPECT_THAT(names("labels.project = axle"), ElementsAre(axle));
  EXPECT_THAT(names("labels.project:*", "create_time asc"), ElementsAre(axle, other));
  EXPECT_THAT(names("labels.project != axle"), ElementsAre(curve, other));
  EXPECT_THAT(names("lubricant = \"lubricants/paper-fluid-2\""), ElementsAre(curve));
  EXPECT_THAT(names("lubricant = \"lubricants/paper-fluid-1@1\" AND state = SUCCEEDED"),
              ElementsAre(other, axle));
  EXPECT_THAT(names("state = FAILED"), ElementsAre());
  EXPECT_THAT(names("state = succeeded AND lubricant = paper-fluid-2"), ElementsAre(curve));
  EXPECT_THAT(names("lubricant != paper-fluid-2"), ElementsAre(other, axle));
  v1::PinSimulationRequest pin;
  pin.set_name(other);
  ASSERT_TRUE(pin_simulation(app_, pin).ok());
  EXPECT_THAT(
      names("gear_set = reference-axle AND surface = run-in AND vehicle = passenger-car").size(),
      3U);
  EXPECT_THAT(names("gear_set = reference-axle-loaded-error"), ElementsAre());
  EXPECT_THAT(names("gear_set != gearSets/reference-axle-loaded-error@1").size(), 3U);
  EXPECT_THAT(names("end_time > 2020-01-01T00:00:00Z").size(), 3U);
  EXPECT_THAT(names("end_time > 2199-01-01T00:00:00Z"), ElementsAre());
  EXPECT_THAT(names("end_time:*").size(), 3U);
  EXPECT_THAT(names("input_hash = " + bench_.get(curve).input_hash()), ElementsAre(curve));
  v1::Simulation titled = point_simulation();
  titled.set_display_name("Blend 7, hot");
  const std::string hot = finished(titled);
  EXPECT_THAT(names("display_name = \"Blend 7, hot\""), ElementsAre(hot));
  EXPECT_THAT(names("display_name:blend"), ElementsAre(hot));
  EXPECT_THAT(names("display_name != \"Blend 7, hot\"").size(), 3U);
  EXPECT_THAT(names("display_name:x AND state = FAILED"), ElementsAre());
  EXPECT_THAT(names("pinned = true"), ElementsAre(other));
  EXPECT_THAT(names("pinned = false"), ElementsAre(hot, curve, axle));
  EXPECT_EQ(names("create_time > 2020-01-01T00:00:00Z AND state != QUEUED").size(), 4U);
  EXPECT_THAT(names("create_time > 2199-01-01T00:00:00Z"), ElementsAre());
  v1::ListSimulationsRequest bad;
  for (const char* filter :
       {"state > FAILED", "stat = FAILED", "state = FAILD", "name = x", "pinned = maybe",
        "pinned > false", "gear_set > A", "input_hash:a", "display_name > a"}) {
    bad.set_filter(filter);
    EXPECT_EQ(list_simulations(app_, bad).error().code(), google::rpc::INVALID_ARGUMENT) << filter;
  }
  bad.set_filter("state = DONE");
  const std::string said = list_simulations(app_, bad).error().message();
  EXPECT_THAT(said, testing::HasSubstr("allowed: QUEUED, RUNNING"));
  EXPECT_THAT(said, testing::Not(testing::HasSubstr("UNSPECIFIED")));
  bad.set_filter("");
  bad.set_order_by("end_time");
  EXPECT_EQ(list_simulations(app_, bad).error().code(), google::rpc::INVALID_ARGUMENT);
}

TEST_F(AppTest, AListOfFullViewsHasResultsAndEverySimulationOnce) {
  std::vector<std::string> expected;
  for (int i = 0; i < 7; ++i) expected.push_back(finished(labelled("axle", 40 + i)));
  std::reverse(expected.begin(), expected.end());
  v1::ListSimulationsRequest request;
  request.set_page_size(3);
  request.set_filter("labels.project = axle");
  request.set_view(v1::SIMULATION_VIEW_FULL);
  std::vector<std::string> names;
  do {
    const auto page = list_simulations(app_, request).message();
    for (const auto& each : page.simulations()) {
      EXPECT_TRUE(each.has_result());
      names.push_back(each.name());
    }
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  EXPECT_EQ(names, expected);
  request.set_filter("");
  request.set_page_token(list_simulations(app_, request).message().next_page_token());
  request.set_filter("state = SUCCEEDED");
  EXPECT_EQ(list_simulations(app_, request).error().code(), google::rpc::INVALID_ARGUMENT)
      << "a token belongs to its filter";
}

TEST_F(AppTest, AListHasSimulationsAsTheyAreReadOneByOne) {
  for (const char* lubricant : {"lubricants/paper-fluid-1", "lubricants/paper-fluid-2"}) {
    for (const double speed : {40.0, 60.0}) {
      v1::Simulation simulation = labelled("axle", speed);
      simulation.set_lubricant(lubricant);
      finished(simulation);
    }
  }
  std::set<std::string> lubricants;
  const auto page = list_simulations(app_, {}).message();
  for (const v1::Simulation& listed : page.simulations()) {
    auto request = named<v1::GetSimulationRequest>(listed.name());
    request.set_view(v1::SIMULATION_VIEW_BASIC);
    EXPECT_EQ(listed.SerializeAsString(),
              get_simulation(app_, request).message().SerializeAsString());
    lubricants.insert(listed.lubricant_revision());
  }
  EXPECT_EQ(lubricants,
            (std::set<std::string>{"lubricants/paper-fluid-1@1", "lubricants/paper-fluid-2@1"}));
}

TEST_F(AppTest, AListTellsHowManyThereAreInAll) {
  for (int i = 0; i < 5; ++i) finished(labelled(i < 3 ? "axle" : "other", 40 + i));
  v1::ListSimulationsRequest request;
  request.set_page_size(2);
  EXPECT_EQ(list_simulations(app_, request).message().total_size(), 5);
  request.set_filter("labels.project = axle");
  auto page = list_simulations(app_, request).message();
  EXPECT_EQ(page.simulations_size(), 2);
  EXPECT_EQ(page.total_size(), 3);
  request.set_page_token(page.next_page_token());
  page = list_simulations(app_, request).message();
  EXPECT_EQ(page.simulations_size(), 1);
  EXPECT_EQ(page.total_size(), 3) << "of the whole list";
  request.clear_page_token();
  request.set_filter("labels.project = none");
  EXPECT_EQ(list_simulations(app_, request).message().total_size(), 0);
}

TEST_F(AppTest, ASimulationIsRenamedAndLabelledAnew) {
  const std::string name = finished(labelled("axle", 40));
  const v1::Simulation before = bench_.get(name);
  v1::UpdateSimulationRequest request;
  request.mutable_simulation()->set_name(name);
  request.mutable_simulation()->set_etag(before.etag());
  request.mutable_simulation()->set_display_name("hot");
  const auto renamed = update_simulation(app_, request);
  ASSERT_TRUE(renamed.ok()) << complaints(renamed.error());
  EXPECT_EQ(renamed.message().display_name(), "hot");
  EXPECT_EQ(renamed.message().labels_size(), 1) << "an omitted mask leaves what is not stated";
  EXPECT_NE(renamed.message().etag(), before.etag());
  EXPECT_EQ(update_simulation(app_, request).error().code(), google::rpc::ABORTED);

  v1::Simulation changed = bench_.get(name);
  changed.clear_display_name();
  changed.mutable_labels(0)->set_value("van");
  *request.mutable_simulation() = changed;
  request.mutable_update_mask()->add_paths("*");
  ASSERT_TRUE(update_simulation(app_, request).ok());
  const v1::Simulation after = bench_.get(name);
  EXPECT_EQ(after.display_name(), "");
  EXPECT_EQ(after.input_hash(), before.input_hash());
  EXPECT_EQ(after.result().SerializeAsString(), before.result().SerializeAsString());
  v1::ListSimulationsRequest list;
  list.set_filter("labels.project = van");
  EXPECT_EQ(list_simulations(app_, list).message().total_size(), 1);
  list.set_filter("labels.project = axle");
  EXPECT_EQ(list_simulations(app_, list).message().total_size(), 0);

  request.mutable_simulation()->clear_etag();
  request.mutable_update_mask()->set_paths(0, "lubricant");
  EXPECT_THAT(complaints(update_simulation(app_, request).error()),
              testing::HasSubstr("update_mask: \"lubricant\" cannot be changed; allowed: "
                                 "display_name, labels"));
  request.mutable_update_mask()->set_paths(0, "display_name");
  request.mutable_simulation()->set_display_name(std::string(1000, 'x'));
  EXPECT_THAT(complaints(update_simulation(app_, request).error()),
              testing::HasSubstr("simulation.display_name: "));
  request.mutable_simulation()->set_name("simulations/77");
  EXPECT_EQ(update_simulation(app_, request).error().code(), google::rpc::NOT_FOUND);
}

TEST_F(AppTest, APinnedSimulationSurvivesExpiryAndDiskBudget) {
  const std::string pinned = finished(with_history(10, 5000));
  const std::string served = finished(with_history(10, 5000));
  const std::string other = finished(labelled("axle", 50));
  EXPECT_TRUE(bench_.get(served).cache_hit());
  EXPECT_TRUE(pin_simulation(app_, named<v1::PinSimulationRequest>(pinned)).message().pinned());
  const Microseconds later = system_time() + 120'000'000;
  const auto names = [&] {
    std::vector<std::string> out;
    const auto page = list_simulations(app_, {}).message();
    for (const auto& each : page.simulations()) out.push_back(each.name());
    return out;
  };
  Janitor early(bench_.store(), {.keep = 600'000'000}, [later] { return later; });
  early.clean();
  EXPECT_EQ(names().size(), 3U) << "not yet";
  Janitor within(bench_.store(), {.disk_budget_bytes = 1 << 30}, [later] { return later; });
  within.clean();
  EXPECT_EQ(names().size(), 3U) << "there is room";
  Janitor full(bench_.store(), {.disk_budget_bytes = 1}, [later] { return later; });
  full.clean();
  EXPECT_THAT(names(), testing::ElementsAre(pinned));
  EXPECT_EQ(get_simulation(app_, named<v1::GetSimulationRequest>(other)).error().code(),
            google::rpc::NOT_FOUND);
  const auto history = read_all(read_history(app_, named<v1::ReadHistoryRequest>(pinned)));
  EXPECT_EQ(history.columns[0].size(), 50'000U) << "shared with one that is gone";
  EXPECT_FALSE(
      unpin_simulation(app_, named<v1::UnpinSimulationRequest>(pinned)).message().pinned());
  const std::int64_t before = bench_.store().used_bytes();
  Janitor late(bench_.store(), {.keep = 1'000'000}, [later] { return later; });
  late.clean();
  EXPECT_TRUE(names().empty());
  EXPECT_LT(bench_.store().used_bytes(), before - 20'000) << "its history is gone too";
  EXPECT_TRUE(check_database(bench_.database()).empty());
}

TEST_F(AppTest, CancellingIsIdempotentAndDoesNotChangeEndedSimulations) {
  const std::string name = finished(point_simulation());
  for (int i = 0; i < 2; ++i) {
    const auto outcome = cancel_simulation(app_, named<v1::CancelSimulationRequest>(name));
    ASSERT_TRUE(outcome.ok());
    EXPECT_EQ(outcome.message().state(), v1::Simulation::SUCCEEDED);
    EXPECT_TRUE(outcome.message().has_result());
  }
}

TEST_F(AppTest, AnEmptyContactIsRefusedWithEveryViolation) {
  const auto status = evaluate_contact(app_, {}).error();
  EXPECT_EQ(status.code(), google::rpc::INVALID_ARGUMENT);
  EXPECT_EQ(detail<google::rpc::BadRequest>(status)->field_violations_size(), 10);
}

TEST_F(AppTest, ARefusalOfTheModelIsAnErrorWithItsReason) {
  v1::EvaluateContactRequest request = contact_request();
  request.set_gear_velocity_x_metres_per_second(-5);
  request.set_gear_velocity_y_metres_per_second(-6);
  request.mutable_model_options()->set_no_limiting_shear_stress(true);
  const auto status = answer_contact(app_, request).error();
  EXPECT_EQ(status.code(), google::rpc::INVALID_ARGUMENT);
  EXPECT_EQ(detail<google::rpc::ErrorInfo>(status)->reason(), "UNBOUNDED_SHEAR");
}

TEST_F(AppTest, AContactWithoutLoadIsAnswered) {
  v1::EvaluateContactRequest request = contact_request();
  request.set_load_newtons(0);
  const auto outcome = evaluate_contact(app_, request);
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome.message().status(), v1::CONTACT_STATUS_NO_LOAD);
  EXPECT_EQ(outcome.message().friction_newtons(), 0);
}

TEST_F(AppTest, ErrorDetailsAreLimitedAndCountTheOmittedViolations) {
  Violations violations;
  for (int i = 0; i < 500; ++i) violations.push_back({"field", std::string(100, 'x')});
  const auto status = invalid(violations);
  EXPECT_LT(status.ByteSizeLong(), 6000U);
  const auto bad = detail<google::rpc::BadRequest>(status);
  const auto& last = bad->field_violations(bad->field_violations_size() - 1);
  EXPECT_EQ(last.description(),
            std::to_string(500 - (bad->field_violations_size() - 1)) + " more violations");
}

/// Those of the numbers that every contact states.
TEST_F(AppTest, AllViolationsOfAContactFitIntoOneError) {
  v1::EvaluateContactRequest request;
  const auto spoil = [](google::protobuf::Message* message) {
    const auto& descriptor = *message->GetDescriptor();
    for (int i = 0; i < descriptor.field_count(); ++i) {
      const auto* field = descriptor.field(i);
      if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE &&
          !may_be_unset(*field)) {
        message->GetReflection()->SetDouble(message, field, -1.2345678901234567e300);
      }
    }
  };
  spoil(&request);
  spoil(request.mutable_lubricant_parameters());
  const auto bad = detail<google::rpc::BadRequest>(evaluate_contact(app_, request).error());
  ASSERT_TRUE(bad);
  for (const auto& violation : bad->field_violations()) {
    EXPECT_NE(violation.field(), "*") << violation.description();
  }
}

TEST_F(AppTest, AHistoryIsReadAsASchemaAndChunks) {
  const std::string name = finished(with_history(10, 5000));
  EXPECT_EQ(bench_.get(name).result().history_rows(), 50'000);
  EXPECT_EQ(bench_.get(name).result().history_columns_size(), 4);
  const auto read = read_all(read_history(app_, named<v1::ReadHistoryRequest>(name)));
  EXPECT_EQ(read.schema.total_rows(), 50'000);
  EXPECT_EQ(read.schema.rows_per_pair(), 0);
  ASSERT_EQ(read.schema.columns_size(), 4);
  EXPECT_EQ(read.schema.columns(2).name(), "flank_load_newtons_flank_1");
  EXPECT_EQ(read.schema.columns(2).unit(), "N");
  EXPECT_EQ(read.chunks.size(), 8U);
  for (const auto& chunk : read.chunks) EXPECT_LE(chunk.values().size(), 262'144U);
  for (std::size_t i = 0; i < read.columns[2].size(); ++i) {
    ASSERT_EQ(read.columns[2][i], 1000.0 + static_cast<double>(i));
  }
}

TEST_F(AppTest, TheViewAndNotTheSizeOfAResultDecidesWhatIsTold) {
  v1::Simulation simulation = curve_simulation();
  auto* curve = simulation.mutable_inefficiency_curve();
  curve->set_last_speed_kilometres_per_hour(119.9);
  curve->set_speed_step_kilometres_per_hour(0.1);
  for (const std::string& name : {finished(simulation), finished(point_simulation())}) {
    auto request = named<v1::GetSimulationRequest>(name);
    const auto full = get_simulation(app_, request).message().result();
    EXPECT_GT(full.assumptions_size(), 40);
    for (const v1::CurvePoint& point : full.points()) {
      ASSERT_TRUE(point.has_result());
      ASSERT_FALSE(point.has_summary());
    }
    request.set_view(v1::SIMULATION_VIEW_FULL);
    EXPECT_EQ(get_simulation(app_, request).message().result().SerializeAsString(),
              full.SerializeAsString());
    request.set_view(v1::SIMULATION_VIEW_SUMMARY);
    const auto summary = get_simulation(app_, request).message().result();
    EXPECT_EQ(summary.points_size(), full.points_size());
    EXPECT_EQ(summary.assumptions_size(), 0);
    EXPECT_EQ(summary.input_hash(), full.input_hash());
    for (const v1::CurvePoint& point : summary.points()) {
      ASSERT_FALSE(point.has_result()) << "its figures would read as zeros";
      ASSERT_EQ(point.summary().inefficiency_rms_percent(), 1.5);
      ASSERT_TRUE(point.summary().has_pinion_torque_newton_metres());
    }
    EXPECT_LT(summary.ByteSizeLong(), 65'536U);
    request.set_view(v1::SIMULATION_VIEW_BASIC);
    EXPECT_FALSE(get_simulation(app_, request).message().has_result());
  }
}

TEST_F(AppTest, AResultThatIsSentUnparsedArrivesAsTheSameMessage) {
  CallContext sent_as_bytes;
  sent_as_bytes.sends_wire_format = true;
  auto request = named<v1::GetSimulationRequest>(finished(curve_simulation()));
  for (const auto view : {v1::SIMULATION_VIEW_UNSPECIFIED, v1::SIMULATION_VIEW_BASIC,
                          v1::SIMULATION_VIEW_SUMMARY, v1::SIMULATION_VIEW_FULL}) {
    request.set_view(view);
    const v1::Simulation sent = get_simulation(app_, request, sent_as_bytes).message();
    EXPECT_EQ(sent.has_result(), view == v1::SIMULATION_VIEW_SUMMARY) << "others are not parsed";
    v1::Simulation received;
    ASSERT_TRUE(received.ParseFromString(sent.SerializeAsString()));
    EXPECT_EQ(received.SerializeAsString(),
              get_simulation(app_, request).message().SerializeAsString());
    EXPECT_EQ(received.has_result(), view != v1::SIMULATION_VIEW_BASIC);
  }
}

/// Sets every field: numbers to what takes most bytes, lists to `elements` entries.
void fill(google::protobuf::Message& message, int elements) {
  using google::protobuf::FieldDescriptor;
  const auto& reflection = *message.GetReflection();
  const auto& descriptor = *message.GetDescriptor();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor* field = descriptor.field(i);
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      for (int k = 0; field->is_repeated() && k < elements; ++k) {
        fill(*reflection.AddMessage(&message, field), elements);
      }
      if (!field->is_repeated()) fill(*reflection.MutableMessage(&message, field), elements);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE && field->is_repeated()) {
      for (int k = 0; k < elements; ++k) reflection.AddDouble(&message, field, 1.0 / 3);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
      reflection.SetDouble(&message, field, 1.0 / 3);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
      reflection.SetInt32(&message, field, 1'000'000);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_INT64) {
      reflection.SetInt64(&message, field, 1'000'000'000);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL) {
      reflection.SetBool(&message, field, true);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
      reflection.SetEnumValue(&message, field, 1);
    } else if (!field->is_repeated()) {
      reflection.SetString(&message, field, std::string(200, 'x'));
    }
  }
}

TEST(SimulationViews, TheLongestCurveFitsIntoAnAnswerInFull) {
  v1::CurvePoint point;
  v1::PointResult& most = *point.mutable_result();
  fill(most, 3);  // flanks
  most.clear_sensitivities();
  v1::RangeWarning& longest = *most.mutable_warnings(0);
  longest.clear_summary();
  longest.clear_code();
  for (const WarningKind& each : warning_kinds()) {
    if (each.summary.size() > longest.summary().size()) {
      longest.set_summary(std::string(each.summary));
    }
    if (each.code.size() > longest.code().size()) longest.set_code(std::string(each.code));
  }
  while (most.warnings_size() < 5) *most.add_warnings() = v1::RangeWarning(most.warnings(0));
  while (most.contact_losses_size() < 20) {
    *most.add_contact_losses() = v1::ContactLoss(most.contact_losses(0));
  }
  point.mutable_branch_end()->set_gone_at_kilometres_per_hour(1.0 / 3);
  v1::SimulationResult result;
  for (int i = 0; i < kMaximumCurvePoints; ++i) *result.add_points() = point;
  EXPECT_LT(result.ByteSizeLong(), 4'000'000U) << "clients accept 4 MiB unless told otherwise";

  v1::PointSensitivities& sensitivities =
      *result.mutable_points(0)->mutable_result()->mutable_sensitivities();
  const std::string name(60, 'x');  // "lubricant.improved_yasutomi.expansivity_pressure_factor"
  for (int f = 0; f < kOrbitFigures; ++f) {
    sensitivities.add_figures(name);
    sensitivities.add_values(1.0 / 3);
  }
  for (int i = 0; i < 31; ++i) {  // under the law with most parameters
    v1::ParameterSensitivity& parameter = *sensitivities.add_parameters();
    parameter.set_parameter(name);
    parameter.set_unit("kg/(m3 K)");
    parameter.set_value(1.0 / 3);
    for (int f = 0; f < kOrbitFigures; ++f) {
      parameter.add_derivatives(1.0 / 3);
      parameter.add_elasticities(1.0 / 3);
    }
  }
  const v1::CurvePoint differentiated = result.points(0);
  result.clear_points();
  for (int i = 0; i < kMaximumDifferentiatedCurvePoints; ++i) *result.add_points() = differentiated;
  EXPECT_LT(result.ByteSizeLong(), 4'000'000U);
}

TEST_F(AppTest, AReadMaskNamesTheFieldsOfAnAnswer) {
  const std::string name = finished(curve_simulation());
  auto request = named<v1::GetSimulationRequest>(name);
  const v1::Simulation whole = get_simulation(app_, request).message();
  request.mutable_read_mask()->add_paths("*");
  EXPECT_EQ(get_simulation(app_, request).message().SerializeAsString(), whole.SerializeAsString());
  request.mutable_read_mask()->set_paths(0, "state");
  request.mutable_read_mask()->add_paths("result.points.result.inefficiency_rms_percent");
  const v1::Simulation part = get_simulation(app_, request).message();
  EXPECT_EQ(part.state(), v1::Simulation::SUCCEEDED);
  EXPECT_EQ(part.name(), "");
  EXPECT_EQ(part.result().assumptions_size(), 0);
  ASSERT_EQ(part.result().points_size(), whole.result().points_size());
  for (const v1::CurvePoint& point : part.result().points()) {
    v1::CurvePoint expected;
    expected.mutable_result()->set_inefficiency_rms_percent(1.5);
    EXPECT_EQ(point.SerializeAsString(), expected.SerializeAsString());
  }
  request.mutable_read_mask()->add_paths("result.points.result");
  EXPECT_EQ(get_simulation(app_, request).message().result().points(0).result().SerializeAsString(),
            whole.result().points(0).result().SerializeAsString())
      << "a field that is named whole stays whole";

  v1::ListSimulationsRequest list;
  EXPECT_FALSE(list_simulations(app_, list).message().simulations(0).has_result());
  list.mutable_read_mask()->add_paths("name");
  list.mutable_read_mask()->add_paths("result.input_hash");
  const v1::Simulation listed = list_simulations(app_, list).message().simulations(0);
  v1::Simulation expected;
  expected.set_name(name);
  expected.mutable_result()->set_input_hash(whole.result().input_hash());
  EXPECT_EQ(listed.SerializeAsString(), expected.SerializeAsString());

  for (const char* wrong : {"reslt", "result.points.speed", "name.x", "", ".", "result."}) {
    request.mutable_read_mask()->set_paths(0, wrong);
    const auto refused = get_simulation(app_, request);
    ASSERT_FALSE(refused.ok()) << wrong;
    EXPECT_EQ(refused.error().code(), google::rpc::INVALID_ARGUMENT);
    EXPECT_THAT(complaints(refused.error()), testing::HasSubstr("read_mask: ")) << wrong;
  }
  request.clear_read_mask();
  for (int i = 0; i < 5000; ++i) request.mutable_read_mask()->add_paths("name");
  EXPECT_THAT(complaints(get_simulation(app_, request).error()),
              testing::HasSubstr("read_mask: 5000 entries; allowed: at most 200"));
}

TEST_F(AppTest, ManyConcurrentReadersGetSmallerChunks) {
  const std::string name = finished(with_history(10, 5000));
  const auto request = named<v1::ReadHistoryRequest>(name);
  std::vector<StreamOutcome<v1::ReadHistoryResponse>> readers;
  for (int i = 0; i < 64; ++i) readers.push_back(read_history(app_, request));
  std::size_t bytes = 0;
  for (const auto& chunk : read_all(readers.front()).chunks) {
    bytes = std::max(bytes, chunk.values().size());
  }
  EXPECT_EQ(bytes, 65'536U) << "one block each";
  readers.erase(readers.begin() + 1, readers.end());
  EXPECT_EQ(read_all(read_history(app_, request)).chunks.front().values().size(), 262'144U);
}

TEST_F(AppTest, AnOverviewHasTheExtremesOfEveryRun) {
  const std::string name = finished(with_history(10, 5000));
  auto request = named<v1::ReadHistoryRequest>(name);
  request.set_start_row(123);
  request.set_row_count(40'000);
  for (const int points : {4, 100, 4000, 30'000}) {
    request.set_max_points(points);
    const auto read = read_all(read_history(app_, request));
    const std::int64_t run = read.schema.rows_per_pair();
    EXPECT_LE(read.schema.row_count(), points);
    EXPECT_GE(read.schema.row_count(), points / 3) << "no coarser than it must be";
    EXPECT_EQ(read.schema.start_row(), 123);
    for (std::int64_t k = 0; k < read.schema.row_count() / 2; ++k) {
      const std::int64_t first = (123 / run + k) * run;
      ASSERT_EQ(read.columns[1][2 * k], static_cast<double>(std::max<std::int64_t>(123, first)));
      ASSERT_EQ(read.columns[1][2 * k + 1],
                static_cast<double>(std::min<std::int64_t>(40'123, first + run) - 1));
    }
  }
  request.set_max_points(40'000);
  EXPECT_EQ(read_all(read_history(app_, request)).schema.rows_per_pair(), 0) << "there is room";
  request.set_max_points(3);
  EXPECT_EQ(read_history(app_, request).error().code(), google::rpc::INVALID_ARGUMENT);
}

TEST_F(AppTest, HistoriesAreReadInPart) {
  const std::string name = finished(with_history(1, 100));
  auto request = named<v1::ReadHistoryRequest>(name);
  request.add_columns("flank_load_newtons");
  request.add_columns("flank_load_newtons_flank_2");
  request.set_start_row(90);
  request.set_row_count(5);
  auto read = read_all(read_history(app_, request));
  ASSERT_EQ(read.chunks.size(), 3U) << "a flank column stands for its three flanks";
  EXPECT_EQ(read.schema.start_row(), 90);
  EXPECT_THAT(read.columns[2], testing::ElementsAre(2090, 2091, 2092, 2093, 2094));
  request.set_row_count(1000);
  EXPECT_EQ(read_all(read_history(app_, request)).columns[0].size(), 10U);
  request.set_start_row(100);
  EXPECT_TRUE(read_all(read_history(app_, request)).chunks.empty());
  request.set_start_row(101);
  request.set_row_count(-1);
  request.add_columns("mesh_forces");
  const auto bad = detail<google::rpc::BadRequest>(read_history(app_, request).error());
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->field_violations_size(), 3);
}

TEST_F(AppTest, AHistoryNeedsAResultThatHasOne) {
  const std::string name = finished(point_simulation());
  EXPECT_EQ(read_history(app_, named<v1::ReadHistoryRequest>(name)).error().code(),
            google::rpc::NOT_FOUND);
  auto release = std::make_shared<std::atomic<bool>>(false);
  bench_.restart(patient_studies(release));
  Application app = bench_.application();
  v1::Simulation another = point_simulation();  // no stored result has its inputs
  another.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(66);
  const std::string running = bench_.create(another);
  EXPECT_EQ(read_history(app, named<v1::ReadHistoryRequest>(running)).error().code(),
            google::rpc::FAILED_PRECONDITION);
  *release = true;
}

TEST_F(AppTest, AWatchShowsEveryChangeOfState) {
  const std::string name = finished(point_simulation());
  const auto outcome = watch_simulation(app_, named<v1::WatchSimulationRequest>(name));
  ASSERT_TRUE(outcome.ok());
  using Step = MessageSource<v1::SimulationEvent>::Step;
  v1::SimulationEvent event;
  for (const auto state :
       {v1::Simulation::QUEUED, v1::Simulation::RUNNING, v1::Simulation::SUCCEEDED}) {
    ASSERT_EQ(outcome.message()->next(event), Step::kMessage);
    EXPECT_EQ(event.state(), state);
    EXPECT_EQ(event.sequence(), state);
    EXPECT_EQ(event.kind(), v1::SimulationEvent::STATE_CHANGE);
  }
  EXPECT_EQ(event.progress_fraction(), 1);
  EXPECT_EQ(outcome.message()->next(event), Step::kEnd);
}

TEST_F(AppTest, AFullQueueRefusesSimulationsWithARetryDelay) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench small(patient_studies(release), 1, {.jobs = 1});
  const std::string running = small.create(point_simulation());
  ASSERT_TRUE(small.reaches(running, v1::Simulation::RUNNING));
  small.create(point_simulation());
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  Application app = small.application();
  const auto status = create_simulation(app, request).error();
  EXPECT_EQ(status.code(), google::rpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.message(), testing::HasSubstr("at most 1 simulations and 100 processor hours "
                                                   "may wait, three quarters of them for one "
                                                   "client; try again in 0."));
  const auto delay = detail<google::rpc::RetryInfo>(status)->retry_delay();
  EXPECT_EQ(delay.seconds(), 0) << "a point is computed in far less than a second";
  EXPECT_GT(delay.nanos(), 0);
  *release = true;
}

}  // namespace
}  // namespace tribodyn::server
