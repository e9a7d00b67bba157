#pragma once

#include <google/protobuf/message.h>

#include <optional>
#include <string>
#include <vector>

#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

/// A column of a table with one resource per row.
struct RowColumn {
  enum class Kind {
    kText,
    kClass,          ///< a word of an enumeration
    kNumber,         ///< in the unit at the end of the field's name, or with its own unit
    kMeasurements,   ///< a list of the block's rows, "150000 mPa s at -40 C; 21000 mPa s at -26 C"
    kColdViscosity,  ///< one Brookfield viscosity; the header contains the temperature
    kProvenance,     ///< the origin of the parameter `key`: "FIELD.source" and so on
    kLabel,          ///< "labels.KEY"
  };
  enum class Part { kProvenance, kSource, kStandardUncertainty, kWarning };

  Kind kind = Kind::kText;
  const google::protobuf::FieldDescriptor* block =
      nullptr;  ///< null: at the top level of the resource
  const google::protobuf::FieldDescriptor* field = nullptr;
  std::string key;                 ///< of a label; the field of a provenance entry
  Part part = Part::kProvenance;   ///< of a provenance entry
  double temperature_celsius = 0;  ///< of a cold viscosity
  /// For a number: the unit of cells without one; empty: cells must state their unit.
  std::string bare_unit;

  bool is_number() const { return kind == Kind::kNumber || kind == Kind::kColdViscosity; }
};

/// How a complaint of find_column() about a header begins that is a list of the resource.
inline constexpr char kNotAColumn[] = "is a table itself, which no cell can contain";

/// Returns the columns that every table of the kind may have, texts and classes first, without
/// labels and provenance.
std::vector<RowColumn> columns_of(const ResourceKind& kind);

/// Returns the provenance columns of these resources, without columns that would be empty.
std::vector<RowColumn> provenance_columns(const std::vector<ResourcePointer>& resources);

/// Returns e.g. "kinematic_viscosity_40_celsius_square_millimetres_per_second", "labels.project" or
/// "thermal_conductivity_watts_per_metre_kelvin.source".
std::string header_of(const RowColumn& column);

/// Returns the column of a header: its full name or its data-sheet name (kv40), in upper or lower
/// case, with blanks, dashes or underscores, optionally followed by a unit in brackets, "Density15
/// (g/cm3)". Returns nullopt and sets `wrong` to a complaint with the nearest name if there is
/// none.
std::optional<RowColumn> find_column(const ResourceKind& kind, const std::string& header,
                                     std::string& wrong);

/// Returns the name of a column that is nearest to a header, without its unit; empty if none is
/// near enough. The header itself if it is a name.
std::string nearest_column(const ResourceKind& kind, const std::string& header);

/// Writes a cell, which is not empty, into the resource. Returns an empty text, or the error in the
/// cell.
std::string set_cell(const RowColumn& column, const std::string& text,
                     google::protobuf::Message& resource);

/// Clears the value that a cell of the column would set.
void clear_cell(const RowColumn& column, google::protobuf::Message& resource);

/// Returns the cell of a resource; empty if the value is not set or computed by the server.
std::string cell_of(const RowColumn& column, const google::protobuf::Message& resource);

/// Returns the path for an update mask; empty for the name.
std::string mask_of(const RowColumn& column);

/// Returns the class for a data-sheet text such as "PAO", "Gr. III", "group 3" or "Ester"; null if
/// there is none.
const google::protobuf::EnumValueDescriptor* find_base_oil_class(const std::string& text);

/// Returns a header or a word in lower case, with one underscore for each run of blanks, dashes and
/// underscores.
std::string plain_word(std::string_view text);

}  // namespace tribodyn::client
