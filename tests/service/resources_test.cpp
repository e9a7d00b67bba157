// Tests of the standard methods: no create, update or deletion loses or mixes up data.
#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "proto/field_behavior.h"
#include "server/application/call_context.h"
#include "server/application/contacts.h"
#include "server/application/element_limits.h"
#include "server/application/schemas.h"
#include "server/application/simulations.h"
#include "server/contract/constraints.h"
#include "server/resources/provenance.h"
#include "server/storage/resource_types.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using google::protobuf::util::MessageDifferencer;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

v1::Lubricant three_numbers() {
  v1::Lubricant out;
  auto* measured = out.mutable_measurements();
  measured->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(73.3);
  measured->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(14.2);
  measured->set_density_15_celsius_kilograms_per_cubic_metre(865);
  out.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  return out;
}

class ResourcesTest : public testing::Test {
 protected:
  Outcome<v1::Lubricant> create(const v1::Lubricant& lubricant, const std::string& id,
                                bool validate_only = false) {
    v1::CreateLubricantRequest request;
    *request.mutable_lubricant() = lubricant;
    request.set_lubricant_id(id);
    request.set_validate_only(validate_only);
    return create_lubricant(app_, request);
  }

  Outcome<v1::Lubricant> update(const v1::Lubricant& lubricant,
                                const std::vector<std::string>& mask = {}) {
    v1::UpdateLubricantRequest request;
    *request.mutable_lubricant() = lubricant;
    for (const std::string& path : mask) request.mutable_update_mask()->add_paths(path);
    return update_lubricant(app_, request);
  }

  Outcome<v1::Lubricant> get(const std::string& name) {
    v1::GetLubricantRequest request;
    request.set_name(name);
    return get_lubricant(app_, request);
  }

  Outcome<v1::Lubricant> remove(const std::string& name, const std::string& etag = "") {
    v1::DeleteLubricantRequest request;
    request.set_name(name);
    request.set_etag(etag);
    return delete_lubricant(app_, request);
  }

  Outcome<v1::Lubricant> undelete(const std::string& name) {
    v1::UndeleteLubricantRequest request;
    request.set_name(name);
    return undelete_lubricant(app_, request);
  }

  /// Returns the ids of all pages of size `size`.
  std::vector<std::string> ids(const std::string& filter, const std::string& order = "",
                               int size = 2, bool deleted = false) {
    v1::ListLubricantsRequest request;
    request.set_filter(filter);
    request.set_order_by(order);
    request.set_page_size(size);
    request.set_show_deleted(deleted);
    std::vector<std::string> out;
    do {
      const auto page = list_lubricants(app_, request);
      if (!page.ok()) {
        ADD_FAILURE() << complaints(page.error());
        return out;
      }
      EXPECT_LE(page.message().lubricants_size(), size);
      for (const auto& each : page.message().lubricants()) out.push_back(each.name().substr(11));
      request.set_page_token(page.message().next_page_token());
    } while (!request.page_token().empty() && out.size() < 1000);
    return out;
  }

  Bench bench_;
  Application app_ = bench_.application();
};

TEST_F(ResourcesTest, ThreeNumbersMakeACompleteLubricantWithAllAssumptions) {
  const auto made = create(three_numbers(), "x");
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  const v1::Lubricant& lubricant = made.message();
  EXPECT_EQ(lubricant.name(), "lubricants/x");
  EXPECT_EQ(lubricant.revision(), 1);
  for (const std::string& field : parameter_paths(*v1::Lubricant::descriptor()).numbers) {
    const auto* descriptor = v1::Lubricant::descriptor()->FindFieldByName(field);
    if (descriptor == nullptr || may_be_unset(*descriptor))
      continue;  // of another law, or optional
    EXPECT_TRUE(lubricant.GetReflection()->HasField(lubricant, descriptor)) << field;
    const auto* entry = find_provenance(lubricant.provenance(), field);
    ASSERT_NE(entry, nullptr) << field;
    EXPECT_TRUE(entry->computed()) << field;
    EXPECT_NE(entry->source(), "") << field;
    EXPECT_NE(entry->provenance(), v1::PROVENANCE_UNSPECIFIED) << field;
  }
  const auto* alpha =
      find_provenance(lubricant.provenance(), "pressure_viscosity_coefficient_per_pascal");
  EXPECT_GT(alpha->standard_uncertainty(), 0);
  EXPECT_NE(alpha->warning(), "");
  EXPECT_EQ(alpha->unit(), "1/Pa");
  EXPECT_NEAR(lubricant.characterisation().viscosity_residuals(0).residual(), 0, 1e-9);
  EXPECT_EQ(lubricant.characterisation().sae_j306_grade(), "90");
  EXPECT_GT(lubricant.characterisation().viscosity_index(), 100);
  EXPECT_GT(lubricant.characterisation().warnings_size(), 0);
}

