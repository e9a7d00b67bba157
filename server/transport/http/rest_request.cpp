#include "server/transport/http/rest_request.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/util/field_mask_util.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver_util.h>
#include <google/protobuf/wire_format_lite.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "google/protobuf/field_mask.pb.h"
#include "server/application/errors.h"
#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "server/support/text.h"
#include "server/transport/http/body_errors.h"
#include "server/transport/http/media_types.h"
#include "server/transport/http/stream_format.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr char kTypePrefix[] = "type.googleapis.com";

google::protobuf::util::TypeResolver& resolver() {
  static const std::unique_ptr<google::protobuf::util::TypeResolver> kResolver(
      google::protobuf::util::NewTypeResolverForDescriptorPool(
          kTypePrefix, google::protobuf::DescriptorPool::generated_pool()));
  return *kResolver;
}

/// True if the text is UTF-8 as RFC 3629 has it. protobuf accepts other texts, logs an error, and
/// refuses to parse what it has written.
bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    if (first < 0x80) continue;
    const int further = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
    if (first < 0xc2 || first > 0xf4) return false;
    char32_t point = first & (0x3f >> further);
    for (int k = 0; k < further; ++k) {
      if (i == text.size() || (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return false;
      point = point << 6 | (static_cast<unsigned char>(text[i++]) & 0x3f);
    }
    const char32_t least = further == 1 ? 0x80 : further == 2 ? 0x800 : 0x10000;
    if (point < least || point > 0x10ffff || (point >= 0xd800 && point < 0xe000)) return false;
  }
  return true;
}

/// Gives a field the value of a text, or appends the value to a repeated field. Returns what the
/// text should be if it is no such value, else "".
std::string set_field(Message& message, const FieldDescriptor& field, const std::string& text) {
  const Reflection& reflect = *message.GetReflection();
  const auto put = [&](auto value, auto set, auto add) -> std::string {
    if (field.is_repeated()) {
      (reflect.*add)(&message, &field, value);
    } else {
      (reflect.*set)(&message, &field, value);
    }
    return {};
  };
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_STRING:
      if (!is_utf8(text)) return "text in UTF-8";
      return put(text, &Reflection::SetString, &Reflection::AddString);
    case FieldDescriptor::CPPTYPE_BOOL:
      if (text != "true" && text != "false") return "true or false";
      return put(text == "true", &Reflection::SetBool, &Reflection::AddBool);
    case FieldDescriptor::CPPTYPE_INT32:
      if (const auto value = parse_number<std::int32_t>(text)) {
        return put(*value, &Reflection::SetInt32, &Reflection::AddInt32);
      }
      return "a whole number";
    case FieldDescriptor::CPPTYPE_INT64:
      if (const auto value = parse_number<std::int64_t>(text)) {
        return put(*value, &Reflection::SetInt64, &Reflection::AddInt64);
      }
      return "a whole number";
    case FieldDescriptor::CPPTYPE_DOUBLE:
      if (const auto value = parse_number<double>(text)) {
        return put(*value, &Reflection::SetDouble, &Reflection::AddDouble);
      }
      return "a number";
    case FieldDescriptor::CPPTYPE_ENUM:
      if (const auto* value = field.enum_type()->FindValueByName(text)) {
        return put(value, &Reflection::SetEnum, &Reflection::AddEnum);
      }
      return "one of " + values_of(*field.enum_type());
    case FieldDescriptor::CPPTYPE_MESSAGE:
      if (field.message_type() == google::protobuf::FieldMask::descriptor() &&
          !field.is_repeated()) {
        if (!is_utf8(text)) return "names of fields";
        google::protobuf::FieldMask mask;
        google::protobuf::util::FieldMaskUtil::FromString(text, &mask);
        reflect.MutableMessage(&message, &field)->MergeFrom(mask);
        return {};
      }
      return "in the body of the request";
    default:
      return "in the body of the request";
  }
}

/// A field that a text gives a value to, and the message that holds the field.
struct Target {
  Message* message = nullptr;
  const FieldDescriptor* field = nullptr;
};

/// Finds "lubricant.name" or "pageSize" in `message`. Returns nullopt if there is no such field.
std::optional<Target> find_target(Message& message, std::string_view path) {
  Target out{&message, nullptr};
  for (;;) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    const std::string name(path.substr(0, dot));
    const Descriptor& type = *out.message->GetDescriptor();
    out.field = type.FindFieldByName(name);
    if (out.field == nullptr) out.field = type.FindFieldByCamelcaseName(name);
    if (out.field == nullptr) return std::nullopt;
    if (dot == path.size()) return out;
    if (out.field->is_repeated() || out.field->message_type() == nullptr) return std::nullopt;
    out.message = out.message->GetReflection()->MutableMessage(out.message, out.field);
    path.remove_prefix(dot + 1);
  }
}

