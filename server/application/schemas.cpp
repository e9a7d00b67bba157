#include "server/application/schemas.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/study/warning_kinds.h"
#include "core/version.h"
#include "server/application/errors.h"
#include "server/application/list_filter.h"
#include "server/contract/constraints.h"
#include "server/contract/contract_comments.h"
#include "server/contract/resource_kinds.h"
#include "server/mapping/history_columns.h"
#include "server/resources/imports/import_gear_set.h"
#include "server/resources/imports/import_lubricant.h"
#include "server/resources/imports/read_profiles.h"
#include "server/resources/provenance.h"
#include "server/storage/resource_types.h"
#include "tribodyn/v1/results.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::EnumDescriptor;

void add_constraint(const Constraint& row, v1::Schema& out) {
  v1::Constraint* added = out.add_constraints();
  added->set_message(std::string(row.message));
  added->set_field(std::string(row.field));
  added->set_unit(std::string(row.unit));
  added->set_minimum(row.minimum);
  added->set_maximum(row.maximum);
  added->set_equation(std::string(row.equation));
  added->set_reason(std::string(row.reason));
  added->set_zero_is_unset(row.zero == Zero::kUnset);
  added->set_required(is_required(row));
}

void add_words(const std::string& name, const std::vector<std::string>& words, v1::Schema& out) {
  v1::Vocabulary* added = out.add_vocabularies();
  added->set_name(name);
  for (const std::string& word : words) added->add_words(word);
}

void add_enum(const EnumDescriptor& descriptor, v1::Schema& out) {
  const std::string& name = descriptor.full_name();
  const std::string package = descriptor.file()->package() + ".";
  v1::Vocabulary* added = out.add_vocabularies();
  added->set_name(name.starts_with(package) ? name.substr(package.size()) : name);
  for (int i = 0; i < descriptor.value_count(); ++i) added->add_words(descriptor.value(i)->name());
}

void add_vocabularies(v1::Schema& out) {
  add_words("history.columns", history_column_names(), out);
  for (const char* collection : {kSimulations, kCampaigns}) {
    add_words(std::string(collection) + ".filter", filter_fields(collection), out);
  }
  for (const char* collection : kResourceCollections) {
    add_words(std::string(collection) + ".filter", filter_fields(collection), out);
    const auto message = new_resource(collection);
    const ParameterPaths paths = parameter_paths(*message->GetDescriptor());
    add_words(std::string(collection) + ".parameters", paths.numbers, out);
  }
  add_words("ImportLubricantRequest.viscosity_table_csv", viscosity_headers(), out);
  add_words("ImportGearSetRequest.tooth_contact_csv", tooth_contact_headers(), out);
  add_words("ImportGearSetRequest.series_csv", series_headers(), out);
  add_words("SurfaceProfile.csv", profile_headers(), out);
  for (const EnumDescriptor* each :
       {v1::Lubricant::BaseOilClass_descriptor(), v1::Lubricant::Condition_descriptor(),
        v1::Provenance_descriptor(), v1::FlankMember_descriptor(),
        v1::ProfileDirection_descriptor(), v1::Levelling_descriptor(), v1::PointModel_descriptor(),
        v1::PointStart_descriptor(), v1::SweepDirection_descriptor(),
        v1::Simulation::State_descriptor(), v1::ModelOptions::PressureViscosityIndex_descriptor(),
        v1::ModelOptions::Preset_descriptor()}) {
    add_enum(*each, out);
  }
  std::vector<std::string> codes;
  for (const WarningKind& each : warning_kinds()) codes.emplace_back(each.code);
  add_words("RangeWarning.code", codes, out);
}

void add_column(const std::string& table, const std::string& name, const std::string& description,
                v1::Schema& out) {
  v1::ColumnDescription* added = out.add_columns();
  added->set_table(table);
  added->set_name(name);
  added->set_unit(std::string(history_column_unit(name)));
  added->set_description(description);
}

/// Adds the figures of the flank slots, in the spelling of a CSV of points.
void add_flank_columns(const ContractComments& comments, v1::Schema& out) {
  const auto& loss = *v1::FlankLoss::descriptor();
  for (int slot = 0; slot < kFlankPairs; ++slot) {
    for (int i = 0; i < loss.field_count(); ++i) {
      add_column(v1::PointResult::descriptor()->name(),
                 fmt::format("flank_losses_{}_{}", slot, loss.field(i)->name()),
                 comments.of(loss.field(i)->full_name()), out);
    }
  }
}

/// Adds the figures of a point, with the comments of the contract, and the columns of histories.
void add_columns(v1::Schema& out) {
  static const ContractComments kComments;
  const auto& point = *v1::PointResult::descriptor();
  for (int i = 0; i < point.field_count(); ++i) {
    const auto* field = point.field(i);
    const bool is_extremes = field->message_type() == v1::Extremes::descriptor();
    if (field->message_type() == v1::FlankLoss::descriptor()) {
      add_flank_columns(kComments, out);
      continue;
    }
    if (field->is_repeated() || (field->message_type() != nullptr && !is_extremes)) continue;
    add_column(point.name(), field->name(), kComments.of(field->full_name()), out);
  }
  for (int i = 0; i < kHistoryColumns; ++i) {
    const auto column = static_cast<HistoryColumn>(i);
    add_column("history.columns", std::string(history_column_name(column)),
               std::string(history_column_description(column)), out);
  }
}

std::vector<std::string> known_messages() {
  std::vector<std::string> out;
  for (const Constraint& row : constraints()) {
    if (out.empty() || out.back() != row.message) out.emplace_back(row.message);
  }
  return out;
}

}  // namespace

Outcome<v1::Schema> get_schema(Application&, const v1::GetSchemaRequest& request,
                               const CallContext&) {
  v1::Schema out;
  out.set_model_version(kModelVersion);
  for (const Constraint& row : constraints()) {
    if (request.message().empty() || request.message() == row.message) add_constraint(row, out);
  }
  if (out.constraints().empty()) {
    return invalid(
        {{"message", fmt::format("\"{}\" has no constraints{}", plain_excerpt(request.message()),
                                 meant_text(request.message(), known_messages()))}});
  }
  if (request.message().empty()) {
    add_vocabularies(out);
    add_columns(out);
  }
  return out;
}

}  // namespace tribodyn::server
