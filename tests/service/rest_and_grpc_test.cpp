// Every method of the table by gRPC and by REST: the same requests in the same order to two equal
// servers have the same answers, messages and errors alike. Bodies and answers of REST are as the
// OpenAPI description has them, without a field that it does not name.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "google/protobuf/timestamp.pb.h"
#include "google/rpc/code.pb.h"
#include "proto/resource_kinds.h"
#include "server/storage/seeds.h"
#include "server/transport/grpc/grpc_server.h"
#include "server/transport/http/http_server.h"
#include "server/transport/http/openapi.h"
#include "server/transport/http/rest_answer.h"
#include "tests/service/contract_methods.h"
#include "tests/service/http_client.h"
#include "tests/service/openapi_schemas.h"
#include "tests/service/raw_client.h"
#include "tests/service/rest_rendering.h"
#include "tests/service/server_process.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using google::protobuf::TextFormat;

/// What a method answers: messages, more than one of a stream, or an error.
struct Answer {
  google::rpc::Status status;
  std::vector<std::unique_ptr<Message>> messages;
};

/// A server with the seeds, in the project default and in acme.
class Twin {
 public:
  Twin() {
    bench_.store().add_project("acme", seed_resources(), 1);
    accept_owner(app_);
  }
  virtual ~Twin() = default;
  virtual Answer answer(const Method& method, const Message& request) = 0;
  const std::vector<Method>& methods() const { return dispatcher_.methods(); }

 protected:
  static void add(const Method& method, const std::string& bytes, Answer& out) {
    out.messages.emplace_back(method.response->New());
    ASSERT_TRUE(out.messages.back()->ParseFromString(bytes)) << method.descriptor->name();
  }

  Bench bench_;
  Application app_ = bench_.application();
  CallDispatcher dispatcher_{app_};
};

class GrpcTwin final : public Twin {
 public:
  ~GrpcTwin() override { server_.shutdown(); }
  Answer answer(const Method& method, const Message& request) override {
    const std::string path = path_of(*method.descriptor);
    const std::string bytes = request.SerializeAsString();
    Answer out;
    grpc::Status status;
    if (method.open) {
      auto [ended, parts] = client_.read_all(path, bytes);
      for (const std::string& part : parts) add(method, part, out);
      status = ended;
    } else {
      auto [ended, message] = client_.call(path, bytes);
      if (ended.ok()) add(method, message, out);
      status = ended;
    }
    out.status.ParseFromString(status.error_details());
    if (!status.ok()) {
      EXPECT_EQ(out.status.code(), static_cast<int>(status.error_code())) << path;
      EXPECT_EQ(out.status.message(), status.error_message()) << path;
    }
    return out;
  }

 private:
  GrpcServer server_{dispatcher_, {{"127.0.0.1", 0, ""}}};
  RawClient client_{connect_with(server_.addresses().front(), kSecret)};
};

class RestTwin final : public Twin {
 public:
  Answer answer(const Method& method, const Message& request) override {
    HttpRequest sent = rest_request(handler_.routes(), method, request);
    if (method.open) {
      sent.target += sent.target.find('?') == std::string::npos ? "?" : "&";
      sent.target += "alt=ndjson";
    }
    const Described described = description(method, sent);
    HttpConnection client(server_.address().port);
    std::string text = sent.verb + " " + sent.target + " HTTP/1.0\r\n" + kHost;
    for (const auto& [name, value] : sent.headers) text += name + ": " + value + "\r\n";
    if (!sent.body.empty()) text += fmt::format("Content-Length: {}\r\n", sent.body.size());
    EXPECT_TRUE(client.send_all(text + "\r\n" + sent.body));
    return read(method, described, client.read_all());
  }

 private:
  /// What the description says of a request and its answer.
  struct Described {
    std::string body;  ///< of the request; empty: none
    const nlohmann::json* operation;
    OpenApiSchemas::Rigour rigour;  ///< of the answer
  };
  Described description(const Method& method, const HttpRequest& sent) const {
    const std::string path = sent.target.substr(0, sent.target.find('?'));
    for (const HttpRoutes::Route& route : handler_.routes().all()) {
      if (route.method->descriptor != method.descriptor) continue;
      const bool in_project = path.starts_with("/v1/projects/");
      if ((route.segments[1] == "projects") != in_project) continue;
      const bool is_masked = sent.target.find("read_mask=") != std::string::npos ||
                             sent.body.find("\"read_mask\"") != std::string::npos;
      return {sent.body, &schemas_.operation(route),
              is_masked ? OpenApiSchemas::Rigour::kSomeFields : OpenApiSchemas::Rigour::kWhole};
    }
    throw std::logic_error("no route of " + path);
  }

