#include "server/application/element_limits.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/study/history.h"
#include "server/contract/constraints.h"
#include "server/contract/labels.h"
#include "server/resources/accept_resource.h"
#include "server/resources/gear_set_checks.h"
#include "server/resources/imports/import_surface.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// One list, or with the field "*" every list of a message.
struct ElementLimit {
  std::string_view message;  ///< of tribodyn.v1, or a full name
  std::string_view field;
  int maximum;
};

// Lists that only the server fills may come back in a request: a client sends what it got.
constexpr ElementLimit kElementLimits[] = {
    {"Lubricant", "provenance", kMaximumProvenances},
    {"Lubricant", "labels", kMaximumLabels},
    {"LubricantMeasurements", "brookfield_viscosities", kMaximumMeasurements},
    {"LubricantMeasurements", "viscosities", kMaximumMeasurements},
    {"LubricantMeasurements", "densities", kMaximumMeasurements},
    {"LubricantCharacterisation", "viscosity_residuals", 2 * kMaximumMeasurements + 2},
    {"LubricantCharacterisation", "walther_comparison", 100},
    {"LubricantCharacterisation", "warnings", 1000},
    {"GearSet", "flank_slots", kFlankPairs},
    {"GearSet", "series_by_torque", kMaximumTorques},
    {"GearSet", "load_share_by_torque", kMaximumTorques},
    {"GearSet", "provenance", kMaximumProvenances},
    {"GearSet", "labels", kMaximumLabels},
    {"FourierSeries", "*", kMaximumHarmonics},
    {"FlankSlot", "*", kMaximumFlankSamples},
    {"LoadShareAtTorque", "slots", kFlankPairs},
    {"LoadShareAtTorque.Slot", "load_share", kMaximumFlankSamples},
    {"Surface", "provenance", kMaximumProvenances},
    {"Surface", "measurements", kMaximumMeasurements},
    {"Surface", "labels", kMaximumLabels},
    {"ImportSurfaceProfilesRequest", "profiles", kMaximumProfiles},
    {"Vehicle", "provenance", kMaximumProvenances},
    {"Vehicle", "labels", kMaximumLabels},
    {"Simulation", "labels", kMaximumSimulationLabels},
    {"HistoryRequest", "columns", kMaximumHistoryColumns},
    {"InefficiencyCurveStudy", "speeds_kilometres_per_hour", kMaximumCurvePoints},
    {"ReadHistoryRequest", "columns", kMaximumHistoryColumns},
    {"SimulationResult", "points", kMaximumCurvePoints},
    {"SimulationResult", "assumptions", 1000},
    {"SimulationResult", "history_columns", kFlankPairs* kMaximumHistoryColumns},
    {"SimulationResult", "input_warnings", 1000},
    {"PointResult", "flank_losses", kFlankPairs},
    {"PointResult", "contact_losses", 1000},
    {"PointResult", "warnings", 100},
    {"BatchCreateLubricantsRequest", "requests", kMaximumBatchSize},
    {"BatchUpdateLubricantsRequest", "requests", kMaximumBatchSize},
    {"BatchCreateGearSetsRequest", "requests", kMaximumBatchSize},
    {"BatchUpdateGearSetsRequest", "requests", kMaximumBatchSize},
    {"BatchCreateSurfacesRequest", "requests", kMaximumBatchSize},
    {"BatchUpdateSurfacesRequest", "requests", kMaximumBatchSize},
    {"BatchCreateVehiclesRequest", "requests", kMaximumBatchSize},
    {"BatchUpdateVehiclesRequest", "requests", kMaximumBatchSize},
    {"google.protobuf.FieldMask", "paths", kMaximumMaskPaths},
};

std::unordered_map<const FieldDescriptor*, int> limits_by_field() {
  const auto& pool = *google::protobuf::DescriptorPool::generated_pool();
  std::unordered_map<const FieldDescriptor*, int> out;
  for (const ElementLimit& row : kElementLimits) {
    const auto* message = pool.FindMessageTypeByName("tribodyn.v1." + std::string(row.message));
    if (message == nullptr) message = pool.FindMessageTypeByName(std::string(row.message));
    const std::size_t before = out.size();
    for (int i = 0; message != nullptr && i < message->field_count(); ++i) {
      const FieldDescriptor& field = *message->field(i);
      if (!field.is_repeated() || (row.field != "*" && row.field != field.name())) continue;
      out.emplace(&field, row.maximum);
    }
    if (out.size() == before) {
      throw std::logic_error(fmt::format("no such list: {}.{}", row.message, row.field));
    }
  }
  return out;
}

}  // namespace

std::optional<int> maximum_elements(const FieldDescriptor& field) {
  static const std::unordered_map<const FieldDescriptor*, int> limits = limits_by_field();
  const auto found = limits.find(&field);
  if (found == limits.end()) return std::nullopt;
  return found->second;
}

std::string too_many_text(std::int64_t count, std::int64_t maximum) {
  return fmt::format("{} entries; allowed: at most {}", count, maximum);
}

void check_counts(const Message& message, const std::string& path, Violations& violations) {
  const auto& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const bool is_message = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    const std::string here = join_path(path, field->name());
    if (!field->is_repeated()) {
      if (is_message) check_counts(reflection.GetMessage(message, field), here, violations);
      continue;
    }
    const int count = reflection.FieldSize(message, field);
    const std::optional<int> maximum = maximum_elements(*field);
    if (maximum && count > *maximum) {
      violations.push_back({here, too_many_text(count, *maximum)});
      continue;
    }
    for (int i = 0; is_message && i < count; ++i) {
      check_counts(reflection.GetRepeatedMessage(message, field, i), fmt::format("{}[{}]", here, i),
                   violations);
    }
  }
}

}  // namespace tribodyn::server
