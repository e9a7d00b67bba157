#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cpp/commands/json_import.h"
#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/row_columns.h"
#include "client/cpp/resources/row_table.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table_text.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Returns the kind whose table has this header; null if there is none.
const ResourceKind* kind_of_table(const std::string& text) {
  const std::string header = text.substr(0, text.find('\n'));
  const auto has = [&](const char* word) { return header.find(word) != std::string::npos; };
  const auto* kind = has("load_share")    ? "gear-sets"
                     : has("temperature") ? "lubricants"
                     : has("height")      ? "surfaces"
                                          : "";
  for (const ResourceKind& each : resource_kinds()) {
    if (each.word == kind) return &each;
  }
  return nullptr;
}

/// Returns the kind that has most columns of a table of rows.
const ResourceKind& kind_of_rows(const std::string& text) {
  const std::vector<std::string> header = read_csv(text, 1).front().cells;
  const auto count = [&](const ResourceKind& kind) {
    return std::count_if(header.begin(), header.end(), [&](const std::string& cell) {
      std::string wrong;
      return find_column(kind, cell, wrong).has_value();
    });
  };
  return *std::max_element(
      resource_kinds().begin(), resource_kinds().end(),
      [&](const ResourceKind& a, const ResourceKind& b) { return count(a) < count(b); });
}

/// The id for a file without a name.
constexpr char kAnyId[] = "validated";

/// Adds the errors of a file to `wrong` and prints its valid parts on standard output.
void validate(Connection& connection, const std::string& path, std::vector<std::string>& wrong) {
  const bool is_table = is_table_file(path);
  const std::string text = is_table ? read_table_file(path, kLargestFile) : read_file(path);
  const bool rows = is_table && is_row_table(text);
  if (is_table && !rows) {
    const ResourceKind* kind = kind_of_table(text);
    if (kind == nullptr) {
      wrong.push_back(path +
                      ": unknown columns; `tribodyn help files` lists the "
                      "columns");
      return;
    }
    TableFiles tables;
    add_table(*kind, path, tables);
    // Fields that the table does not set come from valid hardware, so that only the table is
    // checked.
    const ResourcePointer rest = kind->word == "lubricants"
                                     ? kind->make()
                                     : copy_of(connection, *kind, kind->example, tables);
    try {
      create_with_tables(connection, *kind, *rest, kAnyId, tables, true);
      std::cout << path << ": valid\n";
    } catch (const ServiceError& error) {
      if (error.kind() != ServiceError::Kind::kRefused) throw;
      wrong.push_back(path + ": " + error.what());
    }
    return;
  }
  auto resources = rows ? read_row_table(text, path, kind_of_rows(text)).resources
                        : read_resources(text, path, nullptr);
  if (resources.empty()) {
    std::cout << path << ": valid, but empty\n";
    return;
  }
  const bool is_nameless =
      resources.size() == 1 && text_field(*resources.front().resource, "name").empty();
  const ResourceKind& kind = *resources.front().kind;
  const JsonImport import(kind, std::move(resources), is_nameless ? kAnyId : "");
  const JsonImport::Verdict verdict = import.check(connection);
  for (const std::string& origin : verdict.valid) std::cout << origin << ": valid\n";
  wrong.insert(wrong.end(), verdict.wrong.begin(), verdict.wrong.end());
}

int run(const std::vector<std::string>& files, const CommonOptions& options) {
  Connection connection = options.connect();
  std::vector<std::string> wrong;
  ExitCode exit_code = kExitOk;
  for (const std::string& path : files) {
    try {
      validate(connection, path, wrong);
    } catch (const Failure& failure) {
      wrong.emplace_back(failure.what());
      exit_code = failure.exit_code();
    }
  }
  if (wrong.empty()) return kExitOk;
  throw Failure(exit_code == kExitOk ? kExitFailed : exit_code, joined(wrong, "\n"));
}

}  // namespace

Command validate_command() {
  const auto files = std::make_shared<std::vector<std::string>>();
  Command command{
      "validate",
      "check files as an import does, and write nothing",
      "Checks files as an import does: lubricants, gear sets, surfaces and vehicles as JSON, and "
      "tables as CSV. Lists every violation with value, unit and allowed range.",
      {"tribodyn validate fluids.json", "tribodyn validate my-oil.csv"},
      {},
      {},
      {}};
  command.flags.group("Arguments");
  command.flags.texts("file", "FILE",
                      "JSON, or a table whose name ends in .csv, .tsv, .tab or .txt; - is "
                      "JSON from standard input.",
                      [files](const std::string& path) { files->push_back(path); });
  command.check = [files](Complaints& complaints) {
    if (files->empty()) complaints.emplace_back("FILE is missing");
  };
  command.run = [files](const CommonOptions& options) { return run(*files, options); };
  return command;
}

}  // namespace tribodyn::client
