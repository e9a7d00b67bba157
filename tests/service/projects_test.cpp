// Projects: names with and without one, and what no two of them may share.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/request_project.h"
#include "server/application/simulations.h"
#include "server/storage/maintenance.h"
#include "server/storage/seeds.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"
#include "tribodyn/v1/purge_report.pb.h"

namespace tribodyn::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

const char kAcme[] = "acme";
const char kOther[] = "other-plant";

TEST(ProjectNames, OnlyTheProjectDefaultIsLeftOut) {
  EXPECT_EQ(full_name("default", "lubricants/x"), "lubricants/x");
  EXPECT_EQ(full_name("acme", "lubricants/x"), "projects/acme/lubricants/x");
  EXPECT_EQ(relative_name("projects/acme/lubricants/x@2"), "lubricants/x@2");
  EXPECT_EQ(relative_name("lubricants/x"), "lubricants/x");
  EXPECT_EQ(name_in("acme", "lubricants/x"), "projects/acme/lubricants/x");
  EXPECT_EQ(name_in("acme", "projects/default/lubricants/x"), "lubricants/x");
  EXPECT_EQ(simulation_name("default", 7), "simulations/7");
  EXPECT_EQ(simulation_name("acme", 7), "projects/acme/simulations/7");
}

TEST(ProjectNames, AreLowerCaseWords) {
  for (const char* good : {"a", "acme", "gear-boxes-2"}) EXPECT_TRUE(is_project_id(good)) << good;
  EXPECT_TRUE(is_project_id(std::string(63, 'a')));
  for (const char* bad : {"", "A", "2x", "-x", "x-", "x/y", "x_y", "x y", "x\n", "\xc3\xa4"}) {
    EXPECT_FALSE(is_project_id(bad)) << bad;
  }
  EXPECT_FALSE(is_project_id(std::string(64, 'a')));
}

RC_GTEST_PROP(ProjectNames, AFullNameIsSplitIntoItsParts, ()) {
  const auto word = rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange('a', 'z')));
  const std::string project = (*word).substr(0, 63);
  const std::string name = "lubricants/" + *word;
  const std::string full = "projects/" + project + "/" + name;
  const auto parts = split_name(full);
  RC_ASSERT(parts.has_value());
  RC_ASSERT(parts->project == project);
  RC_ASSERT(parts->relative == name);
  RC_ASSERT(name_in("other", "projects/" + project + "/" + name) == full_name(project, name));
}

class ProjectsTest : public testing::Test {
 protected:
  ProjectsTest() {
    for (const char* each : {kAcme, kOther}) bench_.store().add_project(each, seed_resources(), 1);
  }

