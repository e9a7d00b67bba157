#pragma once

#include <functional>
#include <string>

namespace tribodyn::crash {

/// Calls `hook` before each system call of this process that names, removes or syncs a file, while
/// the object exists. The hook receives the call and its paths ("rename /a/b /a/c", "fsync /a/b").
/// If it does not return 0, the call fails with that errno. Calls of SQLite and of the standard
/// library are included. Only one object may exist, for calls of one thread.
class FileCallHook {
 public:
  using Hook = std::function<int(const std::string& call)>;
  explicit FileCallHook(Hook hook);
  ~FileCallHook();
  FileCallHook(const FileCallHook&) = delete;
  FileCallHook& operator=(const FileCallHook&) = delete;
};

/// Runs an action in a forked process. Returns its exit code: 0 after the action, 1 if the action
/// throws, or 128 + the number of the signal that killed it. Requires that this process has one
/// thread.
int run_in_child(const std::function<void()>& action);

}  // namespace tribodyn::crash
