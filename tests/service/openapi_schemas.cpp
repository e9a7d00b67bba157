#include "tests/service/openapi_schemas.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace tribodyn::server {

using nlohmann::json;

std::string route_shape(const HttpRoutes::Route& route) {
  std::string out;
  for (const std::string& each : route.segments) out += each == "*" ? "/{}" : "/" + each;
  return route.custom_verb.empty() ? out : out + ":" + route.custom_verb;
}

std::string path_shape(const std::string& path) {
  std::string out;
  bool is_inside = false;
  for (const char each : path) {
    if (each == '}') is_inside = false;
    if (!is_inside) out += each;
    if (each == '{') is_inside = true;
  }
  return out;
}

const json& OpenApiSchemas::operation(const HttpRoutes::Route& route) const {
  std::string verb = route.verb;
  for (char& each : verb) each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  for (const auto& [path, verbs] : document_.at("paths").items()) {
    if (path_shape(path) == route_shape(route) && verbs.contains(verb)) return verbs.at(verb);
  }
  return document_.at(verb + " " + route_shape(route));
}

std::string OpenApiSchemas::complaints(const json& value, const json& schema, Rigour rigour) const {
  std::string out;
  compare(value, schema, "", rigour, out);
  return out;
}

void OpenApiSchemas::compare(const json& value, const json& schema, const std::string& place,
                             Rigour rigour, std::string& wrong) const {
  if (schema.contains("$ref")) {
    const std::string name = schema["$ref"];
    return compare(value, document_.at(json::json_pointer(name.substr(1))), place, rigour, wrong);
  }
  const std::string shown = value.dump().substr(0, 50);
  if (schema.contains("anyOf")) {
    for (const json& each : schema["anyOf"]) {
      std::string found;
      compare(value, each, place, rigour, found);
      if (found.empty()) return;
    }
    wrong += place + ": " + shown + " is none of the forms\n";
    return;
  }
  const std::string type = schema.value("type", "");
  const bool fits = type == "object"    ? value.is_object()
                    : type == "array"   ? value.is_array()
                    : type == "string"  ? value.is_string()
                    : type == "boolean" ? value.is_boolean()
                    : type == "null"    ? value.is_null()
                    : type == "integer" ? value.is_number_integer()
                                        : value.is_number();
  if (!fits) {
    wrong += place + ": " + shown + " is no " + type + "\n";
    return;
  }
  if (schema.contains("enum") &&
      std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end()) {
    wrong += place + ": " + shown + " is not in the list\n";
  }
  if (schema.contains("pattern") &&
      !std::regex_search(value.get<std::string>(),
                         std::regex(schema["pattern"].get<std::string>()))) {
    wrong += place + ": " + shown + " has another form\n";
  }
  if (schema.contains("maxItems") && value.size() > schema["maxItems"].get<std::size_t>()) {
    wrong += place + ": too many items\n";
  }
  if (value.is_array()) {
    for (const json& each : value) compare(each, schema.at("items"), place + "[]", rigour, wrong);
  }
  if (!value.is_object()) return;
  const json none = json::object();
  const json& properties = schema.contains("properties") ? schema["properties"] : none;
  for (const auto& [name, field] : value.items()) {
    if (properties.contains(name)) {
      compare(field, properties[name], place + "." + name, rigour, wrong);
    } else if (!schema.contains("additionalProperties")) {
      wrong += place + "." + name + " is not described\n";
    } else if (schema["additionalProperties"].is_object()) {
      compare(field, schema["additionalProperties"], place + "." + name, rigour, wrong);
    }
  }
  if (rigour == Rigour::kSomeFields || !schema.contains("required")) return;
  for (const std::string name : schema["required"]) {
    if (!value.contains(name)) wrong += place + "." + name + " is missing\n";
  }
}

}  // namespace tribodyn::server
