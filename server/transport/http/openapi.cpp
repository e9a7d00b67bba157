#include "server/transport/http/openapi.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "google/api/field_behavior.pb.h"
#include "google/protobuf/duration.pb.h"
#include "google/protobuf/empty.pb.h"
#include "google/protobuf/field_mask.pb.h"
#include "google/protobuf/timestamp.pb.h"
#include "google/rpc/code.pb.h"
#include "proto/field_behavior.h"
#include "server/application/errors.h"
#include "server/contract/constraints.h"
#include "server/contract/contract_comments.h"
#include "server/transport/http/method_forms.h"
#include "server/transport/http/stream_format.h"
#include "tribodyn/v1/errors.pb.h"
#include "tribodyn/v1/limits.pb.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::MethodDescriptor;
using Json = nlohmann::ordered_json;

constexpr char kIntroduction[] =
    "Every method of the contract over HTTP/1.1. Bodies are protobuf's JSON with names in "
    "snake_case. 64-bit integers are texts, because JavaScript rounds them; a request may state "
    "them as numbers. Answers have every field that their schemas require, zeros included, unless "
    "a read_mask chooses some. XInput is the schema of X in requests, XUpdate that of a change. A "
    "body may repeat a field of the path, with the same value. "
    "Field masks in bodies are texts with names in camelCase and commas between them "
    "(\"displayName,labels\"); in queries snake_case is read as well.\n\n"
    "A call needs a token (Authorization: Bearer TOKEN), except over the Unix socket of the "
    "server's owner. This description and its page need none: they are the same for every server "
    "of a version.";

/// "tribodyn.v1.Lubricant.Condition" as the name of a schema: "Lubricant.Condition".
std::string schema_name(const std::string& full_name) {
  constexpr std::string_view kPackage = "tribodyn.v1.";
  return full_name.starts_with(kPackage) ? full_name.substr(kPackage.size()) : full_name;
}

Json reference(const std::string& kind, const std::string& name) {
  return {{"$ref", "#/components/" + kind + "/" + name}};
}

/// "gearSets" as the name of a parameter: "gear_set".
std::string singular(const std::string& collection) {
  std::string out;
  for (const char each : collection) {
    if (std::isupper(static_cast<unsigned char>(each)) != 0) out += '_';
    out += static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  }
  if (out.ends_with('s')) out.pop_back();
  return out;
}

bool is_required_field(const FieldDescriptor& field) {
  const auto& options = field.options();
  for (int i = 0; i < options.ExtensionSize(google::api::field_behavior); ++i) {
    if (options.GetExtension(google::api::field_behavior, i) == google::api::REQUIRED) return true;
  }
  return false;
}

/// True for messages that JSON writes as one text.
bool is_text_message(const Descriptor& type) {
  return &type == google::protobuf::Timestamp::descriptor() ||
         &type == google::protobuf::Duration::descriptor() ||
         &type == google::protobuf::FieldMask::descriptor();
}

/// Joins sentences that are not empty by a blank.
std::string joined_sentences(const std::vector<std::string>& sentences) {
  std::string out;
  for (const std::string& each : sentences) {
    if (each.empty()) continue;
    if (!out.empty()) out += out.ends_with('.') ? " " : ". ";
    out += each;
  }
  return out;
}

/// Where a message stands: that decides which of its fields are required.
enum class Use { kAnswer, kRequest };

class OpenApiDocument {
 public:
  explicit OpenApiDocument(const HttpRoutes& routes);
  std::string text() const { return out_.dump(1); }

 private:
  // Schemas.
  Json value_schema(const FieldDescriptor& field, Use use);
  Json field_schema(const FieldDescriptor& field, Use use);
  Json message_reference(const Descriptor& type, Use use);
  Json body_reference(const HttpRoutes::Route& route);
  Json enum_reference(const EnumDescriptor& type);
  Json message_schema(const Descriptor& type, Use use);
  std::string range_text(const FieldDescriptor& field) const;
  void add_basic_schemas();
  // Operations.
  void add(const HttpRoutes::Route& route, bool is_additional);
  void add_query(const Descriptor& type, const std::string& prefix, const HttpRoutes::Route& route,
                 Json& parameters);
  Json parameters_of(const HttpRoutes::Route& route, const std::vector<std::string>& of_path);
  Json answer_of(const HttpRoutes::Route& route);
  Json responses_of(const HttpRoutes::Route& route);
  void add_pages();
  void add_error_responses();

