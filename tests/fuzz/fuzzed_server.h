#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "server/application/application.h"
#include "server/storage/seeds.h"

namespace tribodyn::server {

/// Ends the process, which libFuzzer reports as a crash, unless the condition holds.
inline void require(bool condition) {
  if (!condition) std::abort();
}

/// The application over a database with the seeds. Nothing runs: simulations stay queued.
class FuzzedServer {
 public:
  FuzzedServer()
      : folder_(folder()),
        store_(folder_ / "tribodyn.db"),
        jobs_(store_, {}),
        application_{store_, jobs_} {
    static const std::vector<NewResource> kSeeds = seed_resources();
    store_.add_project("default", kSeeds, system_time());
  }
  ~FuzzedServer() {
    jobs_.stop();
    std::filesystem::remove_all(folder_);
  }
  FuzzedServer(const FuzzedServer&) = delete;
  FuzzedServer& operator=(const FuzzedServer&) = delete;

  Application& application() { return application_; }

 private:
  static std::filesystem::path folder() {
    const std::filesystem::path memory = "/dev/shm";
    const auto parent =
        std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    std::string name = (parent / "tribodyn_fuzzer.XXXXXX").string();
    require(mkdtemp(name.data()) != nullptr);
    return name;
  }

  const std::filesystem::path folder_;
  Store store_;
  SimulationJobs jobs_;
  Application application_;
};

}  // namespace tribodyn::server
