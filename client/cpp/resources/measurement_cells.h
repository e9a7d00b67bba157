#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace tribodyn::client {

// The lists among a lubricant's measurements as cells of a table, one list a cell:
// "150000 mPa s at -40 C; 21000 mPa s at -26 C". No spreadsheet takes that for a formula, a date or
// a number.

/// Whether a field of LubricantMeasurements is such a list.
bool is_measurement_list(const google::protobuf::FieldDescriptor& field);

/// Replaces the list by that of the cell. What is wrong with the cell, or nothing. The unit of a
/// Brookfield viscosity and of a density may be left out: mPa s and kg/m3; that of a temperature
/// too: C. A viscosity may end in "+- 0.01", its relative standard uncertainty.
std::string read_measurement_cell(const google::protobuf::FieldDescriptor& list,
                                  const std::string& text, google::protobuf::Message& measurements);

/// The cell that read_measurement_cell reads back exactly.
std::string measurement_cell(const google::protobuf::FieldDescriptor& list,
                             const google::protobuf::Message& measurements);

/// Adds the Brookfield viscosity at a temperature, in place of one that is there. What is wrong
/// with the text, or nothing.
std::string add_cold_viscosity(double temperature_celsius, const std::string& text,
                               const std::string& bare_unit,
                               google::protobuf::Message& measurements);
void remove_cold_viscosity(double temperature_celsius, google::protobuf::Message& measurements);

}  // namespace tribodyn::client
