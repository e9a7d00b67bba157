// Batches are written completely or not at all, and violations name the right element.
#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/call_context.h"
#include "server/contract/constraints.h"
#include "server/resources/accept_resource.h"
#include "server/storage/maintenance.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

v1::Lubricant fluid(const std::string& id) {
  v1::Lubricant out;
  out.set_name("lubricants/" + id);
  auto* measured = out.mutable_measurements();
  measured->set_kinematic_viscosity_40_celsius_square_millimetres_per_second(73.3);
  measured->set_kinematic_viscosity_100_celsius_square_millimetres_per_second(8.86);
  measured->set_density_15_celsius_kilograms_per_cubic_metre(870);
  return out;
}

std::string numbered(int i) { return "many-" + std::to_string(i); }

class BatchTest : public testing::Test {
 protected:
  static v1::BatchCreateLubricantsRequest creation(const std::vector<v1::Lubricant>& fluids) {
    v1::BatchCreateLubricantsRequest batch;
    for (const v1::Lubricant& each : fluids) *batch.add_requests()->mutable_lubricant() = each;
    return batch;
  }
  static v1::BatchCreateLubricantsRequest many(int count) {
    std::vector<v1::Lubricant> fluids;
    for (int i = 0; i < count; ++i) fluids.push_back(fluid(numbered(i)));
    v1::BatchCreateLubricantsRequest batch = creation(fluids);
    batch.mutable_read_mask()->add_paths("name");
    return batch;
  }
  static v1::BatchUpdateLubricantsRequest update(const std::vector<v1::Lubricant>& fluids,
                                                 bool allow_missing = false) {
    v1::BatchUpdateLubricantsRequest batch;
    for (const v1::Lubricant& each : fluids) {
      *batch.add_requests()->mutable_lubricant() = each;
      batch.mutable_requests()->rbegin()->set_allow_missing(allow_missing);
    }
    return batch;
  }

  v1::Lubricant get(const std::string& id) {
    v1::GetLubricantRequest request;
    request.set_name("lubricants/" + id);
    const auto found = get_lubricant(app_, request);
    if (!found.ok()) ADD_FAILURE() << found.error().message();
    return found.ok() ? found.message() : v1::Lubricant();
  }
  std::size_t count() { return bench_.store().resource_names("default", "lubricants").size(); }

  void expect_nothing_written(const google::rpc::Status& status, google::rpc::Code code) {
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_EQ(count(), before_);
    EXPECT_THAT(check_database(bench_.database()), testing::IsEmpty());
  }

  Bench bench_;
  Application app_ = bench_.application();
  const std::size_t before_ = count();
};

TEST_F(BatchTest, AllAreCreatedAndAnsweredInOrder) {
  const auto created = batch_create_lubricants(app_, creation({fluid("b"), fluid("a")}));
  ASSERT_TRUE(created.ok()) << created.error().message();
  ASSERT_EQ(created.message().lubricants_size(), 2);
  for (const int i : {0, 1}) {
    const v1::Lubricant& each = created.message().lubricants(i);
    EXPECT_EQ(each.SerializeAsString(), get(i == 0 ? "b" : "a").SerializeAsString())
        << "as a create answers";
  }
}

TEST_F(BatchTest, AViolationInTheLastElementWritesNothing) {
  v1::BatchCreateLubricantsRequest batch = many(300);
  batch.mutable_requests(299)->mutable_lubricant()->set_relaxation_time_seconds(-1);
  const auto refused = batch_create_lubricants(app_, batch);
  ASSERT_FALSE(refused.ok());
  expect_nothing_written(refused.error(), google::rpc::INVALID_ARGUMENT);
  EXPECT_THAT(complaint_lines(refused.error()),
              ElementsAre(StartsWith("requests[299].lubricant.relaxation_time_seconds: "
                                     "relaxation_time_seconds = -1 s; allowed: 0 to 10 s")));
}

