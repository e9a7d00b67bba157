// Tests of removed simulations, and of removed resources with their simulations.
#include "server/storage/removal.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "server/storage/store.h"
#include "tests/service/support.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {
namespace {

const std::string kSecretName = "Grandmother's secret additive 4711";
constexpr double kSecretNumber = 1.2345678901234567e-8;

std::string bytes_of(double number) {
  std::string out(sizeof number, '\0');
  std::memcpy(out.data(), &number, sizeof number);
  return out;
}

class Removals : public testing::Test {
 protected:
  ResultKey key(char input) const { return {std::string(64, input), "model", "platform"}; }

  StoredResource write_secret(int revision) {
    v1::Lubricant body;
    body.set_display_name(kSecretName);
    body.set_description(std::string(5000, 'd') + kSecretName + std::to_string(revision));
    body.set_pressure_viscosity_coefficient_per_pascal(kSecretNumber);
    const auto present = store_.resource("lubricants/secret");
    return store_
        .write_resources({{{"lubricants/secret", body.SerializeAsString()}, present}}, revision)
        ->front();
  }

  std::int64_t queue(char input, int revision) {
    v1::SimulationResult assumptions;
    assumptions.add_assumptions()->set_value("1.2345678901234567e-8 /Pa");
    assumptions.mutable_assumptions(0)->set_source(kSecretName);
    return store_
        .add_simulation(
            {.request = "request",
             .key = key(input),
             .ledger = assumptions.SerializeAsString(),
             .labels = {{"series", kSecretName}},
             .revisions = {.lubricant = "lubricants/secret@" + std::to_string(revision)}},
            10)
        .id;
  }

  std::int64_t finish(char input, int revision) {
    const auto id = queue(input, revision);
    EXPECT_TRUE(store_.mark_running(id, 11, key(input)));
    EXPECT_TRUE(store_.mark_succeeded(
        id, 12, {key(input), kSecretName, {{"column", std::vector<double>(50, kSecretNumber)}}}));
    return id;
  }

  /// Returns the names of the files of the folder that contain a text.
  std::vector<std::string> files_with(const std::string& text) const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      std::ifstream in(entry.path(), std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(in)), {});
      if (bytes.find(text) != std::string::npos) out.push_back(entry.path().filename());
    }
    return out;
  }

  TemporaryFolder folder_;
  Store store_{folder_.file("tribodyn.db")};
};

TEST_F(Removals, APurgedFormulationIsInNoFile) {
  for (int revision = 1; revision <= 3; ++revision) write_secret(revision);
  finish('a', 1);
  finish('b', 3);
  const auto old = finish('c', 2);
  ASSERT_EQ(store_.remove_simulation(old), Store::Removal::kDone);
  store_.add_project("default", {{"lubricants/other", "other"}}, 20);
  ASSERT_FALSE(files_with(kSecretName).empty());
  ASSERT_FALSE(files_with(bytes_of(kSecretNumber)).empty());

  const auto purge = store_.purge_resource(*store_.resource("lubricants/secret"), true);
  EXPECT_EQ(purge.revisions, 3);
  EXPECT_EQ(purge.dependents.ended, 2);
  EXPECT_EQ(purge.dependents.results, 2);
  EXPECT_EQ(store_.resource("lubricants/secret"), std::nullopt);
  EXPECT_EQ(store_.revision("lubricants/secret", 1), std::nullopt);
  EXPECT_FALSE(files_with(kSecretName).empty())
      << "free pages are expected to hold what was removed";

  store_.erase_removed();
  EXPECT_EQ(files_with(kSecretName), std::vector<std::string>());
  EXPECT_EQ(files_with(bytes_of(kSecretNumber)), std::vector<std::string>());
  EXPECT_EQ(files_with("1.2345678901234567"), std::vector<std::string>());
  EXPECT_TRUE(store_.resource("lubricants/other")) << "others stay";
}

TEST_F(Removals, ErasingRemovesCopiesOfMigrationsAndNamesFormerDatabases) {
  const std::string migration = folder_.file("tribodyn.db.schema-4");
  const std::string former = folder_.file("tribodyn.db.replaced.2");
  for (const std::string& each : {migration, former}) std::ofstream(each) << "a database";
  EXPECT_EQ(store_.erase_removed(), std::vector<std::filesystem::path>{former});
  EXPECT_FALSE(std::filesystem::exists(migration));
}