TEST_F(ResourcesTest, EnteredValuesAreKept) {
  v1::Lubricant entered = three_numbers();
  auto* row = entered.mutable_measurements()->add_viscosities();
  row->set_temperature_celsius(70);
  row->set_dynamic_viscosity_millipascal_seconds(24.5);
  row = entered.mutable_measurements()->add_viscosities();
  row->set_temperature_celsius(20);
  row->set_kinematic_viscosity_square_millimetres_per_second(175);
  entered.mutable_measurements()->add_brookfield_viscosities()->set_temperature_celsius(-40);
  entered.mutable_measurements()
      ->mutable_brookfield_viscosities(0)
      ->set_dynamic_viscosity_millipascal_seconds(95'000);
  const auto made = create(entered, "x");
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  EXPECT_TRUE(MessageDifferencer::Equals(made.message().measurements(), entered.measurements()));
  EXPECT_EQ(made.message().characterisation().viscosity_residuals_size(), 5);
  EXPECT_EQ(made.message().characterisation().sae_j306_grade(), "75W-90");
  EXPECT_GT(made.message().characterisation().root_mean_square_residual(), 0);
}

TEST_F(ResourcesTest, AGivenParameterIsNeverReplaced) {
  v1::Lubricant entered = three_numbers();
  entered.set_thermal_conductivity_watts_per_metre_kelvin(0.2);
  entered.set_relaxation_time_seconds(0);
  const auto made = create(entered, "x");
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  EXPECT_EQ(made.message().thermal_conductivity_watts_per_metre_kelvin(), 0.2);
  EXPECT_EQ(made.message().relaxation_time_seconds(), 0) << "zero is a value";
  const auto* entry =
      find_provenance(made.message().provenance(), "thermal_conductivity_watts_per_metre_kelvin");
  EXPECT_EQ(entry->provenance(), v1::PROVENANCE_USER);
  EXPECT_FALSE(entry->computed());
}

TEST_F(ResourcesTest, ALubricantWithTooFewDataIsRefused) {
  v1::Lubricant entered;
  entered.mutable_measurements()->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
      70);
  EXPECT_EQ(create(entered, "x").error().code(), google::rpc::INVALID_ARGUMENT);
  entered.mutable_measurements()->set_density_15_celsius_kilograms_per_cubic_metre(-1);
  entered.mutable_measurements()->add_viscosities()->set_temperature_celsius(9999);
  entered.add_labels()->set_key("no spaces");
  entered.add_provenance()->set_field("thermal_conductivity");
  entered.set_derived_from("lubricants/paper-fluid-11");
  const std::string said = complaints(create(entered, "").error());
  for (const char* part :
       {"lubricant_id", "density_15_celsius_kilograms_per_cubic_metre = -1 kg/m3", "9999 C",
        "lubricant.measurements.viscosities[0].viscosity", "lubricant.labels[0].key",
        "did you mean \"thermal_conductivity_watts_per_metre_kelvin\"",
        "did you mean \"lubricants/paper-fluid-1\""}) {
    EXPECT_THAT(said, HasSubstr(part));
  }
  EXPECT_THAT(ids(""), ElementsAre("paper-fluid-1", "paper-fluid-2", "paper-fluid-3", "shell-t9"));
}

TEST_F(ResourcesTest, ValidateOnlyAnswersInFullAndWritesNothing) {
  const auto checked = create(three_numbers(), "x", true);
  ASSERT_TRUE(checked.ok());
  EXPECT_TRUE(checked.message().has_thermal_conductivity_watts_per_metre_kelvin());
  EXPECT_EQ(get("lubricants/x").error().code(), google::rpc::NOT_FOUND);
  create(three_numbers(), "x");
  EXPECT_EQ(create(three_numbers(), "x", true).error().code(), google::rpc::ALREADY_EXISTS);
  v1::UpdateLubricantRequest request;
  request.mutable_lubricant()->set_name("lubricants/x");
  request.mutable_lubricant()->set_display_name("new");
  request.mutable_update_mask()->add_paths("display_name");
  request.set_validate_only(true);
  EXPECT_EQ(update_lubricant(app_, request).message().display_name(), "new");
  EXPECT_EQ(get("lubricants/x").message().display_name(), "");
  v1::CreateSimulationRequest simulation;
  *simulation.mutable_simulation() = point_simulation();
  simulation.set_validate_only(true);
  EXPECT_EQ(create_simulation(app_, simulation).message().gear_set_revision(),
            "gearSets/reference-axle@1");
  EXPECT_EQ(list_simulations(app_, {}).message().simulations_size(), 0);
}

TEST_F(ResourcesTest, AnUpdateChangesOnlyTheFieldsOfItsMask) {
  v1::Lubricant first = create(three_numbers(), "x").message();
  v1::Lubricant change;
  change.set_name(first.name());
  change.set_display_name("Blend 7");
  change.set_description("not in the mask");
  const auto second = update(change, {"display_name"});
  ASSERT_TRUE(second.ok()) << complaints(second.error());
  EXPECT_EQ(second.message().display_name(), "Blend 7");
  EXPECT_EQ(second.message().description(), "");
  EXPECT_EQ(second.message().revision(), 2);
  EXPECT_NE(second.message().etag(), first.etag());
  EXPECT_EQ(get("lubricants/x@1").message().display_name(), "");
  EXPECT_EQ(get("lubricants/x@1").message().name(), "lubricants/x@1");
  EXPECT_EQ(update(change, {"display_name"}).message().revision(), 2) << "nothing changes";
  EXPECT_THAT(complaints(update(change, {"displayname"}).error()), HasSubstr("display_name"));
  EXPECT_EQ(get("lubricants/x@3").error().code(), google::rpc::NOT_FOUND);
}

TEST_F(ResourcesTest, AnUpdateWithoutAMaskLosesNothingThatItLeavesOut) {
  v1::Lubricant full = three_numbers();
  full.set_display_name("before");
  full.set_description("kept");
  full.set_external_sample_id("S-7");
  full.set_pressure_viscosity_coefficient_per_pascal(2e-8);
  auto* label = full.add_labels();
  label->set_key("project");
  label->set_value("axle");
  auto* entry = full.add_provenance();
  entry->set_field("pressure_viscosity_coefficient_per_pascal");
  entry->set_provenance(v1::PROVENANCE_MEASURED);
  entry->set_source("report 12");
  const auto made = create(full, "x");
  ASSERT_TRUE(made.ok()) << complaints(made.error());

  v1::Lubricant change;  // {name, parameters, display_name}
  change.set_name("lubricants/x");
  change.set_display_name("after");
  change.set_thermal_conductivity_watts_per_metre_kelvin(0.16);
  change.mutable_measurements()->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
      75);
  const auto updated = update(change);
  ASSERT_TRUE(updated.ok()) << complaints(updated.error());
  const v1::Lubricant& now = updated.message();
  EXPECT_EQ(now.display_name(), "after");
  EXPECT_EQ(now.thermal_conductivity_watts_per_metre_kelvin(), 0.16);
  EXPECT_EQ(now.description(), "kept");
  EXPECT_EQ(now.external_sample_id(), "S-7");
  ASSERT_EQ(now.labels_size(), 1);
  EXPECT_EQ(now.pressure_viscosity_coefficient_per_pascal(), 2e-8);
  EXPECT_EQ(
      find_provenance(now.provenance(), "pressure_viscosity_coefficient_per_pascal")->source(),
      "report 12");
  v1::LubricantMeasurements measured = full.measurements();
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(75);
  EXPECT_EQ(now.measurements().SerializeAsString(), measured.SerializeAsString())
      << "of a message only what is stated in it";

  const auto same = update(change);
  ASSERT_TRUE(same.ok());
  EXPECT_EQ(same.message().revision(), 2) << "nothing changes";
  v1::Lubricant nothing;
  nothing.set_name("lubricants/x");
  EXPECT_EQ(update(nothing).message().revision(), 2);

  v1::Lubricant replacement = three_numbers();
  replacement.set_name("lubricants/x");
  const auto replaced = update(replacement, {"*"});
  ASSERT_TRUE(replaced.ok()) << complaints(replaced.error());
  EXPECT_EQ(replaced.message().description(), "");
  EXPECT_EQ(replaced.message().labels_size(), 0);
  EXPECT_NE(replaced.message().pressure_viscosity_coefficient_per_pascal(), 2e-8) << "estimated";
}

