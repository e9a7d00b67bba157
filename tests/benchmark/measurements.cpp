#include "tests/benchmark/measurements.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "core/contact/flank_contact_batch.h"

namespace tribodyn {
namespace {

/// Held until the end of a scope; other processes wait.
class FileLock {
 public:
  explicit FileLock(const std::string& path)
      : descriptor_(open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0 || flock(descriptor_, LOCK_EX) != 0) {
      throw std::runtime_error("cannot lock " + path);
    }
  }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock() { close(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace

bool is_met(const Measurement& m) {
  if (!m.target) return true;
  return m.at_most ? m.value <= *m.target : m.value >= *m.target;
}

void record(const std::string& path, const std::vector<Measurement>& measurements) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  const FileLock lock(path + ".lock");
  nlohmann::json list = nlohmann::json::array();
  if (std::ifstream old(path); old) {
    const nlohmann::json read = nlohmann::json::parse(old, nullptr, false);
    if (read.is_array()) list = read;
  }
  for (const Measurement& m : measurements) {
    nlohmann::json entry = {{"name", m.name},    {"value", m.value}, {"unit", m.unit},
                            {"target", nullptr}, {"met", nullptr},   {"machine", machine_name()}};
    if (m.target) {
      entry["target"] = *m.target;
      entry["met"] = is_met(m);
    }
    const auto same = std::find_if(list.begin(), list.end(), [&](const nlohmann::json& e) {
      return e.value("name", "") == m.name;
    });
    if (same != list.end()) {
      *same = entry;
    } else {
      list.push_back(entry);
    }
  }
  const std::string fresh = path + ".new";
  {
    std::ofstream out(fresh);
    out << "[\n";
    for (std::size_t i = 0; i < list.size(); ++i) {
      out << list[i].dump() << (i + 1 < list.size() ? ",\n" : "\n");
    }
    out << "]\n";
    if (!out) throw std::runtime_error("cannot write " + fresh);
  }
  std::filesystem::rename(fresh, path);
}

void print(const std::vector<Measurement>& measurements) {
  for (const Measurement& m : measurements) {
    std::printf("%-52s %10.4g %-22s", m.name.c_str(), m.value, m.unit.c_str());
    if (m.target) {
      std::printf(" %s %g: %s", m.at_most ? "at most" : "at least", *m.target,
                  is_met(m) ? "met" : "missed");
    }
    std::printf("\n");
  }
}

std::string machine_name() {
  std::string processor = "unknown processor";
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      processor = line.substr(colon + 2);
      break;
    }
  }
  return processor + ", " + std::to_string(std::thread::hardware_concurrency()) + " processors, " +
         FlankContactBatch::name(FlankContactBatch::widest());
}

double processor_seconds() {
  timespec at{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
  return static_cast<double>(at.tv_sec) + 1e-9 * static_cast<double>(at.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace tribodyn
