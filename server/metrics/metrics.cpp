#include "server/metrics/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace tribodyn::server {
namespace {

/// Returns upper bounds from 0.1 ms to 17 minutes; each is three times the previous one.
prometheus::Histogram::BucketBoundaries boundaries() {
  prometheus::Histogram::BucketBoundaries out;
  for (double bound = 1e-4; bound < 2000; bound *= 3) out.push_back(bound);
  return out;
}

const std::map<Phase, const char*>& phase_names() {
  static const std::map<Phase, const char*> kNames = {{Phase::kQueue, "queue"},
                                                      {Phase::kValidation, "validation"},
                                                      {Phase::kOrbit, "orbit"},
                                                      {Phase::kFriction, "friction"},
                                                      {Phase::kStore, "store"}};
  return kNames;
}

/// Adds a family whose value is read for each scrape; without a value, none.
void add(prometheus::MetricType type, const char* name, const char* help,
         std::optional<double> value, std::vector<prometheus::MetricFamily>& out) {
  if (!value) return;
  prometheus::ClientMetric metric;
  metric.gauge.value = metric.counter.value = *value;
  out.push_back({name, help, type, {metric}});
}

void add_gauge(const char* name, const char* help, std::optional<double> value,
               std::vector<prometheus::MetricFamily>& out) {
  add(prometheus::MetricType::Gauge, name, help, value, out);
}

/// Adds gauges that a label tells apart.
void add_gauges(const char* name, const char* help, const char* label,
                const std::map<std::string, double>& values,
                std::vector<prometheus::MetricFamily>& out) {
  prometheus::MetricFamily family{name, help, prometheus::MetricType::Gauge, {}};
  for (const auto& [key, value] : values) {
    prometheus::ClientMetric& metric = family.metric.emplace_back();
    metric.label.push_back({label, key});
    metric.gauge.value = value;
  }
  if (!family.metric.empty()) out.push_back(std::move(family));
}

void add_workload(const Workload& load, std::vector<prometheus::MetricFamily>& out) {
  const auto number = [](auto count) { return static_cast<double>(count); };
  add_gauge("tribodyn_simulations_waiting", "Simulations in the queue",
            number(load.simulations.waiting), out);
  add_gauge("tribodyn_simulations_running", "Simulations in computation",
            number(load.simulations.running), out);
  add_gauge("tribodyn_waiting_processor_seconds",
            "Estimated cost of the simulations in the queue, in seconds of one processor",
            load.simulations.waiting_seconds, out);
  add_gauges(
      "tribodyn_campaigns", "Campaigns that have not ended, by state", "state",
      {{"running", number(load.campaigns.running)}, {"paused", number(load.campaigns.paused)}},
      out);
  add_gauge("tribodyn_campaigns_stalled",
            "Running campaigns that cannot go on, e.g. because the disk is full",
            number(load.campaigns.stalled), out);
  add_gauge("tribodyn_campaign_points_remaining", "Points that running campaigns have to compute",
            number(load.campaigns.points_left), out);
  add_gauge("tribodyn_campaign_backlog_processor_seconds",
            "Estimated cost of these points, in seconds of one processor",
            load.campaigns.seconds_left, out);
  std::map<std::string, double> waiting, running;
  for (const LaneOccupancy& each : load.lanes) {
    waiting[each.lane] = number(each.waiting);
    running[each.lane] = number(each.running);
  }
  add_gauges("tribodyn_calls_waiting", "Calls that wait for a thread, by lane", "lane", waiting,
             out);
  add_gauges("tribodyn_calls_running", "Calls on a thread, by lane", "lane", running, out);
  add_gauge("tribodyn_streams_open", "Streams that clients have open", number(load.open_streams),
            out);
}

/// Adds the metrics that every process has, under the names that Prometheus gives them.
void add_process(const ProcessUse& use, std::vector<prometheus::MetricFamily>& out) {
  add(prometheus::MetricType::Counter, "process_cpu_seconds_total",
      "Processor time of the process [s]", use.cpu_seconds, out);
  add_gauge("process_resident_memory_bytes", "Memory that the process has in RAM",
            use.resident_bytes, out);
  add_gauge("process_open_fds", "Open file descriptors, connections included", use.open_files, out);
  add_gauge("process_max_fds", "Largest number of open file descriptors", use.maximum_files, out);
  add_gauge("process_threads", "Threads of the process", use.threads, out);
  add_gauge("process_start_time_seconds", "Start of the process, in seconds since 1970",
            use.start_time_seconds, out);
}

void add_disk(const DiskUse& use, std::vector<prometheus::MetricFamily>& out) {
  add_gauge("tribodyn_disk_free_bytes", "Free space in the file system of the database",
            use.free_bytes, out);
  add_gauge("tribodyn_disk_size_bytes", "Size of the file system of the database", use.size_bytes,
            out);
  add_gauges("tribodyn_file_bytes", "Sizes of the server's files", "file", use.file_bytes, out);
}

}  // namespace

