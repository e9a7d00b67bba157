#include <iostream>
#include <memory>

#include "client/cpp/commands/command.h"
#include "client/cpp/resources/kind.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Returns "Lubricant" for "lubricants", "lubricant" and "Lubricant".
std::string message_of(const std::string& word) {
  for (const ResourceKind& kind : resource_kinds()) {
    if (word == kind.word || word == kind.collection || word == kind.list_field) {
      return kind.prototype->GetDescriptor()->name();
    }
  }
  std::string message = word;
  if (!message.empty() && message[0] >= 'a' && message[0] <= 'z') {
    message[0] = static_cast<char>(message[0] - 'a' + 'A');
  }
  return message;
}

std::string schema_table(const v1::Schema& schema) {
  std::string text;
  for (int i = 0; i < schema.constraints_size();) {
    const std::string message = schema.constraints(i).message();
    Table table({{message, "", Table::Align::kLeft},
                 {"from", ""},
                 {"to", ""},
                 {"unit", "", Table::Align::kLeft},
                 {"needed by", "", Table::Align::kLeft}});
    for (; i < schema.constraints_size() && schema.constraints(i).message() == message; ++i) {
      const v1::Constraint& row = schema.constraints(i);
      std::string need = row.equation();
      if (!row.reason().empty()) need += (need.empty() ? "" : ": ") + row.reason();
      if (row.zero_is_unset()) need += need.empty() ? "0: unset" : "; 0: unset";
      if (row.required()) need += need.empty() ? "required" : "; required";
      table.add_row({row.field(), significant(row.minimum(), 6), significant(row.maximum(), 6),
                     row.unit(), need});
    }
    text += (text.empty() ? "" : "\n") + table.text();
  }
  for (const v1::Vocabulary& vocabulary : schema.vocabularies()) {
    text +=
        "\n" + printable(vocabulary.name()) + "\n" +
        wrapped(printable(joined({vocabulary.words().begin(), vocabulary.words().end()}, ", ")), 2);
  }
  for (int i = 0; i < schema.columns_size();) {
    const std::string name = schema.columns(i).table();
    Table table({{"column of " + printable(name), "", Table::Align::kLeft},
                 {"unit", "", Table::Align::kLeft},
                 {"meaning", "", Table::Align::kLeft}});
    for (; i < schema.columns_size() && schema.columns(i).table() == name; ++i) {
      const v1::ColumnDescription& column = schema.columns(i);
      table.add_row(
          {printable(column.name()), printable(column.unit()), printable(column.description())});
    }
    text += "\n" + table.text();
  }
  return text;
}

int run(const std::string& word, const CommonOptions& options) {
  Connection connection = options.connect();
  const v1::Schema schema = connection.schema(message_of(word));
  switch (options.output_format) {
    case OutputFormat::kTable:
      std::cout << schema_table(schema);
      break;
    case OutputFormat::kCsv: {
      std::vector<CsvRow> rows;
      for (const auto& row : schema.constraints()) append_fields(row, "", rows.emplace_back());
      std::cout << csv_text(rows);
      break;
    }
    case OutputFormat::kJson:
      std::cout << json_text(schema);
  }
  return kExitOk;
}

}  // namespace

Command schema_command() {
  const auto message = std::make_shared<std::string>();
  Command command{
      "schema",
      "the constraints of every number: unit and allowed range",
      "Prints the server's table of constraints, from which all checks are made: field, "
      "allowed range, unit and the equation that requires it.",
      {"tribodyn schema lubricants", "tribodyn schema --output csv"},
      {},
      {},
      {}};
  command.flags.group("Arguments");
  Flag& flag = command.flags.text(
      "message", "[MESSAGE]",
      "Only this message, e.g. lubricants or LubricantMeasurements. Default: all, with the words "
      "that text fields may contain.",
      [message](const std::string& text) { *message = text; });
  for (const ResourceKind& kind : resource_kinds()) flag.words.push_back(kind.word);
  command.run = [message](const CommonOptions& options) { return run(*message, options); };
  return command;
}

}  // namespace tribodyn::client
