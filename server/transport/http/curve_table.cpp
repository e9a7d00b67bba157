#include "server/transport/http/curve_table.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "server/application/errors.h"
#include "server/contract/resource_names.h"
#include "server/transport/http/column_text.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

using Row = std::vector<std::pair<std::string, double>>;

bool is_number(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_INT64:
    case FieldDescriptor::CPPTYPE_BOOL:
      return true;
    default:
      return false;
  }
}

double number_at(const Message& message, const FieldDescriptor& field) {
  const auto& reflect = *message.GetReflection();
  if (field.has_presence() && !reflect.HasField(message, &field)) return kNothing;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return reflect.GetDouble(message, &field);
    case FieldDescriptor::CPPTYPE_INT32:
      return reflect.GetInt32(message, &field);
    case FieldDescriptor::CPPTYPE_INT64:
      return static_cast<double>(reflect.GetInt64(message, &field));
    default:
      return reflect.GetBool(message, &field) ? 1 : 0;
  }
}

/// Appends the numbers of a message, or NaN for each if there is none.
void append_numbers(const Message* message, const Descriptor& type, const std::string& prefix,
                    Row& row) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.is_repeated()) continue;
    if (is_number(field)) {
      row.emplace_back(prefix + field.name(), message ? number_at(*message, field) : kNothing);
    }
    if (field.message_type() == nullptr) continue;
    const bool is_there = message && message->GetReflection()->HasField(*message, &field);
    const Message* inner =
        is_there ? &message->GetReflection()->GetMessage(*message, &field) : nullptr;
    if (field.message_type() != v1::Extremes::descriptor()) {
      append_numbers(inner, *field.message_type(), prefix + field.name() + "_", row);
      continue;
    }
    for (int k = 0; k < v1::Extremes::descriptor()->field_count(); ++k) {
      const FieldDescriptor& figure = *v1::Extremes::descriptor()->field(k);
      row.emplace_back(figure.name() + "_" + prefix + field.name(),
                       inner ? number_at(*inner, figure) : kNothing);
    }
  }
}

Row row_of(const v1::CurvePoint& point) {
  Row out = {{"speed_kilometres_per_hour", point.speed_kilometres_per_hour()}};
  append_numbers(point.has_result() ? &point.result() : nullptr, *v1::PointResult::descriptor(), "",
                 out);
  return out;
}

std::string json_columns(const std::vector<std::string>& names, const Columns& columns) {
  std::string out = "{\"columns\":{";
  for (std::size_t c = 0; c < names.size(); ++c) {
    out += (c > 0 ? ",\"" : "\"") + names[c] + "\":[";
    for (std::size_t row = 0; row < columns[c].size(); ++row) {
      if (row > 0) out += ',';
      append_json_number(columns[c][row], out);
    }
    out += ']';
  }
  return out + "}}\n";
}

}  // namespace

Outcome<HttpResponse> curve_table(const v1::Simulation& simulation,
                                  const std::vector<std::string>& wanted, Form form) {
  if (!simulation.has_result()) {
    return not_possible(v1::ERROR_REASON_NO_RESULT_YET, "tribodyn.v1.Simulation", simulation.name(),
                        simulation.name() + " has no result",
                        {{"state", v1::Simulation::State_Name(simulation.state())}});
  }
  std::vector<std::string> existing;
  for (const auto& [name, value] : row_of({})) existing.push_back(name);
  const std::vector<std::string>& names = wanted.empty() ? existing : wanted;
  std::vector<std::size_t> places;
  Violations violations;
  for (const std::string& name : names) {
    const auto found = std::find(existing.begin(), existing.end(), name);
    places.push_back(static_cast<std::size_t>(found - existing.begin()));
    if (found == existing.end()) {
      violations.add("columns", "has no column {}{}", plain_excerpt(name),
                     meant_text(name, existing));
    }
  }
  if (!violations.empty()) return invalid(violations);
  Columns columns(names.size());
  for (const v1::CurvePoint& point : simulation.result().points()) {
    const Row row = row_of(point);
    for (std::size_t c = 0; c < places.size(); ++c) columns[c].push_back(row[places[c]].second);
  }
  const auto rows = static_cast<std::int64_t>(simulation.result().points_size());
  HttpResponse out;
  out.headers["Content-Type"] = content_type(form);
  if (form == Form::kCsv) out.body = csv_header(names) + csv_rows(columns);
  if (form == Form::kNumpy) out.body = numpy_header(names, rows) + numpy_rows(columns);
  if (form == Form::kPointColumns) out.body = json_columns(names, columns);
  return out;
}

}  // namespace tribodyn::server
