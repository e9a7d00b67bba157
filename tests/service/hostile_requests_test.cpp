// Sends hostile requests that parse to every method of tribodynd. request_fuzzer sends many more of
// them without gRPC.
#include <gmock/gmock.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "tests/service/contract_methods.h"
#include "tests/service/grpc_fixture.h"
#include "tests/service/raw_client.h"
#include "tests/support/hostile_message.h"
#include "tests/support/paths.h"

namespace tribodyn::server {
namespace {

using google::protobuf::Message;
using google::protobuf::MessageFactory;
using google::protobuf::MethodDescriptor;
using testing::AllOf;
using testing::Ne;

constexpr int kRequests = 30;  // for each method
constexpr int kMostChanges = 5;

/// Returns valid requests of a method in text format; an empty one if the corpus has none.
std::vector<std::string> valid_requests(const MethodDescriptor& method) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(request_corpus_folder())) {
    std::ifstream file(entry.path());
    std::string name;
    std::getline(file, name);
    if (name != method.name()) continue;
    out.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  std::sort(out.begin(), out.end());
  if (out.empty()) out.emplace_back();
  return out;
}

bool has_reason(const grpc::Status& status) {
  google::rpc::Status details;
  details.ParseFromString(status.error_details());
  for (const auto& any : details.details()) {
    google::rpc::ErrorInfo info;
    if (any.UnpackTo(&info) && !info.reason().empty()) return true;
  }
  return false;
}

std::unique_ptr<Message> new_request(const MethodDescriptor& method) {
  return std::unique_ptr<Message>(
      MessageFactory::generated_factory()->GetPrototype(method.input_type())->New());
}

class HostileRequestsTest : public GrpcTest {
 protected:
  grpc::Status call(const MethodDescriptor& method, const Message& request) {
    return RawClient(channel_).call(path_of(method), request.SerializeAsString()).first;
  }

  void send(const MethodDescriptor& method, const Message& request) {
    const grpc::Status status = call(method, request);
    if (status.ok()) {
      ++answered_;
      return;
    }
    ++refused_;
    EXPECT_THAT(status.error_code(),
                AllOf(Ne(grpc::StatusCode::INTERNAL), Ne(grpc::StatusCode::UNKNOWN),
                      Ne(grpc::StatusCode::UNAVAILABLE), Ne(grpc::StatusCode::DATA_LOSS),
                      Ne(grpc::StatusCode::DEADLINE_EXCEEDED)))
        << method.name() << ": " << status.error_message() << "\n"
        << request.ShortDebugString();
    EXPECT_TRUE(has_reason(status)) << method.name() << "\n" << request.ShortDebugString();
  }

  int answered_ = 0;
  int refused_ = 0;
};

TEST_F(HostileRequestsTest, AreMadeFromRequestsThatAreAccepted) {
  for (const MethodDescriptor* method : all_methods()) {
    for (const std::string& text : valid_requests(*method)) {
      const std::unique_ptr<Message> request = new_request(*method);
      ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(text, request.get())) << text;
      if (text.empty()) continue;  // the corpus has none
      const grpc::Status status = call(*method, *request);
      EXPECT_TRUE(status.ok()) << method->name() << ": " << status.error_message() << "\n"
                               << status.error_details();
    }
  }
}

TEST_F(HostileRequestsTest, AreAnsweredOrRefusedWithAReason) {
  HostileMessages hostile(20261122);
  for (const MethodDescriptor* method : all_methods()) {
    if (method->server_streaming()) continue;  // a watch may last as long as its simulation
    const std::vector<std::string> valid = valid_requests(*method);
    const std::unique_ptr<Message> request = new_request(*method);
    for (int i = 0; i < kRequests; ++i) {
      const std::string& text = valid[static_cast<std::size_t>(i) % valid.size()];
      ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(text, request.get())) << text;
      for (int change = 0; change < i % (kMostChanges + 1); ++change) hostile.mutate(*request);
      send(*method, *request);
    }
  }
  EXPECT_GT(answered_, 100);
  EXPECT_GT(refused_, 100);
  EXPECT_TRUE(process_->running()) << process_->log();
}

}  // namespace
}  // namespace tribodyn::server
