#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "core/gear/gear_set.h"
#include "google/api/annotations.pb.h"
#include "proto/enum_names.h"
#include "server/application/element_limits.h"
#include "server/application/list_filter.h"
#include "server/application/request_limits.h"
#include "server/application/request_text.h"
#include "server/contract/constraints.h"
#include "server/contract/labels.h"
#include "server/resources/accept_resource.h"
#include "server/resources/gear_set_checks.h"
#include "server/resources/imports/csv_table.h"
#include "server/resources/imports/read_profiles.h"
#include "server/simulation/campaign_candidates.h"
#include "server/simulation/cycle_evaluation.h"
#include "tests/contract/breaking_changes.h"
#include "tests/contract/lint.h"
#include "tests/service/contract_methods.h"
#include "tribodyn/v1/limits.pb.h"
#include "tribodyn/v1/simulations.pb.h"
#include "tribodyn/v1/surfaces.pb.h"

namespace tribodyn {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::FieldDescriptor;
using google::protobuf::FileDescriptorSet;
using testing::IsEmpty;

std::string text_of(const char* file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream out;
  out << stream.rdbuf();
  return out.str();
}

FileDescriptorSet present_contract() {
  FileDescriptorSet out;
  EXPECT_TRUE(out.ParseFromString(text_of(CONTRACT_DESCRIPTORS)));
  EXPECT_GT(out.file_size(), 10);
  return out;
}

/// The comparison begins at 0.1.0, when the output of deploy/contract-text is committed as
/// baseline.
TEST(Contract, IsThatOfTheLatestRelease) {
  if (!std::filesystem::exists(CONTRACT_BASELINE)) GTEST_SKIP() << "no release, no baseline";
  FileDescriptorSet baseline;
  ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(text_of(CONTRACT_BASELINE), &baseline));
  ASSERT_GT(baseline.file_size(), 10);
  EXPECT_THAT(breaking_changes(baseline, present_contract()), IsEmpty());
  EXPECT_THAT(breaking_changes(present_contract(), baseline), IsEmpty())
      << "additions: renew the baseline with deploy/contract-text";
}

TEST(Contract, IsNamedByItsRules) { EXPECT_THAT(lint(present_contract()), IsEmpty()); }

std::string path_of(const google::api::HttpRule& rule) {
  for (const std::string& path : {rule.get(), rule.post(), rule.patch(), rule.delete_()}) {
    if (!path.empty()) return path;
  }
  return {};
}

/// A name of the project `default` has a short form, and so has its route.
TEST(Contract, RoutesEveryMethodOfResourcesWithAProjectAndWithout) {
  int routes = 0;
  const FileDescriptorSet contract = present_contract();
  for (const auto& file : contract.file()) {
    for (const auto& service : file.service()) {
      if (service.name() == "SchemaService") continue;
      for (const auto& method : service.method()) {
        const auto& rule = method.options().GetExtension(google::api::http);
        ASSERT_EQ(rule.additional_bindings_size(), 1) << method.name();
        const auto& without = rule.additional_bindings(0);
        const std::string path = path_of(rule);
        const std::string of_parent =
            std::regex_replace(path, std::regex(R"(^/v1/\{parent=projects/\*\}/)"), "/v1/");
        const std::string short_path =
            std::regex_replace(of_parent, std::regex(R"(=projects/\*/)"), "=");
        EXPECT_NE(short_path, path) << method.name();
        EXPECT_EQ(path_of(without), short_path) << method.name();
        EXPECT_EQ(without.body(), rule.body()) << method.name();
        EXPECT_EQ(without.pattern_case(), rule.pattern_case()) << method.name();
        ++routes;
      }
    }
  }
  EXPECT_GT(routes, 40);
}

const FieldDescriptor& field(const std::string& message, const std::string& name) {
  v1::Simulation::descriptor();  // else the linker may leave files out
  const auto* found =
      DescriptorPool::generated_pool()->FindFieldByName("tribodyn.v1." + message + "." + name);
  if (found == nullptr) throw std::logic_error("no field " + message + "." + name);
  return *found;
}