  const ContractComments comments_;
  std::set<std::string> answered_;  // schemas that answers contain
  Json schemas_ = Json::object();
  Json paths_ = Json::object();
  Json out_ = Json::object();
};

std::string OpenApiDocument::range_text(const FieldDescriptor& field) const {
  const std::string message = schema_name(field.containing_type()->full_name());
  const Constraint* row = find_constraint(message, field.name());
  if (row == nullptr || field.message_type() != nullptr) return {};
  std::string out =
      "Allowed: " + number_text(row->minimum) + " to " + quantity_text(row->maximum, row->unit);
  if (!row->equation.empty()) out += " (" + std::string(row->equation) + ")";
  if (row->zero == Zero::kUnset) out += "; 0: not set";
  return out + ".";
}

Json OpenApiDocument::value_schema(const FieldDescriptor& field, Use use) {
  switch (field.type()) {
    case FieldDescriptor::TYPE_DOUBLE:
    case FieldDescriptor::TYPE_FLOAT:
      return reference("schemas", "Number");
    case FieldDescriptor::TYPE_INT64:
    case FieldDescriptor::TYPE_UINT64:
    case FieldDescriptor::TYPE_SINT64:
    case FieldDescriptor::TYPE_FIXED64:
    case FieldDescriptor::TYPE_SFIXED64:
      return reference("schemas", "Integer64");
    case FieldDescriptor::TYPE_BOOL:
      return {{"type", "boolean"}};
    case FieldDescriptor::TYPE_STRING:
      return {{"type", "string"}};
    case FieldDescriptor::TYPE_BYTES:
      return {{"type", "string"}, {"contentEncoding", "base64"}};
    case FieldDescriptor::TYPE_ENUM:
      return enum_reference(*field.enum_type());
    case FieldDescriptor::TYPE_MESSAGE:
    case FieldDescriptor::TYPE_GROUP:
      return message_reference(*field.message_type(), use);
    default:
      return {{"type", "integer"}, {"format", "int32"}};
  }
}

Json OpenApiDocument::field_schema(const FieldDescriptor& field, Use use) {
  Json out = value_schema(field, use);
  std::string limit;
  const auto& options = field.options();
  if (field.is_repeated()) {
    out = {{"type", "array"}, {"items", std::move(out)}};
    const int most = options.GetExtension(v1::max_items);
    if (most > 0) out["maxItems"] = most;
  } else if (options.HasExtension(v1::max_bytes)) {
    limit = "At most " + std::to_string(options.GetExtension(v1::max_bytes)) + " bytes.";
  }
  if (const auto* choice = field.real_containing_oneof()) {
    for (int i = 0; i < choice->field_count(); ++i) {
      limit += (i == 0                           ? "Only one of "
                : i + 1 == choice->field_count() ? " and "
                                                 : ", ") +
               choice->field(i)->name();
    }
    limit += " may be set.";
  }
  const std::string text =
      joined_sentences({comments_.of(field.full_name()), range_text(field), limit});
  if (!text.empty()) out["description"] = text;
  if (is_output_only(field)) out["readOnly"] = true;
  return out;
}

Json OpenApiDocument::enum_reference(const EnumDescriptor& type) {
  const std::string name = schema_name(type.full_name());
  if (!schemas_.contains(name)) {
    Json values = Json::array();
    std::string text = comments_.of(type.full_name());
    for (int i = 0; i < type.value_count(); ++i) {
      values.push_back(type.value(i)->name());
      const std::string comment = comments_.of(type.value(i)->full_name());
      if (!comment.empty()) text += "\n\n- `" + type.value(i)->name() + "`: " + comment;
    }
    schemas_[name] = {{"type", "string"}, {"description", text}, {"enum", std::move(values)}};
  }
  return reference("schemas", name);
}

