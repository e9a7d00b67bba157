#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "server/transport/http/http_message.h"
#include "server/transport/http/static_page.h"

namespace tribodyn::server {

/// The files of the dashboard, read once. Safe for concurrent access.
class StaticFiles {
 public:
  /// Reads all files of a folder and of those in it; `NAME.gz` is the compressed form of NAME.
  /// Throws std::runtime_error if the folder has no index.html, or if its files take more than
  /// 32 MiB.
  explicit StaticFiles(const std::filesystem::path& folder);

  /// Returns the answer to GET or HEAD of a path, or nullopt. Paths of views are no files: they are
  /// answered with index.html if the client accepts HTML and the path is not below /v1/.
  std::optional<HttpResponse> answer(const HttpRequest& request, const std::string& path) const;

 private:
  std::map<std::string, StaticPage> files_;  ///< by path, e.g. "/assets/index-1a2b.js"
};

/// Returns the folder of the dashboard beside this program: that of the build, or that of an
/// installation. Empty if there is none.
std::filesystem::path default_dashboard_folder();

}  // namespace tribodyn::server
