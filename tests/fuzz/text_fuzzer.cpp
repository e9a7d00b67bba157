// libFuzzer: texts that users write. The first letter of an input chooses the reader of the rest:
// - f: filter and order of a list (its collection in the first line)
// - t: page token
// - m: field mask, one path in each line
// - u: quantity, unit, unit of a bare number
// - c: table of the client
// - s: table of the server
//
// No text may cause a crash, a hang or a refusal without a sentence; a written table must be read
// back unchanged.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "server/application/field_mask.h"
#include "server/application/list_filter.h"
#include "server/application/page_token.h"
#include "server/resources/imports/csv_table.h"
#include "server/storage/properties.h"
#include "server/storage/seeds.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn {
namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void judge(const server::Violations& violations, std::size_t most) {
  require(violations.size() <= most);
  for (const server::Violation& each : violations) {
    require(!each.field.empty() && !each.description.empty());
  }
}

void read_filter(std::string_view text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string collection(text.substr(0, end));
  const std::string rest(text.substr(std::min(end + 1, text.size())));
  if (server::property_fields(collection).empty()) return;
  server::Violations violations;
  const auto restrictions = server::parse_filter(rest, collection, violations);
  judge(violations, server::kMaximumRestrictions + 1);
  require(restrictions.size() <= server::kMaximumRestrictions);
  require(!restrictions.empty() || !violations.empty() ||
          rest.find_first_not_of(" \t\n\v\f\r") == std::string::npos);
  violations.clear();
  server::parse_order(rest, collection, violations);
  judge(violations, 2);
}

void read_page_token(std::string_view text) {
  const std::string key = "the server's own", scope = "lubricants";
  require(!server::parse_page_token(key, scope, std::string(text)));  // nobody guesses a token
  const std::string seal = server::page_token(key, scope, {}).substr(0, 32);
  server::parse_page_token(key, scope, seal + std::string(text));
  const server::PageToken start{.last = {std::string(text), "lubricants/x"},
                                .total = static_cast<std::int64_t>(text.size())};
  const std::string token = server::page_token(key, scope, start);
  const auto again = server::parse_page_token(key, scope, token);
  require(!again || server::page_token(key, scope, *again) == token);
  require(again.has_value() || token.size() > 20'000);
  require(!server::parse_page_token(key, "vehicles", token));
  require(!server::parse_page_token("another key", scope, token));
}

void read_field_mask(std::string_view text) {
  static const std::vector<server::NewResource> kSeeds = server::seed_resources();
  const auto seed = [](const std::string& name) {
    v1::Lubricant out;
    for (const server::NewResource& each : kSeeds) {
      if (each.name == name) out.ParseFromString(each.body);
    }
    return out;
  };
  google::protobuf::FieldMask mask;
  for (const std::string& path : client::split(text, '\n')) mask.add_paths(path);
  v1::Lubricant target = seed("lubricants/paper-fluid-1");
  server::Violations violations;
  server::merge(seed("lubricants/paper-fluid-2"), mask, target, violations);
  judge(violations, static_cast<std::size_t>(mask.paths_size()) + 1);
  v1::Lubricant copy;
  require(copy.ParseFromString(target.SerializeAsString()));
}

void read_quantity(std::string_view text) {
  std::vector<std::string> lines = client::split(text, '\n');
  lines.resize(3);
  for (const bool temperature : {false, true}) {
    std::string wrong;
    const auto value = client::read_quantity(lines[0], lines[1], lines[2], temperature, wrong);
    require(value ? std::isfinite(*value) : !wrong.empty());
  }
  const auto ratio = client::unit_ratio(lines[1], lines[2]);
  require(ratio.has_value() == client::unit_ratio(lines[2], lines[1]).has_value());
  client::in_trade_unit(lines[1], 1);
  client::label_of_field(lines[1]);
}

/// Writes rows and reads them with both readers; the header is fixed.
void write_and_read(const std::vector<std::vector<std::string>>& rows) {
  std::string written = "a,b,c\n";
  for (const auto& row : rows) written += client::csv_line(row);
  const std::vector<client::CsvLine> lines = client::read_csv(written);
  require(lines.size() == rows.size() + 1);
  for (std::size_t i = 0; i < rows.size(); ++i) require(lines[i + 1].cells == rows[i]);
  // Cells of the server contain no line breaks.
  if (written.find('\0') != std::string::npos || written.find('\r') != std::string::npos) return;
  for (const auto& row : rows) {
    for (const std::string& cell : row) {
      if (cell.find('\n') != std::string::npos) return;
    }
  }
  server::Violations violations;
  const auto table = server::parse_csv(written, "csv", server::kMaximumCsvBytes, violations);
  require(table.has_value() == !rows.empty());
  for (std::size_t i = 0; i < rows.size(); ++i) require(table->rows[i].cells == rows[i]);
}

void read_client_table(std::string_view text) {
  std::vector<std::vector<std::string>> rows;
  int number = 0;
  for (client::CsvLine& line : client::read_csv(text)) {
    require(line.number > number && !line.cells.empty());
    number = line.number;
    line.cells.resize(3);
    rows.push_back(std::move(line.cells));
  }
  require(client::read_csv(text, 1).size() == std::min<std::size_t>(rows.size(), 1));
  write_and_read(rows);
}

void read_server_table(std::string_view text) {
  server::Violations violations;
  const auto table = server::parse_csv(text, "csv", 100'000, violations);
  judge(violations, server::kMaximumCsvViolations + 1);
  require(table || !violations.empty());
  if (!table) return;
  const std::vector<server::CsvColumnForm> forms = {
      {"temperature_celsius", "temperature", 1, 273.15},
      {"temperature_kelvin", "temperature"},
      {"density_kilograms_per_cubic_metre", "density"}};
  for (const auto& row : table->rows) require(row.cells.size() == table->columns.size());
  for (const server::CsvColumn& column : server::match_columns(*table, forms, violations)) {
    for (const auto empty : {server::EmptyCells::kViolation, server::EmptyCells::kAreNaN}) {
      const auto values = server::numbers(*table, column, empty, violations);
      require(values.size() == table->rows.size());
    }
  }
}

}  // namespace
}  // namespace tribodyn

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tribodyn;
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0]) {
    case 'f':
      read_filter(text);
      break;
    case 't':
      read_page_token(text);
      break;
    case 'm':
      read_field_mask(text);
      break;
    case 'u':
      read_quantity(text);
      break;
    case 'c':
      read_client_table(text);
      break;
    case 's':
      read_server_table(text);
      break;
    default:
      break;
  }
  return 0;
}
