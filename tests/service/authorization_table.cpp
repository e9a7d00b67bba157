#include "tests/service/authorization_table.h"

#include <sqlite3.h>

#include <atomic>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "google/rpc/error_details.pb.h"
#include "proto/resource_kinds.h"
#include "server/contract/resource_kinds.h"
#include "server/storage/connections.h"
#include "server/storage/seeds.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::atomic<long> statement_count = 0;

/// Sets every name of a request: parent, name and names, also of the resource that it holds.
void set_names(Message& message, const std::string& project, const std::string& id) {
#define TRIBODYN_COLLECTION(Resource, field, collection, seed) {#Resource, #collection},
  static const std::map<std::string, std::string> kCollections = {
      TRIBODYN_RESOURCE_KINDS(TRIBODYN_COLLECTION){"Simulation", "simulations"},
      {"Campaign", "campaigns"},
      {"Candidate", "campaigns"}};
#undef TRIBODYN_COLLECTION
  std::string collection = "simulations";
  for (const auto& [kind, name] : kCollections) {
    if (message.GetDescriptor()->name().find(kind) != std::string::npos) collection = name;
  }
  const std::string parent = "projects/" + project;
  const std::string name = parent + "/" + collection + "/" + id;
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    if (field.name() == "parent") {
      reflection.SetString(&message, &field, parent);
    } else if (field.name() == "name") {
      reflection.SetString(&message, &field, name);
    } else if (field.name() == "names") {
      reflection.AddString(&message, &field, name);
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && !field.is_repeated() &&
               kCollections.contains(field.message_type()->name())) {
      Message& inner = *reflection.MutableMessage(&message, &field);
      const auto* inner_name = inner.GetDescriptor()->FindFieldByName("name");
      inner.GetReflection()->SetString(&inner, inner_name, name);
    }
  }
}

std::string error_reason_of(const google::rpc::Status& status) {
  google::rpc::ErrorInfo info;
  for (const auto& detail : status.details()) {
    if (detail.UnpackTo(&info)) return info.reason();
  }
  return {};
}

}  // namespace

/// Counts the statements of all connections that are opened while the object exists.
class AuthorizationTable::StatementCount {
 public:
  StatementCount() {
    configure_sqlite();
    sqlite3_auto_extension(reinterpret_cast<void (*)()>(&trace));
  }
  ~StatementCount() { sqlite3_cancel_auto_extension(reinterpret_cast<void (*)()>(&trace)); }
  StatementCount(const StatementCount&) = delete;
  StatementCount& operator=(const StatementCount&) = delete;

 private:
  static int trace(sqlite3* db, char**, const void*) {
    return sqlite3_trace_v2(
        db, SQLITE_TRACE_STMT,
        [](unsigned int, void*, void*, void*) {
          ++statement_count;
          return 0;
        },
        nullptr);
  }
};

AuthorizationTable::AuthorizationTable() : count_(std::make_unique<StatementCount>()) {
  bench_.store().add_project("acme", seed_resources(), 1);
  const Microseconds now = system_time();
  const auto token = [&](const std::string& name, Scope scope) {
    return StoredToken{.name = name, .hash = token_hash(name), .scope = scope};
  };
  StoredToken expired = token("expired", Scope::kAdmin);
  expired.expire_time = now - 1;
  StoredToken revoked = token("revoked", Scope::kAdmin);
  revoked.revoke_time = now - 1;
  StoredToken plant = token("plant", Scope::kAdmin);
  plant.projects = {"default"};
  tokens_ = {expired,
             revoked,
             plant,
             token("reader", Scope::kRead),
             token("writer", Scope::kWrite),
             token("admin", Scope::kAdmin)};
  app_.authorizer->set_tokens(tokens_, now);
}

AuthorizationTable::~AuthorizationTable() = default;

google::rpc::Status AuthorizationTable::answer(const Method& row, const std::string& project,
                                               const std::string& id, const std::string& secret) {
  const std::unique_ptr<Message> request(row.request->New());
  set_names(*request, project, id);
  return call(row, *request, secret);
}

void AuthorizationTable::expect_refused(const Method& row, const std::string& secret,
                                        google::rpc::Code code, const std::string& reason) {
  const std::string method = row.descriptor->name() + " by " + secret;
  // The projects' names have the same length.
  const std::vector<std::pair<std::string, std::string>> places = {
      {"acme", "paper-fluid-1"}, {"acme", "no-such-thing"}, {"none", "no-such-thing"}};
  std::set<std::string> answers;
  const long before = statement_count;
  for (const auto& [project, id] : places) {
    const google::rpc::Status status = answer(row, project, id, secret);
    EXPECT_EQ(status.code(), code) << method << ": " << status.message();
    EXPECT_EQ(error_reason_of(status), reason) << method;
    std::string text = status.SerializeAsString();
    for (std::size_t at = 0; (at = text.find(project)) != std::string::npos;) {
      text.replace(at, project.size(), "PROJ");
    }
    answers.insert(text);
  }
  EXPECT_EQ(statement_count, before) << method << " read the database";
  EXPECT_EQ(answers.size(), 1U) << method;
}

void AuthorizationTable::refuses_whoever_has_no_valid_token() {
  for (const Method& row : dispatcher_.methods()) {
    for (const char* secret : {"", "unknown", "expired", "revoked"}) {
      expect_refused(row, secret, google::rpc::UNAUTHENTICATED, "UNAUTHENTICATED");
    }
  }
}

void AuthorizationTable::refuses_a_token_of_another_project() {
  int without_project = 0;
  for (const Method& row : dispatcher_.methods()) {
    if (row.descriptor->name() == "GetSchema") {
      ++without_project;
      EXPECT_EQ(answer(row, "acme", "x", "plant").code(), google::rpc::OK);
      continue;
    }
    expect_refused(row, "plant", google::rpc::PERMISSION_DENIED, "PROJECT_NOT_GRANTED");
  }
  EXPECT_EQ(without_project, 1);
}

void AuthorizationTable::refuses_a_too_small_scope() {
  std::map<Scope, std::size_t> methods;
  for (const Method& row : dispatcher_.methods()) {
    ++methods[row.scope];
    if (row.scope > Scope::kRead) {
      expect_refused(row, "reader", google::rpc::PERMISSION_DENIED, "SCOPE_TOO_SMALL");
    }
    if (row.scope > Scope::kWrite) {
      expect_refused(row, "writer", google::rpc::PERMISSION_DENIED, "SCOPE_TOO_SMALL");
    }
  }
  EXPECT_EQ(methods[Scope::kAdmin], std::size(kResourceCollections)) << "purges";
  EXPECT_EQ(methods.size(), 3U);
}

void AuthorizationTable::admits_a_sufficient_token_for_all_projects() {
  for (const Method& row : dispatcher_.methods()) {
    const std::string secret = row.scope == Scope::kRead    ? "reader"
                               : row.scope == Scope::kWrite ? "writer"
                                                            : "admin";
    for (const char* project : {"acme", "default"}) {
      const int code = answer(row, project, "no-such-thing", secret).code();
      EXPECT_NE(code, google::rpc::UNAUTHENTICATED) << row.descriptor->name();
      EXPECT_NE(code, google::rpc::PERMISSION_DENIED) << row.descriptor->name();
    }
  }
}

}  // namespace tribodyn::server
