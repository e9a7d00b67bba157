#include "server/convert/input_hash.h"

#include <fmt/format.h>
#include <google/protobuf/message.h>

#include <set>
#include <stdexcept>

#include "core/version.h"
#include "server/convert/output_only.h"
#include "server/hash/sha256.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Fields that say what a thing is called, where it comes from or what only the server sets; never
/// what the model computes with.
bool is_label(const FieldDescriptor& field) {
  static const std::set<std::string> kLabels = {
      "name",      "display_name",   "description",  "provenance", "lubricant",
      "gear_set",  "surface",        "vehicle",      "labels",     "derived_from",
      "condition", "base_oil_class", "measurements", "lims_id",    "external_sample_id"};
  // Constant lines in the text of every simulation; without them stored hashes would be others.
  static const std::set<std::string> kConstant = {"state", "progress_fraction"};
  return kLabels.contains(field.name()) ||
         (is_output_only(field) && !kConstant.contains(field.name()));
}

void add_line(std::string& text, const std::string& path, const std::string& value) {
  text += path + "=" + value + "\n";
}

std::string number(double value) {
  return fmt::format("{:a}", value + 0.0);  // + 0.0: minus zero is zero
}

void add_message(std::string& text, const Message& message, const std::string& path);

void add_field(std::string& text, const Message& message, const FieldDescriptor& field, int index,
               const std::string& path) {
  const auto& reflection = *message.GetReflection();
  const bool repeated = field.is_repeated();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return add_line(text, path,
                      number(repeated ? reflection.GetRepeatedDouble(message, &field, index)
                                      : reflection.GetDouble(message, &field)));
    case FieldDescriptor::CPPTYPE_INT32:
      return add_line(text, path, std::to_string(reflection.GetInt32(message, &field)));
    case FieldDescriptor::CPPTYPE_BOOL:
      return add_line(text, path, reflection.GetBool(message, &field) ? "true" : "false");
    case FieldDescriptor::CPPTYPE_ENUM:
      return add_line(text, path, reflection.GetEnum(message, &field)->name());
    case FieldDescriptor::CPPTYPE_STRING:
      return add_line(text, path,
                      repeated ? reflection.GetRepeatedString(message, &field, index)
                               : reflection.GetString(message, &field));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return add_message(text,
                         repeated ? reflection.GetRepeatedMessage(message, &field, index)
                                  : reflection.GetMessage(message, &field),
                         path);
    default:
      throw std::logic_error("input_hash: no canonical form for " + field.full_name());
  }
}

void add_message(std::string& text, const Message& message, const std::string& path) {
  const auto& descriptor = *message.GetDescriptor();
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const FieldDescriptor& field = *descriptor.field(i);
    if (is_label(field)) continue;
    const std::string field_path = path + "." + field.name();
    if (field.is_repeated()) {
      for (int k = 0; k < reflection.FieldSize(message, &field); ++k) {
        add_field(text, message, field, k, fmt::format("{}[{}]", field_path, k));
      }
    } else if (!field.has_presence() || reflection.HasField(message, &field)) {
      add_field(text, message, field, 0, field_path);
    }
  }
}

}  // namespace

std::string canonical_inputs(const SimulationInputs& inputs) {
  std::string text;
  add_line(text, "model_version", kModelVersion);
  add_message(text, inputs.lubricant, "lubricant");
  add_message(text, inputs.gear_set, "gear_set");
  add_message(text, inputs.surface, "surface");
  add_message(text, inputs.vehicle, "vehicle");
  add_message(text, inputs.effective, "simulation");
  return text;
}

std::string input_hash(const SimulationInputs& inputs) { return sha256(canonical_inputs(inputs)); }

}  // namespace tribodyn::server
