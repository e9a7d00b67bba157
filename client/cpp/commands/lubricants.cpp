#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include "client/cpp/commands/command.h"
#include "client/cpp/report/inputs.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

std::string lubricants_csv(const v1::ListLubricantsResponse& list) {
  std::vector<CsvRow> rows;
  for (const v1::Lubricant& lubricant : list.lubricants()) {
    append_fields(lubricant, "", rows.emplace_back());
  }
  return csv_text(rows);
}

std::string lubricants_table(const v1::ListLubricantsResponse& list) {
  Table table({{"Name", "", Table::Align::kLeft},
               {"Title", "", Table::Align::kLeft},
               {"alpha*", "1/GPa"},
               {"Vogel A_1", "K"},
               {"conductivity", "W/(m K)"}});
  for (const v1::Lubricant& lubricant : list.lubricants()) {
    table.add_row({lubricant.name(), lubricant.display_name(),
                   significant(1e9 * lubricant.pressure_viscosity_coefficient_per_pascal()),
                   significant(lubricant.vogel_temperature_coefficient_kelvin()),
                   significant(lubricant.thermal_conductivity_watts_per_metre_kelvin())});
  }
  return table.text();
}

/// Parameters in a table, and below it, once each, how they came to be known.
std::string lubricant_sheet(const v1::Lubricant& lubricant) {
  std::map<std::string, std::string> knowledge;
  for (const auto& entry : lubricant.provenance()) {
    knowledge[entry.field()] =
        provenance_word(entry.provenance()) + (entry.source().empty() ? "" : ": " + entry.source());
  }
  Table table(
      {{"Parameter (with its unit)", "", Table::Align::kLeft}, {"Value", ""}, {"Known", ""}});
  std::vector<std::string> notes;
  const auto* descriptor = v1::Lubricant::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const auto& field = *descriptor->field(i);
    if (field.cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
    const std::string note = knowledge[knowledge.count(field.name()) != 0 ? field.name() : "*"];
    auto found = std::find(notes.begin(), notes.end(), note);
    if (found == notes.end()) found = notes.insert(notes.end(), note);
    table.add_row({field.name(), shortest(lubricant.GetReflection()->GetDouble(lubricant, &field)),
                   "[" + std::to_string(found - notes.begin() + 1) + "]"});
  }
  std::string text = printable(lubricant.name()) + ": " + printable(lubricant.display_name()) +
                     "\n" + wrapped(printable(lubricant.description()), 0) + "\n" + table.text() +
                     "\n";
  for (std::size_t i = 0; i < notes.size(); ++i) {
    text += wrapped("[" + std::to_string(i + 1) + "] " +
                        (notes[i].empty() ? "not stated" : printable(notes[i])),
                    0);
  }
  return text;
}

int run_list(const CommonOptions& options) {
  const v1::ListLubricantsResponse list = options.connect().list_lubricants();
  switch (options.output_format) {
    case OutputFormat::kTable:
      std::cout << lubricants_table(list);
      break;
    case OutputFormat::kCsv:
      std::cout << lubricants_csv(list);
      break;
    case OutputFormat::kJson:
      std::cout << json_text(list);
  }
  return kExitOk;
}

int run_get(const std::string& name, const CommonOptions& options) {
  const v1::Lubricant lubricant =
      options.connect().get_lubricant(resource_name("lubricants", name));
  switch (options.output_format) {
    case OutputFormat::kTable:
      std::cout << lubricant_sheet(lubricant);
      break;
    case OutputFormat::kCsv: {
      v1::ListLubricantsResponse list;
      *list.add_lubricants() = lubricant;
      std::cout << lubricants_csv(list);
      break;
    }
    case OutputFormat::kJson:
      std::cout << json_text(lubricant);
  }
  return kExitOk;
}

}  // namespace

Command lubricants_list_command() {
  Command command{"lubricants list",
                  "the lubricants the server knows",
                  "Lists the lubricants the server knows.",
                  {"tribodyn lubricants list", "tribodyn lubricants list --output csv"},
                  {},
                  {},
                  run_list};
  return command;
}

Command lubricants_get_command() {
  const auto name = std::make_shared<std::string>();
  Command command{"lubricants get",
                  "one lubricant, each parameter with where it comes from",
                  "Prints one lubricant: every parameter, its value and how it is known.",
                  {"tribodyn lubricants get 1"},
                  {},
                  {},
                  {}};
  command.flags.group("Arguments");
  command.flags.text("name", "NAME", "The lubricant, e.g. 1 or lubricants/1.",
                     [name](const std::string& text) { *name = text; });
  command.check = [name](Complaints& complaints) {
    if (name->empty()) complaints.emplace_back("NAME is missing, e.g. tribodyn lubricants get 1");
  };
  command.run = [name](const CommonOptions& options) { return run_get(*name, options); };
  return command;
}

}  // namespace tribodyn::client
