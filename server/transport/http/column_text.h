#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tribodyn::server {

/// Columns of one length.
using Columns = std::vector<std::vector<double>>;

/// Appends the shortest text that reads back as the same double; "" for a NaN.
void append_csv_number(double value, std::string& out);
/// Appends the same as JSON: null for a NaN, "Infinity" and "-Infinity" in quotes.
void append_json_number(double value, std::string& out);

/// Returns a line of the names. They hold no comma and no quote.
std::string csv_header(const std::vector<std::string>& names);
/// Returns a line for each row.
std::string csv_rows(const Columns& columns);

/// Returns the header of a .npy file (version 1.0) of a structured array: a field "<f8" for each
/// name. Throws std::length_error if the names are longer than 65 kB together.
std::string numpy_header(const std::vector<std::string>& names, std::int64_t rows);
/// Returns the rows in little-endian doubles, row by row.
std::string numpy_rows(const Columns& columns);

}  // namespace tribodyn::server
