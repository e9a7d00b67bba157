#include "tests/crash/file_call_hook.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <utility>

namespace tribodyn::crash {
namespace {

FileCallHook::Hook installed;

/// Returns 0, or the errno with which the call must fail.
int reason_to_fail(const std::string& call) { return installed ? installed(call) : 0; }

std::string path_of(int descriptor) {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), ignored)
      .string();
}

template <class Call>
int hooked(const std::string& description, const Call& call) {
  const int reason = reason_to_fail(description);
  if (reason == 0) return static_cast<int>(call());
  errno = reason;
  return -1;
}

}  // namespace

FileCallHook::FileCallHook(Hook hook) { installed = std::move(hook); }

FileCallHook::~FileCallHook() { installed = nullptr; }

int run_in_child(const std::function<void()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      action();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace tribodyn::crash

// For all libraries of the process, definitions in the program precede those of the C library.

extern "C" {

int rename(const char* from, const char* to) noexcept {
  return tribodyn::crash::hooked(std::string("rename ") + from + " " + to,
                                 [&] { return syscall(SYS_rename, from, to); });
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) noexcept {
  return tribodyn::crash::hooked(std::string("renameat2 ") + from + " " + to, [&] {
    return syscall(SYS_renameat2, from_folder, from, to_folder, to, flags);
  });
}

int link(const char* from, const char* to) noexcept {
  return tribodyn::crash::hooked(std::string("link ") + from + " " + to,
                                 [&] { return syscall(SYS_link, from, to); });
}

int unlink(const char* path) noexcept {
  return tribodyn::crash::hooked(std::string("unlink ") + path,
                                 [&] { return syscall(SYS_unlink, path); });
}

int remove(const char* path) noexcept {
  return tribodyn::crash::hooked(std::string("remove ") + path, [&] {
    const long removed = syscall(SYS_unlink, path);
    return removed != 0 && errno == EISDIR ? syscall(SYS_rmdir, path) : removed;
  });
}

int fsync(int descriptor) {
  return tribodyn::crash::hooked("fsync " + tribodyn::crash::path_of(descriptor),
                                 [&] { return syscall(SYS_fsync, descriptor); });
}

int fdatasync(int descriptor) {
  return tribodyn::crash::hooked("fsync " + tribodyn::crash::path_of(descriptor),
                                 [&] { return syscall(SYS_fdatasync, descriptor); });
}

}  // extern "C"
