#include "server/transport/http/static_files.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace tribodyn::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 32 << 20;
/// Vite names a file in this folder after its content.
constexpr std::string_view kHashedFolder = "/assets/";
/// What a page may load, call and show: files and methods of this server, and pictures that the
/// page draws itself. No script or style stands within a page.
constexpr char kPagePolicy[] =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
    "require-trusted-types-for 'script'";

std::string media_type(const fs::path& file) {
  static const std::map<std::string, std::string> kTypes = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".json", "application/json"},
      {".txt", "text/plain; charset=utf-8"}};
  const auto found = kTypes.find(file.extension());
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return std::move(out).str();
}

std::map<std::string, std::string> headers_of(const std::string& path) {
  std::map<std::string, std::string> out = {{"Content-Type", media_type(path)}};
  if (path.starts_with(kHashedFolder)) {
    out["Cache-Control"] = "public, max-age=31536000, immutable";
  }
  if (path.ends_with(".html")) {
    out["Content-Security-Policy"] = kPagePolicy;
    out["Cross-Origin-Opener-Policy"] = "same-origin";
    out["Permissions-Policy"] = "camera=(), geolocation=(), microphone=()";
  }
  return out;
}

}  // namespace

StaticFiles::StaticFiles(const fs::path& folder) {
  struct File {
    std::string body, compressed;
  };
  std::map<std::string, File> files;
  std::size_t bytes = 0;
  for (const fs::directory_entry& each : fs::recursive_directory_iterator(folder)) {
    if (!each.is_regular_file()) continue;
    bytes += each.file_size();
    if (bytes > kMostBytes) {
      throw std::runtime_error(
          fmt::format("the files of {} take more than {} bytes", folder.string(), kMostBytes));
    }
    fs::path path = each.path();
    const bool is_compressed = path.extension() == ".gz";
    if (is_compressed) path.replace_extension();
    File& file = files["/" + fs::relative(path, folder).generic_string()];
    (is_compressed ? file.compressed : file.body) = content(each.path());
  }
  for (auto& [path, file] : files) {
    files_.emplace(path,
                   StaticPage(std::move(file.body), headers_of(path), std::move(file.compressed)));
  }
  if (!files_.contains("/index.html")) {
    throw std::runtime_error(folder.string() + " has no index.html");
  }
}

std::optional<HttpResponse> StaticFiles::answer(const HttpRequest& request,
                                                const std::string& path) const {
  if (request.verb != "GET" && request.verb != "HEAD") return std::nullopt;
  auto found = files_.find(path);
  if (found == files_.end()) {
    const bool is_view = !path.starts_with("/v1/") &&
                         request.header("accept").find("text/html") != std::string_view::npos;
    if (!is_view) return std::nullopt;
    found = files_.find("/index.html");
  }
  return found->second.answer(request);
}

fs::path default_dashboard_folder() {
  std::error_code missing;
  const fs::path program = fs::read_symlink("/proc/self/exe", missing).parent_path();
  for (const char* each : {"../../web/dist", "../share/tribodyn/dashboard"}) {
    fs::path folder = (program / each).lexically_normal();
    if (fs::exists(folder / "index.html", missing)) return folder;
  }
  return {};
}

}  // namespace tribodyn::server
