#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "google/rpc/status.pb.h"
#include "server/application/application.h"
#include "server/contract/resource_names.h"
#include "server/execution/simulation_jobs.h"
#include "server/storage/store.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

/// A folder that goes when the object goes.
class TemporaryFolder {
 public:
  enum class Kind {
    kDisk,
    kMemory,  ///< for thousands of commits; where there is none, on disk
  };
  explicit TemporaryFolder(Kind kind = Kind::kDisk);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// The seeds as a lookup, without a database.
ResourceLookup seed_lookup();

/// The seed of that name.
template <class Resource>
Resource seed(const std::string& name) {
  Resource resource;
  resource.ParseFromString(seed_lookup().find({name, 0})->body);
  return resource;
}

/// The violations that a refusal lists, "path: sentence" each.
std::vector<std::string> complaint_lines(const google::rpc::Status& refusal);
/// The same as one text, a line each.
std::string complaints(const google::rpc::Status& refusal);

/// Acceptable requests, to be spoilt by tests.
v1::EvaluateContactRequest contact_request();
v1::Simulation point_simulation();
v1::Simulation curve_simulation();

/// Minutes of work on any machine, for tests that need a simulation which runs: a curve of a
/// thousand points, each settled far sharper than anybody needs.
v1::Simulation long_simulation(v1::SteadyStateMethod method = v1::STEADY_STATE_METHOD_MARCH);

/// What is logged while it lives, of every level. Made before any other thread logs, and destroyed
/// after the last one has.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

/// Studies that answer at once with made-up numbers: speed in, speed out, 1.5 % inefficiency.
StudyFunctions quick_studies();

/// Studies that report progress until they are stopped, or until `release` is set.
StudyFunctions patient_studies(const std::shared_ptr<std::atomic<bool>>& release);

/// Polls until the condition holds; false after ten seconds.
bool eventually(const std::function<bool()>& condition);

/// Store with seeds, jobs and application over a temporary database.
class Bench {
 public:
  explicit Bench(StudyFunctions studies = quick_studies(), int threads = 2,
                 const QueueLimits& limits = {},
                 std::chrono::milliseconds heartbeat = std::chrono::seconds(15));

  Store& store() { return *store_; }
  std::string database() const { return folder_.file("tribodyn.db"); }
  SimulationJobs& jobs() { return *jobs_; }
  Application application() { return {*store_, *jobs_}; }

  /// Creates a simulation that must be accepted; its name.
  std::string create(const v1::Simulation& simulation);
  std::string create(const v1::CreateSimulationRequest& request);
  v1::Simulation get(const std::string& name);
  bool reaches(const std::string& name, v1::Simulation::State state);

  /// Stops everything and opens the same database again, as after a restart.
  void restart(StudyFunctions studies);

 private:
  void open(StudyFunctions studies);

  TemporaryFolder folder_;
  int threads_;
  QueueLimits limits_;
  std::chrono::milliseconds heartbeat_;
  std::unique_ptr<Store> store_;
  std::unique_ptr<SimulationJobs> jobs_;
};

}  // namespace tribodyn::server
