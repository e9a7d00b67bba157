#pragma once

#include <google/protobuf/message.h>

#include <optional>
#include <string>
#include <vector>

#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

/// A column of a table that holds a resource a row.
struct RowColumn {
  enum class Kind {
    kText,
    kClass,          ///< a word of an enumeration
    kNumber,         ///< in the unit that the field's name ends in, or with a unit of its own
    kMeasurements,   ///< a list of the block's rows, "150000 mPa s at -40 C; 21000 mPa s at -26 C"
    kColdViscosity,  ///< one Brookfield viscosity; the temperature stands in the header
    kProvenance,     ///< how the parameter `key` is known: "FIELD.source" and so on
    kLabel,          ///< "labels.KEY"
  };
  enum class Part { kProvenance, kSource, kStandardUncertainty, kWarning };

  Kind kind = Kind::kText;
  const google::protobuf::FieldDescriptor* block = nullptr;  ///< null: at the top of the resource
  const google::protobuf::FieldDescriptor* field = nullptr;
  std::string key;                 ///< of a label; the field of a provenance entry
  Part part = Part::kProvenance;   ///< of a provenance entry
  double temperature_celsius = 0;  ///< of a cold viscosity
  /// Of a number: the unit of cells that have none; empty: cells must have one.
  std::string bare_unit;

  bool is_number() const { return kind == Kind::kNumber || kind == Kind::kColdViscosity; }
};

/// The columns that every table of the kind can have, texts and classes first. Neither labels nor
/// provenance.
std::vector<RowColumn> columns_of(const ResourceKind& kind);

/// The columns that tell how the parameters of these resources are known: only those with something
/// to tell.
std::vector<RowColumn> provenance_columns(const std::vector<ResourcePointer>& resources);

/// "kinematic_viscosity_40_celsius_square_millimetres_per_second", "labels.project",
/// "thermal_conductivity_watts_per_metre_kelvin.source".
std::string header_of(const RowColumn& column);

/// The column that a header means: its full name or that of the trade (kv40), in any case, with
/// blanks, dashes or underscores; behind it a unit in brackets, "Density15 (g/cm3)". Nullopt, and
/// `wrong` names the nearest, when it means none.
std::optional<RowColumn> find_column(const ResourceKind& kind, const std::string& header,
                                     std::string& wrong);

/// Puts a cell, which is not empty, into the resource. What is wrong with it, or nothing.
std::string set_cell(const RowColumn& column, const std::string& text,
                     google::protobuf::Message& resource);

/// Takes away what a cell of the column would set.
void clear_cell(const RowColumn& column, google::protobuf::Message& resource);

/// The cell of a resource; empty where the server computed the value or nothing is set.
std::string cell_of(const RowColumn& column, const google::protobuf::Message& resource);

/// The path of an update mask that the column changes; empty for the name.
std::string mask_of(const RowColumn& column);

/// The class of base oil that the trade means: "PAO", "Gr. III", "group 3", "Ester". Null when none
/// is meant.
const google::protobuf::EnumValueDescriptor* find_base_oil_class(const std::string& text);

/// A header or a word in lower case, each run of blanks, dashes and underscores a single
/// underscore.
std::string plain_word(std::string_view text);

}  // namespace tribodyn::client