TEST_F(ResourcesTest, AReadMaskNamesTheFieldsOfAnAnswer) {
  v1::GetLubricantRequest request;
  request.set_name("lubricants/paper-fluid-1");
  request.mutable_read_mask()->add_paths("display_name");
  request.mutable_read_mask()->add_paths("provenance.field");
  const v1::Lubricant whole = get("lubricants/paper-fluid-1").message();
  const auto part = get_lubricant(app_, request);
  ASSERT_TRUE(part.ok()) << complaints(part.error());
  EXPECT_EQ(part.message().display_name(), whole.display_name());
  EXPECT_EQ(part.message().name(), "");
  EXPECT_FALSE(part.message().has_characterisation());
  ASSERT_EQ(part.message().provenance_size(), whole.provenance_size());
  EXPECT_EQ(part.message().provenance(0).field(), whole.provenance(0).field());
  EXPECT_EQ(part.message().provenance(0).source(), "");

  v1::ListGearSetsRequest list;
  list.mutable_read_mask()->add_paths("name");
  const auto listed = list_gear_sets(app_, list);
  ASSERT_TRUE(listed.ok());
  ASSERT_GT(listed.message().gear_sets_size(), 1);
  v1::GearSet name_alone;
  name_alone.set_name(listed.message().gear_sets(0).name());
  EXPECT_EQ(listed.message().gear_sets(0).SerializeAsString(), name_alone.SerializeAsString());
  list.mutable_read_mask()->add_paths("dynamics.mass");
  EXPECT_THAT(complaints(list_gear_sets(app_, list).error()),
              HasSubstr("read_mask: \"mass\" is not a field of DrivelineDynamics"));
}

TEST_F(ResourcesTest, ComputedParametersFollowTheirInputs) {
  const v1::Lubricant first = create(three_numbers(), "x").message();
  v1::Lubricant change = first;
  change.mutable_measurements()->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(
      15);
  const v1::Lubricant second = update(change).message();
  EXPECT_NE(second.vogel_temperature_coefficient_kelvin(),
            first.vogel_temperature_coefficient_kelvin());
  EXPECT_NEAR(second.characterisation().viscosity_residuals(1).residual(), 0, 1e-9);
  change = second;
  change.set_thermal_conductivity_watts_per_metre_kelvin(0.16);
  const v1::Lubricant third = update(change).message();
  const auto* entry =
      find_provenance(third.provenance(), "thermal_conductivity_watts_per_metre_kelvin");
  EXPECT_FALSE(entry->computed()) << "the client's from now on";
  EXPECT_EQ(entry->provenance(), v1::PROVENANCE_USER);
  EXPECT_EQ(third.thermal_conductivity_watts_per_metre_kelvin(), 0.16);
  EXPECT_EQ(third.vogel_temperature_coefficient_kelvin(),
            second.vogel_temperature_coefficient_kelvin());
}

TEST_F(ResourcesTest, AnOldEtagIsRefused) {
  v1::Lubricant mine = create(three_numbers(), "x").message();
  v1::Lubricant yours = mine;
  yours.set_display_name("yours");
  ASSERT_TRUE(update(yours).ok());
  mine.set_display_name("mine");
  EXPECT_EQ(update(mine).error().code(), google::rpc::ABORTED);
  EXPECT_EQ(remove("lubricants/x", mine.etag()).error().code(), google::rpc::ABORTED);
  EXPECT_EQ(get("lubricants/x").message().display_name(), "yours");
}

TEST_F(ResourcesTest, ADeletedResourceIsHiddenAndCanBeUndeleted) {
  create(three_numbers(), "x");
  const std::string simulated = [&] {
    v1::Simulation simulation = point_simulation();
    simulation.set_lubricant("lubricants/x");
    return bench_.create(simulation);
  }();
  const auto deleted = remove("lubricants/x");
  ASSERT_TRUE(deleted.ok());
  EXPECT_TRUE(deleted.message().has_delete_time());
  EXPECT_TRUE(remove("lubricants/x").ok()) << "twice is once";
  EXPECT_TRUE(get("lubricants/x").message().has_delete_time());
  EXPECT_THAT(ids(""), ElementsAre("paper-fluid-1", "paper-fluid-2", "paper-fluid-3", "shell-t9"));
  EXPECT_THAT(ids("", "", 2, true),
              ElementsAre("paper-fluid-1", "paper-fluid-2", "paper-fluid-3", "shell-t9", "x"));
  EXPECT_EQ(create(three_numbers(), "x").error().code(), google::rpc::ALREADY_EXISTS);
  v1::Lubricant change;
  change.set_name("lubricants/x");
  EXPECT_EQ(update(change, {"display_name"}).error().code(), google::rpc::FAILED_PRECONDITION);
  v1::EvaluateContactRequest contact = contact_request();
  contact.set_lubricant("lubricants/x@1");
  EXPECT_THAT(complaints(evaluate_contact(app_, contact).error()), HasSubstr("undelete"));
  EXPECT_TRUE(bench_.reaches(simulated, v1::Simulation::SUCCEEDED)) << "accepted before";
  ASSERT_TRUE(undelete("lubricants/x").ok());
  const auto again = undelete("lubricants/x");
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().code(), google::rpc::ALREADY_EXISTS) << "AIP-164";
  EXPECT_EQ(again.error().message(), "lubricants/x is not deleted");
  EXPECT_THAT(ids(""),
              ElementsAre("paper-fluid-1", "paper-fluid-2", "paper-fluid-3", "shell-t9", "x"));
  EXPECT_FALSE(get("lubricants/x").message().has_delete_time());
}

