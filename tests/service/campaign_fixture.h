#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/application/campaigns.h"
#include "tests/service/support.h"
#include "tests/support/run_length.h"

namespace tribodyn::server {

/// Columns of a campaign by name.
using Table = std::map<std::string, std::vector<double>>;

/// A thousand candidates take some seconds under TSan, which slows the model more than ten times: a
/// third of them there.
inline constexpr int kThousand = kUnderSanitizer && !kUnderAddressSanitizer ? 330 : 1000;

/// Candidates that differ in a parameter of the lubricant and one of the surface, at six
/// conditions.
inline v1::Campaign campaign_of(int candidates) {
  v1::Campaign out;
  out.set_lubricant("lubricants/paper-fluid-1");
  v1::CandidateColumn& coefficient = *out.add_candidate_columns();
  coefficient.set_path("lubricant.pressure_viscosity_coefficient_per_pascal");
  v1::CandidateColumn& friction = *out.add_candidate_columns();
  friction.set_path("surface.asperity_friction_coefficient");
  v1::CandidateAttribute& additive = *out.add_candidate_attributes();
  additive.set_name("additive");
  v1::CandidateAttribute& cost = *out.add_candidate_attributes();
  cost.set_name("cost_euros_per_kilogram");
  for (int i = 0; i < candidates; ++i) {
    coefficient.add_values(1.2e-8 + 1e-8 * i / candidates);
    friction.add_values(0.08 + 0.04 * (i % 7) / 7);
    additive.add_texts("additive " + std::to_string(i % 3));
    cost.add_values(2 + i);
  }
  for (const double sump : {40.0, 90.0}) {
    for (const double speed : {30.0, 70.0, 110.0}) {
      v1::PointCondition& condition = *out.add_conditions();
      condition.set_speed_kilometres_per_hour(speed);
      condition.set_sump_temperature_celsius(sump);
      out.add_condition_weights(speed);
    }
  }
  return out;
}

inline bool have_equal_bits(const std::vector<double>& one, const std::vector<double>& other) {
  return one.size() == other.size() &&
         std::memcmp(one.data(), other.data(), one.size() * sizeof(double)) == 0;
}

class CampaignTest : public testing::Test {
 protected:
  Outcome<v1::Campaign> try_create(const v1::Campaign& campaign, const std::string& request_id = {},
                                   bool validate_only = false) {
    v1::CreateCampaignRequest request;
    *request.mutable_campaign() = campaign;
    request.set_request_id(request_id);
    request.set_validate_only(validate_only);
    Application application = bench_.application();
    return create_campaign(application, request);
  }
  std::string create(const v1::Campaign& campaign, const std::string& request_id = {}) {
    const auto created = try_create(campaign, request_id);
    if (!created.ok()) throw std::runtime_error(created.error().message());
    return created.message().name();
  }
  v1::Campaign get(const std::string& name, v1::CampaignView view = v1::CAMPAIGN_VIEW_BASIC) {
    v1::GetCampaignRequest request;
    request.set_name(name);
    request.set_view(view);
    Application application = bench_.application();
    return get_campaign(application, request).message();
  }
  bool reaches(const std::string& name, v1::Campaign::State state) {
    return eventually([&] { return get(name).state() == state; });
  }
  template <class Request, class UseCase>
  auto call(UseCase use_case, const std::string& name, Request request = {}) {
    request.set_name(name);
    Application application = bench_.application();
    return use_case(application, request, CallContext());
  }

  StreamOutcome<v1::ReadCampaignResponse> open(const v1::ReadCampaignRequest& request) {
    application_.emplace(bench_.application());
    return read_campaign(*application_, request);
  }
  Table read(const std::string& name, const std::vector<std::string>& columns = {},
             std::int64_t start = 0, std::int64_t count = 0, const std::string& filter = {}) {
    v1::ReadCampaignRequest request;
    request.set_name(name);
    request.set_start_row(start);
    request.set_row_count(count);
    request.set_filter(filter);
    for (const std::string& each : columns) request.add_columns(each);
    const auto source = open(request);
    if (!source.ok()) throw std::runtime_error(complaints(source.error()));
    Table out;
    v1::HistorySchema schema;
    for (v1::ReadCampaignResponse part;
         source.message()->next(part) == AnyMessageSource::Step::kMessage;) {
      if (part.has_schema()) {
        schema = part.schema();
        for (const auto& column : schema.columns()) out[column.name()];
        continue;
      }
      std::vector<double>& column = out[schema.columns(part.chunk().column()).name()];
      const std::string& bytes = part.chunk().values();
      const std::size_t before = column.size();
      EXPECT_EQ(part.chunk().first_row(), static_cast<std::int64_t>(before));
      column.resize(before + bytes.size() / sizeof(double));
      std::memcpy(column.data() + before, bytes.data(), bytes.size());
    }
    EXPECT_EQ(source.message()->error().code(), 0);
    return out;
  }

  std::shared_ptr<MessageSource<v1::CampaignEvent>> watch(const std::string& name,
                                                          std::int64_t after_version = 0) {
    v1::WatchCampaignRequest request;
    request.set_name(name);
    request.set_after_version(after_version);
    application_.emplace(bench_.application());
    return watch_campaign(*application_, request).message();
  }
  /// Returns the next event of a watch, heartbeats left out; nullopt at its end.
  static std::optional<v1::CampaignEvent> next_event(MessageSource<v1::CampaignEvent>& source) {
    std::optional<v1::CampaignEvent> out;
    EXPECT_TRUE(eventually([&] {
      v1::CampaignEvent event;
      const auto step = source.next(event);
      if (step == AnyMessageSource::Step::kEnd) return true;
      if (step == AnyMessageSource::Step::kWait) return false;
      if (event.kind() == v1::CampaignEvent::HEARTBEAT) return false;
      out = event;
      return true;
    }));
    return out;
  }

  Bench bench_;
  std::optional<Application> application_;
};

inline void expect_equal_tables(const Table& one, const Table& other) {
  ASSERT_EQ(one.size(), other.size());
  for (const auto& [name, values] : one) {
    EXPECT_TRUE(have_equal_bits(values, other.at(name))) << name;
  }
}

}  // namespace tribodyn::server
