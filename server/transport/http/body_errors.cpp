#include "server/transport/http/body_errors.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/support/text.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

/// The first line of what protobuf says of a body, as printable ASCII and without its end if it is
/// long. Further lines repeat the body.
std::string first_line(std::string_view text) {
  constexpr std::size_t kLongest = 300;  // [bytes]
  std::string out(text.substr(0, std::min(text.find('\n'), kLongest)));
  for (char& character : out) {
    if (character < ' ' || character > '~') character = '?';
  }
  return out;
}

/// What the parser expected of a value, by the name that it gives the type.
std::string expected_of(std::string_view type) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 5> kScalars = {
      {{"TYPE_DOUBLE", "a number, \"NaN\", \"Infinity\" or \"-Infinity\""},
       {"TYPE_INT32", "a whole number of 32 bits"},
       {"TYPE_INT64", "a whole number of 64 bits, as a number or in quotes"},
       {"TYPE_BOOL", "true or false"},
       {"TYPE_STRING", "text in quotes, in UTF-8"}}};
  for (const auto& [name, expected] : kScalars) {
    if (type == name) return expected;
  }
  static constexpr std::string_view kPrefix = "type.googleapis.com/";
  if (!type.starts_with(kPrefix)) return {};
  const std::string name(type.substr(kPrefix.size()));
  const auto& pool = *google::protobuf::DescriptorPool::generated_pool();
  if (const auto* values = pool.FindEnumTypeByName(name)) return "one of " + values_of(*values);
  if (name == "google.protobuf.Timestamp") return "a time such as \"2025-01-31T12:00:00Z\"";
  if (name == "google.protobuf.Duration") return "a duration such as \"1.5s\"";
  if (name == "google.protobuf.FieldMask") return "names of fields such as \"displayName,labels\"";
  const Descriptor* message = pool.FindMessageTypeByName(name);
  return message == nullptr ? std::string() : "a JSON object, " + message->name();
}

/// Cuts "(path)" off the front of a complaint and returns the path; "" if there is none.
std::string take_place(std::string_view& complaint) {
  if (!complaint.starts_with('(')) return {};
  const std::size_t end = complaint.find(')');
  if (end == std::string_view::npos) return {};
  std::string out(complaint.substr(1, end - 1));
  complaint.remove_prefix(end + 1);
  return out;
}

/// Returns the message at a path such as "measurements.viscosities[1]", or null.
const Descriptor* message_at(const Descriptor& type, std::string_view path) {
  const Descriptor* out = &type;
  while (out != nullptr && !path.empty()) {
    std::string_view name = take_part(path, '.');
    name = name.substr(0, name.find('['));
    const FieldDescriptor* field = out->FindFieldByName(std::string(name));
    if (field == nullptr) field = out->FindFieldByCamelcaseName(std::string(name));
    out = field == nullptr ? nullptr : field->message_type();
  }
  return out;
}

/// A complaint such as `(path): invalid value "x" for type T`.
std::optional<Violation> wrong_value(const std::string& prefix, std::string_view complaint) {
  const std::string place = take_place(complaint);
  static constexpr std::string_view kBegin = ": invalid value ";
  static constexpr std::string_view kMiddle = " for type ";
  const std::size_t middle = complaint.rfind(kMiddle);
  if (place.empty() || !complaint.starts_with(kBegin) || middle == std::string_view::npos ||
      middle < kBegin.size()) {
    return std::nullopt;
  }
  const std::string expected = expected_of(complaint.substr(middle + kMiddle.size()));
  if (expected.empty()) return std::nullopt;
  const std::string_view value = complaint.substr(kBegin.size(), middle - kBegin.size());
  return Violation{join_path(prefix, first_line(place)),
                   "is " + plain_excerpt(value) + "; allowed: " + expected};
}

/// A complaint such as "(path) name: Cannot find field."
std::optional<Violation> unknown_field(const Descriptor& type, const std::string& prefix,
                                       std::string_view complaint) {
  const std::string place = take_place(complaint);
  static constexpr std::string_view kEnd = ": Cannot find field.";
  if (!complaint.ends_with(kEnd)) return std::nullopt;
  complaint.remove_suffix(kEnd.size());
  while (complaint.starts_with(' ')) complaint.remove_prefix(1);
  const Descriptor* message = message_at(type, place);
  if (message == nullptr) return std::nullopt;
  std::vector<std::string> names;
  for (int i = 0; i < message->field_count(); ++i) names.push_back(message->field(i)->name());
  return Violation{join_path(prefix, join_path(first_line(place), plain_excerpt(complaint))),
                   "is no field of " + message->name() + meant_text(std::string(complaint), names)};
}

}  // namespace

std::string values_of(const google::protobuf::EnumDescriptor& type) {
  std::string out;
  for (int i = 0; i < type.value_count(); ++i) {
    if (i > 0) out += ", ";
    out += type.value(i)->name();
  }
  return out;
}

Violation body_violation(const Descriptor& type, const std::string& prefix,
                         std::string_view complaint) {
  if (auto out = wrong_value(prefix, complaint)) return *std::move(out);
  if (auto out = unknown_field(type, prefix, complaint)) return *std::move(out);
  return {prefix, "the body is no JSON of " + type.name() + ": " + first_line(complaint)};
}

}  // namespace tribodyn::server