TEST_F(ResourcesTest, ASimulationKeepsItsRevisions) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  bench_.restart(patient_studies(release));
  Application app = bench_.application();
  const std::string name = bench_.create(point_simulation());
  v1::UpdateLubricantRequest request;
  *request.mutable_lubricant() = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  request.mutable_lubricant()->set_thermal_conductivity_watts_per_metre_kelvin(0.2);
  ASSERT_EQ(update_lubricant(app, request).message().revision(), 2);
  *release = true;
  ASSERT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
  const v1::Simulation done = bench_.get(name);
  EXPECT_EQ(done.lubricant(), "lubricants/paper-fluid-1");
  EXPECT_EQ(done.lubricant_revision(), "lubricants/paper-fluid-1@1");
  EXPECT_EQ(done.surface_revision(), "surfaces/run-in@1");
  bool found = false;
  for (const auto& assumption : done.result().assumptions()) {
    if (assumption.field() != "thermal_conductivity_watts_per_metre_kelvin") continue;
    found = true;
    EXPECT_EQ(assumption.value(), "0.154 W/(m K)");
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(bench_.get(bench_.create(point_simulation())).lubricant_revision(),
            "lubricants/paper-fluid-1@2");
}

TEST_F(ResourcesTest, RevisionsAreListedNewestFirst) {
  v1::Lubricant lubricant = create(three_numbers(), "x").message();
  for (int i = 0; i < 4; ++i) {
    lubricant.clear_etag();
    lubricant.set_description(std::to_string(i));
    ASSERT_TRUE(update(lubricant).ok());
  }
  v1::ListLubricantRevisionsRequest request;
  request.set_name("lubricants/x");
  request.set_page_size(2);
  std::vector<std::string> names;
  do {
    const auto page = list_lubricant_revisions(app_, request);
    ASSERT_TRUE(page.ok());
    for (const auto& each : page.message().lubricants()) names.push_back(each.name());
    request.set_page_token(page.message().next_page_token());
  } while (!request.page_token().empty());
  EXPECT_THAT(names, ElementsAre("lubricants/x@5", "lubricants/x@4", "lubricants/x@3",
                                 "lubricants/x@2", "lubricants/x@1"));
}

TEST_F(ResourcesTest, ANumberThatTheModelDoesNotUseIsStoredAndMayBeUnset) {
  v1::Lubricant oil = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  oil.clear_name();
  ASSERT_FALSE(oil.has_flash_point_celsius());
  oil.set_flash_point_celsius(212);
  oil.set_pour_point_celsius(0);
  ASSERT_TRUE(create(oil, "x").ok());
  const v1::Lubricant stored = get("lubricants/x").message();
  EXPECT_EQ(stored.flash_point_celsius(), 212);
  EXPECT_TRUE(stored.has_pour_point_celsius()) << "0 C is a pour point";
  for (const auto& entry : stored.provenance()) {
    EXPECT_THAT(entry.field(), testing::Not(HasSubstr("point_celsius"))) << "it is no parameter";
  }
  EXPECT_THAT(ids("flash_point_celsius >= 200"), ElementsAre("x"));
  EXPECT_THAT(ids("flash_point_celsius < 200"), IsEmpty());
  v1::UpdateLubricantRequest request;
  request.mutable_lubricant()->set_name("lubricants/x");
  request.mutable_update_mask()->add_paths("flash_point_celsius");
  ASSERT_TRUE(update_lubricant(app_, request).ok());
  EXPECT_FALSE(get("lubricants/x").message().has_flash_point_celsius());
  EXPECT_TRUE(get("lubricants/x").message().has_pour_point_celsius());
  oil.add_provenance()->set_field("flash_point_celsius");
  oil.set_pour_point_celsius(-200);
  EXPECT_THAT(
      complaints(create(oil, "y").error()),
      testing::AllOf(HasSubstr("pour_point_celsius = -200 C; allowed: -120 to 100 C (ASTM D97)"),
                     HasSubstr("\"flash_point_celsius\" is not a parameter")));
}

class ListTest : public ResourcesTest {
 protected:
  void SetUp() override {
    for (int i = 0; i < 8; ++i) {
      v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/paper-fluid-1");
      lubricant.clear_name();
      lubricant.set_display_name(i % 2 == 0 ? "Even \"oil\"" : "Odd oil");
      lubricant.set_condition(i < 3 ? v1::Lubricant::FRESH : v1::Lubricant::USED);
      lubricant.set_lims_id("L" + std::to_string(i / 2));
      lubricant.set_thermal_conductivity_watts_per_metre_kelvin(0.2 - 0.01 * (i % 4));
      auto* label = lubricant.add_labels();
      label->set_key("project");
      label->set_value(i < 4 ? "axle" : "gearbox");
      if (i == 5) lubricant.add_labels()->set_key("urgent");
      ASSERT_TRUE(create(lubricant, "o" + std::to_string(i)).ok());
    }
    for (const char* name : {"lubricants/paper-fluid-1", "lubricants/paper-fluid-2",
                             "lubricants/paper-fluid-3", "lubricants/shell-t9"})
      remove(name);
  }
};

