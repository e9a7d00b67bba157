#include "server/metrics/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <map>
#include <mutex>
#include <utility>

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
  prometheus::Gauge* waiting = nullptr;
  prometheus::Gauge* running = nullptr;
  prometheus::Gauge* waiting_seconds = nullptr;
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
  const auto gauge = [&registry](const char* name, const char* help) {
    return &prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
  };
  families_->waiting = gauge("tribodyn_simulations_waiting", "Simulations in the queue");
  families_->running = gauge("tribodyn_simulations_running", "Simulations in computation");
  families_->waiting_seconds = gauge("tribodyn_waiting_processor_seconds",
                                     "Estimated cost of the queue, in seconds of one processor");
}

Metrics::~Metrics() = default;

void Metrics::observe(Phase phase, double seconds) {
  families_->phases.at(phase)->Observe(seconds);
}

void Metrics::count(Submission submission) { families_->submissions.at(submission)->Increment(); }

void Metrics::count(SimulationOutcome outcome) { families_->outcomes.at(outcome)->Increment(); }

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

std::string Metrics::text(const Occupancy& occupancy) const {
  families_->waiting->Set(static_cast<double>(occupancy.waiting));
  families_->running->Set(static_cast<double>(occupancy.running));
  families_->waiting_seconds->Set(occupancy.waiting_seconds);
  return prometheus::TextSerializer().Serialize(families_->registry.Collect());
}

}  // namespace tribodyn::server