std::vector<std::string> field_names(const Descriptor& type, const RouteMatch& route) {
  std::vector<std::string> out;
  for (int i = 0; i < type.field_count(); ++i) {
    const std::string& name = type.field(i)->name();
    if (name != route.body_field && !route.of_path.contains(name)) out.push_back(name);
  }
  return out;
}

/// A query in decoded pairs. Adds a violation for each that cannot be decoded.
std::vector<std::pair<std::string, std::string>> pairs_of(std::string_view query,
                                                          Violations& violations) {
  std::vector<std::pair<std::string, std::string>> out;
  while (!query.empty()) {
    std::string pair(take_part(query, '&'));
    if (pair.empty()) continue;
    for (char& character : pair) {
      if (character == '+') character = ' ';
    }
    const std::size_t equals = std::min(pair.find('='), pair.size());
    auto name = percent_decoded(pair.substr(0, equals));
    auto value = percent_decoded(pair.substr(std::min(equals + 1, pair.size())));
    if (name && value) {
      out.emplace_back(*std::move(name), *std::move(value));
    } else {
      violations.add(plain_excerpt(pair.substr(0, equals)),
                     "a percent sign in the query must be followed by two hexadecimal "
                     "digits; a percent sign itself is written %25");
    }
  }
  return out;
}

void add_query(const RouteMatch& route, std::string_view query, Message& message,
               Violations& violations) {
  const Descriptor& type = *message.GetDescriptor();
  for (const auto& [name, value] : pairs_of(query, violations)) {
    const std::string shown = plain_excerpt(name);
    const std::string first = name.substr(0, name.find('.'));
    if (name == kFormParameter) continue;  // says how the answer is written
    if (route.body_field == "*") {
      violations.add(shown, "this method takes no query; its fields stand in the JSON body");
      continue;
    }
    const auto target = find_target(message, name);
    if (!target) {
      violations.add(shown,
                     "is no parameter of this method" + meant_text(name, field_names(type, route)));
    } else if (first == route.body_field) {
      violations.add(shown, "stands in the JSON body, not in the query");
    } else if (route.of_path.contains(target->field->name())) {
      violations.add(shown, "stands in the path, not in the query");
    } else {
      const std::string expected = set_field(*target->message, *target->field, value);
      if (!expected.empty()) {
        violations.add(shown, "is \"{}\"; allowed: {}", plain_excerpt(value), expected);
      }
    }
  }
}

/// The entity tag of an If-Match header. Returns nullopt if the header is not one tag in quotes.
std::optional<std::string> etag_of(std::string_view header) {
  if (header.size() < 3 || header.front() != '"' || header.back() != '"') return std::nullopt;
  const std::string_view tag = header.substr(1, header.size() - 2);
  if (tag.find('"') != std::string_view::npos) return std::nullopt;
  return std::string(tag);
}

/// Gives the request, or the resource in its body, the etag that the client has seen. Returns false
/// if neither has an etag.
bool set_etag(const RouteMatch& route, const std::string& etag, Message& message) {
  for (const std::string& path : {std::string("etag"), route.body_field + ".etag"}) {
    const Descriptor& type = *message.GetDescriptor();
    if (path != "etag" && type.FindFieldByName(route.body_field) == nullptr) continue;
    if (const auto target = find_target(message, path)) {
      set_field(*target->message, *target->field, etag);
      return true;
    }
  }
  return false;
}

/// A condition that cannot be kept is refused: the client relies on it.
void add_condition(const RouteMatch& route, std::string_view header, Message& message,
                   Violations& violations) {
  if (header.empty() || header == "*") return;
  const auto etag = etag_of(header);
  if (!etag) {
    violations.add("If-Match",
                   "is " + plain_excerpt(header) + "; allowed: one etag in double quotes, or *");
  } else if (!set_etag(route, *etag, message)) {
    violations.add("If-Match", "this method compares no etag");
  }
}

/// The type of what the body holds.
const Descriptor& body_type(const RouteMatch& route) {
  const Descriptor& request = *route.method->descriptor->input_type();
  if (route.body_field == "*") return request;
  return *request.FindFieldByName(route.body_field)->message_type();
}

/// Appends the body of the request. Returns a violation if the body is not JSON of its type.
std::optional<Violation> append_body(const RouteMatch& route, const std::string& body,
                                     std::string& wire) {
  namespace io = google::protobuf::io;
  const std::string type = std::string(kTypePrefix) + "/" + body_type(route).full_name();
  std::string binary;
  const auto status = google::protobuf::util::JsonToBinaryString(
      &resolver(), type, body.empty() ? "{}" : body, &binary);
  if (!status.ok()) {
    return body_violation(body_type(route), route.body_field == "*" ? "" : route.body_field,
                          {status.message().data(), status.message().size()});
  }
  if (route.body_field == "*") {
    wire += binary;
    return std::nullopt;
  }
  using google::protobuf::internal::WireFormatLite;
  const FieldDescriptor& field =
      *route.method->descriptor->input_type()->FindFieldByName(route.body_field);
  io::StringOutputStream stream(&wire);
  io::CodedOutputStream out(&stream);
  out.WriteTag(WireFormatLite::MakeTag(field.number(), WireFormatLite::WIRETYPE_LENGTH_DELIMITED));
  out.WriteVarint32(static_cast<std::uint32_t>(binary.size()));
  out.WriteString(binary);
  return std::nullopt;
}

