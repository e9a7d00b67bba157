#include "server/metrics/system_use.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

namespace tribodyn::server {
namespace {

namespace fs = std::filesystem;

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Returns the fields of /proc/self/stat that follow the name of the program, which may contain
/// blanks: the first one is field 3 of proc(5).
std::vector<std::string> stat_fields() {
  std::ifstream file("/proc/self/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream fields(text.substr(name_end + 1));
  return {std::istream_iterator<std::string>(fields), {}};
}

std::optional<double> open_files() {
  std::error_code failure;
  double count = -1;  // without the descriptor that reads the folder
  fs::directory_iterator file("/proc/self/fd", failure);
  for (; !failure && file != fs::directory_iterator(); file.increment(failure)) ++count;
  if (failure) return std::nullopt;
  return count;
}

}  // namespace

ProcessUse process_use() {
  ProcessUse out;
  out.cpu_seconds = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  out.maximum_files = static_cast<double>(limit.rlim_cur);
  out.open_files = open_files();
  const std::vector<std::string> fields = stat_fields();
  const auto field = [&](std::size_t number) { return std::stod(fields.at(number - 3)); };
  constexpr std::size_t kThreads = 20, kStartTime = 22, kResidentPages = 24;  // proc(5)
  if (fields.size() <= kResidentPages - 3) return out;
  out.threads = field(kThreads);
  out.resident_bytes = field(kResidentPages) * static_cast<double>(sysconf(_SC_PAGESIZE));
  // Taken once: a second result would differ by microseconds, which looks like a restart.
  static const double kBootTime = seconds_of(CLOCK_REALTIME) - seconds_of(CLOCK_BOOTTIME);
  out.start_time_seconds =
      kBootTime + field(kStartTime) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return out;
}

DiskUse disk_use(const std::vector<NamedFile>& files) {
  DiskUse out;
  if (files.empty()) return out;
  struct statvfs system {};
  // Of the folder: the file may be renamed, and the disk full all the same.
  if (statvfs(files.front().path.parent_path().c_str(), &system) == 0) {
    const auto block = static_cast<double>(system.f_frsize);
    out.size_bytes = block * static_cast<double>(system.f_blocks);
    out.free_bytes = block * static_cast<double>(system.f_bavail);
  }
  for (const NamedFile& each : files) {
    struct stat found {};
    if (stat(each.path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) continue;
    out.file_bytes[each.name] = static_cast<double>(found.st_size);
  }
  return out;
}

}  // namespace tribodyn::server
