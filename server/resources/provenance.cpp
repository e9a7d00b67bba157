#include "server/resources/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "server/contract/constraints.h"
#include "server/contract/output_only.h"
#include "server/contract/resource_names.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

constexpr char kSourceOfUser[] = "stated without a source";

/// Returns true for a message field that holds parameters of the model.
bool is_block(const FieldDescriptor& field) {
  static const std::set<std::string> kOther = {"provenance", "measurements", "labels"};
  return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && !is_output_only(field) &&
         !kOther.contains(field.name());
}

bool has_tables(const Descriptor& resource) {
  for (int i = 0; i < resource.field_count(); ++i) {
    if (is_block(*resource.field(i)) && resource.field(i)->is_repeated() &&
        !may_be_unset(*resource.field(i))) {
      return true;
    }
  }
  return false;
}

bool is_parameter(const FieldDescriptor& field) {
  return !field.is_repeated() && !is_output_only(field) && !is_documentary(field) &&
         find_constraint(field) != nullptr;
}

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool is_set_in(const google::protobuf::Message& resource, const FieldDescriptor& block) {
  const auto& reflection = *resource.GetReflection();
  return block.is_repeated() ? reflection.FieldSize(resource, &block) > 0
                             : reflection.HasField(resource, &block);
}

/// Returns the symbol of the unit of a field such as "half_backlash_metres" or
/// "dynamics.half_backlash_metres".
std::string unit_of(const Descriptor& resource, const std::string& field) {
  const std::size_t dot = field.find('.');
  if (dot == std::string::npos) {
    const Constraint* row = find_constraint(resource.name(), field);
    return row == nullptr ? "" : std::string(row->unit);
  }
  const FieldDescriptor* block = resource.FindFieldByName(field.substr(0, dot));
  if (block == nullptr || block->message_type() == nullptr) return "";
  return unit_of(*block->message_type(), field.substr(dot + 1));
}

}  // namespace

const v1::ParameterProvenance* find_provenance(const Provenances& all, const std::string& field) {
  const std::string block = field.substr(0, field.find('.'));
  for (const std::string& key : {field, block, std::string("*")}) {
    for (const v1::ParameterProvenance& entry : all) {
      if (entry.field() == key) return &entry;
    }
  }
  return nullptr;
}

ParameterPaths parameter_paths(const Descriptor& resource) {
  ParameterPaths out;
  for (int i = 0; i < resource.field_count(); ++i) {
    const FieldDescriptor& field = *resource.field(i);
    if (is_parameter(field)) out.numbers.push_back(field.name());
    if (!is_block(field)) continue;
    out.blocks.push_back(field.name());
    if (field.is_repeated()) continue;
    for (int k = 0; k < field.message_type()->field_count(); ++k) {
      const FieldDescriptor& inner = *field.message_type()->field(k);
      if (is_parameter(inner)) out.numbers.push_back(field.name() + "." + inner.name());
    }
  }
  return out;
}

void check_provenance(const Descriptor& resource, const Provenances& all, const std::string& path,
                      Violations& violations) {
  const ParameterPaths paths = parameter_paths(resource);
  std::vector<std::string> known = paths.numbers;
  known.insert(known.end(), paths.blocks.begin(), paths.blocks.end());
  known.emplace_back("*");
  std::set<std::string> seen;
  for (int i = 0; i < all.size(); ++i) {
    const v1::ParameterProvenance& entry = all.Get(i);
    const std::string here = fmt::format("{}[{}]", path, i);
    if (!contains(known, entry.field())) {
      violations.add(here + ".field", "\"{}\" is not a parameter{}", plain_excerpt(entry.field()),
                     meant_text(entry.field(), known));
      continue;
    }
    if (!seen.insert(entry.field()).second) {
      violations.add(here + ".field", "\"{}\" is named twice", entry.field());
    }
    const bool is_number = contains(paths.numbers, entry.field());
    if (entry.standard_uncertainty() != 0 && !is_number) {
      violations.add(here + ".standard_uncertainty", "\"{}\" is not a single number",
                     entry.field());
    }
    const std::string unit = unit_of(resource, entry.field());
    if (!entry.unit().empty() && entry.unit() != unit) {
      violations.add(here + ".unit", "unit = \"{}\"; allowed: \"{}\", the unit of {}, or empty",
                     plain_excerpt(entry.unit()), unit, entry.field());
    }
  }
}

void clear_units(Provenances& all) {
  for (v1::ParameterProvenance& entry : all) entry.clear_unit();
}

void fill_units(const Descriptor& resource, Provenances& all) {
  for (v1::ParameterProvenance& entry : all) entry.set_unit(unit_of(resource, entry.field()));
}

void complete_provenance(const google::protobuf::Message& resource, Provenances& all) {
  const ParameterPaths paths = parameter_paths(*resource.GetDescriptor());
  std::vector<std::string> needed;
  for (const std::string& block : paths.blocks) {
    if (is_set_in(resource, *resource.GetDescriptor()->FindFieldByName(block))) {
      needed.push_back(block);
    }
  }
  for (const std::string& number : paths.numbers) {
    const auto* field = resource.GetDescriptor()->FindFieldByName(number);  // null: in a block
    if (field == nullptr) continue;
    const bool is_set =
        !field->has_presence() || resource.GetReflection()->HasField(resource, field);
    if (is_set) needed.push_back(number);
  }
  for (const std::string& field : needed) {
    if (find_provenance(all, field) != nullptr) continue;
    v1::ParameterProvenance* entry = all.Add();
    entry->set_field(field);
    entry->set_provenance(v1::PROVENANCE_USER);
    entry->set_source(kSourceOfUser);
  }
  if (has_tables(*resource.GetDescriptor())) return;
  std::vector<std::string> order = paths.numbers;
  order.insert(order.end(), paths.blocks.begin(), paths.blocks.end());
  const auto place = [&](const v1::ParameterProvenance& entry) {
    return std::find(order.begin(), order.end(), entry.field());
  };
  std::stable_sort(all.pointer_begin(), all.pointer_end(),
                   [&](const auto* a, const auto* b) { return place(*a) < place(*b); });
}

}  // namespace tribodyn::server
