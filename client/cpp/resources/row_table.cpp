#include "client/cpp/resources/row_table.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/grouped_complaints.h"
#include "client/cpp/resources/row_columns.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Reads a table row by row.
class RowReader {
 public:
  RowReader(const std::string& text, const std::string& path, const ResourceKind& kind,
            const RowBases& bases)
      : path_(path),
        kind_(kind),
        bases_(bases),
        cells_(
            text, path,
            [&kind](const std::string& header, std::string& wrong) {
              return find_column(kind, header, wrong);
            },
            wrong_) {
    out_.note = cells_.note();
    for (const auto& column : cells_.columns()) {
      has_provenance_columns_ =
          has_provenance_columns_ || (column && column->kind == RowColumn::Kind::kProvenance);
    }
  }

  RowTable result() {
    for (const CsvLine& line : cells_.lines()) read_row(line);
    if (wrong_.empty() && out_.resources.empty()) wrong_.add("has no rows");
    if (!wrong_.empty()) {
      throw Failure(kExitUsage,
                    path_ + ":\n  " + joined(wrong_.lines(), "\n  ") + "\n  Nothing was written.");
    }
    return std::move(out_);
  }

 private:
  std::string name_in(const CsvLine& line) const {
    for (std::size_t k = 0; k < cells_.header().size(); ++k) {
      if (cells_.is_name(k)) {
        return line.cells[k].empty() ? "" : kind_.name_of(line.cells[k]);
      }
    }
    return "";
  }

  void read_row(const CsvLine& line) {
    FileResource& read = out_.resources.emplace_back(
        FileResource{&kind_, kind_.make(), path_ + " " + RowCells::row_text(line)});
    bool clears = false;
    if (bases_.like != nullptr) {
      read.resource->CopyFrom(*bases_.like);
    } else if (bases_.present && has_provenance_columns_) {
      if (ResourcePointer present = bases_.present(name_in(line))) {
        read.resource = std::move(present);
        clears = true;
      }
    }
    const auto& columns = cells_.columns();
    // Provenance cells come after the number: a new number clears its former provenance.
    for (const bool provenance : {false, true}) {
      for (std::size_t k = 0; k < columns.size(); ++k) {
        if (!columns[k]) continue;
        if ((columns[k]->kind == RowColumn::Kind::kProvenance) != provenance) continue;
        set(line, k, clears, *read.resource);
      }
    }
    if (bases_.like != nullptr) leave_law_to_viscosities(cells_, line, *read.resource);
    if (text_field(*read.resource, "name").empty())
      wrong_.add(RowCells::row_text(line), "", "has no name");
    for (const char* field : {"name", "derived_from"}) {
      const std::string stated = text_field(*read.resource, field);
      if (!stated.empty()) set_text(*read.resource, field, kind_.name_of(stated));
    }
    if (bases_.like == nullptr) read.fields = fields();
    read.columns = cells_.columns_by_name();
  }

  void set(const CsvLine& line, std::size_t k, bool clears, Message& resource) {
    const std::string& cell = line.cells[k];
    const RowColumn& column = *cells_.columns()[k];
    if (cell.empty()) {
      if (clears) clear_cell(column, resource);
      return;
    }
    const std::string wrong = set_cell(column, cell, resource);
    if (!wrong.empty()) wrong_.add(RowCells::row_text(line), cells_.column_text(k), wrong);
  }

  /// Returns the fields that the columns set; a field of a nested message as "block.field", so that
  /// an update keeps its other fields.
  std::vector<std::string> fields() const {
    std::set<std::string> out;
    for (const auto& column : cells_.columns()) {
      if (column) out.insert(mask_of(*column));
    }
    out.erase("");
    return {out.begin(), out.end()};
  }

  const std::string path_;
  const ResourceKind& kind_;
  const RowBases& bases_;
  GroupedComplaints wrong_;
  const RowCells cells_;
  bool has_provenance_columns_ = false;
  RowTable out_;
};

