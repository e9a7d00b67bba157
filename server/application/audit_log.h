#pragma once

#include <google/protobuf/message.h>

#include <filesystem>
#include <memory>
#include <string>

#include "google/rpc/status.pb.h"
#include "server/application/call_context.h"

namespace tribodyn::server {

/// A file with one line for each call that changed something or that a grant did not allow: when,
/// who, which method, the outcome and the names. No line has contents of a request. Lines are only
/// appended; a file that was renamed is replaced by a new one. Safe for concurrent access.
class AuditLog {
 public:
  /// An empty path records nothing.
  explicit AuditLog(const std::filesystem::path& file);

  /// Appends a line before the client has its answer. Throws nothing: a failure is logged.
  void record(const CallContext& call, const std::string& method, const google::rpc::Status& status,
              const std::string& names) const noexcept;

 private:
  class File;
  std::shared_ptr<File> file_;  ///< shared by copies
};

/// Returns the names in a request or an answer, separated by commas: its own, those of its resource
/// and those of the single requests of a batch; the first 20, and how many follow.
std::string audited_names(const google::protobuf::Message& message);

/// True for a request that only checks what it would do.
bool validates_only(const google::protobuf::Message& request);

}  // namespace tribodyn::server