Json OpenApiDocument::message_schema(const Descriptor& type, Use use) {
  Json properties = Json::object();
  Json required = Json::array();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    properties[field.name()] = field_schema(field, use);
    // An answer has every field but those that can be absent: json_of() prints zeros.
    const bool is_required = use == Use::kAnswer ? !field.has_presence() : is_required_field(field);
    if (is_required) required.push_back(field.name());
  }
  Json out = {{"type", "object"}, {"description", comments_.of(type.full_name())}};
  out["properties"] = std::move(properties);
  if (!required.empty()) out["required"] = std::move(required);
  return out;
}

/// The schema of a message of protobuf that JSON writes in another form than an object of its
/// fields; null for other messages.
Json special_schema(const Descriptor& type) {
  if (&type == google::protobuf::Timestamp::descriptor()) {
    return {
        {"type", "string"}, {"format", "date-time"}, {"description", "A time in UTC (RFC 3339)."}};
  }
  if (&type == google::protobuf::Duration::descriptor()) {
    return {{"type", "string"},
            {"description", "A duration in seconds."},
            {"pattern", "^-?[0-9]+(\\.[0-9]{1,9})?s$"}};
  }
  if (&type == google::protobuf::FieldMask::descriptor()) {
    return {{"type", "string"}, {"description", "Names of fields with commas between them."}};
  }
  if (&type == google::protobuf::Empty::descriptor()) {
    return {{"type", "object"}, {"description", "An object without fields."}};
  }
  return nullptr;
}

Json OpenApiDocument::message_reference(const Descriptor& type, Use use) {
  Json schema = special_schema(type);
  std::string name = schema.is_null() ? schema_name(type.full_name()) : type.name();
  if (schema.is_null() && use == Use::kRequest && answered_.contains(type.full_name())) {
    name += "Input";
  }
  if (!schemas_.contains(name)) {
    schemas_[name] = schema;  // a message may contain itself
    if (schema.is_null()) schema = message_schema(type, use);
    schemas_[name] = std::move(schema);
  }
  return reference("schemas", name);
}

/// The schema of the body of a route's request: of a whole request that without the fields of the
/// path. One route of a method may have `parent` in its path and the other one not.
Json OpenApiDocument::body_reference(const HttpRoutes::Route& route) {
  const Descriptor& request = *route.method->descriptor->input_type();
  if (route.body_field != "*") {
    const Descriptor& resource = *request.FindFieldByName(route.body_field)->message_type();
    Json schema = message_schema(resource, Use::kRequest);
    if (route.verb != "PATCH" || !schema.contains("required")) {
      return message_reference(resource, Use::kRequest);
    }
    schema.erase("required");  // a change states any of the fields
    const std::string name = schema_name(resource.full_name()) + "Update";
    schemas_[name] = std::move(schema);
    return reference("schemas", name);
  }
  if (route.variables.empty()) return message_reference(request, Use::kRequest);
  std::string name = schema_name(request.full_name());
  Json schema = message_schema(request, Use::kRequest);
  for (const HttpRoutes::Route::Variable& each : route.variables) {
    if (each.field == "parent") name += "InProject";
    schema["properties"].erase(each.field);
    if (!schema.contains("required")) continue;
    std::erase(schema["required"].get_ref<Json::array_t&>(), Json(each.field));
    if (schema["required"].empty()) schema.erase("required");
  }
  schemas_[name] = std::move(schema);
  return reference("schemas", name);
}