TEST_F(BatchTest, TheViolationsOfAllElementsAreReportedTogether) {
  v1::BatchCreateLubricantsRequest batch =
      creation({fluid("paper-fluid-1"), fluid("x"), fluid("y"), fluid("y"), fluid("z")});
  batch.mutable_requests(1)->mutable_lubricant()->set_thermal_conductivity_watts_per_metre_kelvin(
      1e9);
  batch.mutable_requests(1)->mutable_lubricant()->set_limiting_shear_stress_coefficient(-1);
  batch.mutable_requests(2)->set_lubricant_id("a b");
  batch.mutable_requests(3)->set_validate_only(true);
  batch.mutable_requests(4)->mutable_lubricant()->set_derived_from("lubricants/paper-fluid-11");
  batch.add_requests();
  *batch.add_requests() = batch.requests(0);
  const auto refused = batch_create_lubricants(app_, batch);
  ASSERT_FALSE(refused.ok());
  expect_nothing_written(refused.error(), google::rpc::INVALID_ARGUMENT);
  EXPECT_THAT(
      complaint_lines(refused.error()),
      ElementsAre(
          HasSubstr("requests[0].lubricant.name: lubricants/paper-fluid-1 exists already"),
          StartsWith("requests[1].lubricant.limiting_shear_stress_coefficient: "),
          StartsWith("requests[1].lubricant.thermal_conductivity_"),
          StartsWith("requests[2].lubricant_id: \"a b\"; allowed: "),
          StartsWith("requests[3].validate_only: "),
          HasSubstr("requests[4].lubricant.derived_from: \"lubricants/paper-fluid-11\" does "
                    "not exist; did you mean \"lubricants/paper-fluid-1\"?"),
          "requests[5].lubricant: not set",
          HasSubstr("requests[6].lubricant.name: lubricants/paper-fluid-1 stands in "
                    "requests[0] too; allowed: once"),
          HasSubstr("requests[6].lubricant.name: lubricants/paper-fluid-1 exists already")));
}

TEST_F(BatchTest, AnExistingNameIsRefusedWithAlreadyExists) {
  v1::Lubricant gone = fluid("gone");
  ASSERT_TRUE(batch_create_lubricants(app_, creation({gone})).ok());
  v1::DeleteLubricantRequest deletion;
  deletion.set_name("lubricants/gone");
  ASSERT_TRUE(delete_lubricant(app_, deletion).ok());
  const auto taken =
      batch_create_lubricants(app_, creation({fluid("new"), gone, fluid("paper-fluid-1")}));
  ASSERT_FALSE(taken.ok());
  expect_nothing_written(taken.error(), google::rpc::ALREADY_EXISTS);
  EXPECT_THAT(
      complaint_lines(taken.error()),
      ElementsAre(
          StartsWith("requests[1].lubricant.name: lubricants/gone exists and is"),
          StartsWith("requests[2].lubricant.name: lubricants/paper-fluid-1 exists already")));
  const auto deleted = batch_update_lubricants(app_, update({fluid("new"), gone}, true));
  ASSERT_FALSE(deleted.ok());
  expect_nothing_written(deleted.error(), google::rpc::FAILED_PRECONDITION);
  auto replacements = update({fluid("paper-fluid-1"), fluid("paper-fluid-11")});
  replacements.mutable_requests(0)->mutable_update_mask()->add_paths("*");
  const auto missing = batch_update_lubricants(app_, replacements);
  ASSERT_FALSE(missing.ok());
  expect_nothing_written(missing.error(), google::rpc::NOT_FOUND);
  EXPECT_THAT(complaint_lines(missing.error()), ElementsAre(HasSubstr("did you mean")));
}

