#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <functional>
#include <memory>
#include <vector>

#include "server/application/application.h"
#include "server/application/call_context.h"
#include "server/application/call_lanes.h"
#include "server/application/message_source.h"
#include "server/application/outcome.h"
#include "server/application/request_limits.h"
#include "server/storage/stored_token.h"

namespace tribodyn::server {

/// The answer to a unary call, and the source of the messages of a stream.
using Reply = std::unique_ptr<google::protobuf::Message>;
using ReplySource = std::shared_ptr<AnyMessageSource>;

/// One row of the table of methods: what a transport needs to serve a method.
struct Method {
  template <class Answer>
  using UseCase = std::function<Outcome<Answer>(
      Application&, const google::protobuf::Message& request, const CallContext&)>;

  const google::protobuf::MethodDescriptor* descriptor;
  const google::protobuf::Message* request;   ///< prototype
  const google::protobuf::Message* response;  ///< prototype
  Scope scope;                                ///< that a principal needs
  CallLane lane;              ///< of requests up to kUsualRequestBytes; larger ones take kHeavy
  UseCase<Reply> answer;      ///< null for a streaming method
  UseCase<ReplySource> open;  ///< null for a unary method
  /// Returns true for a request that takes about a millisecond or less; null: as the lane says.
  std::function<bool(const google::protobuf::Message& request)> is_short = nullptr;
};

/// Returns one row for every method of the contract. Throws std::logic_error if a method has none
/// or two.
std::vector<Method> method_table();

}  // namespace tribodyn::server