void OpenApiDocument::add_basic_schemas() {
  schemas_["Number"] = {
      {"description", "A number in double precision; values that JSON cannot write are texts."},
      {"anyOf",
       {{{"type", "number"}, {"format", "double"}},
        {{"type", "string"}, {"enum", {"NaN", "Infinity", "-Infinity"}}}}}};
  schemas_["Integer64"] = {{"description", "A whole number of 64 bits, as text."},
                           {"type", "string"},
                           {"format", "int64"},
                           {"pattern", "^-?[0-9]{1,19}$"}};
  const Json number_or_null = {{"anyOf", {{{"type", "number"}}, {{"type", "null"}}}}};
  const Json whole_number = {{"type", "integer"}, {"format", "int64"}};
  const Json columns = {{"type", "object"},
                        {"description", "The values of each column, by its name; null: none."},
                        {"additionalProperties", {{"type", "array"}, {"items", number_or_null}}}};
  schemas_["PointColumns"] = {{"type", "object"},
                              {"description", "The points of a simulation as columns."},
                              {"properties", {{"columns", columns}}},
                              {"required", {"columns"}}};
  schemas_["RowColumns"] = {
      {"type", "object"},
      {"description",
       "Rows of a history or a campaign as columns, with the members of HistorySchema."},
      {"properties",
       {{"start_row", whole_number},
        {"row_count", whole_number},
        {"total_rows", whole_number},
        {"rows_per_pair", whole_number},
        {"units",
         {{"type", "object"},
          {"description", "The symbol of the unit of each column, by its name."},
          {"additionalProperties", {{"type", "string"}}}}},
        {"columns", columns}}},
      {"required", {"start_row", "row_count", "total_rows", "rows_per_pair", "units", "columns"}}};
  std::string reasons =
      "google.rpc.ErrorInfo with the reason of the error; google.rpc.BadRequest with the "
      "violations, field and sentence each; google.rpc.RetryInfo. Reasons:";
  const EnumDescriptor& reason = *v1::ErrorReason_descriptor();
  for (int i = 1; i < reason.value_count(); ++i) {
    reasons += "\n\n- `" + reason_text(static_cast<v1::ErrorReason>(reason.value(i)->number())) +
               "`: " + comments_.of(reason.value(i)->full_name());
  }
  Json codes = Json::array();
  for (int i = google::rpc::Code_MIN; i <= google::rpc::Code_MAX; ++i) {
    if (i != google::rpc::OK) codes.push_back(google::rpc::Code_Name(i));
  }
  schemas_["Error"] = {
      {"type", "object"},
      {"description", "An error (AIP-193)."},
      {"required", {"error"}},
      {"properties",
       {{"error",
         {{"type", "object"},
          {"required", {"code", "message", "status", "details"}},
          {"properties",
           {{"code", {{"type", "integer"}, {"description", "The status of HTTP."}}},
            {"message", {{"type", "string"}, {"description", "A sentence for people."}}},
            {"status", {{"type", "string"}, {"enum", codes}}},
            {"details",
             {{"type", "array"},
              {"description", reasons},
              {"items",
               {{"type", "object"},
                {"required", {"@type"}},
                {"properties", {{"@type", {{"type", "string"}}}}},
                {"additionalProperties", true}}}}}}}}}}}};
}

/// A parameter of an operation.
Json parameter(const char* place, const std::string& name, Json schema,
               const std::string& description, bool is_required = false) {
  Json out = {{"name", name}, {"in", place}};
  if (!description.empty()) out["description"] = description;
  if (is_required) out["required"] = true;
  out["schema"] = std::move(schema);
  return out;
}

bool is_of_path(const HttpRoutes::Route& route, const std::string& path) {
  return std::any_of(route.variables.begin(), route.variables.end(),
                     [&](const auto& variable) { return variable.field == path; });
}

void OpenApiDocument::add_query(const Descriptor& type, const std::string& prefix,
                                const HttpRoutes::Route& route, Json& parameters) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    const std::string path = prefix + field.name();
    if (path == route.body_field || is_of_path(route, path)) continue;
    const Descriptor* message = field.message_type();
    if (message != nullptr && !is_text_message(*message)) {
      if (!field.is_repeated()) add_query(*message, path + ".", route, parameters);
      continue;
    }
    Json schema = field_schema(field, Use::kRequest);
    const std::string description = schema.value("description", "");
    schema.erase("description");
    parameters.push_back(
        parameter("query", path, std::move(schema), description, is_required_field(field)));
  }
}

