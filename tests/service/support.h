#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
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

/// The steps of a program whose present schema is 2, with one more table than schema 1.
SchemaSteps two_schemas();

/// A temporary folder. The destructor removes it.
class TemporaryFolder {
 public:
  enum class Kind {
    kDisk,
    kMemory,  ///< in memory, for thousands of commits; on disk if there is no such file system
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

/// Returns a lookup of the seeds without a database.
ResourceLookup seed_lookup();

/// Returns the seed with this name.
template <class Resource>
Resource seed(const std::string& name) {
  Resource resource;
  resource.ParseFromString(seed_lookup().find({name, 0})->body);
  return resource;
}

/// Returns the detail of this type of an error; nullopt if it has none.
template <class Detail>
std::optional<Detail> detail(const google::rpc::Status& status) {
  for (const auto& any : status.details()) {
    Detail out;
    if (any.UnpackTo(&out)) return out;
  }
  return std::nullopt;
}

/// Returns the violations of an error, "path: sentence" each.
std::vector<std::string> complaint_lines(const google::rpc::Status& refusal);
/// Returns the violations as one text, one for each line.
std::string complaints(const google::rpc::Status& refusal);

/// Return valid requests that tests change.
v1::EvaluateContactRequest contact_request();
v1::Simulation point_simulation();
v1::Simulation curve_simulation();

/// Returns a simulation that runs for minutes on any machine: a curve of a thousand points with a
/// very small tolerance.
v1::Simulation long_simulation(v1::SteadyStateMethod method = v1::STEADY_STATE_METHOD_MARCH);

/// Records log lines of every level while the object exists. Create it before any other thread
/// logs, and destroy it after the last one.
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

/// Returns studies that answer at once with invented numbers: speed in, speed out, 1.5 %
/// inefficiency.
StudyFunctions quick_studies();

/// Returns studies that report progress until they are cancelled or `release` is set.
StudyFunctions patient_studies(const std::shared_ptr<std::atomic<bool>>& release);

/// Polls until the condition is true. Returns false after ten seconds.
bool eventually(const std::function<bool()>& condition);

/// Store with seeds, jobs and application over a temporary database.
class Bench {
 public:
  explicit Bench(StudyFunctions studies = quick_studies(), int threads = 2,
                 const QueueLimits& limits = {},
                 std::chrono::milliseconds heartbeat = std::chrono::seconds(15));

  Store& store() { return *store_; }
  std::string database() const { return folder_.file("tribodyn.db"); }
  /// Returns a connection of its own to the database. It waits at most 10 s for a lock, because
  /// threads of the bench may still write.
  SQLite::Database open_database() const {
    return {database(), SQLite::OPEN_READWRITE, 10'000 /* milliseconds */};
  }
  SimulationJobs& jobs() { return *jobs_; }
  Application application() { return {*store_, *jobs_}; }

  /// Creates a simulation, which must be accepted. Returns its name.
  std::string create(const v1::Simulation& simulation);
  std::string create(const v1::CreateSimulationRequest& request);
  v1::Simulation get(const std::string& name);
  bool reaches(const std::string& name, v1::Simulation::State state);

  /// Stops everything and opens the same database again, like a restart.
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

/// Returns rows [start, start + count) of one column of a history, which must exist.
std::vector<double> history_rows(Store& store, std::int64_t simulation, const std::string& column,
                                 std::int64_t start, std::int64_t count);

}  // namespace tribodyn::server
