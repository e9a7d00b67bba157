#pragma once

#include <array>
#include <atomic>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/system/error_code.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "server/transport/http/byte_stream.h"
#include "server/transport/http/http_connections.h"

namespace tribodyn::server {

/// A connection: reads a head, a body, has the request answered, writes the response, and begins
/// again.
class HttpServer::Connections::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(Connections& all, int connection, std::string its_peer);
  ~Session() { release_body(); }

  void start();

  void close();

  bool is_open() const { return stream_.descriptor() >= 0; }
  /// True from the end of a request to the end of its answer.
  bool is_answering() const { return is_answering_; }

  /// Sends the answer of the request.
  void write(HttpResponse response);

  /// Returns false if the client has gone meanwhile.
  bool write_part(std::string part, bool is_last);
  /// Ends a connection whose client is gone or reads too slowly; one without a stream likewise.
  void drop();

  const std::string peer;

 private:
  using Error = boost::system::error_code;
  /// Writes the head of a response, then has its body made part by part.
  void begin_stream(const HttpResponse& response);
  void start_body();
  void part_written(Error failure, bool is_last);
  /// Reads and drops what a client sends while it receives a stream, to notice its hang-up.
  void drop_input();
  void read_head();
  void head_read(Error failure);
  /// Tells a client that waits for it before it sends a long body.
  void invite_body();
  void read_body();
  void handle();
  /// Cancels the call if the client goes while it waits for the answer.
  void watch_for_hangup();
  /// Before its end a client may have sent the next request, or the end of TLS.
  void note_hangup(unsigned answered);
  void refuse(int status, const std::string& message);
  void refuse(HttpResponse response);
  void release_body();
  void end();

  Connections& all_;
  const std::unique_ptr<ByteStream> connection_;
  ByteStream& stream_;               // *connection_, as Beast's functions take it
  boost::asio::steady_timer timer_;  // for a hang-up while a call is under way
  std::string certificate_;          // common name of the client's
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> head_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> body_;
  std::optional<boost::beast::http::response<boost::beast::http::string_body>> response_;
  HttpRequest request_;
  const std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
  std::size_t counted_bytes_ = 0;
  unsigned version_ = 11;
  unsigned answered_ = 0;
  bool is_kept_ = false;
  bool is_head_ = false;
  bool is_answering_ = false;
  // Of a streamed body: null from its end on, or from the failure of a write.
  std::shared_ptr<HttpStream> body_stream_;
  std::string part_;
  std::array<std::string, 2> frame_;  // what HTTP puts around a part
  std::size_t stray_bytes_ = 0;
  bool is_chunked_ = false;
  bool is_writing_ = false;
};

}  // namespace tribodyn::server