  /// Answers a request as the dispatcher does.
  template <class Response, class Request>
  Outcome<Response> call(Request request) {
    CallContext context;
    if (auto refused = enter_project(app_, request, context)) return *refused;
    return ResourceCall<Response>()(app_, request, context);
  }
  static v1::Lubricant fluid(const std::string& name, double density_slope = 0.7) {
    v1::Lubricant out = seed<v1::Lubricant>("lubricants/paper-fluid-1");
    out.set_name(name);
    out.set_density_slope_kilograms_per_cubic_metre_kelvin(density_slope);
    return out;
  }
  Outcome<v1::Lubricant> create(const std::string& parent, const v1::Lubricant& lubricant) {
    v1::CreateLubricantRequest request;
    request.set_parent(parent);
    *request.mutable_lubricant() = lubricant;
    return call<v1::Lubricant>(request);
  }
  Outcome<v1::Lubricant> get(const std::string& name) {
    v1::GetLubricantRequest request;
    request.set_name(name);
    return call<v1::Lubricant>(request);
  }
  Outcome<v1::Simulation> simulate(const std::string& parent, const std::string& lubricant,
                                   const std::string& request_id = "") {
    v1::CreateSimulationRequest request;
    request.set_parent(parent);
    request.set_request_id(request_id);
    *request.mutable_simulation() = point_simulation();
    request.mutable_simulation()->set_lubricant(lubricant);
    return call<v1::Simulation>(request);
  }
  Outcome<v1::Simulation> get_job(const std::string& name) {
    v1::GetSimulationRequest request;
    request.set_name(name);
    return call<v1::Simulation>(request);
  }
  bool succeeds(const std::string& name) {
    return eventually([&] { return get_job(name).message().state() == v1::Simulation::SUCCEEDED; });
  }
  std::vector<std::string> lubricants(const std::string& parent, const std::string& filter = "",
                                      int page_size = 0) {
    v1::ListLubricantsRequest request;
    request.set_parent(parent);
    request.set_filter(filter);
    request.set_page_size(page_size);
    std::vector<std::string> out;
    do {
      const auto page = call<v1::ListLubricantsResponse>(request);
      if (!page.ok()) return {complaints(page.error())};
      for (const auto& each : page.message().lubricants()) out.push_back(each.name());
      request.set_page_token(page.message().next_page_token());
    } while (!request.page_token().empty());
    return out;
  }
  std::vector<std::string> jobs(const std::string& parent, const std::string& filter = "") {
    v1::ListSimulationsRequest request;
    request.set_parent(parent);
    request.set_filter(filter);
    const auto page = call<v1::ListSimulationsResponse>(request);
    if (!page.ok()) return {complaints(page.error())};
    std::vector<std::string> out;
    for (const auto& each : page.message().simulations()) out.push_back(each.name());
    EXPECT_EQ(page.message().total_size(), static_cast<int>(out.size()));
    return out;
  }

  Bench bench_;
  Application app_ = bench_.application();
};

TEST_F(ProjectsTest, EqualIdsAreTwoResources) {
  ASSERT_TRUE(create("", fluid("lubricants/oil", 0.7)).ok());
  const auto created = create("projects/acme", fluid("lubricants/oil", 0.8));
  ASSERT_TRUE(created.ok()) << complaints(created.error());
  EXPECT_EQ(created.message().name(), "projects/acme/lubricants/oil");
  const auto slope = [&](const std::string& name) {
    return get(name).message().density_slope_kilograms_per_cubic_metre_kelvin();
  };
  EXPECT_EQ(slope("lubricants/oil"), 0.7);
  EXPECT_EQ(slope("projects/default/lubricants/oil"), 0.7);
  EXPECT_EQ(slope("projects/acme/lubricants/oil"), 0.8);
  EXPECT_EQ(slope("projects/acme/lubricants/oil@1"), 0.8);
  EXPECT_EQ(get("projects/default/lubricants/oil").message().name(), "lubricants/oil");
  EXPECT_EQ(get("projects/acme/lubricants/oil@1").message().name(), "projects/acme/lubricants/oil");
  EXPECT_EQ(get("projects/other-plant/lubricants/oil").error().code(), google::rpc::NOT_FOUND);
  EXPECT_THAT(get("projects/other-plant/lubricants/oil").error().message(),
              testing::Not(HasSubstr("did you mean \"lubricants/oil\"")));
  v1::Lubricant stored;
  stored.ParseFromString(bench_.store().resource("projects/acme/lubricants/oil")->body);
  EXPECT_EQ(stored.name(), "lubricants/oil") << "bodies have relative names";
}

TEST_F(ProjectsTest, AnUnknownProjectIsNotFoundAndAMalformedOneIsInvalid) {
  EXPECT_EQ(get("projects/none/lubricants/paper-fluid-1").error().message(),
            "projects/none does not exist");
  EXPECT_EQ(create("projects/none", fluid("lubricants/x")).error().code(), google::rpc::NOT_FOUND);
  for (const char* bad : {"acme", "projects/", "projects/A", "projects/acme/lubricants", "/"}) {
    EXPECT_THAT(complaints(create(bad, fluid("lubricants/x")).error()),
                HasSubstr("parent: \"" + std::string(bad) + "\" is not a name of the form"));
  }
  EXPECT_THAT(complaints(get("projects/A/lubricants/x").error()), HasSubstr("name: "));
  EXPECT_THAT(complaints(get("projects//lubricants/x").error()), HasSubstr("name: "));
}