TEST_F(ListTest, FiltersApplyToEveryPage) {
  EXPECT_THAT(ids("condition = FRESH"), ElementsAre("o0", "o1", "o2"));
  EXPECT_THAT(ids("condition != FRESH AND labels.project = axle"), ElementsAre("o3"));
  EXPECT_THAT(ids("lims_id = \"L2\""), ElementsAre("o4", "o5"));
  EXPECT_THAT(ids("lims_id >= L2 AND lims_id < L3"), ElementsAre("o4", "o5"));
  EXPECT_THAT(ids("display_name:EVEN AND labels.project=gearbox"), ElementsAre("o4", "o6"));
  EXPECT_THAT(ids("display_name = \"Even \\\"oil\\\"\"").size(), 4U);
  EXPECT_THAT(ids("labels.urgent:*"), ElementsAre("o5"));
  EXPECT_THAT(ids("labels.urgent = \"\""), ElementsAre("o5"));
  EXPECT_THAT(ids("thermal_conductivity_watts_per_metre_kelvin > 0.195"), ElementsAre("o0", "o4"));
  EXPECT_THAT(ids("thermal_conductivity_watts_per_metre_kelvin <= 0.17 AND name > lubricants/o4"),
              ElementsAre("o7"));
  EXPECT_THAT(ids("name:o7"), ElementsAre("o7"));
  EXPECT_THAT(ids("create_time > 2020-01-01T00:00:00Z").size(), 8U);
  EXPECT_THAT(ids("create_time < 2020-01-01T00:00:00Z"), IsEmpty());
}

TEST_F(ListTest, OrdersContinueOverPages) {
  EXPECT_THAT(ids("", "name desc"), ElementsAre("o7", "o6", "o5", "o4", "o3", "o2", "o1", "o0"));
  EXPECT_THAT(ids("", "thermal_conductivity_watts_per_metre_kelvin"),
              ElementsAre("o3", "o7", "o2", "o6", "o1", "o5", "o0", "o4"));
  EXPECT_THAT(ids("labels.project = axle", "thermal_conductivity_watts_per_metre_kelvin desc", 1),
              ElementsAre("o0", "o1", "o2", "o3"));
  EXPECT_THAT(ids("", "condition desc", 3).front(), "o7");
  EXPECT_THAT(ids("", "update_time", 3).size(), 8U);
}

TEST_F(ListTest, ComputedFiguresFilterAndOrderOverPages) {
  for (const double kv40 : {70.0, 100.0, 150.0, 85.0}) {
    v1::Lubricant fluid = three_numbers();
    fluid.mutable_measurements()->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
        kv40);
    fluid.set_condition(kv40 < 100 ? v1::Lubricant::FRESH : v1::Lubricant::USED);
    ASSERT_TRUE(create(fluid, "k" + std::to_string(static_cast<int>(kv40))).ok());
  }
  for (const int size : {1, 3, 100}) {
    EXPECT_THAT(ids("name:k AND kv40 > 80 AND kv40 <= 100", "", size), ElementsAre("k100", "k85"));
    EXPECT_THAT(ids("name:k", "kv40", size), ElementsAre("k70", "k85", "k100", "k150"));
    EXPECT_THAT(ids("name:k", "kv40 desc", size), ElementsAre("k150", "k100", "k85", "k70"));
    // At equal KV100, a higher KV40 means a lower viscosity index.
    EXPECT_THAT(ids("name:k AND vi < 160", "viscosity_index desc", size),
                ElementsAre("k100", "k150"));
    EXPECT_THAT(ids("name:k AND condition = USED", "vi", size), ElementsAre("k150", "k100"));
    EXPECT_THAT(ids("name:k AND sae_grade = 90 AND kv100 = 14.2 AND density > 860", "", size),
                ElementsAre("k100", "k150", "k70", "k85"));
    EXPECT_THAT(ids("name:k AND kv40 != 100", "condition desc", size),
                ElementsAre("k150", "k85", "k70"));
  }
  // All oils of the fixture have the same figures: then names decide the order.
  EXPECT_THAT(ids("name:o", "kv40 desc", 3),
              ElementsAre("o7", "o6", "o5", "o4", "o3", "o2", "o1", "o0"));
  EXPECT_THAT(ids("kv40:*").size(), 12U);
}

TEST_F(ListTest, NamesNeedNoCollectionAndEnumsNoCapitals) {
  EXPECT_THAT(ids("name = o3"), ElementsAre("o3"));
  EXPECT_THAT(ids("name = lubricants/o3"), ElementsAre("o3"));
  EXPECT_THAT(ids("condition = fresh"), ElementsAre("o0", "o1", "o2"));
  v1::Lubricant child = three_numbers();
  child.set_derived_from("lubricants/o1");
  child.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_GROUP_III);
  ASSERT_TRUE(create(child, "child").ok());
  EXPECT_THAT(ids("derived_from = o1"), ElementsAre("child"));
  EXPECT_THAT(ids("base_oil_class = group-iii"), ElementsAre("child"));
  EXPECT_THAT(ids("base_oil_class = BASE_OIL_CLASS_GROUP_III"), ElementsAre("child"));
}

TEST_F(ListTest, EveryFluidShowsItsFigures) {
  const auto page = list_lubricants(app_, v1::ListLubricantsRequest());
  ASSERT_TRUE(page.ok());
  for (const v1::Lubricant& each : page.message().lubricants()) {
    const v1::Lubricant whole = get(each.name()).message();
    const auto& shown = each.characterisation();
    EXPECT_EQ(shown.viscosity_index(), whole.characterisation().viscosity_index()) << each.name();
    EXPECT_GT(shown.viscosity_index(), 50);
    EXPECT_GT(shown.kinematic_viscosity_40_celsius_square_millimetres_per_second(),
              shown.kinematic_viscosity_100_celsius_square_millimetres_per_second());
    EXPECT_EQ(shown.warnings_size() + shown.walther_comparison_size(), 0) << "for Get";
  }
}

