#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "server/transport/http/openapi.h"

namespace tribodyn::server {
namespace {

using PageJson = nlohmann::ordered_json;

std::string html_escaped(std::string_view text) {
  std::string out;
  for (const char each : text) {
    switch (each) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += each;
    }
  }
  return out;
}

/// A description as paragraphs; text between backquotes is code, and a paragraph that begins with
/// "- " an item of a list.
std::string paragraphs(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find("\n\n"), text.size());
    std::string part = html_escaped(text.substr(0, end));
    text.remove_prefix(std::min(end + 2, text.size()));
    const bool is_item = part.starts_with("- ");
    if (is_item) part.erase(0, 2);
    bool is_code = false;
    std::string marked;
    for (const char each : part) {
      if (each == '`') {
        marked += is_code ? "</code>" : "<code>";
        is_code = !is_code;
      } else {
        marked += each;
      }
    }
    if (is_code) marked += "</code>";
    out += (is_item ? "<p class=\"item\">" : "<p>") + marked + "</p>\n";
  }
  return out;
}

std::string name_of_reference(const PageJson& schema) {
  const std::string reference = schema.at("$ref").get<std::string>();
  return reference.substr(reference.rfind('/') + 1);
}

/// The type of a value, with a link to its schema.
std::string type_text(const PageJson& schema) {
  if (schema.contains("$ref")) {
    const std::string name = html_escaped(name_of_reference(schema));
    return "<a href=\"#schema-" + name + "\">" + name + "</a>";
  }
  if (schema.contains("anyOf")) {
    std::string out;
    for (const PageJson& each : schema["anyOf"])
      out += (out.empty() ? "" : " or ") + type_text(each);
    return out;
  }
  if (schema.contains("items")) return "list of " + type_text(schema["items"]);
  std::string out = html_escaped(schema.value("type", "bytes"));
  if (schema.contains("enum")) {
    out += ":";
    for (const PageJson& each : schema["enum"]) {
      out += " <code>" + html_escaped(each.get<std::string>()) + "</code>";
    }
  }
  return out;
}

std::string table_row(const std::string& name, const std::string& type, const std::string& notes,
                      const std::string& description) {
  return "<tr><td><code>" + html_escaped(name) + "</code>" +
         (notes.empty() ? "" : "<br><small>" + html_escaped(notes) + "</small>") + "</td><td>" +
         type + "</td><td>" + paragraphs(description) + "</td></tr>\n";
}

std::string operation_text(const std::string& path, const std::string& verb,
                           const PageJson& operation) {
  std::string upper = verb;
  for (char& each : upper) each = static_cast<char>(std::toupper(static_cast<unsigned char>(each)));
  const std::string id = html_escaped(operation.at("operationId").get<std::string>());
  std::string out = "<section id=\"" + id + "\">\n<h3><a href=\"#" + id + "\">" + id +
                    "</a></h3>\n<p class=\"route\"><b>" + upper + "</b> <code>" +
                    html_escaped(path) + "</code></p>\n" +
                    paragraphs(operation.value("description", operation.value("summary", "")));
  if (operation.contains("parameters")) {
    out += "<table><tr><th>Parameter</th><th>Type</th><th>Meaning</th></tr>\n";
    for (const PageJson& each : operation["parameters"]) {
      out += table_row(
          each["name"].get<std::string>(), type_text(each["schema"]),
          each["in"].get<std::string>() + (each.value("required", false) ? ", required" : ""),
          each.value("description", ""));
    }
    out += "</table>\n";
  }
  if (operation.contains("requestBody")) {
    out +=
        "<p>Body: " + type_text(operation["requestBody"]["content"]["application/json"]["schema"]) +
        "</p>\n";
  }
  const PageJson& answer = operation.at("responses").at("200");
  std::string forms;
  for (const auto& [type, content] : answer.at("content").items()) {
    forms += (forms.empty() ? "" : ", ") + ("<code>" + html_escaped(type) + "</code>");
    const PageJson& schema = content.at("schema");
    if (schema.contains("$ref") || schema.contains("anyOf")) forms += " " + type_text(schema);
  }
  return out + "<p>Answer: " + forms + "</p>\n</section>\n";
}

std::string schema_text(const std::string& name, const PageJson& schema) {
  const std::string id = html_escaped(name);
  std::string out = "<section id=\"schema-" + id + "\">\n<h3><a href=\"#schema-" + id + "\">" + id +
                    "</a></h3>\n" + paragraphs(schema.value("description", ""));
  if (!schema.contains("properties")) return out + "<p>" + type_text(schema) + "</p>\n</section>\n";
  std::vector<std::string> required;
  if (schema.contains("required")) required = schema["required"].get<std::vector<std::string>>();
  out += "<table><tr><th>Field</th><th>Type</th><th>Meaning</th></tr>\n";
  for (const auto& [field, value] : schema["properties"].items()) {
    const bool is_required = std::find(required.begin(), required.end(), field) != required.end();
    out += table_row(field, type_text(value),
                     value.value("readOnly", false) ? "set by the server"
                     : is_required                  ? "required"
                                                    : "",
                     value.value("description", ""));
  }
  return out + "</table>\n</section>\n";
}

}  // namespace

std::string openapi_page(const std::string& text) {
  const PageJson document = PageJson::parse(text);
  const std::string title = html_escaped(document["info"]["title"].get<std::string>());
  std::string contents = "<nav>\n";
  std::string body;
  for (const PageJson& tag : document["tags"]) {
    const std::string name = tag["name"].get<std::string>();
    const std::string id = html_escaped(name);
    contents += "<p><a href=\"#" + id + "\"><b>" + id + "</b></a>";
    body += "<h2 id=\"" + id + "\">" + id + "</h2>\n" + paragraphs(tag.value("description", ""));
    for (const auto& [path, verbs] : document["paths"].items()) {
      for (const auto& [verb, operation] : verbs.items()) {
        if (operation["tags"][0] != name) continue;
        const std::string operation_id = html_escaped(operation["operationId"].get<std::string>());
        contents += " <a href=\"#" + operation_id + "\">" + operation_id + "</a>";
        body += operation_text(path, verb, operation);
      }
    }
    contents += "</p>\n";
  }
  contents += "<p><a href=\"#schemas\"><b>Schemas</b></a></p>\n</nav>\n";
  body += "<h2 id=\"schemas\">Schemas</h2>\n";
  for (const auto& [name, schema] : document["components"]["schemas"].items()) {
    body += schema_text(name, schema);
  }
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
         title + ": REST</title>\n<link rel=\"stylesheet\" href=\"" + kOpenApiStylePath +
         "\">\n</head>\n<body>\n<h1>" + title + ": REST</h1>\n" +
         paragraphs(document["info"]["description"].get<std::string>()) +
         "<p>For programs: <a href=\"" + kOpenApiPath + "\">" + kOpenApiPath + "</a></p>\n" +
         contents + body + "</body>\n</html>\n";
}

std::string openapi_style() {
  return R"(:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem; }
nav { font-size: 0.9rem; }
nav a { margin-right: 0.6rem; }
h3 { margin-bottom: 0; }
h3 a { color: inherit; text-decoration: none; }
section { border-top: 1px solid #8886; padding-bottom: 1rem; }
.route code { font-size: 1rem; }
.item { margin-left: 1rem; }
code { font: 0.9em ui-monospace, monospace; overflow-wrap: anywhere; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: 0.2rem 0.6rem 0.2rem 0; border-bottom: 1px solid #8883; }
td p { margin: 0; }
)";
}

}  // namespace tribodyn::server