TEST_F(ProjectsTest, ARequestIsAboutOneProject) {
  EXPECT_THAT(
      complaints(create("projects/acme", fluid("projects/other-plant/lubricants/x")).error()),
      HasSubstr("lubricant.name: \"projects/other-plant/lubricants/x\" belongs to another"));
  v1::Lubricant copy = fluid("lubricants/x");
  copy.set_derived_from("projects/other-plant/lubricants/paper-fluid-1");
  EXPECT_THAT(complaints(create("projects/acme", copy).error()),
              HasSubstr("lubricant.derived_from: "));
  EXPECT_THAT(
      complaints(simulate("", "projects/acme/lubricants/paper-fluid-1").error()),
      HasSubstr("allowed: names of projects/default, which is the project of this request"));
  v1::BatchCreateLubricantsRequest batch;
  batch.add_requests()->set_parent("projects/acme");
  *batch.mutable_requests(0)->mutable_lubricant() = fluid("lubricants/x");
  *batch.add_requests()->mutable_lubricant() = fluid("projects/default/lubricants/y");
  EXPECT_THAT(complaints(call<v1::BatchCreateLubricantsResponse>(batch).error()),
              HasSubstr("requests[1].lubricant.name: "));
}

TEST_F(ProjectsTest, WithinARequestRelativeNamesMeanItsProject) {
  v1::Lubricant child = fluid("lubricants/child");
  child.set_derived_from("projects/acme/lubricants/paper-fluid-1@1");
  const auto created = create("projects/acme", child);
  ASSERT_TRUE(created.ok()) << complaints(created.error());
  EXPECT_EQ(created.message().derived_from(), "lubricants/paper-fluid-1@1");
  // The name gives the project as a parent does.
  v1::UpdateLubricantRequest update;
  update.mutable_lubricant()->set_name("projects/acme/lubricants/child");
  update.mutable_lubricant()->set_derived_from("lubricants/paper-fluid-2");
  const auto updated = call<v1::Lubricant>(update);
  ASSERT_TRUE(updated.ok()) << complaints(updated.error());
  EXPECT_EQ(updated.message().name(), "projects/acme/lubricants/child");
  EXPECT_EQ(updated.message().revision(), 2);
  EXPECT_EQ(get("lubricants/child").error().code(), google::rpc::NOT_FOUND);
  // A batch has one parent.
  v1::BatchCreateLubricantsRequest batch;
  batch.set_parent("projects/acme");
  *batch.add_requests()->mutable_lubricant() = fluid("lubricants/b1");
  *batch.add_requests()->mutable_lubricant() = fluid("projects/acme/lubricants/b2");
  batch.mutable_requests(0)->mutable_lubricant()->set_derived_from("lubricants/b2");
  const auto written = call<v1::BatchCreateLubricantsResponse>(batch);
  ASSERT_TRUE(written.ok()) << complaints(written.error());
  EXPECT_EQ(written.message().lubricants(0).name(), "projects/acme/lubricants/b1");
  EXPECT_THAT(lubricants("projects/acme", "name:lubricants/b"),
              ElementsAre("projects/acme/lubricants/b1", "projects/acme/lubricants/b2"));
  batch.set_validate_only(true);
  batch.mutable_requests(0)->mutable_lubricant()->set_name("lubricants/c1");
  batch.mutable_requests()->RemoveLast();
  EXPECT_EQ(call<v1::BatchCreateLubricantsResponse>(batch).message().lubricants(0).name(),
            "projects/acme/lubricants/c1");
}