  /// The description allows the answer, and the request if the server did not refuse it.
  void check_description(const Described& described, const std::string& type,
                         const std::string& answer) const {
    const nlohmann::json& operation = *described.operation;
    const std::string id = operation["operationId"];
    EXPECT_EQ(schemas_.complaints(nlohmann::json::parse(answer),
                                  operation["responses"]["200"]["content"][type]["schema"],
                                  described.rigour),
              "")
        << id;
    if (described.body.empty()) return;
    EXPECT_EQ(
        schemas_.complaints(nlohmann::json::parse(described.body),
                            operation["requestBody"]["content"]["application/json"]["schema"]),
        "")
        << id;
  }

  Answer read(const Method& method, const Described& described, const std::string& response) const {
    Answer out;
    const std::size_t end = response.find("\r\n\r\n");
    if (end == std::string::npos) {
      ADD_FAILURE() << method.descriptor->name() << " has no answer";
      return out;
    }
    const std::string body = response.substr(end + 4);
    const int http_code = std::stoi(response.substr(response.find(' ')));
    if (http_code != 200) {
      out.status = error_of_json(body);
      EXPECT_EQ(http_code, http_status(out.status)) << body;
      return out;
    }
    if (!method.open) {
      out.messages.emplace_back(method.response->New());
      read_json(body, *out.messages.back());
      check_description(described, "application/json", body);
      return out;
    }
    std::istringstream lines(body);
    for (std::string line; std::getline(lines, line);) {
      check_description(described, "application/x-ndjson", line);
      out.messages.emplace_back(method.response->New());
      read_json(nlohmann::json::parse(line).at("result").dump(), *out.messages.back());
    }
    return out;
  }

  RestHandler handler_{dispatcher_};
  const OpenApiSchemas schemas_{nlohmann::json::parse(openapi_document(handler_.routes()))};
  HttpServer server_{handler_, {"127.0.0.1", 0, ""}};
};

/// Clears what two servers that do the same differ in: times of the clock, also in the tokens of
/// pages that are ordered by them, and how far a campaign is. `times` counts them.
void clear_times(Message& message, int& times) {
  const Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (field->message_type() == nullptr) {
      static const std::set<std::string> kByTheClock = {
          "tribodyn.v1.ListSimulationsResponse.next_page_token",
          "tribodyn.v1.Campaign.processor_seconds", "tribodyn.v1.Campaign.points_done",
          "tribodyn.v1.Campaign.stored_bytes", "tribodyn.v1.CampaignEvent.processor_seconds"};
      if (!kByTheClock.contains(field->full_name())) continue;
      reflection.ClearField(&message, field);
      ++times;
      continue;
    }
    if (field->message_type() == google::protobuf::Timestamp::descriptor()) {
      reflection.ClearField(&message, field);
      ++times;
    } else if (field->is_repeated()) {
      for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
        clear_times(*reflection.MutableRepeatedMessage(&message, field, i), times);
      }
    } else {
      clear_times(*reflection.MutableMessage(&message, field), times);
    }
  }
}

constexpr const char* kToothColumns[] = {"load_share",
                                         "radius_x_metres",
                                         "radius_y_metres",
                                         "pinion_velocity_x_metres",
                                         "pinion_velocity_y_metres",
                                         "gear_velocity_x_metres",
                                         "gear_velocity_y_metres",
                                         "contact_point_velocity_x_metres",
                                         "contact_point_velocity_y_metres",
                                         "pinion_friction_arm_metres",
                                         "gear_friction_arm_metres"};

/// A kind of resource, in the words of its methods.
struct Kind {
  std::string one;         ///< "GearSet"
  std::string many;        ///< "GearSets"
  std::string collection;  ///< "gearSets"
  std::string field;       ///< "gear_set"
  std::string seed;        ///< id
};