/// True if the request, or the resource in its body, has an etag that If-Match stands for.
bool takes_etag(const HttpRoutes::Route& route) {
  const Descriptor& request = *route.method->descriptor->input_type();
  if (request.FindFieldByName("etag") != nullptr) return true;
  const FieldDescriptor* body = request.FindFieldByName(route.body_field);
  return body != nullptr && body->message_type()->FindFieldByName("etag") != nullptr;
}

bool has_form(const HttpRoutes::Route& route, Form form) {
  const std::vector<Form> forms = forms_of(*route.method);
  return std::find(forms.begin(), forms.end(), form) != forms.end();
}

Json OpenApiDocument::parameters_of(const HttpRoutes::Route& route,
                                    const std::vector<std::string>& of_path) {
  Json out = Json::array();
  for (const std::string& name : of_path) {
    const std::string text = name == "project"
                                 ? "Id of the project."
                                 : "Id, and for one revision of a resource \"@\" with its number.";
    out.push_back(parameter("path", name, {{"type", "string"}, {"pattern", "^[A-Za-z0-9._@-]+$"}},
                            name == "simulation" ? "Number of the simulation." : text, true));
  }
  const MethodDescriptor& method = *route.method->descriptor;
  if (route.body_field != "*") add_query(*method.input_type(), "", route, out);
  const std::vector<Form> forms = forms_of(*route.method);
  if (forms.size() > 1) {
    Json words = Json::array();
    for (const Form each : forms) words.push_back(form_word(each));
    out.push_back(parameter("query", "alt", {{"type", "string"}, {"enum", std::move(words)}},
                            "Form of the answer; it has priority over the header Accept."));
  }
  if (forms.front() == Form::kMessage && forms.size() > 1) {
    out.push_back(parameter("query", "columns", {{"type", "string"}},
                            "With a form of columns: their names with commas between them."));
  }
  if (takes_etag(route)) {
    out.push_back(parameter("header", "If-Match", {{"type", "string"}},
                            "The etag that the resource must have, in double quotes; or *."));
  }
  const bool has_ranges = has_form(route, Form::kNumpy);
  if (has_ranges) {
    out.push_back(parameter("header", "Range", {{"type", "string"}},
                            "One range of bytes of a table whose response has Accept-Ranges."));
    out.push_back(parameter("header", "If-Range", {{"type", "string"}},
                            "The strong ETag of the table that the range is of."));
  }
  if (route.verb == "GET" && (route.method->answer || has_ranges)) {
    out.push_back(parameter("header", "If-None-Match", {{"type", "string"}},
                            "Etags of answers that the client has."));
  }
  if (route.method->open && resume_fields(method)) {
    out.push_back(parameter("header", "Last-Event-ID", {{"type", "string"}},
                            "Id of the last event that the client has."));
  }
  return out;
}

Json OpenApiDocument::answer_of(const HttpRoutes::Route& route) {
  Json content = Json::object();
  for (const Form form : forms_of(*route.method)) {
    std::string type = content_type(form);
    type = type.substr(0, type.find(';'));
    Json schema = {{"type", "string"}};
    if (form == Form::kMessage || form == Form::kEvents) {  // an event's data is a message
      schema = message_reference(*route.method->descriptor->output_type(), Use::kAnswer);
    } else if (form == Form::kPointColumns) {
      schema = reference("schemas", "PointColumns");
    } else if (form == Form::kColumns) {
      schema = reference("schemas", "RowColumns");
    } else if (form == Form::kLines) {  // a line
      const Json message =
          message_reference(*route.method->descriptor->output_type(), Use::kAnswer);
      schema = {{"type", "object"},
                {"properties",
                 {{"result", message}, {"error", reference("schemas", "Error/properties/error")}}}};
    } else if (form == Form::kNumpy || form == Form::kBinary) {
      schema = Json::object();
    }
    content[type] = {{"schema", std::move(schema)}};
  }
  std::string description = "The answer.";
  if (route.method->open) {
    description =
        "The messages one after another: the data of each event, each line as an object with "
        "\"result\", or their columns together. A last line has \"error\" if messages are missing.";
  }
  return {{"description", description}, {"content", std::move(content)}};
}

