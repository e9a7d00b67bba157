// Who may call what, without a transport; by REST: rest_authorization_test.cpp.
#include <gmock/gmock.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "tests/service/authorization_table.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Message;
using testing::HasSubstr;
using testing::Not;

constexpr Microseconds kHour = 3'600'000'000;

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

class Authorization : public AuthorizationTable {
 protected:
  google::rpc::Status call(const Method& row, const Message& request,
                           const std::string& secret) override {
    return AnyCall(row, request, secret).answer(dispatcher_);
  }
};

TEST_F(Authorization, EveryMethodRefusesWhoeverHasNoValidTokenAndReadsNoRow) {
  refuses_whoever_has_no_valid_token();
}

TEST_F(Authorization, EveryMethodRefusesATokenOfAnotherProjectAndReadsNoRow) {
  refuses_a_token_of_another_project();
}

TEST_F(Authorization, EveryMethodRefusesATooSmallScopeAndReadsNoRow) {
  refuses_a_too_small_scope();
}

TEST_F(Authorization, WhatOnlyReadsNeedsTheScopeReadAndWhatErasesTheScopeAdmin) {
  for (const Method& row : dispatcher_.methods()) {
    const std::string& name = row.descriptor->name();
    const auto begins = [&name](const char* word) { return name.starts_with(word); };
    const bool reads = begins("Get") || begins("List") || begins("Watch") || begins("Read") ||
                       begins("Evaluate") || begins("Compare") || begins("Explain") ||
                       begins("Rank") || begins("Find") || begins("Estimate");
    const Scope scope = reads ? Scope::kRead : begins("Purge") ? Scope::kAdmin : Scope::kWrite;
    EXPECT_EQ(row.scope, scope) << name;
  }
}

TEST_F(Authorization, NoMethodRefusesATokenOfSufficientScopeForAllProjects) {
  admits_a_sufficient_token_for_all_projects();
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