TEST_F(ProjectsTest, AListHoldsItsProjectOnly) {
  ASSERT_TRUE(create("projects/acme", fluid("lubricants/oil")).ok());
  EXPECT_THAT(lubricants(""), ElementsAre("lubricants/paper-fluid-1", "lubricants/paper-fluid-2",
                                          "lubricants/paper-fluid-3", "lubricants/shell-t9"));
  EXPECT_THAT(
      lubricants("projects/acme", "", 1),
      ElementsAre("projects/acme/lubricants/oil", "projects/acme/lubricants/paper-fluid-1",
                  "projects/acme/lubricants/paper-fluid-2",
                  "projects/acme/lubricants/paper-fluid-3", "projects/acme/lubricants/shell-t9"));
  for (const char* filter :
       {"name = oil", "name = lubricants/oil", "name = projects/acme/lubricants/oil", "name:oil",
        "name > lubricants/a AND name < lubricants/p"}) {
    EXPECT_THAT(lubricants("projects/acme", filter), ElementsAre("projects/acme/lubricants/oil"))
        << filter;
    EXPECT_THAT(lubricants("projects/other-plant", filter), IsEmpty()) << filter;
  }
  EXPECT_THAT(lubricants("projects/acme", "name:acme"), IsEmpty()) << "is the project's id";
  EXPECT_EQ(lubricants("projects/acme", "kv100 > 1").size(), 5U) << "computed fields";
}

TEST_F(ProjectsTest, APageTokenIsWorthNothingUnderAnotherKeyOrChanged) {
  v1::ListLubricantsRequest request;
  request.set_page_size(1);
  const std::string token = call<v1::ListLubricantsResponse>(request).message().next_page_token();
  request.set_page_token(token);
  EXPECT_TRUE(call<v1::ListLubricantsResponse>(request).ok());
  for (std::size_t at : {std::size_t{0}, token.size() / 2, token.size() - 1}) {
    std::string changed = token;
    changed[at] = changed[at] == '0' ? '1' : '0';
    request.set_page_token(changed);
    EXPECT_FALSE(call<v1::ListLubricantsResponse>(request).ok()) << at;
  }
  request.set_page_token(token);
  app_.page_token_key = std::string(32, 'k');
  EXPECT_FALSE(call<v1::ListLubricantsResponse>(request).ok());
}

TEST_F(ProjectsTest, APageTokenIsOfOneProject) {
  v1::ListLubricantsRequest request;
  request.set_page_size(1);
  request.set_parent("projects/acme");
  request.set_page_token(call<v1::ListLubricantsResponse>(request).message().next_page_token());
  ASSERT_FALSE(request.page_token().empty());
  EXPECT_TRUE(call<v1::ListLubricantsResponse>(request).ok());
  for (const char* other : {"", "projects/other-plant"}) {
    request.set_parent(other);
    EXPECT_THAT(complaints(call<v1::ListLubricantsResponse>(request).error()),
                HasSubstr("page_token"));
  }
  v1::ListLubricantRevisionsRequest revisions;
  revisions.set_name("projects/acme/lubricants/paper-fluid-1");
  revisions.set_page_size(1);
  for (double slope : {0.7, 0.8}) {
    v1::UpdateLubricantRequest update;
    *update.mutable_lubricant() = fluid("projects/acme/lubricants/paper-fluid-1", slope);
    ASSERT_TRUE(call<v1::Lubricant>(update).ok());
  }
  const auto page = call<v1::ListLubricantRevisionsResponse>(revisions);
  ASSERT_TRUE(page.ok());
  EXPECT_EQ(page.message().lubricants(0).name(), "projects/acme/lubricants/paper-fluid-1@3");
  revisions.set_page_token(page.message().next_page_token());
  EXPECT_EQ(call<v1::ListLubricantRevisionsResponse>(revisions).message().lubricants(0).revision(),
            2);
  revisions.set_name("lubricants/paper-fluid-1");
  EXPECT_FALSE(call<v1::ListLubricantRevisionsResponse>(revisions).ok());
}