Json OpenApiDocument::responses_of(const HttpRoutes::Route& route) {
  Json out = Json::object();
  out["200"] = answer_of(route);
  const bool has_ranges = has_form(route, Form::kNumpy);
  if (has_ranges) out["206"] = reference("responses", "Range");
  if (route.verb == "GET" && (route.method->answer || has_ranges)) {
    out["304"] = reference("responses", "NotModified");
  }
  std::vector<std::string> errors = {"400", "401", "403", "404"};
  if (has_ranges) errors.emplace_back("416");
  if (route.verb != "GET") errors.emplace_back("409");
  if (takes_etag(route)) errors.emplace_back("412");
  for (const char* each : {"429", "503"}) errors.emplace_back(each);
  for (const std::string& each : errors) out[each] = reference("responses", "Error" + each);
  out["default"] = reference("responses", "Error");
  return out;
}

void OpenApiDocument::add(const HttpRoutes::Route& route, bool is_additional) {
  std::string path;
  std::vector<std::string> of_path;
  for (std::size_t i = 0; i < route.segments.size(); ++i) {
    if (route.segments[i] == "*") {
      of_path.push_back(singular(route.segments[i - 1]));
      path += "/{" + of_path.back() + "}";
    } else {
      path += "/" + route.segments[i];
    }
  }
  if (!route.custom_verb.empty()) path += ":" + route.custom_verb;
  const MethodDescriptor& method = *route.method->descriptor;
  std::string verb = route.verb;
  for (char& each : verb) each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));

  const std::string text = comments_.of(method.full_name());
  Json operation = {
      {"operationId", method.name() + (is_additional ? "" : "InProject")},
      {"tags", {method.service()->name()}},
      {"summary",
       text.substr(0, text.find(". ") == std::string::npos ? text.size() : text.find(". ") + 1)},
      {"description", text}};
  if (Json parameters = parameters_of(route, of_path); !parameters.empty()) {
    operation["parameters"] = std::move(parameters);
  }
  if (!route.body_field.empty()) {
    const Json body = body_reference(route);
    const std::string name = body["$ref"];
    const bool is_required =
        route.body_field != "*" || schemas_[name.substr(name.rfind('/') + 1)].contains("required");
    operation["requestBody"] = {{"required", is_required},
                                {"content", {{"application/json", {{"schema", body}}}}}};
  }
  operation["responses"] = responses_of(route);
  paths_[path][verb] = std::move(operation);
}

void OpenApiDocument::add_pages() {
  const auto page = [this](const char* path, const char* id, const char* summary, const char* type,
                           bool is_public) {
    Json schema = {{"type", std::string_view(type) == "application/json" ? "object" : "string"}};
    Json operation = {{"operationId", id}, {"tags", {"Server"}}, {"summary", summary}};
    if (is_public) operation["security"] = Json::array();
    operation["responses"]["200"] = {{"description", "The page."},
                                     {"content", {{type, {{"schema", std::move(schema)}}}}}};
    if (!is_public) {
      operation["responses"]["401"] = reference("responses", "Error401");
      operation["responses"]["403"] = reference("responses", "Error403");
    } else if (std::string_view(path) == "/healthz") {
      operation["responses"]["403"] = reference("responses", "Error403");
      operation["responses"]["503"] = {{"description", "The server does not serve."}};
    } else {
      operation["responses"]["304"] = reference("responses", "NotModified");
      operation["responses"]["403"] = reference("responses", "Error403");
    }
    operation["responses"]["default"] = reference("responses", "Error");
    paths_[path]["get"] = std::move(operation);
  };
  page("/healthz", "Health", "Says whether the server serves.", "text/plain", true);
  page("/metrics", "Metrics",
       "Returns the metrics for Prometheus; the token must be for all projects.", "text/plain",
       false);
  page(kOpenApiPath, "Description", "Returns this description.", "application/json", true);
  page(kOpenApiPagePath, "DescriptionPage", "Returns this description as a page for people.",
       "text/html", true);
  page(kOpenApiStylePath, "DescriptionStyle", "Returns the style of the page.", "text/css", true);
}