TEST_F(ResourcesTest, AResourceCannotDescendFromAMissingOneOrFromItsDescendants) {
  const auto derive = [&](const std::string& name, const std::string& parent) {
    v1::UpdateLubricantRequest request;
    request.set_allow_missing(true);
    *request.mutable_lubricant() = seed<v1::Lubricant>("lubricants/paper-fluid-1");
    request.mutable_lubricant()->set_name("lubricants/" + name);
    request.mutable_lubricant()->set_derived_from("lubricants/" + parent);
    const auto outcome = update_lubricant(app_, request);
    return outcome.ok() ? "" : complaints(outcome.error());
  };
  EXPECT_THAT(derive("sheared", "frehs"), HasSubstr("\"lubricants/frehs\" does not exist"));
  EXPECT_EQ(derive("fresh", "paper-fluid-1"), "");
  EXPECT_EQ(derive("sheared", "fresh@7"), "") << "revisions number anew on import";
  EXPECT_EQ(derive("used", "sheared"), "");
  EXPECT_THAT(derive("fresh", "used"),
              HasSubstr("lubricants/used itself descends from lubricants/fresh"));
  EXPECT_THAT(derive("fresh", "fresh@1"), HasSubstr("is the resource itself"));
  EXPECT_THAT(derive("sheared", "frehs"), HasSubstr("did you mean \"lubricants/fresh\"?"));
}

TEST_F(ListTest, UnknownWordsSuggestTheNearest) {
  const auto said = [&](const std::string& filter, const std::string& order) {
    v1::ListLubricantsRequest request;
    request.set_filter(filter);
    request.set_order_by(order);
    return complaints(list_lubricants(app_, request).error());
  };
  EXPECT_THAT(said("conditon = USED", ""), HasSubstr("did you mean \"condition\"?"));
  EXPECT_THAT(said("pressure_viscosty > 1", ""),
              HasSubstr("did you mean \"pressure_viscosity_coefficient_per_pascal\"?"));
  EXPECT_THAT(said("colour = red", ""), HasSubstr("base_oil_class, condition"));
  EXPECT_THAT(said("colour = red", ""), Not(HasSubstr("did you mean")));
  EXPECT_THAT(said("condition = USD", ""), HasSubstr("did you mean \"USED\"?"));
  EXPECT_THAT(said("condition = old", ""), HasSubstr("allowed: CONDITION_UNSPECIFIED, FRESH"));
  v1::ListLubricantsRequest unstated;
  unstated.set_filter("condition = CONDITION_UNSPECIFIED");
  EXPECT_TRUE(list_lubricants(app_, unstated).ok()) << "many do not state theirs";
  EXPECT_THAT(said("thermal_conductivity_watts_per_metre_kelvin = warm", ""),
              HasSubstr("a finite number"));
  EXPECT_THAT(said("create_time > yesterday", ""), HasSubstr("2026-01-31T12:00:00Z"));
  EXPECT_THAT(said("condition = USED OR condition = FRESH", ""), HasSubstr("joined by AND"));
  EXPECT_THAT(said("condition = \"USED", ""), HasSubstr("quotes"));
  EXPECT_THAT(said("condition", ""), HasSubstr("allowed: field"));
  EXPECT_THAT(said("", "lims"), HasSubstr("did you mean \"lims_id\"?"));
  EXPECT_THAT(said("", "name backwards"), HasSubstr("asc or desc"));
  EXPECT_THAT(said(std::string(3000, 'x'), ""), HasSubstr("at most 2000"));
}

TEST_F(ResourcesTest, RefusesAMaskOfTooManyPaths) {
  v1::Lubricant fluid;
  fluid.set_name("lubricants/paper-fluid-1");
  fluid.set_display_name("x");
  const std::vector<std::string> paths(kMaximumMaskPaths, "display_name");
  EXPECT_TRUE(update(fluid, paths).ok());
  std::vector<std::string> more(5000, "no_such_field");
  const auto refused = update(fluid, more);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code(), google::rpc::INVALID_ARGUMENT);
  EXPECT_THAT(complaint_lines(refused.error()),
              testing::ElementsAre("update_mask: 5000 entries; allowed: at most 200"));
}

TEST_F(ListTest, ThePagesOfAListTellItsTotal) {
  const auto totals = [&](const std::string& filter, const std::string& order = "") {
    v1::ListLubricantsRequest request;
    request.set_filter(filter);
    request.set_order_by(order);
    request.set_page_size(2);
    std::set<int> out;
    do {
      const auto page = list_lubricants(app_, request);
      EXPECT_TRUE(page.ok()) << complaints(page.error());
      out.insert(page.message().total_size());
      request.set_page_token(page.message().next_page_token());
    } while (!request.page_token().empty());
    return out;
  };
  EXPECT_THAT(totals(""), ElementsAre(8)) << "without what is deleted";
  EXPECT_THAT(totals("condition = FRESH"), ElementsAre(3));
  EXPECT_THAT(totals("condition != FRESH AND labels.project = gearbox", "lims_id desc"),
              ElementsAre(4));
  EXPECT_THAT(totals("labels.urgent:*"), ElementsAre(1));
  EXPECT_THAT(totals("lims_id = none"), ElementsAre(0));
  EXPECT_THAT(totals("", "kv40"), ElementsAre(8)) << "an order by computed figures reads all";
  EXPECT_THAT(totals("kv40 > 1 AND condition = FRESH"), ElementsAre(-1)) << "not counted";
  EXPECT_THAT(totals("kv40 > 1 AND labels.urgent:*"), ElementsAre(1));
  v1::ListLubricantRevisionsRequest revisions;
  revisions.set_name("lubricants/o1");
  EXPECT_EQ(list_lubricant_revisions(app_, revisions).message().total_size(), 1);
}

