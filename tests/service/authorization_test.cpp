// Who may call what: every method of the table as callers who may not, and what they can learn.
#include <gmock/gmock.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <atomic>
#include <future>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/call_dispatcher.h"
#include "server/storage/connections.h"
#include "server/storage/seeds.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using testing::HasSubstr;
using testing::Not;

constexpr Microseconds kHour = 3'600'000'000;

std::atomic<long> statement_count = 0;

/// Counts the statements of all connections that are opened while the object exists.
class StatementCount {
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

/// A call of any method without a transport.
class AnyCall : public UnaryCall, public StreamCall {
 public:
  AnyCall(const Method& row, const Message& request, const std::string& secret)
      : UnaryCall(row), StreamCall(row), bytes_(request.SerializeAsString()) {
    UnaryCall::credentials.authorization = secret.empty() ? "" : "Bearer " + secret;
    StreamCall::credentials = UnaryCall::credentials;
  }

  google::rpc::Status answer(CallDispatcher& dispatcher) {
    if (UnaryCall::method.open) {
      dispatcher.open(*this);
    } else {
      dispatcher.answer(*this);
    }
    return answer_.get_future().get();
  }

  std::size_t request_size() const override { return bytes_.size(); }
  std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() override {
    return std::make_unique<google::protobuf::io::ArrayInputStream>(
        bytes_.data(), static_cast<int>(bytes_.size()));
  }
  void drop_request() override { bytes_.clear(); }
  void answered(Outcome<Reply> outcome) override {
    answer_.set_value(outcome.ok() ? google::rpc::Status() : outcome.error());
  }
  void opened(Outcome<ReplySource> outcome) override {
    answer_.set_value(outcome.ok() ? google::rpc::Status() : outcome.error());
  }