/// Whether the resource has tables that a row cannot hold: all but a lubricant's measurements.
bool has_other_tables(const Message& resource) {
  std::vector<const FieldDescriptor*> fields;
  resource.GetReflection()->ListFields(resource, &fields);
  return std::any_of(fields.begin(), fields.end(), [](const FieldDescriptor* field) {
    return field->is_repeated() && !is_output_only(*field) && field->name() != "labels" &&
           field->name() != "provenance";
  });
}

}  // namespace

bool is_row_table(const std::string& text) {
  const std::vector<CsvLine> header = read_csv(text, 1);
  return !header.empty() &&
         std::any_of(header[0].cells.begin(), header[0].cells.end(),
                     [](const std::string& cell) { return plain_word(cell) == "name"; });
}

void leave_law_to_viscosities(const RowCells& cells, const CsvLine& line, Message& resource) {
  bool has_viscosity = false;
  std::set<std::string> stated;
  for (std::size_t k = 0; k < cells.header().size(); ++k) {
    const auto& column = cells.columns()[k];
    if (!column || column->field == nullptr || line.cells[k].empty()) continue;
    const std::string& name = column->field->name();
    stated.insert(name);
    has_viscosity =
        has_viscosity || (column->block != nullptr && name.find("viscosit") != std::string::npos);
  }
  if (!has_viscosity) return;
  constexpr const char* kLaw[] = {"vogel_viscosity_prefactor_pascal_seconds",
                                  "vogel_temperature_coefficient_kelvin",
                                  "vogel_reference_temperature_kelvin"};
  if (std::any_of(std::begin(kLaw), std::end(kLaw),
                  [&](const char* each) { return stated.count(each) != 0; })) {
    return;
  }
  for (const char* each : kLaw) {
    const FieldDescriptor* field = resource.GetDescriptor()->FindFieldByName(each);
    if (field == nullptr) return;
    resource.GetReflection()->ClearField(&resource, field);
    drop_provenance(resource, each);
  }
}

RowTable read_row_table(const std::string& text, const std::string& path, const ResourceKind& kind,
                        const RowBases& bases) {
  return RowReader(text, path, kind, bases).result();
}

std::string row_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                      std::string& lost) {
  std::set<std::string> keys;
  std::vector<std::string> incomplete;  // lubricants
  lost.clear();
  for (const ResourcePointer& resource : resources) {
    for (const v1::Label& label : labels_of(*resource)) keys.insert(label.key());
    if (!has_other_tables(*resource)) continue;
    if (dynamic_cast<const v1::Lubricant*>(&*resource) != nullptr) {
      incomplete.push_back(printable(resource_id(text_field(*resource, "name"))));
    } else {
      lost = "measured profiles";  // their parameters are in the row
    }
  }
  if (!incomplete.empty()) {
    throw Failure(kExitUsage,
                  "a row cannot contain boundary friction by temperature, which these lubricants "
                  "have: " +
                      joined(incomplete, ", ") +
                      ". Export JSON (without --output csv).\n  Nothing was written.");
  }
  std::vector<RowColumn> columns = columns_of(kind);
  const std::vector<RowColumn> provenance = provenance_columns(resources);
  columns.insert(columns.end(), provenance.begin(), provenance.end());
  for (const std::string& key : keys) {
    RowColumn& column = columns.emplace_back();
    column.kind = RowColumn::Kind::kLabel;
    column.key = key;
  }
  std::vector<std::string> header;
  for (const RowColumn& column : columns) header.push_back(header_of(column));
  std::string text = csv_line(header);
  for (const ResourcePointer& resource : resources) {
    std::vector<std::string> cells;
    for (const RowColumn& column : columns) cells.push_back(cell_of(column, *resource));
    text += csv_line(cells);
  }
  return text;
}

}  // namespace tribodyn::client
