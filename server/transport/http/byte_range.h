#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/transport/http/http_message.h"

namespace tribodyn::server {

/// Bytes `first` to `last` of a body, both included.
struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

/// Returns the range of a header Range (RFC 9110, 14.1.2) within a body of `length` bytes; nullopt
/// if it asks for the whole body, for several ranges or in other units, which a server may ignore.
/// Sets `is_unsatisfiable`, and returns nullopt, if the range begins behind the end of the body.
std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t length,
                                     bool& is_unsatisfiable);

/// Offers ranges of a body of `length` bytes that never changes. Makes the response 206 or 416, and
/// returns the range of a 206, if the request is a GET with the header Range and, if it has the
/// header If-Range, this has the ETag of the response. `response` has the status 200 and a strong
/// ETag.
std::optional<ByteRange> offer_range(const HttpRequest& request, std::uint64_t length,
                                     HttpResponse& response);
/// The same, and cuts the body of the response.
void offer_range(const HttpRequest& request, HttpResponse& response);

/// Cuts a range out of a body that comes in parts.
class RangeCutter {
 public:
  explicit RangeCutter(const ByteRange& range) : range_(range) {}
  /// Returns what the range contains of the next part.
  std::string cut(const std::string& part);
  /// Returns true if no later part belongs to the range.
  bool is_complete() const { return position_ > range_.last; }

 private:
  const ByteRange range_;
  std::uint64_t position_ = 0;  // of the next part
};

}  // namespace tribodyn::server
