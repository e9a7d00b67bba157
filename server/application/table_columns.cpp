#include "server/application/table_columns.h"

#include <utility>

#include "server/simulation/campaign_candidates.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/campaign_rig.h"
#include "server/simulation/solver_defaults.h"

namespace tribodyn::server {
namespace {

std::vector<double> values_of(const google::protobuf::RepeatedField<double>& values) {
  return {values.begin(), values.end()};
}

/// Returns a column of each field of the conditions of a rig.
std::vector<TableColumn> rig_condition_columns(const v1::Campaign& request) {
  using enum TableColumn::Kind;
  TableColumn load{"load_newtons", kPerCondition},
      speed{"entrainment_speed_metres_per_second", kPerCondition},
      slide{"slide_roll_ratio_percent", kPerCondition},
      supply{"supply_temperature_celsius", kPerCondition};
  for (const v1::RigCondition& each : rig_conditions(request)) {
    load.values.push_back(each.load_newtons());
    speed.values.push_back(each.entrainment_speed_metres_per_second());
    slide.values.push_back(each.slide_roll_ratio_percent());
    supply.values.push_back(each.supply_temperature_celsius());
  }
  return {std::move(load), std::move(speed), std::move(slide), std::move(supply)};
}

}  // namespace

TableColumns::TableColumns(Application& application, const StoredCampaign& stored,
                           const CallContext& call)
    : application_(application), stored_(stored), call_(call) {
  request_.ParseFromString(stored.request);
}

std::vector<TableColumn> TableColumns::conditions() const {
  using enum TableColumn::Kind;
  if (request_.has_rig()) return rig_condition_columns(request_);
  TableColumn speed{"speed_kilometres_per_hour", kPerCondition},
      ascent{"ascent_angle_degrees", kPerCondition},
      sump{"sump_temperature_celsius", kPerCondition},
      rise{"inlet_temperature_rise_kelvin", kPerCondition};
  for (const v1::PointCondition& each : request_.conditions()) {
    speed.values.push_back(each.speed_kilometres_per_hour());
    ascent.values.push_back(each.ascent_angle_degrees());
    sump.values.push_back(each.has_sump_temperature_celsius() ? each.sump_temperature_celsius()
                                                              : kDefaultSumpTemperatureCelsius);
    rise.values.push_back(each.has_inlet_temperature_rise_kelvin()
                              ? each.inlet_temperature_rise_kelvin()
                              : kDefaultInletTemperatureRiseKelvin);
  }
  return {std::move(speed), std::move(ascent), std::move(sump), std::move(rise)};
}

std::vector<TableColumn> TableColumns::figures() const {
  std::vector<TableColumn> out;
  for (std::string& name : campaign_columns(request_)) {
    const int number = static_cast<int>(out.size());
    out.push_back({std::move(name), TableColumn::Kind::kStored, number});
  }
  return out;
}

std::optional<TableColumn> TableColumns::find(const std::string& name) {
  std::vector<TableColumn> simple = figures();
  simple.push_back({"candidate", TableColumn::Kind::kCandidate});
  simple.push_back({"condition", TableColumn::Kind::kCondition});
  simple.push_back({"row", TableColumn::Kind::kRow});
  for (TableColumn& each : conditions()) simple.push_back(std::move(each));
  for (TableColumn& each : simple) {
    if (each.name == name) return std::move(each);
  }
  for (const v1::CandidateColumn& each : table().candidate_columns()) {
    if (each.path() != name) continue;
    return TableColumn{name, TableColumn::Kind::kPerCandidate, 0, values_of(each.values())};
  }
  for (const v1::CandidateAttribute& each : table().candidate_attributes()) {
    if (each.name() != name || each.values().empty()) continue;
    return TableColumn{name, TableColumn::Kind::kPerCandidate, 0, values_of(each.values())};
  }
  return std::nullopt;
}

std::vector<std::string> TableColumns::names() {
  std::vector<std::string> out = campaign_columns(request_);
  out.insert(out.end(), {"candidate", "condition", "row"});
  for (const TableColumn& each : conditions()) out.push_back(each.name);
  for (const v1::CandidateColumn& each : table().candidate_columns()) out.push_back(each.path());
  for (const v1::CandidateAttribute& each : table().candidate_attributes()) {
    if (!each.values().empty()) out.push_back(each.name());
  }
  return out;
}

const v1::Campaign& TableColumns::table() {
  if (!table_) {
    table_.emplace();
    table_->ParseFromString(application_.store.candidate_table(stored_.id, call_.limits));
    keep_first_candidates(stored_.candidates,
                          *table_);  // others may have been added since it was read
  }
  return *table_;
}

}  // namespace tribodyn::server
