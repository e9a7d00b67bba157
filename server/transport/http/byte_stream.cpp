#include "server/transport/http/byte_stream.h"

#include <sys/socket.h>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include "server/transport/tls_context.h"

namespace tribodyn::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Protocol = asio::generic::stream_protocol;
using TimedStream = beast::basic_stream<Protocol, asio::io_context::executor_type>;

TimedStream stream_of(asio::io_context& context, int connection) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(connection, reinterpret_cast<sockaddr*>(&address), &size);
  TimedStream out(context);
  out.socket().assign(Protocol(address.ss_family, 0), connection);
  return out;
}

/// What both kinds share: times and the socket of the timed stream below.
class SocketStream : public ByteStream {
 public:
  using ByteStream::ByteStream;
  void expires_after(std::chrono::milliseconds time) override { timed().expires_after(time); }
  void expires_never() override { timed().expires_never(); }
  void wait_for_input(Ready ready) override {
    timed().socket().async_wait(asio::socket_base::wait_read, std::move(ready));
  }
  int descriptor() override {
    return timed().socket().is_open() ? timed().socket().native_handle() : -1;
  }
  void close() override {
    Error ignored;
    timed().socket().shutdown(asio::socket_base::shutdown_both, ignored);
    timed().socket().close(ignored);
  }

 protected:
  virtual TimedStream& timed() = 0;
};

class PlainStream final : public SocketStream {
 public:
  PlainStream(asio::io_context& context, int connection)
      : SocketStream(context.get_executor()), stream_(stream_of(context, connection)) {}

  void handshake(Ready ready) override {
    asio::post(get_executor(), [ready = std::move(ready)] { ready({}); });
  }
  std::string client_certificate() override { return {}; }
  void finish(Ready ready) override {
    // The client may still send what nobody reads; with these bytes unread a close would reset the
    // connection, and the client might lose the answer.
    Error failure;
    stream_.socket().shutdown(asio::socket_base::shutdown_send, failure);
    ready(failure);
  }

 private:
  void read_some(asio::mutable_buffer buffer, Done done) override {
    stream_.async_read_some(buffer, std::move(done));
  }
  void write_some(std::vector<asio::const_buffer> buffers, Done done) override {
    stream_.async_write_some(buffers, std::move(done));
  }
  TimedStream& timed() override { return stream_; }

  TimedStream stream_;
};

/// asio::ssl::context releases what it holds, so it gets a reference of its own.
asio::ssl::context share(const std::shared_ptr<ssl_ctx_st>& tls) {
  SSL_CTX_up_ref(tls.get());
  return asio::ssl::context(tls.get());
}

class TlsStream final : public SocketStream {
 public:
  TlsStream(asio::io_context& context, int connection, const std::shared_ptr<ssl_ctx_st>& tls)
      : SocketStream(context.get_executor()),
        context_(share(tls)),
        stream_(stream_of(context, connection), context_) {}

  void handshake(Ready ready) override {
    stream_.async_handshake(asio::ssl::stream_base::server, std::move(ready));
  }
  std::string client_certificate() override { return certificate_name(stream_.native_handle()); }
  void finish(Ready ready) override { stream_.async_shutdown(std::move(ready)); }

 private:
  void read_some(asio::mutable_buffer buffer, Done done) override {
    stream_.async_read_some(buffer, std::move(done));
  }
  void write_some(std::vector<asio::const_buffer> buffers, Done done) override {
    stream_.async_write_some(buffers, std::move(done));
  }
  TimedStream& timed() override { return stream_.next_layer(); }

  asio::ssl::context context_;
  beast::ssl_stream<TimedStream> stream_;
};

}  // namespace

std::unique_ptr<ByteStream> byte_stream(asio::io_context& context, int connection,
                                        const std::shared_ptr<ssl_ctx_st>& tls) {
  if (tls == nullptr) return std::make_unique<PlainStream>(context, connection);
  return std::make_unique<TlsStream>(context, connection, tls);
}

}  // namespace tribodyn::server
