#include "client/cpp/resources/row_table.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::string_view kLabel = "labels.";
constexpr std::size_t kMostComplaints = 100;

/// A field at the top of a resource, or in its one block of measurements.
struct Column {
  const FieldDescriptor* block = nullptr;
  const FieldDescriptor* field = nullptr;

  const Message& parent(const Message& resource) const {
    return block == nullptr ? resource : resource.GetReflection()->GetMessage(resource, block);
  }
  Message& mutable_parent(Message& resource) const {
    return block == nullptr ? resource
                            : *resource.GetReflection()->MutableMessage(&resource, block);
  }
};

bool is_number(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
         field.cpp_type() == FieldDescriptor::CPPTYPE_INT32;
}

std::vector<Column> columns_of(const ResourceKind& kind) {
  std::vector<Column> texts;
  std::vector<Column> numbers;
  const auto* type = kind.prototype->GetDescriptor();
  for (int i = 0; i < type->field_count(); ++i) {
    const FieldDescriptor* field = type->field(i);
    if (is_output_only(*field) || field->is_repeated()) continue;
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      (is_number(*field) ? numbers : texts).push_back({nullptr, field});
      continue;
    }
    for (int k = 0; k < field->message_type()->field_count(); ++k) {
      const FieldDescriptor* inner = field->message_type()->field(k);
      if (!inner->is_repeated() && is_number(*inner)) texts.push_back({field, inner});
    }
  }
  texts.insert(texts.end(), numbers.begin(), numbers.end());
  return texts;
}

bool set_number(const Column& column, const std::string& text, Message& resource) {
  double value = 0;
  const char* begin = text.data() + (text[0] == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return false;
  Message& parent = column.mutable_parent(resource);
  if (column.field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
    parent.GetReflection()->SetDouble(&parent, column.field, value);
    return true;
  }
  if (!(std::abs(value) < 1e9) || value != std::floor(value)) return false;
  parent.GetReflection()->SetInt32(&parent, column.field, static_cast<int>(value));
  return true;
}

bool set_class(const Column& column, const std::string& text, Message& resource) {
  const auto* type = column.field->enum_type();
  if (type == v1::Lubricant::BaseOilClass_descriptor() && (text == "pao" || text == "pag")) {
    return set_class(column, text == "pao" ? "POLYALPHAOLEFIN" : "POLYALKYLENE_GLYCOL", resource);
  }
  for (int i = 0; i < type->value_count(); ++i) {
    const auto* value = type->value(i);
    if (text != value->name() && text != enum_word(*value)) continue;
    resource.GetReflection()->SetEnum(&resource, column.field, value);
    return true;
  }
  return false;
}

/// What is wrong with the cell, or nothing.
std::string set_cell(const Column& column, const std::string& text, Message& resource) {
  const std::string quoted = "'" + printable(text.substr(0, 60)) + "'";
  if (is_number(*column.field)) {
    const bool whole = column.field->cpp_type() == FieldDescriptor::CPPTYPE_INT32;
    if (set_number(column, text, resource)) return "";
    return quoted + (whole ? " is not a whole number" : " is not a number with a decimal point");
  }
  if (column.field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    if (set_class(column, text, resource)) return "";
    return quoted + " is not one of " + joined(enum_words(*column.field->enum_type()), ", ");
  }
  resource.GetReflection()->SetString(&resource, column.field, text);
  return "";
}

/// Whether the resource has tables of its own (labels and provenance are none).
bool has_tables(const Message& resource) {
  std::vector<const FieldDescriptor*> fields;
  resource.GetReflection()->ListFields(resource, &fields);
  return std::any_of(fields.begin(), fields.end(), [&](const FieldDescriptor* field) {
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE || is_output_only(*field)) {
      return false;
    }
    if (field->is_repeated()) return field->name() != "labels" && field->name() != "provenance";
    return has_tables(resource.GetReflection()->GetMessage(resource, field));
  });
}

bool is_computed(const Message& resource, const Column& column) {
  if (column.block != nullptr) return false;
  const ProvenanceEntries& entries = provenance_entries_of(resource);
  return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
    return entry.computed() && entry.field() == column.field->name();
  });
}

std::string cell_of(const Column& column, const Message& resource) {
  const Message& parent = column.parent(resource);
  const auto& reflection = *parent.GetReflection();
  if (column.field->has_presence() && !reflection.HasField(parent, column.field)) return "";
  switch (column.field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      const double value = reflection.GetDouble(parent, column.field);
      return value == 0 && !column.field->has_presence() ? "" : shortest(value);
    }
    case FieldDescriptor::CPPTYPE_INT32:
      return std::to_string(reflection.GetInt32(parent, column.field));
    case FieldDescriptor::CPPTYPE_ENUM: {
      const auto* value = reflection.GetEnum(parent, column.field);
      return value->number() == 0 ? "" : enum_word(*value);
    }
    default:
      return reflection.GetString(parent, column.field);
  }
}

/// What one cell of a column does to a resource.
using SetCell = std::function<std::string(const std::string& text, Message& resource)>;

