#include "tests/benchmark/load_client.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

namespace tribodyn {
namespace {

using Clock = std::chrono::steady_clock;

/// Gathers what requests report from whichever thread.
class Gatherer {
 public:
  void add(Clock::time_point begin, bool ok) {
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    const std::lock_guard lock(mutex_);
    out_.seconds.push_back(seconds);
    if (!ok) ++out_.failures;
    ++ended_;
    changed_.notify_all();
  }
  /// Until so many have ended.
  void wait(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended_ >= count; });
  }
  Latencies take() {
    const std::lock_guard lock(mutex_);
    std::sort(out_.seconds.begin(), out_.seconds.end());
    return std::move(out_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Latencies out_;  // guarded by mutex_
  int ended_ = 0;  // guarded by mutex_
};

}  // namespace

double Latencies::percentile(double share) const {
  if (seconds.empty()) return 0;
  const auto place = static_cast<std::size_t>(share * static_cast<double>(seconds.size()));
  return seconds[std::min(place, seconds.size() - 1)];
}

Latencies open_loop(double requests_per_second, std::chrono::duration<double> time,
                    const StartRequest& start) {
  Gatherer gatherer;
  const auto begin = Clock::now();
  const int count = static_cast<int>(requests_per_second * time.count());
  for (int i = 0; i < count; ++i) {
    const auto due = begin + std::chrono::duration_cast<Clock::duration>(
                                 std::chrono::duration<double>(i / requests_per_second));
    std::this_thread::sleep_until(due);
    start(i, [&gatherer, due](bool ok) { gatherer.add(due, ok); });
  }
  gatherer.wait(count);
  return gatherer.take();
}

Latencies closed_loop(int under_way, int count, const StartRequest& start) {
  Gatherer gatherer;
  for (int i = 0; i < count; ++i) {
    gatherer.wait(i - under_way + 1);
    start(i, [&gatherer, begin = Clock::now()](bool ok) { gatherer.add(begin, ok); });
  }
  gatherer.wait(count);
  return gatherer.take();
}

ProcessFigures process_figures(int process_id) {
  const std::string folder = "/proc/" + std::to_string(process_id);
  ProcessFigures out;
  std::ifstream status(folder + "/status");
  for (std::string line; std::getline(status, line);) {
    const std::string value = line.substr(line.find(':') + 1);
    if (line.starts_with("VmRSS:")) out.resident_bytes = 1024 * std::stod(value);
    if (line.starts_with("RssAnon:")) out.anonymous_bytes = 1024 * std::stod(value);
    if (line.starts_with("RssFile:")) out.file_bytes = 1024 * std::stod(value);
    if (line.starts_with("RssShmem:")) out.shared_bytes = 1024 * std::stod(value);
    if (line.starts_with("Threads:")) out.threads = std::stoi(value);
  }
  std::ifstream stat(folder + "/stat");
  std::string word;
  for (int field = 1; field <= 15 && stat >> word; ++field) {
    if (field < 14) continue;  // clock ticks in user mode, then in the kernel
    out.processor_seconds += std::stod(word) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  std::error_code ignored;
  for ([[maybe_unused]] const auto& each :
       std::filesystem::directory_iterator(folder + "/fd", ignored)) {
    ++out.descriptors;
  }
  return out;
}

int server_of(const std::string& database) {
  int process_id = 0;
  std::ifstream(database + ".lock") >> process_id;
  return process_id;
}

double memory_growth(int process_id, const std::function<void()>& action) {
  const double before = process_figures(process_id).resident_bytes;
  double most = before;
  std::atomic<bool> stop = false;
  std::thread sampler([&] {
    while (!stop) {
      most = std::max(most, process_figures(process_id).resident_bytes);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  action();
  stop = true;
  sampler.join();
  return most - before;
}

}  // namespace tribodyn
