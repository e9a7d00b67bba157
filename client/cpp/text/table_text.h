#pragma once

#include <string>

namespace tribodyn::client {

/// Returns the text of a table file as UTF-8. `bytes` may be UTF-8, UTF-16 with or without a byte
/// order mark, or Windows-1252 (Latin-1), as spreadsheets write them. Sets `note` to the conversion
/// that was made, or to empty. Throws Failure (kExitUsage), naming `path`, if the bytes are an
/// Excel workbook or not text.
std::string table_text(const std::string& bytes, const std::string& path, std::string& note);

/// Whether a file is read as a table rather than as JSON. The end of its name decides: .csv, .tsv,
/// .tab, .txt, and .xls or .xlsx, which table_text() rejects.
bool is_table_file(const std::string& path);

}  // namespace tribodyn::client
