#include "tests/contract/lint.h"

#include <cctype>
#include <map>
#include <regex>

#include "google/api/annotations.pb.h"

namespace tribodyn {
namespace {

using google::protobuf::DescriptorProto;
using google::protobuf::EnumDescriptorProto;
using google::protobuf::FieldDescriptorProto;
using google::protobuf::FileDescriptorProto;
using google::protobuf::ServiceDescriptorProto;

/// Other spellings of units, and abbreviations. "newton_metres" and "newton_seconds_per_metre" are
/// units; "load_newton" is not.
const std::regex kOtherSpellings(
    "(^|_)((kilo|milli|micro|nano|centi)?meters?|litres?|liters?|kelvins|centigrade|deg|rad|hz|kg|"
    "mm|um|km|kmh|kph|mps|rpm|ms|sec|secs|hrs?|newton(?!_metre|_second)|joule|percentage|pct|degc|"
    "pa|mpa|gpa)(_|$)");
const std::regex kSnakeCase("[a-z][a-z0-9]*(_[a-z0-9]+)*");
const std::regex kUpperSnakeCase("[A-Z][A-Z0-9]*(_[A-Z0-9]+)*");

std::string value_prefix_of(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::isupper(static_cast<unsigned char>(c)) != 0 && !out.empty()) out += '_';
    out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return out + "_";
}

std::string route_of(const google::protobuf::MethodOptions& options) {
  const auto& rule = options.GetExtension(google::api::http);
  switch (rule.pattern_case()) {
    case google::api::HttpRule::kGet:
      return "GET " + rule.get();
    case google::api::HttpRule::kPost:
      return "POST " + rule.post();
    case google::api::HttpRule::kPatch:
      return "PATCH " + rule.patch();
    case google::api::HttpRule::kDelete:
      return "DELETE " + rule.delete_();
    default:
      return "";
  }
}

class Linter {
 public:
  void read(const FileDescriptorProto& file) {
    for (const auto& type : file.message_type()) read(type, file.package());
    for (const auto& type : file.enum_type()) read(type, file.package(), false);
    for (const auto& service : file.service()) read(service, file.package());
  }

  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  void complain(const std::string& name, const std::string& what) {
    complaints_.push_back(name + " " + what);
  }

  void read(const DescriptorProto& type, const std::string& scope) {
    const std::string name = scope + "." + type.name();
    for (const FieldDescriptorProto& field : type.field()) {
      const std::string full_name = name + "." + field.name();
      if (!std::regex_match(field.name(), kSnakeCase)) complain(full_name, "is not snake_case");
      if (std::regex_search(field.name(), kOtherSpellings)) {
        complain(full_name, "spells a unit in another way");
      }
    }
    for (const auto& nested : type.nested_type()) read(nested, name);
    for (const auto& nested : type.enum_type()) read(nested, name, true);
  }

  void read(const EnumDescriptorProto& type, const std::string& scope, bool is_nested) {
    const std::string name = scope + "." + type.name();
    const std::string prefix = value_prefix_of(type.name());
    int prefixed = 0, others = 0;
    for (const auto& value : type.value()) {
      if (!std::regex_match(value.name(), kUpperSnakeCase)) {
        complain(name + "." + value.name(), "is not UPPER_SNAKE_CASE");
      }
      if (value.number() != 0) {
        ++(value.name().starts_with(prefix) ? prefixed : others);
      } else if (value.name() != prefix + "UNSPECIFIED") {
        complain(name + "." + value.name(), "is number 0 and not " + prefix + "UNSPECIFIED");
      }
    }
    if (others > 0 && !is_nested) complain(name, "has values without " + prefix);
    if (others > 0 && prefixed > 0) complain(name, "has values with and without " + prefix);
  }

  void read(const ServiceDescriptorProto& service, const std::string& scope) {
    const std::string name = scope + "." + service.name();
    if (!service.name().ends_with("Service")) complain(name, "does not end in Service");
    for (const auto& method : service.method()) {
      const std::string full_name = name + "." + method.name();
      const std::string input = method.input_type().substr(method.input_type().rfind('.') + 1);
      const std::string output = method.output_type().substr(method.output_type().rfind('.') + 1);
      if (input != method.name() + "Request") {
        complain(full_name, "takes " + input + ", not " + method.name() + "Request");
      }
      if (output.ends_with("Response") && output != method.name() + "Response") {
        complain(full_name, "returns " + output + ", not " + method.name() + "Response");
      }
      const std::string route = route_of(method.options());
      if (route.empty()) {
        complain(full_name, "has no HTTP route");
      } else if (const auto [other, is_new] = routes_.emplace(route, full_name); !is_new) {
        complain(full_name, "has the route of " + other->second + ", " + route);
      }
    }
  }

  std::map<std::string, std::string> routes_;  // the method of each
  std::vector<std::string> complaints_;
};

}  // namespace

std::vector<std::string> lint(const google::protobuf::FileDescriptorSet& set) {
  Linter linter;
  for (const FileDescriptorProto& file : set.file()) linter.read(file);
  return linter.complaints();
}

}  // namespace tribodyn
