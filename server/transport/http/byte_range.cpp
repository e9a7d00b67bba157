#include "server/transport/http/byte_range.h"

#include <algorithm>

#include "server/support/text.h"
#include "server/transport/http/rest_answer.h"

namespace tribodyn::server {
std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t length,
                                     bool& is_unsatisfiable) {
  constexpr std::string_view kUnit = "bytes=";
  is_unsatisfiable = false;
  const std::size_t dash = header.find('-');
  if (!header.starts_with(kUnit) || dash == std::string_view::npos) return std::nullopt;
  const std::string_view before = header.substr(kUnit.size(), dash - kUnit.size());
  const std::string_view after = header.substr(dash + 1);
  const auto first = parse_number<std::uint64_t>(before);
  const auto last = parse_number<std::uint64_t>(after);
  if (before.empty() && last) {  // the last so many bytes
    is_unsatisfiable = *last == 0 || length == 0;
    if (is_unsatisfiable) return std::nullopt;
    return ByteRange{length - std::min(*last, length), length - 1};
  }
  if (!first || (!last && !after.empty()) || (last && *last < *first)) return std::nullopt;
  is_unsatisfiable = *first >= length;
  if (is_unsatisfiable) return std::nullopt;
  return ByteRange{*first, last ? std::min(*last, length - 1) : length - 1};
}

std::optional<ByteRange> offer_range(const HttpRequest& request, std::uint64_t length,
                                     HttpResponse& response) {
  const std::string tag = response.headers["ETag"];
  response.headers["Accept-Ranges"] = "bytes";
  const std::string_view condition = request.header("if-range");
  if (request.verb != "GET" || (!condition.empty() && condition != tag)) return std::nullopt;
  bool is_unsatisfiable = false;
  const auto range = parse_range(request.header("range"), length, is_unsatisfiable);
  if (is_unsatisfiable) {
    response = http_error(416, "the body has " + std::to_string(length) + " bytes");
    response.headers["ETag"] = tag;
    response.headers["Content-Range"] = "bytes */" + std::to_string(length);
  } else if (range) {
    response.status = 206;
    response.headers["Content-Range"] = "bytes " + std::to_string(range->first) + "-" +
                                        std::to_string(range->last) + "/" + std::to_string(length);
  }
  return range;
}

void offer_range(const HttpRequest& request, HttpResponse& response) {
  const auto range = offer_range(request, response.body.size(), response);
  if (range) response.body = response.body.substr(range->first, range->last - range->first + 1);
}

std::string RangeCutter::cut(const std::string& part) {
  const std::uint64_t begin = std::clamp(range_.first, position_, position_ + part.size());
  const std::uint64_t end = std::clamp(range_.last + 1, begin, position_ + part.size());
  std::string out = part.substr(begin - position_, end - begin);
  position_ += part.size();
  return out;
}

}  // namespace tribodyn::server
