#pragma once

#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "google/rpc/code.pb.h"
#include "google/rpc/status.pb.h"
#include "server/application/call_dispatcher.h"
#include "tests/service/support.h"

namespace tribodyn::server {

/// The table of who may call what: every method as callers who may not. How a call is made is the
/// transport's: the cases are the same for each.
class AuthorizationTable : public testing::Test {
 protected:
  AuthorizationTable();
  ~AuthorizationTable() override;

  /// Makes a call with the token `secret`; "": without one. Returns its error, or OK.
  virtual google::rpc::Status call(const Method& row, const google::protobuf::Message& request,
                                   const std::string& secret) = 0;

  // The cases.
  void refuses_whoever_has_no_valid_token();
  void refuses_a_token_of_another_project();
  void refuses_a_too_small_scope();
  void admits_a_sufficient_token_for_all_projects();

  google::rpc::Status answer(const Method& row, const std::string& project, const std::string& id,
                             const std::string& secret);

  class StatementCount;
  const std::unique_ptr<StatementCount> count_;
  Bench bench_;
  Application app_ = bench_.application();
  std::vector<StoredToken> tokens_;
  CallDispatcher dispatcher_{app_};

 private:
  /// The answers about what exists and what does not are the same, with this code and reason, and
  /// no row was read for them.
  void expect_refused(const Method& row, const std::string& secret, google::rpc::Code code,
                      const std::string& reason);
};

}  // namespace tribodyn::server
