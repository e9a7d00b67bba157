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

namespace tribodyn::server {

/// What answers a unary call, and what answers a stream.
using Reply = std::unique_ptr<google::protobuf::Message>;
using ReplySource = std::shared_ptr<AnyMessageSource>;

/// A method of the contract, as every transport serves it.
struct Method {
  template <class Answer>
  using UseCase = std::function<Outcome<Answer>(
      Application&, const google::protobuf::Message& request, const CallContext&)>;

  const google::protobuf::MethodDescriptor* descriptor;
  const google::protobuf::Message* request;  ///< the prototypes
  const google::protobuf::Message* response;
  CallLane lane;              ///< of requests up to kUsualRequestBytes; kHeavy of others
  UseCase<Reply> answer;      ///< of a unary method, else null
  UseCase<ReplySource> open;  ///< of a method that answers with a stream, else null
};

/// Every method of the contract. Throws std::logic_error if a method has no row or two.
std::vector<Method> method_table();

}  // namespace tribodyn::server