const std::vector<Kind>& kinds() {
#define TRIBODYN_KIND(Resource, field, collection, seed) \
  {#Resource, #Resource "s", #collection, #field, seed},
  static const std::vector<Kind> kKinds = {TRIBODYN_RESOURCE_KINDS(TRIBODYN_KIND)};
#undef TRIBODYN_KIND
  return kKinds;
}

class RestAndGrpc : public testing::Test {
 protected:
  const Method& method(const std::string& name) const {
    for (const Method& each : grpc_.methods()) {
      if (each.descriptor->name() == name) return each;
    }
    throw std::logic_error("no method " + name);
  }

  static std::unique_ptr<Message> parsed(const Method& row, const std::string& text) {
    std::unique_ptr<Message> out(row.request->New());
    if (!TextFormat::ParseFromString(text, out.get())) {
      throw std::logic_error(row.descriptor->name() + " " + text);
    }
    return out;
  }

  /// Both answers are equal: that of gRPC, which is OK or an error as `expected` has it.
  Answer check(const std::string& name, const Message& request,
               google::rpc::Code expected = google::rpc::OK) {
    const Method& row = method(name);
    Answer by_grpc = grpc_.answer(row, request);
    Answer by_rest = rest_.answer(row, request);
    const std::string what = name + " " + request.ShortDebugString().substr(0, 300);
    EXPECT_EQ(by_grpc.status.code(), expected) << what << "\n" << by_grpc.status.DebugString();
    EXPECT_EQ(by_rest.status.DebugString(), by_grpc.status.DebugString()) << what;
    EXPECT_EQ(by_rest.messages.size(), by_grpc.messages.size()) << what;
    for (std::size_t i = 0; i < std::min(by_rest.messages.size(), by_grpc.messages.size()); ++i) {
      int grpc_times = 0;
      int rest_times = 0;
      clear_times(*by_grpc.messages[i], grpc_times);
      clear_times(*by_rest.messages[i], rest_times);
      EXPECT_EQ(rest_times, grpc_times) << what;
      std::string difference;
      google::protobuf::util::MessageDifferencer differencer;
      differencer.ReportDifferencesToString(&difference);
      google::protobuf::util::DefaultFieldComparator same_numbers;
      same_numbers.set_treat_nan_as_equal(true);
      differencer.set_field_comparator(&same_numbers);
      EXPECT_TRUE(differencer.Compare(*by_grpc.messages[i], *by_rest.messages[i]))
          << what << "\n"
          << difference.substr(0, 2000);
    }
    (expected == google::rpc::OK ? answered_ : refused_).insert(name);
    return by_grpc;
  }
  Answer check(const std::string& name, const std::string& request,
               google::rpc::Code expected = google::rpc::OK) {
    return check(name, *parsed(method(name), request), expected);
  }

  void check_resources(const Kind& kind);
  void check_imports();
  void check_simulations();
  void check_campaigns();

  GrpcTwin grpc_;
  RestTwin rest_;
  std::set<std::string> answered_;
  std::set<std::string> refused_;
};

/// The text of the resource that a kind is seeded with, without what the server sets.
std::string seed_text(const Kind& kind) {
  const auto row = seed_lookup().find({kind.collection + "/" + kind.seed, 0});
  const auto* type = google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(
      "tribodyn.v1." + kind.one);
  const std::unique_ptr<Message> resource(
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(type)->New());
  resource->ParseFromString(row->body);
  for (const char* field : {"name", "etag", "revision"}) {
    resource->GetReflection()->ClearField(resource.get(), type->FindFieldByName(field));
  }
  std::string out;
  TextFormat::PrintToString(*resource, &out);
  return out;
}

void RestAndGrpc::check_resources(const Kind& kind) {
  using google::rpc::Code;
  const auto text = [&](std::string form) {
    for (const auto& [word, value] :
         {std::pair("$one", kind.field), {"$collection", kind.collection}, {"$seed", kind.seed}}) {
      for (std::size_t at = 0; (at = form.find(word)) != std::string::npos;) {
        form.replace(at, std::string(word).size(), value);
      }
    }
    return form;
  };
  const std::string made = seed_text(kind);
  const std::string long_name = std::string(300, 'x');

  const std::string get = "Get" + kind.one;
  check(get, text(R"(name: "$collection/$seed")"));
  check(get, text(R"(name: "projects/acme/$collection/$seed@1")"));
  check(get, text(R"(name: "$collection/$seed" read_mask { paths: "display_name" })"));
  check(get, text(R"(name: "$collection/$seed" read_mask { paths: "no_field" })"),
        Code::INVALID_ARGUMENT);
  check(get, text(R"(name: "$collection/$seedd")"), Code::NOT_FOUND);
  check(get, text(R"(name: "projects/none/$collection/$seed")"), Code::NOT_FOUND);

  const std::string create = "Create" + kind.one;
  check(create, text(R"($one_id: "twin" $one {)") + made + "}");
  check(create, text(R"(parent: "projects/acme" $one_id: "twin" $one {)") + made + "}");
  std::string other = made;
  other.insert(other.find("display_name: \"") + 15, "Other ");
  check(create, text(R"($one_id: "twin" $one {)") + other + "}", Code::ALREADY_EXISTS);
  check(create, text(R"($one_id: "no good" $one { display_name: ")") + long_name + "\"}",
        Code::INVALID_ARGUMENT);

  const std::string batch_create = "BatchCreate" + kind.many;
  check(batch_create, text(R"(requests { $one_id: "b1" $one {)") + made +
                          text(R"(} } requests { $one_id: "b2" $one {)") + made + "} }");
  check(batch_create, text(R"(requests { $one_id: "b3" $one { derived_from: "$collection/no" } })"),
        Code::INVALID_ARGUMENT);

  const std::string list = "List" + kind.many;
  const Answer page = check(list, "page_size: 2 order_by: 'display_name desc'");
  const auto& first = *page.messages.at(0);
  const std::string token = first.GetReflection()->GetString(
      first, first.GetDescriptor()->FindFieldByName("next_page_token"));
  EXPECT_FALSE(token.empty());
  check(list, "page_size: 2 order_by: 'display_name desc' page_token: '" + token + "'");
  check(list, R"(parent: "projects/acme" filter: "display_name = \"*\" AND labels.x:*")");
  check(list, "filter: 'lims = 1'", Code::INVALID_ARGUMENT);
  check(list, "page_size: -1 page_token: 'x' order_by: 'nothing'", Code::INVALID_ARGUMENT);

  const std::string update = "Update" + kind.one;
  check(update, text(R"($one { name: "$collection/twin" display_name: "Twin \"1\" \303\244" }
                        update_mask { paths: "display_name" })"));
  check(update, text(R"($one { name: "$collection/twin" etag: "old" display_name: "x" }
                        update_mask { paths: "display_name" })"),
        Code::ABORTED);
  check(update, text(R"($one { name: "$collection/none" display_name: "x" }
                        update_mask { paths: "display_name" })"),
        Code::NOT_FOUND);

  const std::string batch_update = "BatchUpdate" + kind.many;
  check(batch_update, text(R"(requests { $one { name: "$collection/b1" description: "d" }
                           update_mask { paths: "description" } })"));
  check(batch_update, text(R"(requests { $one { name: "$collection/none" } })"), Code::NOT_FOUND);

  check("List" + kind.one + "Revisions", text(R"(name: "$collection/twin")"));
  check("List" + kind.one + "Revisions", text(R"(name: "$collection/none")"), Code::NOT_FOUND);

  check("Delete" + kind.one, text(R"(name: "$collection/twin" etag: "old")"), Code::ABORTED);
  check("Delete" + kind.one, text(R"(name: "$collection/twin")"));
  check(get, text(R"(name: "$collection/twin")"));
  check(list, "show_deleted: true");
  check("Undelete" + kind.one, text(R"(name: "$collection/twin")"));
  check("Undelete" + kind.one, text(R"(name: "$collection/none")"), Code::NOT_FOUND);

  check("Purge" + kind.one, text(R"(name: "$collection/twin" etag: "old")"), Code::ABORTED);
  check("Purge" + kind.one, text(R"(name: "$collection/twin")"));
}

/// The table of a gear set's contacts by mesh phase and slot.
std::string tooth_contact_table(const v1::GearSet& set) {
  std::string out = "mesh_phase,slot";
  for (const char* column : kToothColumns) out += std::string(",") + column;
  for (int slot = 0; slot < 3; ++slot) {
    const v1::FlankSlot& from = set.flank_slots(slot);
    for (int i = 0; i < from.load_share_size(); ++i) {
      out += fmt::format("\n{},{}", i / (from.load_share_size() - 1.0), slot);
      for (const char* column : kToothColumns) {
        const auto* field = v1::FlankSlot::descriptor()->FindFieldByName(column);
        out += fmt::format(",{}", from.GetReflection()->GetRepeatedDouble(from, field, i));
      }
    }
  }
  return out + "\n";
}

void RestAndGrpc::check_imports() {
  using google::rpc::Code;
  check("ImportLubricant", R"(lubricant_id: "oil"
      lubricant { measurements { density_15_celsius_kilograms_per_cubic_metre: 868 } }
      viscosity_table_csv: "T (C);KV (mm2/s)\n100;15\n40;103\n20;283\n")");
  check("ImportLubricant", R"(lubricant_id: "oil2" viscosity_table_csv: "T;KV\n1;x\n")",
        Code::INVALID_ARGUMENT);
  std::string waves = "position_micrometres,height_nanometres\\n";
  for (int i = 0; i < 4001; ++i) {
    waves += fmt::format("{},{}\\n", 0.5 * i, 300 * std::sin(0.0628 * i) + 20);
  }
  check("ImportSurfaceProfiles",
        R"(surface_id: "measured" surface { tribofilm_shear_strength_pascals: 2e6
           asperity_friction_coefficient: 0.17 } profiles { csv: ")" +
            waves + "\" }");
  check("ImportSurfaceProfiles", R"(surface_id: "x" profiles { csv: "a,b\n1,2\n" })",
        Code::INVALID_ARGUMENT);
  const Kind& gear_set = kinds()[1];
  v1::GearSet rest = seed<v1::GearSet>(gear_set.collection + "/" + gear_set.seed);
  v1::ImportGearSetRequest teeth;
  teeth.set_tooth_contact_csv(tooth_contact_table(rest));
  rest.clear_flank_slots();
  rest.clear_load_share_by_torque();
  rest.clear_series_by_torque();
  *teeth.mutable_gear_set() = rest;
  teeth.set_gear_set_id("made-elsewhere");
  check("ImportGearSet", teeth);
  check("ImportGearSet", R"(gear_set_id: "g" tooth_contact_csv: "load_shar\n1\n")",
        Code::INVALID_ARGUMENT);
}

void RestAndGrpc::check_simulations() {
  using google::rpc::Code;
  const std::string point = R"(lubricant: "lubricants/paper-fluid-1"
      operating_point { cruise { speed_kilometres_per_hour: 65 }
                        history { columns: "mesh_force_newtons" mesh_cycles: 4
                                  samples_per_mesh_cycle: 100 } })";
  const auto wait = [&](const std::string& name) {
    const Method& get = method("GetSimulation");
    const auto request = parsed(get, "name: '" + name + "'");
    for (Twin* each : {static_cast<Twin*>(&grpc_), static_cast<Twin*>(&rest_)}) {
      EXPECT_TRUE(eventually([&] {
        const Answer answer = each->answer(get, *request);
        return static_cast<const v1::Simulation&>(*answer.messages.at(0)).state() ==
               v1::Simulation::SUCCEEDED;
      }));
    }
  };
  check("CreateSimulation", "simulation {" + point + "} request_id: 'r1' validate_only: true");
  check("CreateSimulation", "simulation {" + point + "} request_id: 'r1'");
  wait("simulations/1");
  check("CreateSimulation", "simulation {" + point + "} request_id: 'r2'");
  check("CreateSimulation", R"(parent: "projects/acme" simulation {
      lubricant: "lubricants/paper-fluid-1"
      inefficiency_curve { first_speed_kilometres_per_hour: 20 last_speed_kilometres_per_hour: 60
                           speed_step_kilometres_per_hour: 10 } })");
  wait("projects/acme/simulations/1");
  check("CreateSimulation", R"(simulation { lubricant: "lubricants/paper-fluid-11"
      operating_point { cruise { speed_kilometres_per_hour: -5 } } })",
        Code::INVALID_ARGUMENT);

  for (const char* view : {"SIMULATION_VIEW_UNSPECIFIED", "SIMULATION_VIEW_BASIC",
                           "SIMULATION_VIEW_SUMMARY", "SIMULATION_VIEW_FULL"}) {
    check("GetSimulation", fmt::format("name: 'simulations/1' view: {}", view));
    check("GetSimulation", fmt::format("name: 'projects/acme/simulations/1' view: {}", view));
  }
  check("GetSimulation", "name: 'simulations/9'", Code::NOT_FOUND);
  check("ListSimulations", "page_size: 1 view: SIMULATION_VIEW_SUMMARY");
  check("ListSimulations", R"(filter: "lubricant = \"paper-fluid-1\" AND state = SUCCEEDED"
                              order_by: "create_time desc")");
  check("ListSimulations", "page_token: 'simulations/x'", Code::INVALID_ARGUMENT);
  check("UpdateSimulation", R"(simulation { name: "simulations/1" display_name: "a & b?" }
                               update_mask { paths: "display_name" })");
  check("UpdateSimulation", R"(simulation { name: "simulations/9" display_name: "x" }
                               update_mask { paths: "display_name" })",
        Code::NOT_FOUND);
  for (const char* name : {"PinSimulation", "UnpinSimulation"}) {
    check(name, "name: 'simulations/1'");
    check(name, "name: 'simulations/9'", Code::NOT_FOUND);
  }
  check("ReadSpectrum", "name: 'simulations/1'");
  check("ReadSpectrum", "name: 'projects/acme/simulations/1'", Code::NOT_FOUND);
  check("ReadSpectrum", "name: 'simulations/1' columns: 'mesh_force_newtons' maximum_order: 3");
  check("ReadSpectrum", "name: 'simulations/1' columns: 'mesh_force'", Code::INVALID_ARGUMENT);
  check("WatchSimulation", "name: 'simulations/1'");
  check("WatchSimulation", "name: 'simulations/1' after_sequence: 2");
  check("WatchSimulation", "name: 'simulations/9'", Code::NOT_FOUND);
  check("WatchSimulations", "names: 'simulations/1' names: 'simulations/2'");
  check("WatchSimulations", "names: 'simulations/9'", Code::NOT_FOUND);
  check("ReadHistory", "name: 'simulations/1'");
  check("ReadHistory",
        "name: 'simulations/1' start_row: 7 row_count: 50 columns: 'mesh_force_newtons'");
  check("ReadHistory", "name: 'simulations/1' columns: 'mesh_forc'", Code::INVALID_ARGUMENT);
  check("CancelSimulation", "name: 'simulations/1'");
  check("CancelSimulation", "name: 'simulations/9'", Code::NOT_FOUND);
  check("DeleteSimulation", "name: 'simulations/1'");
  check("DeleteSimulation", "name: 'simulations/1'", Code::NOT_FOUND);
}