/// One for each column of the header; complaints for those that are none.
std::vector<SetCell> read_header(const std::vector<std::string>& header, const ResourceKind& kind,
                                 std::vector<std::string>& complaints) {
  const std::vector<Column> columns = columns_of(kind);
  std::vector<std::string> known;
  for (const Column& column : columns) known.push_back(column.field->name());
  std::vector<SetCell> out;
  std::set<std::string> seen;
  for (const std::string& name : header) {
    const std::string start = "column '" + printable(name.substr(0, 100)) + "' ";
    if (!seen.insert(name).second) complaints.push_back(start + "is there twice");
    if (name.rfind(kLabel, 0) == 0 && name.size() > kLabel.size()) {
      out.emplace_back([key = name.substr(kLabel.size())](const std::string& text, Message& to) {
        set_label(to, key, &text);
        return std::string();
      });
      continue;
    }
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const std::string meant = nearest(name, known);
      complaints.push_back(
          start + "is not known" +
          (meant.empty() ? "; `tribodyn help files` names them" : " (is " + meant + " meant?)"));
      out.emplace_back([](const std::string&, Message&) { return std::string(); });
      continue;
    }
    out.emplace_back(
        [column = columns[static_cast<std::size_t>(found - known.begin())]](
            const std::string& text, Message& to) { return set_cell(column, text, to); });
  }
  return out;
}

/// The fields that the columns tell of, those of a block as "block.field": what else the block
/// holds has no room in a table and stays.
std::vector<std::string> fields_of(const std::vector<std::string>& header,
                                   const ResourceKind& kind) {
  std::set<std::string> out;
  for (const std::string& name : header) {
    if (name.rfind(kLabel, 0) == 0) out.insert("labels");
  }
  for (const Column& column : columns_of(kind)) {
    const std::string& name = column.field->name();
    if (name == "name" || std::find(header.begin(), header.end(), name) == header.end()) continue;
    out.insert(column.block == nullptr ? name : column.block->name() + "." + name);
  }
  return {out.begin(), out.end()};
}

}  // namespace

bool is_row_table(const std::string& text) {
  const std::vector<CsvLine> header = read_csv(text, 1);
  return !header.empty() &&
         std::find(header[0].cells.begin(), header[0].cells.end(), "name") != header[0].cells.end();
}

std::vector<FileResource> read_row_table(const std::string& text, const std::string& path,
                                         const ResourceKind& kind) {
  if (!is_utf8(text)) throw Failure(kExitUsage, path + " is not UTF-8 text");
  const std::vector<CsvLine> lines = read_csv(text);
  std::vector<std::string> complaints;
  std::vector<FileResource> resources;
  const std::vector<std::string>& header = lines.at(0).cells;
  const std::vector<SetCell> setters = read_header(header, kind, complaints);
  const std::vector<std::string> fields = fields_of(header, kind);
  for (std::size_t i = 1; i < lines.size() && complaints.size() < kMostComplaints; ++i) {
    const std::string row = "row " + std::to_string(lines[i].number);
    if (lines[i].cells.size() != header.size()) {
      complaints.push_back(row + " has " + std::to_string(lines[i].cells.size()) +
                           " cells, the header " + std::to_string(header.size()));
      continue;
    }
    FileResource& read = resources.emplace_back(FileResource{&kind, kind.make(), path + " " + row});
    for (std::size_t k = 0; k < header.size(); ++k) {
      if (lines[i].cells[k].empty()) continue;
      const std::string wrong = setters[k](lines[i].cells[k], *read.resource);
      if (!wrong.empty()) complaints.push_back(row + " column " + header[k] + ": " + wrong);
    }
    for (const char* field : {"name", "derived_from"}) {
      const std::string stated = text_field(*read.resource, field);
      if (stated.empty()) continue;
      read.resource->GetReflection()->SetString(
          read.resource.get(), read.resource->GetDescriptor()->FindFieldByName(field),
          kind.name_of(stated));
    }
    if (text_field(*read.resource, "name").empty()) complaints.push_back(row + " has no name");
    read.fields = fields;
    read.columns = header;
  }
  if (complaints.empty() && resources.empty()) complaints.emplace_back("has no rows");
  if (!complaints.empty()) {
    throw Failure(kExitUsage,
                  path + ":\n  " + joined(complaints, "\n  ") + "\n  Nothing was written.");
  }
  return resources;
}

std::string row_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                      std::string& lost) {
  std::set<std::string> keys;
  bool tables = false;
  for (const ResourcePointer& resource : resources) {
    for (const v1::Label& label : labels_of(*resource)) keys.insert(label.key());
    tables = tables || has_tables(*resource);
  }
  lost = std::string("how each number is known") + (tables ? " and tables of measurements" : "");
  const std::vector<Column> columns = columns_of(kind);
  std::vector<std::string> header;
  for (const Column& column : columns) header.push_back(column.field->name());
  for (const std::string& key : keys) header.push_back(std::string(kLabel) + key);
  std::string text = csv_line(header);
  for (const ResourcePointer& resource : resources) {
    const bool computed_too = has_tables(*resource);
    std::vector<std::string> cells;
    for (const Column& column : columns) {
      const bool left_out = !computed_too && is_computed(*resource, column);
      cells.push_back(left_out ? "" : cell_of(column, *resource));
    }
    for (const std::string& key : keys) {
      std::string& cell = cells.emplace_back();
      for (const v1::Label& label : labels_of(*resource)) {
        if (label.key() == key) cell = label.value();
      }
    }
    text += csv_line(cells);
  }
  return text;
}

}  // namespace tribodyn::client
