#pragma once

#include <functional>
#include <string>

namespace tribodyn::crash {

/// While it lives, `hook` is called before each system call of this process that names, removes or
/// syncs a file, with the call and its paths ("rename /a/b /a/c", "fsync /a/b"). Where the hook
/// returns another value than 0, the call fails with that errno. The calls of SQLite and of the
/// standard library are included. One object at a time, for calls of one thread.
class FileCallHook {
 public:
  using Hook = std::function<int(const std::string& call)>;
  explicit FileCallHook(Hook hook);
  ~FileCallHook();
  FileCallHook(const FileCallHook&) = delete;
  FileCallHook& operator=(const FileCallHook&) = delete;
};

/// Runs an action in a forked process. Returns its exit code, which is 0 once the action is done
/// and 1 if the action throws, or 128 + the number of the signal that killed it. Requires that this
/// process has one thread.
int run_in_child(const std::function<void()>& action);

}  // namespace tribodyn::crash
