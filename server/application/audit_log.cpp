#include "server/application/audit_log.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/log_text.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::size_t kMostNames = 20;
constexpr std::size_t kLongestName = 200;  // [bytes]; a name in a project has at most 140

void find_audited_names(const Message& message, int depth, std::vector<std::string>& names) {
  const auto& reflection = *message.GetReflection();
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message.GetDescriptor()->field(i);
    const bool is_name = field.name() == "name" || field.name() == "names";
    if (is_name && field.type() == FieldDescriptor::TYPE_STRING) {
      for (int k = 0; field.is_repeated() && k < reflection.FieldSize(message, &field); ++k) {
        names.push_back(reflection.GetRepeatedString(message, &field, k));
      }
      if (field.is_repeated()) continue;
      std::string name = reflection.GetString(message, &field);
      if (!name.empty()) names.push_back(std::move(name));
    } else if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && depth < 2 &&
               !field.is_map()) {
      // A resource has its name at its top: of messages within it, none is looked at.
      if (message.GetDescriptor()->FindFieldByName("name") != nullptr) continue;
      for (int k = 0; field.is_repeated() && k < reflection.FieldSize(message, &field); ++k) {
        find_audited_names(reflection.GetRepeatedMessage(message, &field, k), depth + 1, names);
      }
      if (!field.is_repeated() && reflection.HasField(message, &field)) {
        find_audited_names(reflection.GetMessage(message, &field), depth + 1, names);
      }
    }
  }
}

std::string time_text() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  std::tm parts{};
  gmtime_r(&now.tv_sec, &parts);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", parts, now.tv_nsec / 1'000'000);
}

}  // namespace

/// The file, open for appending.
class AuditLog::File {
 public:
  explicit File(std::filesystem::path path) : path_(std::move(path)) {}
  ~File() {
    if (open_ >= 0) close(open_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// A failure is logged.
  void append(const std::string& line) {
    const std::lock_guard lock(mutex_);
    const int file = current();
    if (file >= 0 && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size())) {
      return;
    }
    const std::string why = std::generic_category().message(errno);
    spdlog::error("event=audit_not_written file={} cause=\"{}\"", path_.string(), why);
  }

 private:
  /// Returns the descriptor of the file with this path, which may be a new file, or -1 with errno.
  int current() {
    struct stat at_path {};
    struct stat opened {};
    const bool is_current = open_ >= 0 && lstat(path_.c_str(), &at_path) == 0 &&
                            fstat(open_, &opened) == 0 && at_path.st_ino == opened.st_ino &&
                            at_path.st_dev == opened.st_dev;
    if (is_current) return open_;
    if (open_ >= 0) close(open_);
    open_ = open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    return open_;
  }

  const std::filesystem::path path_;
  std::mutex mutex_;
  int open_ = -1;  ///< descriptor; -1: none
};

AuditLog::AuditLog(const std::filesystem::path& file)
    : file_(file.empty() ? nullptr : std::make_shared<File>(file)) {}

void AuditLog::record(const CallContext& call, const std::string& method,
                      const google::rpc::Status& status, const std::string& names) const noexcept
    try {
  if (!file_) return;
  file_->append(
      fmt::format("time={} principal={} project={} method={} code={} names={} client={} call={}\n",
                  time_text(), call.grant->principal, log_word(call.project, kLongestName), method,
                  google::rpc::Code_Name(static_cast<google::rpc::Code>(status.code())),
                  names.empty() ? "-" : names, call.client, call.request_id));
} catch (...) {  // no memory: the call goes on
  return;
}

std::string audited_names(const Message& message) {
  std::vector<std::string> names;
  find_audited_names(message, 0, names);
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < kMostNames; ++i) {
    out += (i == 0 ? "" : ",") + log_word(names[i], kLongestName);
  }
  if (names.size() > kMostNames) out += fmt::format(",+{}", names.size() - kMostNames);
  return out;
}

bool validates_only(const Message& request) {
  const auto* field = request.GetDescriptor()->FindFieldByName("validate_only");
  return field != nullptr && field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL &&
         request.GetReflection()->GetBool(request, field);
}

}  // namespace tribodyn::server