void OpenApiDocument::add_error_responses() {
  static const std::vector<std::pair<std::string, const char*>> kErrors = {
      {"", "An error."},
      {"400", "A field is wrong, or the state of the resource forbids the call."},
      {"401", "The call has no valid token."},
      {"403", "The token does not allow the call, or a page of another origin sent it."},
      {"404", "There is no such resource or method."},
      {"409", "It exists already, or has changed meanwhile."},
      {"412", "The resource has another etag."},
      {"416", "The range begins behind the end of the table."},
      {"429", "A limit is reached; try again after Retry-After."},
      {"503", "The server does not serve now; try again after Retry-After."}};
  Json responses = Json::object();
  responses["NotModified"] = {{"description", "The client has the answer already."}};
  responses["Range"] = {{"description", "A range of the bytes of a table."}};
  for (const auto& [code, description] : kErrors) {
    Json& each = responses["Error" + code];
    each["description"] = description;
    if (code == "429" || code == "503") {
      each["headers"]["Retry-After"] = {{"description", "Seconds to wait."},
                                        {"schema", {{"type", "integer"}}}};
    }
    each["content"]["application/json"]["schema"] = reference("schemas", "Error");
  }
  out_["components"]["responses"] = std::move(responses);
}

/// Adds a message and all that it contains.
void add_contained(const Descriptor& type, std::set<std::string>& out) {
  if (!out.insert(type.full_name()).second) return;
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i)->message_type() != nullptr)
      add_contained(*type.field(i)->message_type(), out);
  }
}

OpenApiDocument::OpenApiDocument(const HttpRoutes& routes) {
  out_["openapi"] = "3.1.0";
  out_["info"] = {{"title", "Tribodyn"}, {"version", "v1"}, {"description", kIntroduction}};
  out_["servers"] = {{{"url", "/"}, {"description", "The server of this description."}}};
  out_["security"] = {{{"token", Json::array()}}};
  add_basic_schemas();
  add_error_responses();
  std::map<const MethodDescriptor*, int> count;
  std::vector<const google::protobuf::ServiceDescriptor*> services;
  for (const HttpRoutes::Route& route : routes.all()) {
    add_contained(*route.method->descriptor->output_type(), answered_);
    ++count[route.method->descriptor];
    const auto* service = route.method->descriptor->service();
    if (std::find(services.begin(), services.end(), service) == services.end()) {
      services.push_back(service);
    }
  }
  Json tags = Json::array();
  for (const auto* each : services) {
    tags.push_back({{"name", each->name()}, {"description", comments_.of(each->full_name())}});
  }
  tags.push_back({{"name", "Server"}, {"description", "Pages of the server itself."}});
  out_["tags"] = std::move(tags);
  for (const HttpRoutes::Route& route : routes.all()) {
    const bool in_project = count[route.method->descriptor] > 1 && route.segments.size() > 1 &&
                            route.segments[1] == "projects";
    add(route, !in_project);
  }
  add_pages();
  out_["paths"] = std::move(paths_);
  out_["components"]["schemas"] = std::move(schemas_);
  out_["components"]["securitySchemes"]["token"] = {
      {"type", "http"},
      {"scheme", "bearer"},
      {"description",
       "A token of `tribodynd tokens create`, or the owner's, which the server "
       "writes beside its database."}};
}

}  // namespace

std::string openapi_document(const HttpRoutes& routes) { return OpenApiDocument(routes).text(); }

}  // namespace tribodyn::server