TEST_F(ListTest, ACallEndsAtItsDeadlineAndHasChangedNothing) {
  const CallContext call{.limits = {.deadline = CallLimits::Clock::now()}};
  std::vector<ResourceWrite> many;
  for (int i = 0; i < 200; ++i) {
    many.push_back({{"lubricants/m" + std::to_string(i), std::string(5000, 'x')}, std::nullopt});
  }
  EXPECT_THROW(bench_.store().write_resources(many, 1, call.limits), StoreError);
  v1::ListLubricantsRequest request;
  request.set_filter("display_name:odd AND name:o AND lims_id:l AND labels.project:a");
  EXPECT_EQ(list_lubricants(app_, request, call).error().code(), google::rpc::DEADLINE_EXCEEDED);
}

TEST_F(ListTest, ATokenBelongsToItsList) {
  v1::ListLubricantsRequest request;
  request.set_page_size(2);
  request.set_filter("condition = USED");
  request.set_page_token(list_lubricants(app_, request).message().next_page_token());
  ASSERT_NE(request.page_token(), "");
  EXPECT_TRUE(list_lubricants(app_, request).ok());
  request.set_filter("condition = FRESH");
  EXPECT_THAT(complaints(list_lubricants(app_, request).error()), HasSubstr("page_token"));
  request.clear_filter();
  for (const char* token : {"x", "lubricants/paper-fluid-1", "0123456789abcdef", "zz"}) {
    request.set_page_token(token);
    EXPECT_EQ(list_lubricants(app_, request).error().code(), google::rpc::INVALID_ARGUMENT);
  }
}

TEST_F(ResourcesTest, AMaskMayNameAFieldOfAMessage) {
  v1::Lubricant cold = three_numbers();
  auto* brookfield = cold.mutable_measurements()->add_brookfield_viscosities();
  brookfield->set_temperature_celsius(-40);
  brookfield->set_dynamic_viscosity_millipascal_seconds(140000);
  const auto made = create(cold, "cold");
  ASSERT_TRUE(made.ok()) << complaints(made.error());
  v1::Lubricant row;
  row.set_name("lubricants/cold");
  auto* measured = row.mutable_measurements();
  measured->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(75);
  const std::string kv40 =
      "measurements.kinematic_viscosity_40_celsius_square_millimetres_per_second";
  const auto changed = update(row, {kv40});
  ASSERT_TRUE(changed.ok()) << complaints(changed.error());
  EXPECT_EQ(changed.message().measurements().brookfield_viscosities_size(), 1) << "stays";
  EXPECT_EQ(changed.message()
                .measurements()
                .kinematic_viscosity_100_celsius_square_millimetres_per_second(),
            14.2);
  EXPECT_NE(changed.message().vogel_temperature_coefficient_kelvin(),
            made.message().vogel_temperature_coefficient_kelvin())
      << "fitted again";
  EXPECT_EQ(update(row, {kv40}).message().revision(), 2) << "nothing changes";

  v1::Lubricant plain;
  plain.set_name("lubricants/paper-fluid-1");
  EXPECT_EQ(update(plain, {kv40}).message().revision(), 1) << "nothing to take over";
  EXPECT_THAT(complaints(update(row, {"measurements.densties"}).error()),
              HasSubstr("\"densties\" is not a field of LubricantMeasurements; did you mean "
                        "\"densities\"?"));
  for (const char* none : {"labels.key", "display_name.x", "measurments.densities"}) {
    EXPECT_THAT(complaints(update(row, {none}).error()), HasSubstr("update_mask"));
  }
  EXPECT_THAT(complaints(update(row, {"measurements.densities.temperature_celsius"}).error()),
              HasSubstr("is part of \"measurements.densities\", which changes as a whole"));
  EXPECT_EQ(update(row, {"characterisation.viscosity_index"}).message().revision(), 2)
      << "what only the server sets is left out";

  v1::Lubricant sharper = changed.message();
  sharper.mutable_measurements()->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
      76);
  const auto whole = update(sharper, {kv40, "measurements", kv40});
  ASSERT_TRUE(whole.ok()) << complaints(whole.error());
  EXPECT_EQ(whole.message().measurements().SerializeAsString(),
            sharper.measurements().SerializeAsString())
      << "a path that stands there twice, or inside another one, changes nothing";

  v1::UpdateGearSetRequest gear_set;
  gear_set.mutable_gear_set()->set_name("gearSets/reference-axle");
  gear_set.mutable_gear_set()->mutable_dynamics()->set_half_backlash_metres(7e-5);
  gear_set.mutable_update_mask()->add_paths("dynamics.half_backlash_metres");
  const auto wider = update_gear_set(app_, gear_set);
  ASSERT_TRUE(wider.ok()) << complaints(wider.error());
  EXPECT_EQ(wider.message().dynamics().half_backlash_metres(), 7e-5);
  EXPECT_GT(wider.message().dynamics().gear_inertia_kilogram_square_metres(), 0);
  for (const auto& entry : wider.message().provenance()) {
    if (entry.field() != "dynamics.half_backlash_metres") continue;
    EXPECT_EQ(entry.provenance(), v1::PROVENANCE_USER)
        << "what was known of the old number is gone";
  }
}

TEST_F(ResourcesTest, EveryKindOfResourceHasTheStandardMethods) {
  v1::CreateVehicleRequest vehicle;
  *vehicle.mutable_vehicle() = seed<v1::Vehicle>("vehicles/passenger-car");
  vehicle.set_vehicle_id("van");
  EXPECT_TRUE(create_vehicle(app_, vehicle).ok());
  vehicle.mutable_vehicle()->clear_gravity_metres_per_second_squared();
  vehicle.set_vehicle_id("moon");
  EXPECT_THAT(complaints(create_vehicle(app_, vehicle).error()),
              HasSubstr("gravity_metres_per_second_squared is not set; allowed: 0 to 100 m/s2"));
  v1::CreateSurfaceRequest surface;
  *surface.mutable_surface() = seed<v1::Surface>("surfaces/run-in");
  surface.set_surface_id("copy");
  surface.mutable_surface()->set_derived_from("surfaces/run-in@1");
  EXPECT_TRUE(create_surface(app_, surface).ok());
  v1::CreateGearSetRequest gear_set;
  *gear_set.mutable_gear_set() = seed<v1::GearSet>("gearSets/reference-axle");
  gear_set.set_gear_set_id("copy");
  EXPECT_TRUE(create_gear_set(app_, gear_set).ok());
  v1::ListGearSetsRequest list;
  list.set_view(v1::GEAR_SET_VIEW_BASIC);
  EXPECT_EQ(list_gear_sets(app_, list).message().gear_sets(0).flank_slots_size(), 0);
}

