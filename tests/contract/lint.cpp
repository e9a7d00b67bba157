#include "tests/contract/lint.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <string_view>

#include "google/api/annotations.pb.h"

namespace tribodyn {
namespace {

using google::protobuf::DescriptorProto;
using google::protobuf::EnumDescriptorProto;
using google::protobuf::FieldDescriptorProto;
using google::protobuf::FileDescriptorProto;
using google::protobuf::ServiceDescriptorProto;
using Path = std::vector<int>;

// Field numbers of descriptor.proto, which make up the path of an element in its file.
constexpr int kFileMessages = 4, kFileEnums = 5, kFileServices = 6;
constexpr int kMessageFields = 2, kMessageMessages = 3, kMessageEnums = 4;
constexpr int kEnumValues = 2, kServiceMethods = 2;

const std::set<std::string_view> kUnits = {"celsius", "degrees",   "hertz",   "hour",   "joules",
                                           "kelvin",  "kilograms", "metre",   "metres", "newtons",
                                           "pascal",  "pascals",   "percent", "radian", "radians",
                                           "second",  "seconds",   "squared", "watt",   "watts"};
/// Also numbers whose unit another field of the message states.
const std::set<std::string_view> kPureNumbers = {
    "alpha",       "amplitudes", "beta",      "coefficient", "confidence",  "correlation",
    "cosine",      "coverage",   "defect",    "derivatives", "effect",      "elasticities",
    "error",       "exponent",   "fraction",  "index",       "maximum",     "mean",
    "minimum",     "multiplier", "order",     "orders",      "partition",   "phase",
    "probability", "product",    "ratio",     "residual",    "share",       "sine",
    "sliding",     "slope",      "solutions", "tolerance",   "uncertainty", "value",
    "values",      "weights"};
/// Other spellings of units, and abbreviations.
const std::regex kOtherSpellings(
    "(^|_)((kilo|milli|micro|nano|centi)?meters?|litres?|liters?|kelvins|centigrade|deg|rad|hz|kg|"
    "mm|um|km|kmh|kph|mps|rpm|ms|sec|secs|hrs?|newton|joule|percentage|pct|degc|pa|mpa|gpa)(_|$)");
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

class Linter {
 public:
  explicit Linter(const FileDescriptorProto& file) : file_(file) {
    for (const auto& location : file.source_code_info().location()) {
      if (location.has_leading_comments() || location.has_trailing_comments()) {
        commented_.insert(Path(location.path().begin(), location.path().end()));
      }
    }
  }

  std::vector<std::string> read(std::map<std::string, std::string>& routes) {
    for (int i = 0; i < file_.message_type_size(); ++i) {
      read(file_.message_type(i), file_.package(), {kFileMessages, i});
    }
    for (int i = 0; i < file_.enum_type_size(); ++i) {
      read(file_.enum_type(i), file_.package(), {kFileEnums, i}, false);
    }
    for (int i = 0; i < file_.service_size(); ++i) {
      read(file_.service(i), {kFileServices, i}, routes);
    }
    return std::move(complaints_);
  }

 private:
  void complain(const std::string& name, const std::string& what) {
    complaints_.push_back(name + " " + what);
  }
  void need_comment(const std::string& name, const Path& path) {
    if (!commented_.contains(path)) complain(name, "has no comment");
  }
  static Path below(Path path, int field, int index) {
    path.push_back(field);
    path.push_back(index);
    return path;
  }

  void read(const DescriptorProto& type, const std::string& scope, const Path& path) {
    const std::string name = scope + "." + type.name();
    need_comment(name, path);
    for (int i = 0; i < type.field_size(); ++i) {
      read(type.field(i), name, below(path, kMessageFields, i));
    }
    for (int i = 0; i < type.nested_type_size(); ++i) {
      read(type.nested_type(i), name, below(path, kMessageMessages, i));
    }
    for (int i = 0; i < type.enum_type_size(); ++i) {
      read(type.enum_type(i), name, below(path, kMessageEnums, i), true);
    }
  }