void RestAndGrpc::check_campaigns() {
  using google::rpc::Code;
  const auto campaign = [](const std::string& values, const std::string& rest) {
    return R"(lubricant: "lubricants/paper-fluid-1"
      candidate_columns { path: "surface.asperity_friction_coefficient" )" +
           values + "} conditions { speed_kilometres_per_hour: 110 } " + rest;
  };
  const auto wait = [&](const std::string& name, v1::Campaign::State state) {
    const Method& get = method("GetCampaign");
    const auto request = parsed(get, "name: '" + name + "'");
    for (Twin* each : {static_cast<Twin*>(&grpc_), static_cast<Twin*>(&rest_)}) {
      EXPECT_TRUE(eventually([&] {
        const Answer answer = each->answer(get, *request);
        return static_cast<const v1::Campaign&>(*answer.messages.at(0)).state() == state;
      }));
    }
  };
  const std::string two = campaign("values: 0.1 values: 0.12",
                                   R"(conditions { speed_kilometres_per_hour: 60 }
      candidate_attributes { name: "additive" texts: "ZDDP" texts: "MoDTC" })");
  check("CreateCampaign", "campaign {" + two + "} request_id: 'r1' validate_only: true");
  check("CreateCampaign", "campaign {" + two + "} request_id: 'r1'");
  check("CreateCampaign", "campaign {" + two + " tolerance: 1 }", Code::INVALID_ARGUMENT);
  wait("campaigns/1", v1::Campaign::SUCCEEDED);
  check("GetCampaign", "name: 'campaigns/1' view: CAMPAIGN_VIEW_FULL");
  check("GetCampaign", "name: 'campaigns/9'", Code::NOT_FOUND);
  check("ListCampaigns", "");
  check("ListCampaigns", "page_token: 'x'", Code::INVALID_ARGUMENT);
  check("UpdateCampaign", R"(campaign { name: "campaigns/1" display_name: "a & b?" labels {
        key: "project" value: "axle" } } update_mask { paths: "display_name" paths: "labels" })");
  check("UpdateCampaign", R"(campaign { name: "campaigns/9" display_name: "x" })", Code::NOT_FOUND);
  check("ListCampaigns", "filter: 'labels.project = axle AND state = SUCCEEDED'");
  check("ListCampaigns", "filter: 'labels'", Code::INVALID_ARGUMENT);
  check("PauseCampaign", "name: 'campaigns/1'");
  check("PauseCampaign", "name: 'campaigns/9'", Code::NOT_FOUND);
  check("ResumeCampaign", "name: 'campaigns/1'", Code::FAILED_PRECONDITION);
  std::string values, speeds = "budget { points: 1 }";
  for (int i = 0; i < 8; ++i) values += "values: 0.1 ";
  for (int i = 0; i < 400; ++i) {
    speeds += fmt::format(" conditions {{ speed_kilometres_per_hour: {} }}", 20 + 0.25 * i);
  }
  check("CreateCampaign", "campaign {" + campaign(values, speeds) + "}");
  wait("campaigns/2", v1::Campaign::PAUSED);
  check("ResumeCampaign", "name: 'campaigns/2' budget {}");
  check("CancelCampaign", "name: 'campaigns/1'");
  check("CancelCampaign", "name: 'campaigns/9'", Code::NOT_FOUND);
  check("WatchCampaign", "name: 'campaigns/1'");
  check("WatchCampaign", "name: 'campaigns/1' after_version: -1", Code::INVALID_ARGUMENT);
  check("ReadCampaign", "name: 'campaigns/1'");
  check("ReadCampaign",
        "name: 'campaigns/1' start_row: 1 row_count: 2 columns: 'mesh_loss_power_watts'");
  check("ReadCampaign", "name: 'campaigns/1' columns: 'mesh_loss'", Code::INVALID_ARGUMENT);
  check("ReadCampaign", "name: 'campaigns/1' columns: 'row' filter: 'condition = 0'");
  check("ReadCampaign", "name: 'campaigns/1' filter: 'x = 0'", Code::INVALID_ARGUMENT);
  check("RankCandidates", R"(name: "campaigns/1" objective { wants_most: true } uncertainties {
      parameter: "surface.asperity_friction_coefficient" relative_uncertainty: 0.1 })");
  check("RankCandidates", "name: 'campaigns/1' count: -1", Code::INVALID_ARGUMENT);
  check("RankCandidates", "name: 'campaigns/1' page_token: 'x'", Code::INVALID_ARGUMENT);
  check("FindParetoCandidates",
        "name: 'campaigns/1' second { figure { column: 'mesh_loss_power_watts' } }");
  check("FindParetoCandidates", "name: 'campaigns/1'", Code::INVALID_ARGUMENT);
  check("EstimateCandidateEffects", "name: 'campaigns/1'", Code::INVALID_ARGUMENT);
  check("EstimateCandidateEffects", "name: 'campaigns/9'", Code::NOT_FOUND);
  const std::string four = campaign("values: 0.1 values: 0.12 values: 0.14 values: 0.13", "");
  check("CreateCampaign", "campaign {" + four + "}");
  wait("campaigns/3", v1::Campaign::SUCCEEDED);
  check("EstimateCandidateEffects", "name: 'campaigns/3'");
  check("PromoteCandidate",
        "name: 'campaigns/1' candidate: 1 lubricant_id: 'promoted' surface_id: 'promoted'");
  check("PromoteCandidate",
        "name: 'campaigns/1' candidate: 1 lubricant_id: 'promoted' surface_id: 'promoted'",
        Code::ALREADY_EXISTS);
  const std::string more = R"( candidate_columns { path: "surface.asperity_friction_coefficient"
      values: 0.09 } )";
  check("AppendCandidates", "name: 'campaigns/3'" + more + "request_id: 'a' validate_only: true");
  check("AppendCandidates", "name: 'campaigns/3'" + more + "request_id: 'a'");
  check("AppendCandidates", "name: 'campaigns/1'" + more, Code::INVALID_ARGUMENT);
  check("DeleteCampaign", "name: 'campaigns/1'");
  check("DeleteCampaign", "name: 'campaigns/1'", Code::NOT_FOUND);
}

