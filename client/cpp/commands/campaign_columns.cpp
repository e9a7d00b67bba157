#include <iostream>
#include <optional>

#include "client/cpp/commands/campaign_command.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr int kRowsOfATable = 20;  // that a terminal shows by default

struct ColumnFlags {
  std::string name;
  CampaignRowsOptions part;  ///< but for its row count
  std::optional<int> row_count;
};

std::vector<std::string> row_cells(const HistoryRows& rows, std::size_t row,
                                   std::string (*text)(double)) {
  std::vector<std::string> out;
  for (const std::vector<double>& column : rows.columns) out.push_back(text(column[row]));
  return out;
}

void print_csv(Connection& connection, const std::string& name, const CampaignRowsOptions& part) {
  connection.stream_campaign(
      name, part,
      [](const v1::HistorySchema& schema) {
        std::vector<std::string> header;
        for (const auto& each : schema.columns()) header.push_back(each.name());
        std::cout << csv_line(header);
      },
      [](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.front().size(); ++i) {
          std::cout << csv_line(row_cells(rows, i, shortest));
        }
      });
}

void print_table(Connection& connection, const std::string& name, const CampaignRowsOptions& part) {
  std::optional<Table> table;
  std::int64_t row_number = part.start_row;
  const bool is_filtered = !part.filter.empty();
  v1::HistorySchema schema;
  connection.stream_campaign(
      name, part,
      [&](const v1::HistorySchema& found) {
        schema = found;
        std::vector<Table::Column> columns = {
            {is_filtered ? "match" : "row", "", Table::Align::kRight}};
        for (const auto& each : found.columns()) {
          columns.push_back({each.name(), each.unit(), Table::Align::kDecimal});
        }
        table.emplace(std::move(columns));
      },
      [&](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.front().size(); ++i) {
          std::vector<std::string> cells =
              row_cells(rows, i, [](double value) { return significant(value, 6); });
          cells.insert(cells.begin(), std::to_string(row_number++));
          table->add_row(std::move(cells));
        }
      });
  std::cout << table->text();
  if (is_filtered) {
    std::cerr << row_number - part.start_row << " of the rows looked at satisfy the filter; the "
              << "column row has their numbers.\n";
  } else if (row_number < schema.total_rows()) {
    std::cerr << "Rows " << part.start_row << " to " << row_number - 1 << " of "
              << schema.total_rows()
              << ", counted from 0; --start-row, --row-count and --output csv "
              << "show others.\n";
  }
}

void print_json(Connection& connection, const std::string& name, const CampaignRowsOptions& part) {
  v1::History out;
  connection.stream_campaign(
      name, part,
      [&](const v1::HistorySchema& schema) {
        out.set_start_row(schema.start_row());
        out.set_total_rows(schema.total_rows());
        for (const auto& each : schema.columns()) {
          v1::History::Column* column = out.add_columns();
          column->set_name(each.name());
          column->set_unit(each.unit());
        }
      },
      [&](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.size(); ++i) {
          out.mutable_columns(static_cast<int>(i))
              ->mutable_values()
              ->Add(rows.columns[i].begin(), rows.columns[i].end());
        }
      });
  std::cout << json_text(out);
}

int run_columns(const ColumnFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  CampaignRowsOptions part = flags.part;
  const bool is_table = options.output_format == OutputFormat::kTable;
  const bool is_short = is_table && part.filter.empty();
  part.row_count = flags.row_count.value_or(is_short ? kRowsOfATable : 0);
  switch (options.output_format) {
    case OutputFormat::kTable:
      print_table(connection, flags.name, part);
      break;
    case OutputFormat::kCsv:
      print_csv(connection, flags.name, part);
      break;
    case OutputFormat::kJson:
      print_json(connection, flags.name, part);
  }
  return kExitOk;
}

}  // namespace

Command campaign_columns_command() {
  const auto flags = std::make_shared<ColumnFlags>();
  Command command = one_campaign_command(
      {"campaigns columns", "print columns of a campaign",
       "Prints columns of a campaign by rows, finished or not. Row i * conditions + k is candidate "
       "i "
       "at condition k, counted from 0. Columns are the figures; refusal_number (0: the row has "
       "figures; n: sentence n of `campaigns show`; -1: not computed yet); candidate, condition; "
       "the "
       "fields of conditions, e.g. speed_kilometres_per_hour; the parameters of candidates, e.g. "
       "lubricant.relaxation_time_seconds; row; and the numbers that ride along with them.",
       "tribodyn campaigns columns 12 --columns candidate,inefficiency_energy_mean_percent "
       "--output csv"},
      flags->name);
  command.flags.group("Options");
  command.flags.texts("--columns", "NAME",
                      "Columns, separated by commas. Default: refusal_number and all figures.",
                      [flags](const std::string& name) { flags->part.columns.push_back(name); });
  command.flags.whole_number("--start-row", {"rows", "0 to the last row", "0"}, "First row",
                             [flags](int value) { flags->part.start_row = value; });
  command.flags.whole_number("--row-count", {"rows", "0 or more", "20 in a table, else all"},
                             "Number of rows; 0: to the end",
                             [flags](int value) { flags->row_count = value; });
  command.flags.text("--filter", "FILTER",
                     "Only rows that satisfy all conditions, e.g. 'refusal_number > 0' or "
                     "'film_ratio_minimum < 1 AND additive = ZDDP': columns with = != < <= > >=.",
                     [flags](const std::string& text) { flags->part.filter = text; });
  command.run = [flags](const CommonOptions& options) { return run_columns(*flags, options); };
  return command;
}

}  // namespace tribodyn::client
