#include "tests/service/raw_client.h"

#include <arpa/inet.h>
#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>

namespace tribodyn::server {
namespace {

grpc::ByteBuffer buffer(const std::string& bytes) {
  const grpc::Slice slice(bytes);
  return {&slice, 1};
}

std::string text(const grpc::ByteBuffer& bytes) {
  std::vector<grpc::Slice> slices;
  if (!bytes.Valid() || !bytes.Dump(&slices).ok()) return {};
  std::string out;
  for (const grpc::Slice& slice : slices) {
    out.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  return out;
}

/// Connected or not: who turns the connection away may close it at any time.
int open_connection(int port) {
  const int descriptor = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  [[maybe_unused]] const int ignored =
      connect(descriptor, reinterpret_cast<const sockaddr*>(&name), sizeof(name));
  return descriptor;
}

}  // namespace

struct RawClient::Stream {
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call;

  /// Waits for the step just started.
  bool step() {
    void* tag = nullptr;
    bool ok = false;
    return queue.Next(&tag, &ok) && ok;
  }

  ~Stream() {
    context.TryCancel();
    queue.Shutdown();
    void* tag = nullptr;
    bool ok = false;
    while (queue.Next(&tag, &ok)) {
    }
  }
};

std::pair<grpc::Status, std::string> RawClient::call(const std::string& method,
                                                     const std::string& request) {
  grpc::GenericStub stub(channel_);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
  grpc::CompletionQueue queue;
  auto call = stub.PrepareUnaryCall(&context, method, buffer(request), &queue);
  call->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  call->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  return {status, text(response)};
}

std::shared_ptr<RawClient::Stream> RawClient::open(const std::string& method,
                                                   const std::string& request) {
  auto stream = std::make_shared<Stream>();
  grpc::GenericStub stub(channel_);
  stream->call = stub.PrepareCall(&stream->context, method, &stream->queue);
  stream->call->StartCall(nullptr);
  if (stream->step()) {
    stream->call->Write(buffer(request), nullptr);
    stream->step();
  }
  return stream;
}

std::string RawClient::list_services() {
  const auto stream = open("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
                           std::string("\x3a\x00", 2));  // list_services = 7, empty
  grpc::ByteBuffer response;
  stream->call->Read(&response, nullptr);
  return stream->step() ? text(response) : "";
}

SilentConnections::SilentConnections(int port, int count) {
  descriptors_.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) descriptors_.push_back(open_connection(port));
}

SilentConnections::~SilentConnections() {
  for (const int descriptor : descriptors_) close(descriptor);
}

void send_raw_bytes(int port, const std::string& bytes) {
  const int descriptor = open_connection(port);
  send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  close(descriptor);
}

}  // namespace tribodyn::server
