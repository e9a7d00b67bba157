#pragma once

#include <string>

namespace tribodyn::client {

/// The text of a table as UTF-8, from the bytes of a file as spreadsheets write it: UTF-8, UTF-16
/// with or without a byte order mark, or Windows-1252 (Latin-1). Sets `note` to what was converted,
/// empty if nothing was. Throws Failure (kExitUsage), with `path`, for an Excel workbook and for
/// what is no text.
std::string table_text(const std::string& bytes, const std::string& path, std::string& note);

/// Whether a file is read as a table and not as JSON: by the end of its name (.csv, .tsv, .tab,
/// .txt, and .xls or .xlsx, which are refused).
bool is_table_file(const std::string& path);

}  // namespace tribodyn::client
