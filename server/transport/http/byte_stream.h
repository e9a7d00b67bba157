#pragma once

#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

struct ssl_ctx_st;

namespace tribodyn::server {

/// A connection of the HTTP server, in the clear or by TLS. Beast's templates take this one type of
/// stream and so are compiled once, and those of TLS in a file of their own. Used on the thread of
/// its io_context.
class ByteStream {
 public:
  using Error = boost::system::error_code;
  using Done = std::function<void(Error, std::size_t)>;
  using Ready = std::function<void(Error)>;
  using executor_type = boost::asio::io_context::executor_type;

  explicit ByteStream(const executor_type& executor) : executor_(executor) {}
  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  executor_type get_executor() const { return executor_; }

  /// Has to end before the first read.
  virtual void handshake(Ready ready) = 0;
  /// Returns the common name of the client's certificate, which the handshake has verified; "" if
  /// there is none.
  virtual std::string client_certificate() = 0;
  /// Writes the end of the stream, after which the client may read no more.
  virtual void finish(Ready ready) = 0;

  /// A read, a write or a handshake that has not ended after `time` fails, and the connection is
  /// closed.
  virtual void expires_after(std::chrono::milliseconds time) = 0;
  virtual void expires_never() = 0;
  /// Waits until the system has bytes from the client, or its end.
  virtual void wait_for_input(Ready ready) = 0;
  /// Returns -1 if the connection is closed.
  virtual int descriptor() = 0;
  virtual void close() = 0;

  // As Asio's concepts AsyncReadStream and AsyncWriteStream require.
  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    const boost::asio::mutable_buffer first = *boost::asio::buffer_sequence_begin(buffers);
    return boost::asio::async_initiate<Handler, void(Error, std::size_t)>(
        [this, first](auto&& done) {
          read_some(first, copyable(std::forward<decltype(done)>(done)));
        },
        handler);
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    std::vector<boost::asio::const_buffer> all(boost::asio::buffer_sequence_begin(buffers),
                                               boost::asio::buffer_sequence_end(buffers));
    return boost::asio::async_initiate<Handler, void(Error, std::size_t)>(
        [this, &all](auto&& done) {
          write_some(std::move(all), copyable(std::forward<decltype(done)>(done)));
        },
        handler);
  }

 private:
  virtual void read_some(boost::asio::mutable_buffer buffer, Done done) = 0;
  virtual void write_some(std::vector<boost::asio::const_buffer> buffers, Done done) = 0;

  /// Beast's handlers can only be moved.
  template <class Handler>
  static Done copyable(Handler&& handler) {
    auto shared = std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
    return [shared](Error failure, std::size_t count) { std::move (*shared)(failure, count); };
  }

  const executor_type executor_;
};

/// Takes over a connected socket. With `tls` it speaks TLS as the server; null: in the clear.
std::unique_ptr<ByteStream> byte_stream(boost::asio::io_context& context, int connection,
                                        const std::shared_ptr<ssl_ctx_st>& tls);

}  // namespace tribodyn::server
