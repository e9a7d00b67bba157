#pragma once

#include <map>
#include <string>

#include "server/transport/http/http_message.h"

namespace tribodyn::server {

/// A body that never changes, with its ETag, compressed once.
class StaticPage {
 public:
  /// `headers` are those of every answer, Content-Type among them. `compressed` is the body by
  /// gzip; if it is empty, the constructor compresses the body.
  StaticPage(std::string body, std::map<std::string, std::string> headers,
             std::string compressed = {});

  HttpResponse answer(const HttpRequest& request) const;

 private:
  std::string tag_;
  HttpResponse plain_;
  HttpResponse compressed_;
};

}  // namespace tribodyn::server