/// Checks that know more than the list, such as its row, state the limit on their own.
TEST(Contract, StatesTheLimitsThatTheServerEnforces) {
  const auto items = [](const std::string& message, const std::string& name) {
    return server::maximum_elements(field(message, name)).value_or(0);
  };
  for (const auto* type : server::resource_types()) {
    const std::string& each = type->name();
    EXPECT_EQ(items(each, "labels"), server::kMaximumLabels);
    EXPECT_EQ(items(each, "provenance"), server::kMaximumProvenances);
    const std::string plural = each + "sRequest";
    EXPECT_EQ(items("BatchCreate" + plural, "requests"), server::kMaximumBatchSize);
    EXPECT_EQ(items("BatchUpdate" + plural, "requests"), server::kMaximumBatchSize);
  }
  for (const char* each : {"viscosities", "densities", "brookfield_viscosities"}) {
    EXPECT_EQ(items("LubricantMeasurements", each), server::kMaximumMeasurements);
  }
  EXPECT_EQ(items("Surface", "measurements"), server::kMaximumMeasurements);
  EXPECT_EQ(items("GearSet", "flank_slots"), kFlankPairs);
  EXPECT_EQ(items("LoadShareAtTorque", "slots"), kFlankPairs);
  EXPECT_EQ(items("GearSet", "series_by_torque"), server::kMaximumTorques);
  EXPECT_EQ(items("GearSet", "load_share_by_torque"), server::kMaximumTorques);
  EXPECT_EQ(items("FourierSeries", "sine"), server::kMaximumHarmonics);
  EXPECT_EQ(items("FourierSeries", "cosine"), server::kMaximumHarmonics);
  const auto* slot = field("FlankSlot", "load_share").containing_type();
  for (int i = 0; i < slot->field_count(); ++i) {
    EXPECT_EQ(items("FlankSlot", slot->field(i)->name()), server::kMaximumFlankSamples);
  }
  EXPECT_EQ(items("LoadShareAtTorque.Slot", "load_share"), server::kMaximumFlankSamples);
  EXPECT_EQ(items("ImportSurfaceProfilesRequest", "profiles"), server::kMaximumProfiles);
  EXPECT_EQ(items("EvaluateProfilesRequest", "profiles"), server::kMaximumProfiles);
  EXPECT_EQ(items("EvaluateCycleRequest", "lubricants"), server::kMostCycleLubricants);
  EXPECT_EQ(items("EvaluateCycleResponse", "start_seconds"), server::kMaximumCyclePieces);
  EXPECT_EQ(items("CycleLubricant", "mesh_loss_power_watts"), server::kMaximumCyclePieces);
  EXPECT_EQ(items("Simulation", "labels"), server::kMaximumLabels);
  EXPECT_EQ(items("HistoryRequest", "columns"), server::kMaximumHistoryColumns);
  EXPECT_EQ(items("ReadHistoryRequest", "columns"), server::kMaximumHistoryColumns);
  EXPECT_EQ(items("InefficiencyCurveStudy", "speeds_kilometres_per_hour"),
            server::kMaximumCurvePoints);
  EXPECT_EQ(items("SimulationResult", "points"), server::kMaximumCurvePoints);
}

TEST(Contract, StatesTheLongestTextsThatTheServerTakes) {
  const auto bytes = [](const std::string& message, const std::string& name) {
    return static_cast<std::size_t>(field(message, name).options().GetExtension(v1::max_bytes));
  };
  EXPECT_EQ(bytes("ImportLubricantRequest", "viscosity_table_csv"), server::kMaximumCsvBytes);
  EXPECT_EQ(bytes("ImportGearSetRequest", "tooth_contact_csv"), server::kMaximumCsvBytes);
  EXPECT_EQ(bytes("ImportGearSetRequest", "series_csv"), server::kMaximumCsvBytes);
  EXPECT_EQ(bytes("SurfaceProfile", "csv"), server::kMaximumProfileBytes);
  for (const char* each : {"CreateSimulationRequest", "CreateCampaignRequest"}) {
    EXPECT_EQ(bytes(each, "request_id"), std::size_t{server::kMaximumRequestIdLength});
  }
  for (const auto* type : server::resource_types()) {
    EXPECT_EQ(bytes("List" + type->name() + "sRequest", "filter"), server::kMaximumFilterLength);
  }
  EXPECT_EQ(bytes("ListSimulationsRequest", "filter"), server::kMaximumFilterLength);
  EXPECT_EQ(bytes("ListCampaignsRequest", "filter"), server::kMaximumFilterLength);
}

TEST(Contract, LeavesRoomForTheAnswerThatHoldsAGearSet) {
  for (const char* each : {"CreateGearSet", "UpdateGearSet", "ImportGearSet"}) {
    const auto* method = DescriptorPool::generated_pool()->FindMethodByName(
        "tribodyn.v1.GearSetService." + std::string(each));
    ASSERT_NE(method, nullptr);
    EXPECT_LE(server::maximum_request_bytes(*method), server::kMaximumResponseBytes - (1 << 20));
  }
}

TEST(Contract, LeavesRoomForTheCandidatesOfTheLargestCampaignInRequestAndAnswer) {
  for (const char* each : {"CreateCampaign", "AppendCandidates"}) {
    const auto* method = DescriptorPool::generated_pool()->FindMethodByName(
        "tribodyn.v1.CampaignService." + std::string(each));
    ASSERT_NE(method, nullptr);
    EXPECT_EQ(server::maximum_request_bytes(*method), server::kMaximumCandidateBytes);
  }
  const int columns = field("Campaign", "candidate_columns").options().GetExtension(v1::max_items);
  constexpr std::size_t kNameBytes = 80;
  EXPECT_LE(server::kMaximumCandidates * (columns * sizeof(double) + kNameBytes + 2),
            server::kMaximumCandidateBytes);
  EXPECT_LE(server::kMaximumCandidateBytes + (1 << 20), server::kMaximumResponseBytes);
}

TEST(EnumNames, AreShortForPeople) {
  const auto& model = *v1::PointModel_descriptor();
  EXPECT_EQ(short_name(model, v1::POINT_MODEL_QUASI_STATIC), "QUASI_STATIC");
  EXPECT_EQ(short_name(model, v1::POINT_MODEL_UNSPECIFIED), "POINT_MODEL_UNSPECIFIED");
  EXPECT_EQ(short_name(model, 99), "99");
  EXPECT_EQ(short_name(*v1::Simulation::State_descriptor(), v1::Simulation::FAILED), "FAILED");
}

TEST(EnumNames, AreFoundWholeAndShort) {
  const auto& member = *v1::FlankMember_descriptor();
  for (const char* name : {"GEAR", "FLANK_MEMBER_GEAR"}) {
    ASSERT_NE(find_value(member, name), nullptr) << name;
    EXPECT_EQ(find_value(member, name)->number(), v1::FLANK_MEMBER_GEAR);
  }
  EXPECT_EQ(find_value(member, "WHEEL"), nullptr);
  EXPECT_EQ(find_value(member, ""), nullptr);
}

}  // namespace
}  // namespace tribodyn
