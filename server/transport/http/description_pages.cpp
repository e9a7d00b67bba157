#include "server/transport/http/description_pages.h"

#include <memory>
#include <utility>

#include "server/transport/http/openapi.h"
#include "server/transport/http/static_page.h"

namespace tribodyn::server {
namespace {

RestHandler::Page public_page(std::string body, std::map<std::string, std::string> headers) {
  const auto page = std::make_shared<StaticPage>(std::move(body), std::move(headers));
  return {[page](const HttpRequest& request) { return page->answer(request); }, true};
}

}  // namespace

std::map<std::string, RestHandler::Page> description_pages(const std::vector<Method>& methods) {
  const std::string document = openapi_document(HttpRoutes(methods));
  std::map<std::string, RestHandler::Page> out;
  out[kOpenApiPagePath] =
      public_page(openapi_page(document),
                  {{"Content-Type", "text/html; charset=utf-8"},
                   {"Content-Security-Policy",
                    "default-src 'none'; style-src 'self'; base-uri 'none'; form-action 'none'; "
                    "frame-ancestors 'none'"}});
  out[kOpenApiStylePath] =
      public_page(openapi_style(), {{"Content-Type", "text/css; charset=utf-8"}});
  out[kOpenApiPath] = public_page(document, {{"Content-Type", "application/json; charset=utf-8"}});
  return out;
}

}  // namespace tribodyn::server