struct Metrics::Families {
  prometheus::Registry registry;
  std::map<Phase, prometheus::Histogram*> phases;
  std::map<Submission, prometheus::Counter*> submissions;
  std::map<SimulationOutcome, prometheus::Counter*> outcomes;
  prometheus::Family<prometheus::Histogram>* call_seconds = nullptr;
  prometheus::Family<prometheus::Counter>* calls = nullptr;
  std::mutex calls_mutex;
  // Guarded by calls_mutex. By method, and by method and code, each since its first call.
  std::map<std::string, prometheus::Histogram*> seconds_of;
  std::map<std::pair<std::string, std::string>, prometheus::Counter*> count_of;
  prometheus::Counter* computed_points = nullptr;
  prometheus::Counter* refused_points = nullptr;
  prometheus::Counter* tiles = nullptr;
  std::map<CampaignOutcome, prometheus::Counter*> campaign_outcomes;
  prometheus::Family<prometheus::Counter>* refusals = nullptr;
  std::vector<NamedFile> files;
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {
  prometheus::Registry& registry = families_->registry;
  auto& phases = prometheus::BuildHistogram()
                     .Name("tribodyn_phase_seconds")
                     .Help("Duration of each phase of a simulation")
                     .Register(registry);
  for (const auto& [phase, name] : phase_names()) {
    families_->phases[phase] = &phases.Add({{"phase", name}}, boundaries());
  }
  auto& submissions = prometheus::BuildCounter()
                          .Name("tribodyn_submissions_total")
                          .Help("CreateSimulation requests by outcome")
                          .Register(registry);
  for (const auto& [submission, name] : {std::pair{Submission::kQueued, "queued"},
                                         {Submission::kCacheHit, "cache_hit"},
                                         {Submission::kRepeated, "repeated"},
                                         {Submission::kTurnedAway, "turned_away"},
                                         {Submission::kInvalid, "invalid"}}) {
    families_->submissions[submission] = &submissions.Add({{"outcome", name}});
  }
  auto& outcomes = prometheus::BuildCounter()
                       .Name("tribodyn_simulations_ended_total")
                       .Help("Queued simulations that ended, by outcome")
                       .Register(registry);
  for (const auto& [outcome, name] : {std::pair{SimulationOutcome::kSucceeded, "succeeded"},
                                      {SimulationOutcome::kFailed, "failed"},
                                      {SimulationOutcome::kCancelled, "cancelled"},
                                      {SimulationOutcome::kServedByCache, "cache_hit"}}) {
    families_->outcomes[outcome] = &outcomes.Add({{"outcome", name}});
  }
  families_->call_seconds = &prometheus::BuildHistogram()
                                 .Name("tribodyn_call_seconds")
                                 .Help(
                                     "Time from the arrival of a call to its answer, or to the "
                                     "end of its stream, by method")
                                 .Register(registry);
  families_->calls = &prometheus::BuildCounter()
                          .Name("tribodyn_calls_total")
                          .Help("Calls that have ended, by method and code")
                          .Register(registry);
  auto& points = prometheus::BuildCounter()
                     .Name("tribodyn_campaign_points_total")
                     .Help("Points of campaigns in tiles that were written, by outcome")
                     .Register(registry);
  families_->computed_points = &points.Add({{"outcome", "computed"}});
  families_->refused_points = &points.Add({{"outcome", "refused"}});
  families_->tiles = &prometheus::BuildCounter()
                          .Name("tribodyn_campaign_tiles_total")
                          .Help("Tiles of campaigns that were written")
                          .Register(registry)
                          .Add({});
  auto& campaigns = prometheus::BuildCounter()
                        .Name("tribodyn_campaigns_ended_total")
                        .Help("Campaigns that ended, by outcome")
                        .Register(registry);
  for (const auto& [outcome, name] : {std::pair{CampaignOutcome::kSucceeded, "succeeded"},
                                      {CampaignOutcome::kFailed, "failed"},
                                      {CampaignOutcome::kCancelled, "cancelled"}}) {
    families_->campaign_outcomes[outcome] = &campaigns.Add({{"outcome", name}});
  }
  families_->refusals = &prometheus::BuildCounter()
                             .Name("tribodyn_refusals_total")
                             .Help("Calls that ended with an error, by its reason")
                             .Register(registry);
}

Metrics::~Metrics() = default;

void Metrics::observe(Phase phase, double seconds) {
  families_->phases.at(phase)->Observe(seconds);
}

void Metrics::count(Submission submission) { families_->submissions.at(submission)->Increment(); }

void Metrics::count(SimulationOutcome outcome) { families_->outcomes.at(outcome)->Increment(); }

void Metrics::count(CampaignOutcome outcome) {
  families_->campaign_outcomes.at(outcome)->Increment();
}

void Metrics::count_tile(std::int64_t computed_points, std::int64_t refused_points) {
  families_->tiles->Increment();
  families_->computed_points->Increment(static_cast<double>(computed_points));
  families_->refused_points->Increment(static_cast<double>(refused_points));
}

void Metrics::count_refusal(const std::string& reason, int calls) {
  families_->refusals->Add({{"reason", reason}}).Increment(calls);
}

void Metrics::count_call(const std::string& method, const std::string& code, double seconds) {
  prometheus::Histogram* histogram = nullptr;
  {
    const std::lock_guard lock(families_->calls_mutex);
    auto& of_method = families_->seconds_of[method];
    if (of_method == nullptr) {
      of_method = &families_->call_seconds->Add({{"method", method}}, boundaries());
    }
    histogram = of_method;
    auto& count = families_->count_of[{method, code}];
    if (count == nullptr) count = &families_->calls->Add({{"method", method}, {"code", code}});
    count->Increment();
  }
  histogram->Observe(seconds);
}

void Metrics::set_build(const std::string& version, const std::string& model_version,
                        const std::string& platform) {
  prometheus::BuildGauge()
      .Name("tribodyn_build_info")
      .Help("Always 1; the labels hold the versions")
      .Register(families_->registry)
      .Add({{"version", version}, {"model_version", model_version}, {"platform", platform}})
      .Set(1);
}

void Metrics::set_files(std::vector<NamedFile> files) { families_->files = std::move(files); }

std::string Metrics::text(const Workload& workload) const {
  std::vector<prometheus::MetricFamily> families = families_->registry.Collect();
  add_workload(workload, families);
  add_process(process_use(), families);
  add_disk(disk_use(families_->files), families);
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace tribodyn::server
