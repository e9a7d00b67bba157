#include "tests/service/rest_rendering.h"

#include <fmt/format.h>
#include <google/protobuf/util/field_mask_util.h>
#include <google/protobuf/util/json_util.h>

#include <cctype>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "google/protobuf/field_mask.pb.h"
#include "google/rpc/code.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::FieldMask;
using google::protobuf::Message;

std::string encoded(const std::string& text) {
  std::string out;
  for (const char each : text) {
    const auto byte = static_cast<unsigned char>(each);
    if (std::isalnum(byte) != 0 || each == '-' || each == '_' || each == '.' || each == '@') {
      out += each;
    } else {
      out += fmt::format("%{:02X}", byte);
    }
  }
  return out;
}

/// The text at a path such as "lubricant.name".
std::string text_at(const Message& message, const std::string& path) {
  const std::size_t dot = path.find('.');
  const auto* field = message.GetDescriptor()->FindFieldByName(path.substr(0, dot));
  const auto& reflection = *message.GetReflection();
  if (dot == std::string::npos) return reflection.GetString(message, field);
  return text_at(reflection.GetMessage(message, field), path.substr(dot + 1));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char each : text) {
    if (each == '/') {
      out.emplace_back();
    } else {
      out.back() += each;
    }
  }
  return out;
}

/// The path of a request by a route, or nullopt if a variable of the path has another form.
std::optional<std::string> path_of(const HttpRoutes::Route& route, const Message& request) {
  std::vector<std::string> segments = route.segments;
  for (const HttpRoutes::Route::Variable& variable : route.variables) {
    const std::vector<std::string> values = split(text_at(request, variable.field));
    if (values.size() != variable.count) return std::nullopt;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::string& segment = segments[variable.first + i];
      if (values[i].empty() || (segment != "*" && segment != values[i])) return std::nullopt;
      segment = encoded(values[i]);
    }
  }
  std::string out;
  for (const std::string& each : segments) out += "/" + each;
  return route.custom_verb.empty() ? out : out + ":" + route.custom_verb;
}

/// The text of a value as a query has it.
std::string query_text(const Message& message, const FieldDescriptor& field, int index) {
  const auto& reflection = *message.GetReflection();
  const bool many = field.is_repeated();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_STRING:
      return many ? reflection.GetRepeatedString(message, &field, index)
                  : reflection.GetString(message, &field);
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(message, &field) ? "true" : "false";
    case FieldDescriptor::CPPTYPE_INT32:
      return std::to_string(reflection.GetInt32(message, &field));
    case FieldDescriptor::CPPTYPE_INT64:
      return std::to_string(reflection.GetInt64(message, &field));
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return fmt::format("{}", reflection.GetDouble(message, &field));
    case FieldDescriptor::CPPTYPE_ENUM:
      return reflection.GetEnum(message, &field)->name();
    case FieldDescriptor::CPPTYPE_MESSAGE:
      if (field.message_type() == FieldMask::descriptor()) {
        return google::protobuf::util::FieldMaskUtil::ToString(
            static_cast<const FieldMask&>(reflection.GetMessage(message, &field)));
      }
      break;
    default:
      break;
  }
  throw std::logic_error(field.full_name() + " has no text in a query");
}

std::string json_text(const Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  std::string out;
  const auto status = google::protobuf::util::MessageToJsonString(message, &out, options);
  if (!status.ok()) throw std::logic_error(status.ToString());
  return out;
}

/// The path of the variable's first field: "lubricant" of "lubricant.name".
bool is_of_path(const HttpRoutes::Route& route, const std::string& field) {
  for (const HttpRoutes::Route::Variable& variable : route.variables) {
    if (variable.field.substr(0, variable.field.find('.')) == field) return true;
  }
  return false;
}

std::string query_of(const HttpRoutes::Route& route, const Message& request) {
  std::vector<const FieldDescriptor*> fields;
  request.GetReflection()->ListFields(request, &fields);
  std::string out;
  for (const FieldDescriptor* field : fields) {
    if (field->name() == route.body_field || is_of_path(route, field->name())) continue;
    const int count = field->is_repeated() ? request.GetReflection()->FieldSize(request, field) : 1;
    for (int i = 0; i < count; ++i) {
      out += out.empty() ? "?" : "&";
      out += field->name() + "=" + encoded(query_text(request, *field, i));
    }
  }
  return out;
}

std::string body_of(const HttpRoutes::Route& route, const Message& request) {
  const auto& reflection = *request.GetReflection();
  if (route.body_field == "*") {
    const std::unique_ptr<Message> rest(request.New());
    rest->CopyFrom(request);
    for (const HttpRoutes::Route::Variable& variable : route.variables) {
      reflection.ClearField(rest.get(), rest->GetDescriptor()->FindFieldByName(variable.field));
    }
    return json_text(*rest);
  }
  return json_text(
      reflection.GetMessage(request, request.GetDescriptor()->FindFieldByName(route.body_field)));
}

}  // namespace

HttpRequest rest_request(const HttpRoutes& routes, const Method& method, const Message& request) {
  for (const HttpRoutes::Route& route : routes.all()) {
    if (route.method->descriptor != method.descriptor) continue;
    const auto path = path_of(route, request);
    if (!path) continue;
    HttpRequest out;
    out.verb = route.verb;
    out.target = *path;
    if (!route.body_field.empty()) {
      out.body = body_of(route, request);
      out.headers["content-type"] = "application/json";
    }
    if (route.body_field != "*") out.target += query_of(route, request);
    return out;
  }
  throw std::logic_error("no route of " + method.descriptor->full_name() + " fits " +
                         request.ShortDebugString());
}

void read_json(const std::string& text, Message& out) {
  const auto status = google::protobuf::util::JsonStringToMessage(text, &out);
  if (!status.ok()) throw std::logic_error(status.ToString() + ": " + text.substr(0, 500));
}

google::rpc::Status error_of_json(const std::string& body) {
  nlohmann::json error = nlohmann::json::parse(body).at("error");
  google::rpc::Code code = google::rpc::OK;
  google::rpc::Code_Parse(error.at("status").get<std::string>(), &code);
  error.erase("status");
  error["code"] = static_cast<int>(code);
  google::rpc::Status out;
  read_json(error.dump(), out);
  return out;
}

}  // namespace tribodyn::server