  void read(const FieldDescriptorProto& field, const std::string& scope, const Path& path) {
    const std::string name = scope + "." + field.name();
    need_comment(name, path);
    if (!std::regex_match(field.name(), kSnakeCase)) complain(name, "is not snake_case");
    if (std::regex_search(field.name(), kOtherSpellings) && !ends_in_unit(field.name())) {
      complain(name, "spells a unit in another way");
    }
    const bool is_real = field.has_type() && (field.type() == FieldDescriptorProto::TYPE_DOUBLE ||
                                              field.type() == FieldDescriptorProto::TYPE_FLOAT);
    const std::string last = field.name().substr(field.name().rfind('_') + 1);
    if (is_real && !kUnits.contains(last) && !kPureNumbers.contains(last)) {
      complain(name, "ends in no unit");
    }
  }

  /// "newton_metres" and "newton_seconds_per_metre" are units; "load_newton" is not.
  static bool ends_in_unit(const std::string& name) {
    static const std::regex kCompound(
        "(^|_)(newton_(metres?|seconds?|metre_seconds?)|"
        "kilogram_square_metres)(_per_[a-z_]+)?$");
    return std::regex_search(name, kCompound);
  }

  void read(const EnumDescriptorProto& type, const std::string& scope, const Path& path,
            bool is_nested) {
    const std::string name = scope + "." + type.name();
    need_comment(name, path);
    const std::string prefix = value_prefix_of(type.name());
    int prefixed = 0, others = 0;
    for (int i = 0; i < type.value_size(); ++i) {
      const auto& value = type.value(i);
      if (!std::regex_match(value.name(), kUpperSnakeCase)) {
        complain(name + "." + value.name(), "is not UPPER_SNAKE_CASE");
      }
      if (value.number() == 0) {
        if (value.name() != prefix + "UNSPECIFIED") {
          complain(name + "." + value.name(), "is number 0 and not " + prefix + "UNSPECIFIED");
        }
        continue;
      }
      need_comment(name + "." + value.name(), below(path, kEnumValues, i));
      ++(value.name().starts_with(prefix) ? prefixed : others);
    }
    if (others > 0 && !is_nested) complain(name, "has values without " + prefix);
    if (others > 0 && prefixed > 0) complain(name, "has values with and without " + prefix);
  }

  void read(const ServiceDescriptorProto& service, const Path& path,
            std::map<std::string, std::string>& routes) {
    const std::string name = file_.package() + "." + service.name();
    need_comment(name, path);
    if (!service.name().ends_with("Service")) complain(name, "does not end in Service");
    for (int i = 0; i < service.method_size(); ++i) {
      const auto& method = service.method(i);
      const std::string full_name = name + "." + method.name();
      need_comment(full_name, below(path, kServiceMethods, i));
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
      } else if (const auto [other, is_new] = routes.emplace(route, full_name); !is_new) {
        complain(full_name, "has the route of " + other->second + ", " + route);
      }
    }
  }

  static std::string route_of(const google::protobuf::MethodOptions& options) {
    const auto& rule = options.GetExtension(google::api::http);
    switch (rule.pattern_case()) {
      case google::api::HttpRule::kGet:
        return "GET " + rule.get();
      case google::api::HttpRule::kPost:
        return "POST " + rule.post();
      case google::api::HttpRule::kPatch:
        return "PATCH " + rule.patch();
      case google::api::HttpRule::kPut:
        return "PUT " + rule.put();
      case google::api::HttpRule::kDelete:
        return "DELETE " + rule.delete_();
      default:
        return "";
    }
  }

  const FileDescriptorProto& file_;
  std::set<Path> commented_;
  std::vector<std::string> complaints_;
};

}  // namespace

std::vector<std::string> lint(const google::protobuf::FileDescriptorSet& set) {
  std::vector<std::string> out;
  std::map<std::string, std::string> routes;
  for (const FileDescriptorProto& file : set.file()) {
    const std::vector<std::string> found = Linter(file).read(routes);
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

}  // namespace tribodyn
