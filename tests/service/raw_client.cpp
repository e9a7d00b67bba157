#include "tests/service/raw_client.h"

#include <arpa/inet.h>
#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>

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

/// Succeeds whether or not the connection is established: the server may close it at any time.
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

  /// Waits for the started operation.
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

std::pair<grpc::Status, std::vector<std::string>> RawClient::read_all(
    const std::string& method, const std::optional<std::string>& request) {
  const auto stream = open(method, request);
  stream->call->WritesDone(nullptr);
  stream->step();
  std::vector<std::string> out;
  for (;;) {
    grpc::ByteBuffer part;
    stream->call->Read(&part, nullptr);
    if (!stream->step()) break;
    out.push_back(text(part));
  }
  grpc::Status status;
  stream->call->Finish(&status, nullptr);
  stream->step();
  return {status, out};
}

std::shared_ptr<RawClient::Stream> RawClient::open(const std::string& method,
                                                   const std::optional<std::string>& request) {
  auto stream = std::make_shared<Stream>();
  grpc::GenericStub stub(channel_);
  stream->call = stub.PrepareCall(&stream->context, method, &stream->queue);
  stream->call->StartCall(nullptr);
  if (stream->step() && request) {
    stream->call->Write(buffer(*request), nullptr);
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

namespace {

constexpr char kData = 0;
constexpr char kHeaders = 1;
constexpr char kSettings = 4;
constexpr char kPing = 6;
constexpr char kWindowUpdate = 8;
constexpr char kEndOfHeaders = 4;  // flag of headers
constexpr char kAcknowledged = 1;  // flag of settings and pings

/// Returns an HTTP/2 frame.
std::string frame(char type, char flags, int stream, const std::string& body) {
  const auto byte = [](std::size_t value, int shift) { return static_cast<char>(value >> shift); };
  const auto id = static_cast<std::size_t>(stream);
  return std::string{
             byte(body.size(), 16), byte(body.size(), 8), byte(body.size(), 0), type,       flags,
             byte(id, 24),          byte(id, 16),         byte(id, 8),          byte(id, 0)} +
         body;
}

/// Returns what begins a connection.
std::string preface() { return "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + frame(kSettings, 0, 0, ""); }

/// Returns an uncompressed header field.
std::string header(const std::string& name, const std::string& value) {
  return std::string(1, '\0') + static_cast<char>(name.size()) + name +
         static_cast<char>(value.size()) + value;
}

/// Returns the headers of a call.
std::string headers(int stream, const std::string& method) {
  return frame(kHeaders, kEndOfHeaders, stream,
               header(":method", "POST") + header(":scheme", "http") + header(":path", method) +
                   header(":authority", "x") + header("te", "trailers") +
                   header("content-type", "application/grpc"));
}

/// Reads a frame from the server; returns false after the time limit of the socket.
bool receive_frame(int descriptor, std::string& head, std::string& body) {
  const auto receive = [&](std::string& out, std::size_t count) {
    out.resize(count);
    return count == 0 ||
           recv(descriptor, out.data(), count, MSG_WAITALL) == static_cast<ssize_t>(count);
  };
  if (!receive(head, 9)) return false;
  std::size_t size = 0;
  for (int i = 0; i < 3; ++i) size = size << 8 | static_cast<unsigned char>(head[i]);
  return receive(body, size);
}

std::int64_t number_at(const std::string& bytes, std::size_t offset) {
  std::int64_t out = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    out = out << 8 | static_cast<unsigned char>(bytes[offset + i]);
  }
  return out;
}

}  // namespace

HalfSentCall::HalfSentCall(int port, const std::string& method, std::size_t size)
    : descriptor_(open_connection(port)) {
  constexpr std::int64_t kInitialWindow = 65'535;
  constexpr std::int64_t kLargestFrame = 16'384;
  const timeval limit{.tv_sec = 1, .tv_usec = 0};
  setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof(limit));
  const auto put = [this](const std::string& bytes) {
    return send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  };
  std::string message(5 + size - 1, '\x3a');  // uncompressed flag and length
  message[0] = 0;
  for (int i = 0; i < 4; ++i) message[1 + i] = static_cast<char>(size >> (24 - 8 * i));
  put(preface() + headers(1, method));
  std::int64_t of_connection = kInitialWindow;
  std::int64_t of_stream = kInitialWindow;
  std::int64_t initial = kInitialWindow;
  std::size_t sent = 0;
  std::string head;
  std::string body;
  while (sent < message.size()) {
    const std::int64_t room = std::min({of_connection, of_stream, kLargestFrame,
                                        static_cast<std::int64_t>(message.size() - sent)});
    if (room > 0) {
      if (!put(frame(kData, 0, 1, message.substr(sent, static_cast<std::size_t>(room))))) return;
      sent += static_cast<std::size_t>(room);
      of_connection -= room;
      of_stream -= room;
      continue;
    }
    if (!receive_frame(descriptor_, head, body)) return;  // the server reads no more
    const bool is_answer = (head[4] & kAcknowledged) != 0;
    if (head[3] == kWindowUpdate) {
      (head[8] == 1 ? of_stream : of_connection) += number_at(body, 0);
    } else if (head[3] == kPing && !is_answer) {
      put(frame(kPing, kAcknowledged, 0, body));
    } else if (head[3] == kSettings && !is_answer) {
      for (std::size_t i = 0; i + 6 <= body.size(); i += 6) {
        if (body[i] != 0 || body[i + 1] != 4) continue;  // SETTINGS_INITIAL_WINDOW_SIZE
        of_stream += number_at(body, i + 2) - initial;
        initial = number_at(body, i + 2);
      }
      put(frame(kSettings, kAcknowledged, 0, ""));
    }
  }
}

HalfSentCall::~HalfSentCall() { close(descriptor_); }

HeadersOfCalls::HeadersOfCalls(int port, const std::string& method, int count)
    : descriptor_(open_connection(port)) {
  std::string bytes = preface();
  for (int i = 0; i < count; ++i) bytes += headers(1 + 2 * i, method);
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t now = send(descriptor_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now <= 0) return;
    sent += static_cast<std::size_t>(now);
  }
}

HeadersOfCalls::~HeadersOfCalls() { close(descriptor_); }

bool HeadersOfCalls::is_closed() const {
  char bytes[4096];
  for (;;) {
    const ssize_t count = recv(descriptor_, bytes, sizeof(bytes), MSG_DONTWAIT);
    if (count <= 0) return count == 0 || errno == ECONNRESET;
  }
}

void send_raw_bytes(int port, const std::string& bytes) {
  const int descriptor = open_connection(port);
  send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  close(descriptor);
}

}  // namespace tribodyn::server