/// Returns the texts that a serialised message has at a path such as "lubricant.name". Does not
/// parse the rest, which may be long.
std::vector<std::string> texts_at(std::string_view wire, const Descriptor& type,
                                  std::string_view path) {
  using google::protobuf::internal::WireFormatLite;
  namespace io = google::protobuf::io;
  const std::size_t dot = std::min(path.find('.'), path.size());
  const FieldDescriptor& field = *type.FindFieldByName(std::string(path.substr(0, dot)));
  io::CodedInputStream in(reinterpret_cast<const std::uint8_t*>(wire.data()),
                          static_cast<int>(wire.size()));
  std::vector<std::string> out;
  while (const std::uint32_t tag = in.ReadTag()) {
    if (WireFormatLite::GetTagFieldNumber(tag) != field.number()) {
      if (!WireFormatLite::SkipField(&in, tag)) break;
      continue;
    }
    std::uint32_t length = 0;
    if (!in.ReadVarint32(&length)) break;
    const std::string_view value =
        wire.substr(static_cast<std::size_t>(in.CurrentPosition()), length);
    if (!in.Skip(static_cast<int>(length))) break;
    if (dot == path.size()) {
      out.emplace_back(value);
    } else {
      for (std::string& each : texts_at(value, *field.message_type(), path.substr(dot + 1))) {
        out.push_back(std::move(each));
      }
    }
  }
  return out;
}

/// Whether two names mean the same resource: one may lack "projects/default/".
bool is_same_name(std::string_view one, std::string_view other) {
  const auto first = split_name(one), second = split_name(other);
  if (!first || !second) return one == other;
  return first->project == second->project && first->relative == second->relative;
}

/// Adds a violation for each field of the path that the body gives another value.
void check_repeated_fields(const RouteMatch& route, const std::string& wire,
                           Violations& violations) {
  for (const auto& [path, value] : route.of_path) {
    for (const std::string& stated :
         texts_at(wire, *route.method->descriptor->input_type(), path)) {
      if (stated.empty() || is_same_name(stated, value)) continue;
      violations.add(path,
                     "is \"{}\" in the body and \"{}\" in the path; allowed: the same, or "
                     "only in the path",
                     plain_excerpt(stated), plain_excerpt(value));
    }
  }
}

/// A browser that connects again states the position of the last event that it has.
void add_last_event_id(const RouteMatch& route, std::string_view header, Message& message,
                       Violations& violations) {
  const auto fields = resume_fields(*route.method->descriptor);
  if (header.empty() || !route.method->descriptor->server_streaming() || !fields) return;
  if (!set_field(message, *fields->request, std::string(header)).empty()) {
    violations.add("Last-Event-ID",
                   "is " + plain_excerpt(header) + "; allowed: the id of an event");
  }
}

bool has_read_mask(const Message& request) {
  const FieldDescriptor* field = request.GetDescriptor()->FindFieldByName("read_mask");
  if (field == nullptr || field->message_type() != google::protobuf::FieldMask::descriptor()) {
    return false;
  }
  const Message& mask = request.GetReflection()->GetMessage(request, field);
  return static_cast<const google::protobuf::FieldMask&>(mask).paths_size() > 0;
}

}  // namespace

std::optional<google::rpc::Status> write_request(const RouteMatch& route,
                                                 const HttpRequest& request, WrittenRequest& out) {
  Violations violations;
  const std::unique_ptr<Message> beside_body(route.method->request->New());
  for (const auto& [path, value] : route.of_path) {
    const auto target = find_target(*beside_body, path);  // HttpRoutes has checked that it exists
    const std::string expected = set_field(*target->message, *target->field, value);
    if (!expected.empty()) {
      violations.add(path, "is \"{}\"; allowed: {}", plain_excerpt(value), expected);
    }
  }
  const std::size_t question = request.target.find('?');
  if (question != std::string::npos) {
    add_query(route, std::string_view(request.target).substr(question + 1), *beside_body,
              violations);
  }
  add_condition(route, request.header("if-match"), *beside_body, violations);
  add_last_event_id(route, request.header("last-event-id"), *beside_body, violations);
  out = {};
  if (!route.body_field.empty()) {
    if (auto violation = append_body(route, request.body, out.wire)) {
      violations.push_back(*std::move(violation));
    }
    check_repeated_fields(route, out.wire, violations);
  } else if (!request.body.empty()) {
    violations.add("", "this method takes no body");
  }
  if (!violations.empty()) return invalid(violations);
  out.wire += beside_body->SerializeAsString();
  out.has_read_mask = has_read_mask(*beside_body);
  return std::nullopt;
}

}  // namespace tribodyn::server
