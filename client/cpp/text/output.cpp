#include "client/cpp/text/output.h"

#include <google/protobuf/util/json_util.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "client/cpp/failure.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {

std::string json_text(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  if (!status.ok()) throw Failure(kExitFailed, "cannot write JSON: " + status.ToString());
  return text;
}

std::string json_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string json_number(double value) { return std::isfinite(value) ? shortest(value) : "null"; }

std::string json_with(std::string object, const std::string& name, const std::string& value) {
  object.erase(object.rfind('}'));
  object.erase(object.find_last_not_of(" \n") + 1);
  return object + (object.back() == '{' ? "" : ",") + "\n " + json_quoted(name) + ": " + value +
         "\n}\n";
}

void write_file(const std::string& path, const std::string& text) {
  write_file(path, [&](std::ostream& file) { file << text; });
}

void write_file(const std::string& path, const std::function<void(std::ostream&)>& write) {
  struct stat info;
  // Only a regular file can be replaced; a pipe or a device (/dev/stdout) is written in place.
  const bool replace = stat(path.c_str(), &info) != 0 || S_ISREG(info.st_mode);
  const std::string target = replace ? path + ".part" + std::to_string(getpid()) : path;
  {
    std::ofstream file(target, std::ios::binary);
    write(file);
    file.close();
    if (!file) {
      const std::string why = std::strerror(errno);
      if (replace) unlink(target.c_str());
      throw Failure(kExitFailed, "cannot write " + path + ": " + why);
    }
  }
  if (replace && std::rename(target.c_str(), path.c_str()) != 0) {
    const std::string why = std::strerror(errno);
    unlink(target.c_str());
    throw Failure(kExitFailed, "cannot write " + path + ": " + why);
  }
}

std::string why_not_writable(const std::string& path) {
  struct stat info;
  const bool exists = stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) return "is a folder";
  // Replacing a file requires permission to write to its folder.
  std::string target = path;
  if (!exists || S_ISREG(info.st_mode)) {
    const std::size_t slash = path.rfind('/');
    target = slash == std::string::npos ? "." : path.substr(0, std::max<std::size_t>(slash, 1));
  }
  return access(target.c_str(), W_OK) == 0 ? "" : std::strerror(errno);
}

}  // namespace tribodyn::client