TEST_F(BatchTest, OneMayDescendFromAnotherWhicheverComesFirst) {
  v1::Lubricant child = fluid("child"), grandchild = fluid("grandchild");
  child.set_derived_from("lubricants/parent");
  grandchild.set_derived_from("lubricants/child@1");
  const auto made = batch_create_lubricants(app_, creation({grandchild, child, fluid("parent")}));
  ASSERT_TRUE(made.ok()) << made.error().message();
  EXPECT_EQ(get("grandchild").derived_from(), "lubricants/child@1");

  v1::Lubricant parent = get("parent");
  parent.set_derived_from("lubricants/new");
  v1::Lubricant ring = fluid("new");
  ring.set_derived_from("lubricants/grandchild");
  const auto refused = batch_update_lubricants(app_, update({parent, ring}, true));
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(complaint_lines(refused.error()),
              ElementsAre(HasSubstr("requests[0].lubricant.derived_from: lubricants/new itself "
                                    "descends from lubricants/parent"),
                          HasSubstr("requests[1].lubricant.derived_from: lubricants/grandchild "
                                    "itself descends from lubricants/new")));
  EXPECT_EQ(get("parent").revision(), 1);
}

TEST_F(BatchTest, ABatchUpdateMakesRevisionsLikeASingleUpdate) {
  v1::Lubricant first = get("paper-fluid-1"), second = get("paper-fluid-2"),
                third = get("paper-fluid-3");
  first.set_display_name("renamed");
  second.set_display_name("renamed");
  second.set_lims_id("not in the mask");
  v1::BatchUpdateLubricantsRequest batch = update({first, second, third, fluid("new")}, true);
  batch.mutable_requests(1)->mutable_update_mask()->add_paths("display_name");
  const auto updated = batch_update_lubricants(app_, batch);
  ASSERT_TRUE(updated.ok()) << updated.error().message();
  EXPECT_EQ(updated.message().lubricants(0).revision(), 2);
  EXPECT_EQ(updated.message().lubricants(1).revision(), 2);
  EXPECT_EQ(updated.message().lubricants(2).SerializeAsString(), third.SerializeAsString())
      << "what changes nothing makes no revision";
  EXPECT_EQ(updated.message().lubricants(3).revision(), 1);
  EXPECT_EQ(get("paper-fluid-2").lims_id(), "");

  const auto stale = batch_update_lubricants(app_, update({third, first, fluid("other")}, true));
  ASSERT_FALSE(stale.ok());
  EXPECT_EQ(stale.error().code(), google::rpc::ABORTED);
  EXPECT_THAT(complaint_lines(stale.error()),
              ElementsAre(HasSubstr("requests[1].lubricant.etag: ")));
  EXPECT_EQ(get("paper-fluid-1").revision(), 2);
  EXPECT_EQ(count(), before_ + 1);
}

TEST_F(BatchTest, ValidateOnlyAnswersAsIfWrittenAndWritesNothing) {
  v1::BatchCreateLubricantsRequest batch = many(3);
  batch.clear_read_mask();
  batch.set_validate_only(true);
  batch.mutable_requests(1)->set_validate_only(true);
  const auto checked = batch_create_lubricants(app_, batch);
  ASSERT_TRUE(checked.ok()) << checked.error().message();
  expect_nothing_written({}, google::rpc::OK);
  EXPECT_GT(checked.message().lubricants(2).characterisation().viscosity_index(), 90);
  v1::Lubricant renamed = get("paper-fluid-1");
  renamed.set_display_name("renamed");
  v1::BatchUpdateLubricantsRequest changes = update({renamed});
  changes.set_validate_only(true);
  EXPECT_TRUE(batch_update_lubricants(app_, changes).ok());
  EXPECT_EQ(get("paper-fluid-1").revision(), 1);
}

TEST_F(BatchTest, AStoreErrorAtTheLastElementWritesNothing) {
  SQLite::Database raw = bench_.open_database();
  raw.exec(
      "CREATE TRIGGER fail BEFORE INSERT ON properties WHEN NEW.name = 'lubricants/many-499' "
      "BEGIN SELECT RAISE(ABORT, 'the disk is gone'); END");
  const auto failed = batch_create_lubricants(app_, many(500));
  ASSERT_FALSE(failed.ok());
  raw.exec("DROP TRIGGER fail");
  expect_nothing_written(failed.error(), google::rpc::UNAVAILABLE);
  EXPECT_TRUE(batch_create_lubricants(app_, many(500)).ok()) << "and the store goes on";
  EXPECT_EQ(count(), before_ + 500);
}

