#include "server/transport/http/http_routes.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "google/api/annotations.pb.h"

namespace tribodyn::server {
namespace {

/// The parts of a path between its slashes; a path begins with one.
std::vector<std::string> segments_of(std::string_view path) {
  std::vector<std::string> out;
  while (!path.empty()) {
    path.remove_prefix(1);
    const std::size_t end = std::min(path.find('/'), path.size());
    out.emplace_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return out;
}

/// Cuts ":verb" off the end of `path` and returns it without the colon.
std::string take_custom_verb(std::string_view& path) {
  const std::size_t colon = path.rfind(':');
  const std::size_t slash = path.rfind('/');
  if (colon == std::string_view::npos || slash == std::string_view::npos || colon < slash) {
    return {};
  }
  std::string out(path.substr(colon + 1));
  path = path.substr(0, colon);
  return out;
}

/// Reads a template such as "/v1/{name=lubricants/*}:undelete".
HttpRoutes::Route parse_template(const std::string& text) {
  const auto refuse = [&text](const char* cause) {
    return std::logic_error("route " + text + ": " + cause);
  };
  HttpRoutes::Route out;
  out.text = text;
  std::string_view rest = text;
  const std::size_t brace = rest.rfind('}');
  const std::size_t colon = rest.rfind(':');
  if (colon != std::string_view::npos && (brace == std::string_view::npos || colon > brace)) {
    out.custom_verb = take_custom_verb(rest);
  }
  while (!rest.empty()) {
    if (rest.front() != '/') throw refuse("a segment must begin with a slash");
    if (!rest.starts_with("/{")) {
      const std::size_t end = std::min(rest.find('/', 1), rest.size());
      out.segments.emplace_back(rest.substr(1, end - 1));
      rest.remove_prefix(end);
      continue;
    }
    const std::size_t end = rest.find('}');
    if (end == std::string_view::npos) throw refuse("a brace is not closed");
    const std::string_view variable = rest.substr(2, end - 2);
    const std::size_t equals = std::min(variable.find('='), variable.size());
    const std::string pattern =
        equals == variable.size() ? "/*" : "/" + std::string(variable.substr(equals + 1));
    const std::vector<std::string> inner = segments_of(pattern);
    out.variables.push_back(
        {std::string(variable.substr(0, equals)), out.segments.size(), inner.size()});
    out.segments.insert(out.segments.end(), inner.begin(), inner.end());
    rest.remove_prefix(end + 1);
  }
  if (std::find(out.segments.begin(), out.segments.end(), "**") != out.segments.end()) {
    throw refuse("\"**\" is not supported");
  }
  return out;
}

/// Returns the verb and the template of a rule.
std::pair<std::string, std::string> verb_and_template(const google::api::HttpRule& rule) {
  switch (rule.pattern_case()) {
    case google::api::HttpRule::kGet:
      return {"GET", rule.get()};
    case google::api::HttpRule::kPut:
      return {"PUT", rule.put()};
    case google::api::HttpRule::kPost:
      return {"POST", rule.post()};
    case google::api::HttpRule::kDelete:
      return {"DELETE", rule.delete_()};
    case google::api::HttpRule::kPatch:
      return {"PATCH", rule.patch()};
    case google::api::HttpRule::kCustom:
      return {rule.custom().kind(), rule.custom().path()};
    case google::api::HttpRule::PATTERN_NOT_SET:
      break;
  }
  return {};
}

/// Returns the field with a path such as "lubricant.name", or null.
const google::protobuf::FieldDescriptor* field_at(const google::protobuf::Descriptor& type,
                                                  std::string_view path) {
  const std::size_t dot = std::min(path.find('.'), path.size());
  const auto* field = type.FindFieldByName(std::string(path.substr(0, dot)));
  if (field == nullptr || dot == path.size()) return field;
  if (field->is_repeated() || field->message_type() == nullptr) return nullptr;
  return field_at(*field->message_type(), path.substr(dot + 1));
}

/// Throws std::logic_error unless the request has a text for each variable of the path, and a
/// message for the body.
void check_fields(const HttpRoutes::Route& route) {
  const google::protobuf::Descriptor& request = *route.method->descriptor->input_type();
  const auto refuse = [&](const std::string& field, const char* kind) {
    return std::logic_error("route " + route.text + ": " + request.full_name() + " has no " + kind +
                            " " + field);
  };
  for (const HttpRoutes::Route::Variable& variable : route.variables) {
    const google::protobuf::FieldDescriptor* field = field_at(request, variable.field);
    if (field == nullptr || field->is_repeated() ||
        field->type() != google::protobuf::FieldDescriptor::TYPE_STRING) {
      throw refuse(variable.field, "text");
    }
  }
  if (route.body_field.empty() || route.body_field == "*") return;
  const google::protobuf::FieldDescriptor* field = request.FindFieldByName(route.body_field);
  if (field == nullptr || field->is_repeated() || field->message_type() == nullptr) {
    throw refuse(route.body_field, "message");
  }
}

/// A path of a request in decoded segments.
struct Path {
  std::vector<std::string> segments;
  std::string custom_verb;
};

std::optional<Path> parse_path(std::string_view path) {
  if (!path.starts_with('/')) return std::nullopt;
  Path out;
  out.custom_verb = take_custom_verb(path);
  for (const std::string& each : segments_of(path)) {
    auto decoded = percent_decoded(each);
    // A slash inside a segment would name another resource once the segments are joined again.
    if (!decoded || decoded->empty() || decoded->find('/') != std::string::npos) {
      return std::nullopt;
    }
    out.segments.push_back(*std::move(decoded));
  }
  return out;
}

bool matches(const HttpRoutes::Route& route, const Path& path) {
  return route.custom_verb == path.custom_verb &&
         std::equal(route.segments.begin(), route.segments.end(), path.segments.begin(),
                    path.segments.end(),
                    [](const std::string& pattern, const std::string& segment) {
                      return pattern == "*" || pattern == segment;
                    });
}

int digit_of(char character) {
  if (character >= '0' && character <= '9') return character - '0';
  if (character >= 'a' && character <= 'f') return character - 'a' + 10;
  if (character >= 'A' && character <= 'F') return character - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char character = text[i];
    if (character == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = digit_of(text[i + 1]);
      const int low = digit_of(text[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      character = static_cast<char>(16 * high + low);
      i += 2;
    }
    if (character == '\0') return std::nullopt;
    out += character;
  }
  return out;
}

HttpRoutes::HttpRoutes(const std::vector<Method>& methods) {
  std::set<std::string> known;
  for (const Method& method : methods) {
    const auto& rule = method.descriptor->options().GetExtension(google::api::http);
    std::vector<google::api::HttpRule> rules = {rule};
    rules.insert(rules.end(), rule.additional_bindings().begin(), rule.additional_bindings().end());
    for (const google::api::HttpRule& each : rules) {
      const auto [verb, text] = verb_and_template(each);
      if (text.empty()) {
        throw std::logic_error(method.descriptor->full_name() + " has no google.api.http");
      }
      Route route = parse_template(text);
      route.method = &method;
      route.verb = verb;
      route.body_field = each.body();
      check_fields(route);
      std::string shape = verb + ":" + route.custom_verb;
      for (const std::string& segment : route.segments) shape += "/" + segment;
      if (!known.insert(shape).second) {
        throw std::logic_error(verb + " " + text + " is the route of two methods");
      }
      routes_.push_back(std::move(route));
    }
  }
}

std::optional<RouteMatch> HttpRoutes::find(std::string_view verb, std::string_view path) const {
  const auto parsed = parse_path(path);
  if (!parsed) return std::nullopt;
  for (const Route& route : routes_) {
    if (route.verb != verb || !matches(route, *parsed)) continue;
    RouteMatch out;
    out.method = route.method;
    out.body_field = route.body_field;
    for (const Route::Variable& variable : route.variables) {
      std::string& value = out.of_path[variable.field];
      for (std::size_t i = 0; i < variable.count; ++i) {
        if (i > 0) value += '/';
        value += parsed->segments[variable.first + i];
      }
    }
    return out;
  }
  return std::nullopt;
}

std::vector<std::string> HttpRoutes::verbs(std::string_view path) const {
  std::set<std::string> out;
  if (const auto parsed = parse_path(path)) {
    for (const Route& route : routes_) {
      if (matches(route, *parsed)) out.insert(route.verb);
    }
  }
  return {out.begin(), out.end()};
}

}  // namespace tribodyn::server
