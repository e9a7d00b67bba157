#include "server/transport/http/rest_answer.h"

#include <google/protobuf/util/json_util.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "google/protobuf/wrappers.pb.h"
#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/errors.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr char kJson[] = "application/json; charset=utf-8";
constexpr std::size_t kLeastCompressed = 1024;  // shorter bodies fit into a packet [bytes]

template <class Detail>
std::optional<Detail> detail_of(const google::rpc::Status& error) {
  Detail out;
  for (const auto& detail : error.details()) {
    if (detail.UnpackTo(&out)) return out;
  }
  return std::nullopt;
}

/// The value of the message's own field "etag", or "".
std::string own_etag(const google::protobuf::Message& message) {
  const auto* field = message.GetDescriptor()->FindFieldByName("etag");
  if (field == nullptr) return {};
  return message.GetReflection()->GetString(message, field);
}

/// True if a list of entity tags holds this one, or is "*". Weak tags compare as strong ones.
bool lists_tag(std::string_view list, std::string_view tag) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(','), list.size());
    std::string_view each = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (!each.empty() && each.front() == ' ') each.remove_prefix(1);
    while (!each.empty() && each.back() == ' ') each.remove_suffix(1);
    if (each.starts_with("W/")) each.remove_prefix(2);
    if (each == tag || each == "*") return true;
  }
  return false;
}

}  // namespace

bool accepts_gzip(std::string_view header) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(','), header.size());
    std::string each;
    for (const char character : header.substr(0, end)) {
      if (character != ' ') {
        each += static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
      }
    }
    header.remove_prefix(std::min(end + 1, header.size()));
    if (each == "gzip" || (each.starts_with("gzip;q=") && each != "gzip;q=0")) return true;
  }
  return false;
}

std::string json_of(const google::protobuf::Message& message, bool with_zeros) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = with_zeros;
  std::string out;
  const auto status = google::protobuf::util::MessageToJsonString(message, &out, options);
  if (!status.ok()) throw std::logic_error(status.ToString());
  return out;
}

namespace {

/// Text as a JSON string, with its quotes.
std::string quoted(const std::string& text) {
  google::protobuf::StringValue value;
  value.set_value(text);
  return json_of(value, false);
}

}  // namespace

int http_status(const google::rpc::Status& error) {
  const auto info = detail_of<google::rpc::ErrorInfo>(error);
  if (info && info->reason() == reason_text(v1::ERROR_REASON_ETAG_MISMATCH)) return 412;
  switch (error.code()) {
    case google::rpc::OK:
      return 200;
    case google::rpc::INVALID_ARGUMENT:
    case google::rpc::FAILED_PRECONDITION:
    case google::rpc::OUT_OF_RANGE:
      return 400;
    case google::rpc::UNAUTHENTICATED:
      return 401;
    case google::rpc::PERMISSION_DENIED:
      return 403;
    case google::rpc::NOT_FOUND:
      return 404;
    case google::rpc::ALREADY_EXISTS:
    case google::rpc::ABORTED:
      return 409;
    case google::rpc::RESOURCE_EXHAUSTED:
      return 429;
    case google::rpc::CANCELLED:
      return 499;
    case google::rpc::UNIMPLEMENTED:
      return 501;
    case google::rpc::UNAVAILABLE:
      return 503;
    case google::rpc::DEADLINE_EXCEEDED:
      return 504;
    default:
      return 500;
  }
}

HttpResponse error_response(const google::rpc::Status& error) {
  return error_response(error, http_status(error));
}

HttpResponse error_response(const google::rpc::Status& error, int status) {
  HttpResponse out;
  out.status = status;
  out.headers["Content-Type"] = kJson;
  if (const auto retry = detail_of<google::rpc::RetryInfo>(error)) {
    const std::int64_t seconds = retry->retry_delay().seconds();
    out.headers["Retry-After"] = std::to_string(seconds + (retry->retry_delay().nanos() > 0));
  }
  if (error.code() == google::rpc::UNAUTHENTICATED) {
    out.headers["WWW-Authenticate"] = "Bearer realm=\"tribodyn\"";
  } else if (const auto info = detail_of<google::rpc::ErrorInfo>(error);
             info && info->reason() == reason_text(v1::ERROR_REASON_SCOPE_TOO_SMALL)) {
    out.headers["WWW-Authenticate"] = "Bearer realm=\"tribodyn\", error=\"insufficient_scope\"";
  }
  // google.rpc.Status states the code of the call as "code"; AIP-193 puts the HTTP status there.
  google::rpc::Status details;
  *details.mutable_details() = error.details();
  std::string list = json_of(details, false);
  const std::size_t begin = list.find('[');
  list = begin == std::string::npos ? "[]" : list.substr(begin, list.rfind(']') - begin + 1);
  out.body = "{\"error\":{\"code\":" + std::to_string(status) +
             ",\"message\":" + quoted(error.message()) + ",\"status\":\"" +
             google::rpc::Code_Name(static_cast<google::rpc::Code>(error.code())) +
             "\",\"details\":" + list + "}}";
  return out;
}

HttpResponse http_error(int status, const std::string& message) {
  return error_response(
      error(google::rpc::INVALID_ARGUMENT, v1::ERROR_REASON_INVALID_HTTP, message), status);
}

HttpResponse message_response(const google::protobuf::Message& message, const HttpRequest& request,
                              bool with_zeros) {
  HttpResponse out;
  out.headers["Content-Type"] = kJson;
  out.body = json_of(message, with_zeros);
  const std::string own = own_etag(message);
  set_etag(own.empty() ? sha256(out.body) : own, request, out);
  return out;
}

void set_etag(const std::string& tag, const HttpRequest& request, HttpResponse& response) {
  const std::string quoted_tag = '"' + tag + '"';
  response.headers["ETag"] = quoted_tag;
  const bool is_get = request.verb == "GET" || request.verb == "HEAD";
  if (!is_get || !lists_tag(request.header("if-none-match"), quoted_tag)) return;
  response.status = 304;
  response.headers.erase("Content-Type");
  response.body.clear();
}

void compress(std::string_view accept_encoding, HttpResponse& response) {
  response.headers["Vary"] = "Accept, Accept-Encoding";
  const bool is_compressed = response.headers.contains("Content-Encoding");
  if (is_compressed || response.status == 206 || response.body.size() < kLeastCompressed ||
      !accepts_gzip(accept_encoding)) {
    return;
  }
  constexpr int kGzipWindow = 15 + 16;  // 32 kB, with gzip's header
  constexpr int kMemoryLevel = 8;       // zlib's default
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    return;  // no memory: the plain body is as good
  }
  std::string out(deflateBound(&stream, response.body.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(response.body.data());
  stream.avail_in = static_cast<uInt>(response.body.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const bool is_whole = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (!is_whole) return;
  response.body = std::move(out);
  response.headers["Content-Encoding"] = "gzip";
  // A strong tag would let a client join bytes of both forms.
  if (response.headers.contains("Accept-Ranges")) {
    response.headers["ETag"] = "W/" + response.headers["ETag"];
  }
}

}  // namespace tribodyn::server