TEST_F(BatchTest, ADeadlineInAnyPhaseWritesNothing) {
  const v1::BatchCreateLubricantsRequest batch = many(300);
  // Deadlines from one that the batch always misses to one that it meets: the deadline passes in
  // every phase.
  for (std::chrono::milliseconds limit(1); limit < std::chrono::hours(1);
       limit += limit / 2 + std::chrono::milliseconds(1)) {
    const CallContext call{.limits = {.deadline = CallLimits::Clock::now() + limit}};
    const auto outcome = batch_create_lubricants(app_, batch, call);
    if (outcome.ok()) break;
    ASSERT_EQ(outcome.error().code(), google::rpc::DEADLINE_EXCEEDED) << outcome.error().message();
    ASSERT_EQ(count(), before_);
  }
  EXPECT_EQ(count(), before_ + 300);
}

TEST_F(BatchTest, TheSizeIsLimited) {
  for (const int size : {0, kMaximumBatchSize + 1}) {
    v1::BatchCreateLubricantsRequest batch;
    for (int i = 0; i < size; ++i) batch.add_requests();
    const auto refused = batch_create_lubricants(app_, batch);
    ASSERT_FALSE(refused.ok());
    expect_nothing_written(refused.error(), google::rpc::INVALID_ARGUMENT);
    EXPECT_THAT(complaint_lines(refused.error()),
                ElementsAre(StartsWith("requests: requests = " + std::to_string(size) +
                                       "; allowed: 1 to 20000")));
  }
}