TEST_F(RestAndGrpc, EveryMethodGivesTheSameAnswers) {
  for (const Kind& kind : kinds()) check_resources(kind);
  check_imports();
  check("GetSchema", "");
  check("GetSchema", "message: 'Lubricant'");
  check("GetSchema", "message: 'Lubricnt'", google::rpc::INVALID_ARGUMENT);
  check("EvaluateContact", contact_request());
  check("EvaluateContact", "lubricant: 'lubricants/none'", google::rpc::INVALID_ARGUMENT);
  check("EvaluatePoints", R"(lubricant: "lubricants/paper-fluid-1"
      candidate_columns { path: "surface.asperity_friction_coefficient" values: 0.1 values: 0.12 }
      conditions { speed_kilometres_per_hour: 110 })");
  check("EvaluatePoints",
        "lubricant: 'lubricants/none' conditions { speed_kilometres_per_hour: 1 }",
        google::rpc::INVALID_ARGUMENT);
  check("EvaluateCycle",
        R"(lubricants: "lubricants/paper-fluid-1" lubricants: "lubricants/paper-fluid-2"
      places { } places { time_seconds: 9 speed_kilometres_per_hour: 40 }
      places { time_seconds: 12 speed_kilometres_per_hour: 40 ascent_angle_degrees: 1 })");
  check("EvaluateCycle", R"(lubricants: "lubricants/paper-fluid-1"
      places { time_seconds: 5 } places { time_seconds: 2 speed_kilometres_per_hour: -1 })",
        google::rpc::INVALID_ARGUMENT);
  check("EvaluateProfiles", R"(profiles { member: FLANK_MEMBER_PINION
      csv: "position_micrometres,height_nanometres\n0,1\n2,5\n4,-3\n6,2\n8,-4\n10,1\n12,3\n" })");
  check("EvaluateProfiles", "sampling_steps: 0", google::rpc::INVALID_ARGUMENT);
  check("EvaluateRig",
        R"(lubricant: "lubricants/paper-fluid-1" surface: "surfaces/run-in" radius_x_metres: 0.0127
      conditions { load_newtons: 38 entrainment_speed_metres_per_second: 2
                   slide_roll_ratio_percent: 10 supply_temperature_celsius: 40 })");
  check("EvaluateRig", R"(lubricant: "lubricants/paper-fluid-1" radius_x_metres: 0.0127 draws: 19
      grid { supply_temperatures_celsius: 40 supply_temperatures_celsius: 90
             mean_pressures_pascals: 8e8 entrainment_speeds_metres_per_second: 2
             slide_roll_ratios_percent: 0 slide_roll_ratios_percent: 20 })");
  check("EvaluateRig", "lubricant: 'lubricants/none' radius_x_metres: 1",
        google::rpc::INVALID_ARGUMENT);
  check("EvaluateViscosity", R"(lubricant: "lubricants/paper-fluid-1" temperatures_celsius: -150
      temperatures_celsius: 40 temperatures_celsius: 100 pressures_pascals: 0
      pressures_pascals: 1e9)",
        google::rpc::INVALID_ARGUMENT);
  check("EvaluateViscosity", R"(lubricant: "lubricants/paper-fluid-1" temperatures_celsius: 40
      temperatures_celsius: 100 pressures_pascals: 0 pressures_pascals: 1e9)");
  check("ComparePoints",
        R"(lubricants: "lubricants/paper-fluid-1" lubricants: "lubricants/paper-fluid-2"
      conditions { speed_kilometres_per_hour: 110 } draws: 19)");
  check("ComparePoints",
        "lubricants: 'lubricants/none' conditions { speed_kilometres_per_hour: 1 }",
        google::rpc::INVALID_ARGUMENT);
  check("ExplainPoints",
        R"(lubricant: "lubricants/paper-fluid-1" other_lubricant: "lubricants/paper-fluid-2"
      conditions { speed_kilometres_per_hour: 110 } tolerance: 1e-3)");
  check("ExplainPoints",
        R"(lubricant: "lubricants/none" other_lubricant: "lubricants/paper-fluid-2"
      conditions { speed_kilometres_per_hour: 110 })",
        google::rpc::INVALID_ARGUMENT);
  check_simulations();
  check_campaigns();
  for (const auto* each : all_methods()) {
    EXPECT_TRUE(answered_.contains(each->name()))
        << each->name() << " has no case that is answered";
    EXPECT_TRUE(refused_.contains(each->name())) << each->name() << " has no case that is refused";
  }
}

}  // namespace
}  // namespace tribodyn::server