TEST_F(ProjectsTest, EachProjectCountsItsSimulations) {
  EXPECT_EQ(simulate("", "lubricants/paper-fluid-1").message().name(), "simulations/1");
  EXPECT_EQ(simulate("projects/acme", "lubricants/paper-fluid-1").message().name(),
            "projects/acme/simulations/1");
  EXPECT_EQ(simulate("", "lubricants/paper-fluid-2").message().name(), "simulations/2");
  const auto second = simulate("projects/acme", "projects/acme/lubricants/paper-fluid-2");
  EXPECT_EQ(second.message().name(), "projects/acme/simulations/2");
  EXPECT_EQ(second.message().lubricant(), "lubricants/paper-fluid-2");
  EXPECT_EQ(second.message().lubricant_revision(), "lubricants/paper-fluid-2@1");
  EXPECT_THAT(jobs("projects/acme"),
              ElementsAre("projects/acme/simulations/2", "projects/acme/simulations/1"));
  EXPECT_THAT(jobs("projects/acme", "lubricant = paper-fluid-2"),
              ElementsAre("projects/acme/simulations/2"));
  EXPECT_THAT(jobs("projects/acme", "lubricant = projects/acme/lubricants/paper-fluid-2@1"),
              ElementsAre("projects/acme/simulations/2"));
  EXPECT_THAT(jobs("", "lubricant = projects/acme/lubricants/paper-fluid-2"), IsEmpty());
  EXPECT_THAT(jobs("projects/other-plant"), IsEmpty());
  EXPECT_EQ(get_job("projects/other-plant/simulations/1").error().code(), google::rpc::NOT_FOUND);
  EXPECT_TRUE(succeeds("projects/acme/simulations/2"));
}

TEST_F(ProjectsTest, ARequestIdIsUniqueInItsProject) {
  const std::string first = simulate("", "lubricants/paper-fluid-1", "id").message().name();
  const auto other = simulate("projects/acme", "lubricants/paper-fluid-2", "id");
  ASSERT_TRUE(other.ok()) << complaints(other.error());
  EXPECT_EQ(other.message().name(), "projects/acme/simulations/1");
  EXPECT_EQ(simulate("", "lubricants/paper-fluid-1", "id").message().name(), first);
  EXPECT_EQ(simulate("projects/acme", "lubricants/paper-fluid-2", "id").message().name(),
            other.message().name());
  EXPECT_EQ(simulate("projects/acme", "lubricants/paper-fluid-1", "id").error().code(),
            google::rpc::ALREADY_EXISTS);
}

