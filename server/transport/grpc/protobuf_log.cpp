#include "server/transport/grpc/protobuf_log.h"

#include <google/protobuf/stubs/logging.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <mutex>
#include <string>

#include "server/application/log_text.h"

namespace tribodyn::server {
namespace {

using std::chrono::steady_clock;

constexpr auto kReportInterval = std::chrono::seconds(1);
constexpr std::size_t kLongestReport = 300;

void log_report(google::protobuf::LogLevel, const char*, int, const std::string& message) {
  static std::mutex mutex;
  static steady_clock::time_point next;  // guarded by mutex
  static int left_out = 0;               // guarded by mutex
  const std::lock_guard lock(mutex);
  if (steady_clock::now() < next) {
    ++left_out;
    return;
  }
  spdlog::warn("event=protobuf_report left_out_before={} text=\"{}\"", left_out,
               log_text(message, kLongestReport));
  next = steady_clock::now() + kReportInterval;
  left_out = 0;
}

}  // namespace

void log_protobuf_reports() { google::protobuf::SetLogHandler(log_report); }

}  // namespace tribodyn::server