TEST_F(ResourcesTest, TheSchemaIsTheTableAndTheWordsThatAreAccepted) {
  const v1::Schema schema = get_schema(app_, {}).message();
  ASSERT_EQ(static_cast<std::size_t>(schema.constraints_size()), constraints().size());
  for (int i = 0; i < schema.constraints_size(); ++i) {
    EXPECT_EQ(schema.constraints(i).field(), constraints()[static_cast<std::size_t>(i)].field);
    EXPECT_EQ(schema.constraints(i).maximum(), constraints()[static_cast<std::size_t>(i)].maximum);
  }
  std::map<std::string, std::vector<std::string>> words;
  for (const auto& each : schema.vocabularies()) {
    words[each.name()] = {each.words().begin(), each.words().end()};
    EXPECT_THAT(each.words(), Not(IsEmpty())) << each.name();
  }
  EXPECT_THAT(words["history.columns"], testing::Contains("mesh_force_newtons"));
  EXPECT_THAT(words["campaigns.filter"], testing::Contains("end_time"));
  EXPECT_THAT(words["Lubricant.BaseOilClass"], testing::Contains("BASE_OIL_CLASS_POLYALPHAOLEFIN"));
  for (const std::string& field : words["lubricants.filter"]) {
    if (field.find("KEY") != std::string::npos) continue;
    EXPECT_TRUE(list_lubricants(app_,
                                [&] {
                                  v1::ListLubricantsRequest request;
                                  request.set_order_by(field);
                                  return request;
                                }())
                    .ok())
        << field;
  }
  v1::GetSchemaRequest one;
  one.set_message("Vehicle");
  EXPECT_EQ(get_schema(app_, one).message().constraints_size(), 7);
}

TEST_F(ResourcesTest, AnotherRatioWithTheSameToothDataIsRefusedInOneSentence) {
  v1::CreateGearSetRequest request;
  request.set_gear_set_id("other-ratio");
  *request.mutable_gear_set() = seed<v1::GearSet>("gearSets/reference-axle");
  request.mutable_gear_set()->set_gear_teeth(41);
  EXPECT_EQ(
      complaints(create_gear_set(app_, request).error()),
      "gear_set.gear_teeth: 41/13 teeth; the series (R_g0/R_p0) and the flank slots belong to "
      "a ratio of 2.76923; a gear set of another ratio needs tooth contact data of its own\n");
}

TEST_F(ResourcesTest, ANameWithOtherCharactersIsRefusedWithAnAllowedOne) {
  v1::CreateLubricantRequest request;
  *request.mutable_lubricant() = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  const auto complaint_of = [&](const std::string& id) {
    request.set_lubricant_id(id);
    return complaints(create_lubricant(app_, request).error());
  };
  EXPECT_THAT(complaint_of("Mobil 1  75W-90"), HasSubstr("; did you mean \"Mobil-1-75W-90\"?"));
  EXPECT_THAT(complaint_of(" Öl (neu) "), HasSubstr("; did you mean \"l-neu\"?"));
  EXPECT_THAT(complaint_of("75W/90"), HasSubstr("; did you mean \"75W-90\"?"));
  EXPECT_THAT(complaint_of("lubricants/75W/90"), HasSubstr("; did you mean \"75W-90\"?"));
  EXPECT_THAT(complaint_of("***"), Not(HasSubstr("did you mean")));
}

TEST_F(ResourcesTest, AnUpdateOfANameWithASlashWritesNoOtherResource) {
  ASSERT_TRUE(create(three_numbers(), "1234567").ok());
  v1::UpdateLubricantRequest request;
  *request.mutable_lubricant() = three_numbers();
  request.mutable_lubricant()->set_name("Some Brand/1234567");
  request.set_allow_missing(true);
  const auto answer = update_lubricant(app_, request);
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(get("lubricants/1234567").message().revision(), 1);
  request.mutable_lubricant()->set_name("75W/90");
  EXPECT_THAT(complaints(update_lubricant(app_, request).error()), HasSubstr("lubricants/75W-90"));
}

TEST_F(ResourcesTest, AnInvalidGearSetTableIsReportedBySample) {
  v1::CreateGearSetRequest request;
  request.set_gear_set_id("bad");
  v1::GearSet& set = *request.mutable_gear_set();
  set = seed<v1::GearSet>("gearSets/reference-axle");
  set.mutable_flank_slots(1)->set_load_share(7, 0.5);
  set.mutable_flank_slots(2)->set_radius_x_metres(0, 0.5);
  set.mutable_flank_slots(0)->set_gear_friction_arm_metres(3, 1);
  set.mutable_series()->mutable_gear_contact_radius_metres()->set_mean(0.1);
  const std::string said = complaints(create_gear_set(app_, request).error());
  EXPECT_THAT(said, HasSubstr("gear_set.flank_slots[0].load_share[7]: load shares"));
  EXPECT_THAT(said, HasSubstr("gear_set.flank_slots[1].radius_x_metres[96]"));
  EXPECT_THAT(said, HasSubstr("gear_set.flank_slots[0].pinion_friction_arm_metres[3]"));
  EXPECT_THAT(said, HasSubstr("gear_set.series.gear_contact_radius_metres.mean: R_g0 = 0.1 m"));
}

}  // namespace
}  // namespace tribodyn::server