/// A cache hit would tell a project what another one has computed.
TEST_F(ProjectsTest, ResultsAreSharedWithinAProjectOnly) {
  const auto computed = [&](const std::string& parent) {
    const std::string name = simulate(parent, "lubricants/paper-fluid-1").message().name();
    EXPECT_TRUE(succeeds(name));
    return get_job(name).message();
  };
  const v1::Simulation first = computed("");
  EXPECT_FALSE(first.cache_hit());
  const v1::Simulation other = computed("projects/acme");
  EXPECT_FALSE(other.cache_hit());
  EXPECT_EQ(other.input_hash(), first.input_hash());
  EXPECT_EQ(other.result().SerializeAsString(), first.result().SerializeAsString());
  EXPECT_TRUE(computed("projects/acme").cache_hit());
  EXPECT_TRUE(computed("").cache_hit());
  EXPECT_FALSE(computed("projects/other-plant").cache_hit());
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(ProjectsTest, AJobIsComputedWithTheResourcesOfItsProject) {
  v1::UpdateGearSetRequest update;
  update.mutable_gear_set()->set_name("projects/acme/gearSets/reference-axle");
  update.mutable_gear_set()->set_description("of acme");
  ASSERT_TRUE(call<v1::GearSet>(update).ok());
  const auto mine = simulate("projects/acme", "lubricants/paper-fluid-1");
  EXPECT_EQ(mine.message().gear_set_revision(), "gearSets/reference-axle@2");
  EXPECT_EQ(simulate("", "lubricants/paper-fluid-1").message().gear_set_revision(),
            "gearSets/reference-axle@1");
  EXPECT_TRUE(succeeds(mine.message().name()));
}

TEST_F(ProjectsTest, APurgeOrADeletionConcernsItsProjectOnly) {
  for (const char* parent : {"", "projects/acme"}) {
    const auto job = simulate(parent, "lubricants/paper-fluid-1");
    ASSERT_TRUE(job.ok());
    ASSERT_TRUE(succeeds(job.message().name()));
  }
  v1::PurgeLubricantRequest purge;
  purge.set_name("projects/acme/lubricants/paper-fluid-1");
  purge.set_delete_simulations(true);
  const auto purged = call<v1::PurgeReport>(purge);
  ASSERT_TRUE(purged.ok()) << complaints(purged.error());
  EXPECT_EQ(purged.message().name(), purge.name());
  EXPECT_EQ(purged.message().simulations(), 1);
  EXPECT_EQ(get(purge.name()).error().code(), google::rpc::NOT_FOUND);
  EXPECT_TRUE(get("lubricants/paper-fluid-1").ok());
  EXPECT_TRUE(get_job("simulations/1").message().has_result());
  EXPECT_EQ(get_job("projects/acme/simulations/1").error().code(), google::rpc::NOT_FOUND);
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

TEST_F(ProjectsTest, NumbersAndProjectsOutliveARestart) {
  const std::string name = simulate("projects/acme", "lubricants/paper-fluid-1").message().name();
  ASSERT_TRUE(succeeds(name));
  const auto stored = bench_.store().numbered_simulation(kAcme, 1);
  ASSERT_EQ(bench_.store().remove_simulation(stored->id), Store::Removal::kDone);
  bench_.restart(quick_studies());
  EXPECT_TRUE(bench_.store().has_project(kAcme));
  EXPECT_FALSE(bench_.store().has_project("none"));
  Application again = bench_.application();
  v1::CreateSimulationRequest request;
  request.set_parent("projects/acme");
  *request.mutable_simulation() = point_simulation();
  CallContext context;
  ASSERT_FALSE(enter_project(again, request, context));
  EXPECT_EQ(create_simulation(again, request, context).message().name(),
            "projects/acme/simulations/2")
      << "no number is given twice";
  EXPECT_THAT(check_database(bench_.database()), IsEmpty());
}

/// Random writes with equal ids in three projects: each project is as if it were alone.
TEST_F(ProjectsTest, EachProjectIsAsIfItWereAlone) {
  int runs = 0;
  EXPECT_TRUE(rc::check("each project is as if it were alone", [&] {
    const std::vector<std::string> parents = {"projects/default", "projects/acme",
                                              "projects/other-plant"};
    std::map<std::string, std::map<std::string, double>> model;
    const auto steps = *rc::gen::container<std::vector<std::tuple<int, int, int, bool>>>(
        rc::gen::tuple(rc::gen::inRange(0, 3), rc::gen::inRange(0, 3), rc::gen::inRange(1, 9),
                       rc::gen::arbitrary<bool>()));
    const std::string run = std::to_string(++runs);
    for (const auto& [place, id, tenth, updates] : steps) {
      const std::string& parent = parents[place];
      const std::string name = "lubricants/run-" + run + "-" + std::to_string(id);
      auto& mine = model[parent];
      if (updates) {
        v1::UpdateLubricantRequest update;
        *update.mutable_lubricant() = fluid(parent + "/" + name, 0.1 * tenth);
        RC_ASSERT(call<v1::Lubricant>(update).ok() == mine.contains(name));
        if (mine.contains(name)) mine[name] = 0.1 * tenth;
      } else {
        RC_ASSERT(create(parent, fluid(name, 0.1 * tenth)).ok() == !mine.contains(name));
        mine.emplace(name, 0.1 * tenth);
      }
    }
    for (const std::string& parent : parents) {
      std::vector<std::string> names;
      for (const auto& [name, slope] : model[parent]) {
        names.push_back(full_name(parent.substr(9), name));
        RC_ASSERT(
            get(parent + "/" + name).message().density_slope_kilograms_per_cubic_metre_kelvin() ==
            slope);
      }
      RC_ASSERT(lubricants(parent, "name:run-" + run + "-", 2) == names);
    }
  }));
}

}  // namespace
}  // namespace tribodyn::server
