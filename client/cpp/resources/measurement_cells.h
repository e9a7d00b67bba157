#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace tribodyn::client {

// Lists among a lubricant's measurements as cells of a table, one list per cell: "150000 mPa s at
// -40 C; 21000 mPa s at -26 C". Spreadsheets do not interpret this form as a formula, a date or a
// number.

/// Whether a field of LubricantMeasurements is a list that a cell can hold.
bool is_measurement_list(const google::protobuf::FieldDescriptor& field);

/// Replaces the list by the values in the cell. Returns an empty text, or the error in the cell.
/// The unit may be omitted: mPa s for a Brookfield viscosity, kg/m3 for a density, C for a
/// temperature. A viscosity may end in "+- 0.01", its relative standard uncertainty.
std::string read_measurement_cell(const google::protobuf::FieldDescriptor& list,
                                  const std::string& text, google::protobuf::Message& measurements);

/// Returns a cell from which read_measurement_cell() reads exactly the same list.
std::string measurement_cell(const google::protobuf::FieldDescriptor& list,
                             const google::protobuf::Message& measurements);

/// Sets the Brookfield viscosity at a temperature. Returns an empty text, or the error in `text`.
std::string add_cold_viscosity(double temperature_celsius, const std::string& text,
                               const std::string& bare_unit,
                               google::protobuf::Message& measurements);
void remove_cold_viscosity(double temperature_celsius, google::protobuf::Message& measurements);

}  // namespace tribodyn::client