 private:
  std::string bytes_;
  std::promise<google::rpc::Status> answer_;
};

/// Sets every name of a request: parent, name and names, also of the resource that it holds.
void set_names(Message& message, const std::string& project, const std::string& id) {
  static const std::map<std::string, std::string> kCollections = {{"Lubricant", "lubricants"},
                                                                  {"GearSet", "gearSets"},
                                                                  {"Surface", "surfaces"},
                                                                  {"Vehicle", "vehicles"},
                                                                  {"Simulation", "simulations"}};
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

class Authorization : public testing::Test {
 protected:
  Authorization() {
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

  google::rpc::Status answer(const Method& row, const std::string& project, const std::string& id,
                             const std::string& secret) {
    const std::unique_ptr<Message> request(row.request->New());
    set_names(*request, project, id);
    return AnyCall(row, *request, secret).answer(dispatcher_);
  }

  /// The answers about what exists and what does not are the same, with this code and reason, and
  /// no row was read for them.
  void expect_refused(const Method& row, const std::string& secret, google::rpc::Code code,
                      const std::string& reason) {
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

  StatementCount count_;
  Bench bench_;
  Application app_ = bench_.application();
  std::vector<StoredToken> tokens_;
  CallDispatcher dispatcher_{app_};
};

TEST_F(Authorization, EveryMethodRefusesWhoeverHasNoValidTokenAndReadsNoRow) {
  for (const Method& row : dispatcher_.methods()) {
    for (const char* secret : {"", "unknown", "expired", "revoked"}) {
      expect_refused(row, secret, google::rpc::UNAUTHENTICATED, "UNAUTHENTICATED");
    }
  }
}

TEST_F(Authorization, EveryMethodRefusesATokenOfAnotherProjectAndReadsNoRow) {
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

TEST_F(Authorization, EveryMethodRefusesATooSmallScopeAndReadsNoRow) {
  std::map<Scope, int> methods;
  for (const Method& row : dispatcher_.methods()) {
    ++methods[row.scope];
    if (row.scope > Scope::kRead) {
      expect_refused(row, "reader", google::rpc::PERMISSION_DENIED, "SCOPE_TOO_SMALL");
    }
    if (row.scope > Scope::kWrite) {
      expect_refused(row, "writer", google::rpc::PERMISSION_DENIED, "SCOPE_TOO_SMALL");
    }
  }
  EXPECT_EQ(methods[Scope::kAdmin], 4) << "purges";
  EXPECT_EQ(methods.size(), 3U);
}

TEST_F(Authorization, WhatOnlyReadsNeedsTheScopeReadAndWhatErasesTheScopeAdmin) {
  for (const Method& row : dispatcher_.methods()) {
    const std::string& name = row.descriptor->name();
    const auto begins = [&name](const char* word) { return name.starts_with(word); };
    const bool reads =
        begins("Get") || begins("List") || begins("Watch") || begins("Read") || begins("Evaluate");
    const Scope scope = reads ? Scope::kRead : begins("Purge") ? Scope::kAdmin : Scope::kWrite;
    EXPECT_EQ(row.scope, scope) << name;
  }
}

TEST_F(Authorization, NoMethodRefusesATokenOfSufficientScopeForAllProjects) {
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

TEST_F(Authorization, ATokenIsRefusedFromTheMomentOfItsRevocation) {
  const Credentials reader{.authorization = "bearer reader"};
  const auto grant = app_.authorizer->authenticate(reader, system_time());
  ASSERT_TRUE(grant.ok());
  EXPECT_EQ(grant.message()->principal, "reader");
  EXPECT_TRUE(grant.message()->is_valid(system_time()));
  for (StoredToken& each : tokens_) {
    if (each.name == "reader") each.revoke_time = system_time();
  }
  app_.authorizer->set_tokens(tokens_, system_time());
  EXPECT_FALSE(app_.authorizer->authenticate(reader, system_time()).ok());
  EXPECT_FALSE(grant.message()->is_valid(system_time())) << "for calls that began before";
  const auto writer = app_.authorizer->authenticate({.authorization = "Bearer writer"}, 0);
  EXPECT_TRUE(writer.ok()) << "the others stay";
}

TEST_F(Authorization, ATokenIsRefusedFromItsEndOn) {
  tokens_.back().expire_time = 2 * kHour;
  app_.authorizer->set_tokens(tokens_, kHour);
  const Credentials admin{.authorization = "Bearer admin"};
  EXPECT_TRUE(app_.authorizer->authenticate(admin, 2 * kHour - 1).ok());
  EXPECT_FALSE(app_.authorizer->authenticate(admin, 2 * kHour).ok());
}

TEST_F(Authorization, OtherFormsOfTheHeaderAreRefused) {
  for (const std::string& header :
       {std::string("admin"), std::string("Basic admin"), std::string("Bearer"),
        std::string("Bearer "), std::string("Bearer  admin"), std::string("Bearer admin "),
        "Bearer " + std::string(1'000'000, 'x'), std::string("Beare\0 admin", 12)}) {
    const auto grant = app_.authorizer->authenticate({.authorization = header}, 0);
    EXPECT_EQ(grant.error().code(), google::rpc::UNAUTHENTICATED) << header.substr(0, 20);
    EXPECT_THAT(grant.error().message(), Not(HasSubstr("admin")));
  }
}

TEST_F(Authorization, TheOverviewOfAllProjectsNeedsATokenForAllOfThem) {
  const auto code = [&](const Credentials& credentials) {
    const auto refused = app_.authorizer->refuse_overview(credentials, system_time());
    return refused ? refused->code() : google::rpc::OK;
  };
  EXPECT_EQ(code({.is_owner = true}), google::rpc::OK);
  EXPECT_EQ(code({.authorization = "Bearer reader"}), google::rpc::OK);
  EXPECT_EQ(code({.authorization = "Bearer plant"}), google::rpc::PERMISSION_DENIED);
  EXPECT_EQ(code({}), google::rpc::UNAUTHENTICATED);
}

}  // namespace
}  // namespace tribodyn::server