TEST_F(BatchTest, TheReadMaskAndNotTheSizeDecidesWhatIsAnswered) {
  v1::BatchCreateLubricantsRequest batch = many(2000);
  batch.clear_read_mask();
  const auto refused = batch_create_lubricants(app_, batch);
  ASSERT_FALSE(refused.ok()) << "2000 whole fluids are more than clients accept";
  expect_nothing_written(refused.error(), google::rpc::INVALID_ARGUMENT);
  EXPECT_THAT(complaint_lines(refused.error()),
              ElementsAre(testing::AllOf(StartsWith("read_mask: the answer would take 4"),
                                         HasSubstr("allowed: at most 4000000"),
                                         HasSubstr("read_mask = \"name,etag,revision\""))));

  batch.mutable_read_mask()->add_paths("name");
  batch.mutable_read_mask()->add_paths("etag");
  batch.mutable_read_mask()->add_paths("revision");
  const auto made = batch_create_lubricants(app_, batch);
  ASSERT_TRUE(made.ok()) << made.error().message();
  ASSERT_EQ(made.message().lubricants_size(), 2000);
  EXPECT_LT(made.message().ByteSizeLong(), 200'000U);
  v1::Lubricant expected;
  const v1::Lubricant whole = get(numbered(1999));
  expected.set_name(whole.name());
  expected.set_etag(whole.etag());
  expected.set_revision(1);
  EXPECT_EQ(made.message().lubricants(1999).SerializeAsString(), expected.SerializeAsString());

  v1::BatchUpdateLubricantsRequest one = update({fluid(numbered(7))});
  EXPECT_EQ(batch_update_lubricants(app_, one).message().lubricants(0).SerializeAsString(),
            get(numbered(7)).SerializeAsString())
      << "without a mask all of it";
  one.mutable_read_mask()->add_paths("characterisation.viscosity_index");
  const v1::Lubricant index = batch_update_lubricants(app_, one).message().lubricants(0);
  EXPECT_GT(index.characterisation().viscosity_index(), 90);
  EXPECT_EQ(index.name(), "");
  one.mutable_read_mask()->add_paths("etga");
  const auto unknown = batch_update_lubricants(app_, one);
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(
      complaint_lines(unknown.error()),
      ElementsAre("read_mask: \"etga\" is not a field of Lubricant; did you mean \"etag\"?"));
}

TEST_F(BatchTest, ThousandsOfViolationsAreAnsweredInTime) {
  ASSERT_TRUE(batch_create_lubricants(app_, many(2000)).ok());
  v1::BatchCreateLubricantsRequest batch;
  v1::BatchUpdateLubricantsRequest updates;
  for (int i = 0; i < 5000; ++i) {
    v1::Lubricant* orphan = batch.add_requests()->mutable_lubricant();
    *orphan = fluid("orphan-" + std::to_string(i));
    orphan->set_derived_from("lubricants/mony-17");
    updates.add_requests()->mutable_lubricant()->set_name("lubricants/mony-" + std::to_string(i));
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto orphans = batch_create_lubricants(app_, batch);
  ASSERT_FALSE(orphans.ok());
  EXPECT_EQ(orphans.error().code(), google::rpc::INVALID_ARGUMENT);
  EXPECT_THAT(complaint_lines(orphans.error()).back(), HasSubstr("more violations"));
  const auto unknown = batch_update_lubricants(app_, updates);
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().code(), google::rpc::NOT_FOUND);
  EXPECT_THAT(complaint_lines(unknown.error()).back(), HasSubstr("more violations"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
  EXPECT_EQ(count(), before_ + 2000);
}

TEST_F(BatchTest, AnUpdateWithoutAMaskLosesNothingThatItLeavesOut) {
  v1::Lubricant full = fluid("full");
  full.set_description("kept");
  full.add_labels()->set_key("project");
  ASSERT_TRUE(batch_create_lubricants(app_, creation({full})).ok());
  v1::Lubricant change;
  change.set_name(full.name());
  change.set_display_name("renamed");
  const auto updated = batch_update_lubricants(app_, update({change, fluid("new")}, true));
  ASSERT_TRUE(updated.ok()) << updated.error().message();
  const v1::Lubricant now = get("full");
  EXPECT_EQ(now.display_name(), "renamed");
  EXPECT_EQ(now.description(), "kept");
  EXPECT_EQ(now.labels_size(), 1);
  EXPECT_EQ(now.measurements().SerializeAsString(), full.measurements().SerializeAsString());

  auto all = update({fluid("full")});
  all.mutable_requests(0)->mutable_update_mask()->add_paths("*");
  ASSERT_TRUE(batch_update_lubricants(app_, all).ok());
  EXPECT_EQ(get("full").description(), "");
}

TEST_F(BatchTest, ConcurrentBatchesDoNotMix) {
  ASSERT_TRUE(batch_create_lubricants(app_, many(10)).ok());
  std::vector<std::thread> writers;
  for (const std::string tag : {"left", "right", "middle"}) {
    writers.emplace_back([this, tag] {
      v1::BatchUpdateLubricantsRequest batch;
      for (int i = 0; i < 10; ++i) {
        auto* request = batch.add_requests();
        request->mutable_lubricant()->set_name("lubricants/" + numbered(i));
        request->mutable_update_mask()->add_paths("display_name");
      }
      for (int k = 0; k < 20; ++k) {
        for (auto& request : *batch.mutable_requests()) {
          request.mutable_lubricant()->set_display_name(tag + std::to_string(k));
        }
        const auto outcome = batch_update_lubricants(app_, batch);
        EXPECT_TRUE(outcome.ok() || outcome.error().code() == google::rpc::ABORTED);
      }
    });
  }
  for (std::thread& each : writers) each.join();
  const v1::Lubricant first = get(numbered(0));
  for (int i = 1; i < 10; ++i) {
    EXPECT_EQ(get(numbered(i)).display_name(), first.display_name());
    EXPECT_EQ(get(numbered(i)).revision(), first.revision());
  }
  EXPECT_THAT(check_database(bench_.database()), testing::IsEmpty());
}

TEST_F(BatchTest, EveryKindOfResourceHasBatches) {
  v1::BatchCreateGearSetsRequest gear_sets;
  *gear_sets.add_requests()->mutable_gear_set() =
      seed<v1::GearSet>("gearSets/reference-axle-loaded-error");
  gear_sets.mutable_requests(0)->set_gear_set_id("mine");
  EXPECT_TRUE(batch_create_gear_sets(app_, gear_sets).ok());
  v1::BatchUpdateGearSetsRequest gear_set_updates;
  gear_set_updates.add_requests()->mutable_gear_set()->set_name("gearSets/mine");
  gear_set_updates.mutable_requests(0)->mutable_gear_set()->set_lims_id("7");
  gear_set_updates.mutable_requests(0)->mutable_update_mask()->add_paths("lims_id");
  EXPECT_EQ(batch_update_gear_sets(app_, gear_set_updates).message().gear_sets(0).revision(), 2);

  v1::BatchCreateSurfacesRequest surfaces;
  *surfaces.add_requests()->mutable_surface() = seed<v1::Surface>("surfaces/run-in");
  EXPECT_EQ(batch_create_surfaces(app_, surfaces).error().code(), google::rpc::ALREADY_EXISTS);
  v1::BatchUpdateSurfacesRequest surface_updates;
  *surface_updates.add_requests()->mutable_surface() = seed<v1::Surface>("surfaces/run-in");
  EXPECT_EQ(batch_update_surfaces(app_, surface_updates).message().surfaces(0).revision(), 1);

  v1::BatchCreateVehiclesRequest vehicles;
  *vehicles.add_requests()->mutable_vehicle() = seed<v1::Vehicle>("vehicles/passenger-car");
  vehicles.mutable_requests(0)->set_vehicle_id("van");
  EXPECT_EQ(batch_create_vehicles(app_, vehicles).message().vehicles(0).name(), "vehicles/van");
  v1::BatchUpdateVehiclesRequest vehicle_updates;
  vehicle_updates.add_requests()->mutable_vehicle()->set_name("vehicles/vam");
  const auto unknown = batch_update_vehicles(app_, vehicle_updates);
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(complaint_lines(unknown.error()),
              ElementsAre(HasSubstr("did you mean \"vehicles/van\"?")));
}

/// Vehicles with derived_from chains, and a count of look-ups.
class DescentTest : public testing::Test {
 protected:
  void add(const std::string& id, const std::string& parent) {
    v1::Vehicle vehicle = seed<v1::Vehicle>("vehicles/passenger-car");
    vehicle.set_name("vehicles/" + id);
    if (!parent.empty()) vehicle.set_derived_from("vehicles/" + parent);
    all_[vehicle.name()] = vehicle;
  }
  bool is_accepted(const std::string& id) {
    Violations violations;
    const bool accepted = accept(all_.at("vehicles/" + id), static_cast<v1::Vehicle*>(nullptr),
                                 lookup_, "vehicle", violations)
                              .has_value();
    EXPECT_EQ(accepted, violations.empty());
    return accepted;
  }

  std::map<std::string, v1::Vehicle> all_;
  int looks_ = 0;
  const ResourceLookup lookup_{[this](const RevisionName& name) -> std::optional<FoundResource> {
                                 ++looks_;
                                 const auto found = all_.find(name.name);
                                 if (found == all_.end()) return std::nullopt;
                                 return FoundResource{1, false, found->second.SerializeAsString()};
                               },
                               [](const std::string&) { return std::vector<std::string>(); }};
};

TEST_F(DescentTest, AChainIsReadOnceForAWholeBatch) {
  constexpr int kLength = 300;
  for (int i = 0; i < kLength; ++i) {
    add(std::to_string(i), i == 0 ? "" : std::to_string(i - 1));
  }
  for (int i = kLength; i-- > 0;) EXPECT_TRUE(is_accepted(std::to_string(i)));
  EXPECT_LE(looks_, 3 * kLength) << "and not half the square of it";
}

TEST_F(DescentTest, ACycleIsFoundFromItsMembersOnly) {
  add("a", "b");
  add("b", "c");
  add("c", "a");
  add("hangs", "a");
  add("apart", "");
  for (const auto& [id, expected] : std::vector<std::pair<std::string, bool>>{
           {"hangs", true}, {"apart", true}, {"b", false}, {"a", false}, {"c", false}}) {
    EXPECT_EQ(is_accepted(id), expected) << id;
  }
}

}  // namespace
}  // namespace tribodyn::server
