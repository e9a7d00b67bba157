#include "server/transport/http/static_page.h"

#include <utility>

#include "server/support/sha256.h"
#include "server/transport/http/rest_answer.h"

namespace tribodyn::server {

StaticPage::StaticPage(std::string body, std::map<std::string, std::string> headers,
                       std::string compressed)
    : tag_(sha256(body)) {
  plain_.headers = std::move(headers);
  plain_.body = std::move(body);
  compressed_ = plain_;
  if (!compressed.empty()) {
    compressed_.body = std::move(compressed);
    compressed_.headers["Content-Encoding"] = "gzip";
  }
  compress("gzip", compressed_);
}

HttpResponse StaticPage::answer(const HttpRequest& request) const {
  HttpResponse out = accepts_gzip(request.header("accept-encoding")) ? compressed_ : plain_;
  set_etag(tag_, request, out);
  if (out.status == 304) out.headers.erase("Content-Encoding");
  return out;
}

}  // namespace tribodyn::server
