#include "client/cpp/library/project_names.h"

#include <gtest/gtest.h>

#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {
namespace {

TEST(ProjectNames, AreStatedOnceInARequest) {
  v1::ListLubricantsRequest list;
  add_project("acme", list);
  EXPECT_EQ(list.parent(), "projects/acme");
  v1::CreateLubricantRequest create;
  create.mutable_lubricant()->set_name("lubricants/x");
  add_project("acme", create);
  EXPECT_EQ(create.parent(), "projects/acme");
  EXPECT_EQ(create.lubricant().name(), "lubricants/x");
  v1::GetLubricantRequest get;
  get.set_name("lubricants/x@2");
  add_project("acme", get);
  add_project("acme", get);  // as a repeated call does
  EXPECT_EQ(get.name(), "projects/acme/lubricants/x@2");
  v1::UpdateLubricantRequest update;
  update.mutable_lubricant()->set_name("lubricants/x");
  update.mutable_lubricant()->set_derived_from("lubricants/y");
  add_project("acme", update);
  EXPECT_EQ(update.lubricant().name(), "projects/acme/lubricants/x");
  EXPECT_EQ(update.lubricant().derived_from(), "lubricants/y");
}

TEST(ProjectNames, OfAnotherProjectStay) {
  v1::GetSimulationRequest get;
  get.set_name("projects/other/simulations/1");
  add_project("acme", get);
  EXPECT_EQ(get.name(), "projects/other/simulations/1");
  v1::Simulation answer;
  answer.set_name("projects/other/simulations/1");
  remove_project("acme", answer);
  EXPECT_EQ(answer.name(), "projects/other/simulations/1");
}

TEST(ProjectNames, AreSplit) {
  const auto expect = [](const std::string& name, const std::string& project,
                         const std::string& relative) {
    const ProjectAndName parts = split_name("acme", name);
    EXPECT_EQ(parts.project, project) << name;
    EXPECT_EQ(parts.relative, relative) << name;
  };
  expect("simulations/1", "acme", "simulations/1");
  expect("projects/other/simulations/1", "other", "simulations/1");
  expect("projects/default/simulations/1", "default", "simulations/1");
  expect("projects/other", "acme", "projects/other");
  expect("", "acme", "");
}

TEST(ProjectNames, OfTheDefaultStayAsTheyAre) {
  v1::ListLubricantsRequest list;
  add_project("default", list);
  EXPECT_EQ(list.ByteSizeLong(), 0U);
}

TEST(ProjectNames, AreAnsweredRelative) {
  v1::ListSimulationsResponse page;
  page.add_simulations()->set_name("projects/acme/simulations/1");
  page.add_simulations()->set_name("projects/acme2/simulations/1");
  remove_project("acme", page);
  EXPECT_EQ(page.simulations(0).name(), "simulations/1");
  EXPECT_EQ(page.simulations(1).name(), "projects/acme2/simulations/1");
}

TEST(ProjectNames, OfTheDefaultAreAnsweredInFullToOtherProjects) {
  v1::Lubricant answer;
  answer.set_name("lubricants/x");  // as the server answers for "projects/default/lubricants/x"
  remove_project("acme", answer);
  EXPECT_EQ(answer.name(), "projects/default/lubricants/x");
  v1::Simulation preview;  // no name yet
  remove_project("acme", preview);
  EXPECT_EQ(preview.name(), "");
}

}  // namespace
}  // namespace tribodyn::client