TEST_F(Removals, AfterErasingTheDatabaseAcceptsWrites) {
  write_secret(1);
  store_.purge_resource(*store_.resource("lubricants/secret"), true);
  store_.erase_removed();
  EXPECT_EQ(write_secret(30).revision, 1) << "the name is free again";
  EXPECT_TRUE(store_.result(finish('a', 1)));
}

TEST_F(Removals, AResourceStaysWhileASimulationOfItIsUnfinished) {
  write_secret(1);
  const auto id = queue('a', 1);
  const auto purge = store_.purge_resource(*store_.resource("lubricants/secret"), true);
  EXPECT_EQ(purge.revisions, 0);
  EXPECT_EQ(purge.dependents.unfinished, std::vector<std::int64_t>{id});
  EXPECT_TRUE(store_.resource("lubricants/secret"));
  EXPECT_EQ(store_.remove_simulation(id), Store::Removal::kUnfinished);
}

TEST_F(Removals, SimulationsAreRemovedWithTheirResourceOnlyOnRequest) {
  write_secret(1);
  const auto id = finish('a', 1);
  const StoredResource secret = *store_.resource("lubricants/secret");
  EXPECT_EQ(store_.purge_resource(secret, false).revisions, 0);
  EXPECT_TRUE(store_.simulation(id));
  EXPECT_EQ(store_.purge_resource(secret, true).revisions, 1);
  EXPECT_FALSE(store_.simulation(id));
}

TEST_F(Removals, AChangedResourceIsNotPurged) {
  const StoredResource first = write_secret(1);
  write_secret(2);
  const auto purge = store_.purge_resource(first, true);
  EXPECT_FALSE(purge.is_current);
  EXPECT_EQ(purge.revisions, 0);
}

TEST_F(Removals, AResultIsKeptWhileAnotherSimulationUsesIt) {
  write_secret(1);
  const auto first = finish('a', 1);
  const auto second = queue('a', 1);  // equal inputs: served from the cache
  ASSERT_EQ(store_.simulation(second)->state, StoredState::kSucceeded);
  EXPECT_EQ(store_.remove_simulation(first), Store::Removal::kDone);
  EXPECT_TRUE(store_.result(second));
  EXPECT_EQ(history_rows(store_, second, "column", 0, 1).front(), kSecretNumber);
  EXPECT_EQ(store_.remove_simulation(first), Store::Removal::kAbsent);
}

TEST_F(Removals, RemovedSimulationsLeaveTheTotalOfTheList) {
  write_secret(1);
  const auto total = [&](std::vector<Restriction> restrictions) {
    return store_
        .simulations({.restrictions = std::move(restrictions),
                      .limit = 1,
                      .byte_limit = 1 << 20,
                      .counts_all = true})
        .total;
  };
  const std::vector<Restriction> all = {
      {"state", Restriction::Comparison::kGreater, std::int64_t{0}}};
  const auto first = finish('a', 1);
  for (const char input : {'b', 'c', 'd'}) queue(input, 1);
  EXPECT_EQ(total({}), 4);
  EXPECT_EQ(store_.remove_simulation(first), Store::Removal::kDone);
  EXPECT_EQ(total({}), 3) << "read from the project";
  EXPECT_EQ(total(all), 3) << "counted";
}

TEST_F(Removals, APinnedSimulationIsNotRemoved) {
  write_secret(1);
  const auto id = finish('a', 1);
  ASSERT_TRUE(store_.set_pinned(id, true));
  EXPECT_EQ(store_.remove_simulation(id), Store::Removal::kPinned);
  EXPECT_TRUE(store_.simulation(id));
}

TEST_F(Removals, RevisionsAreProtectedAgainAfterAPurge) {
  write_secret(1);
  store_.purge_resource(*store_.resource("lubricants/secret"), true);
  write_secret(2);
  Connection db(folder_.file("tribodyn.db"), SQLite::OPEN_READWRITE);
  EXPECT_THROW(db.exec("DELETE FROM revisions"), SQLite::Exception);
}

}  // namespace
}  // namespace tribodyn::server
