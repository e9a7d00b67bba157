// 10,000 lubricants against 100: a page, a filter, an order, a get. Ends with the ratios of the
// medians, and with exit code 1 when one of them reaches 3. Compare only figures of one run.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

constexpr double kMostRatio = 3;

/// A store of `count` lubricants of ten projects, each tenth used, every one with its own sample.
class Library {
 public:
  explicit Library(int count) : count_(count) {
    v1::Lubricant lubricant = seed<v1::Lubricant>("lubricants/paper-fluid-1");
    lubricant.clear_name();
    std::vector<NewResource> all;
    for (int i = 0; i < count; ++i) {
      lubricant.set_name(fmt::format("lubricants/oil-{:05}", i));
      lubricant.set_display_name(fmt::format("Blend {}", i));
      lubricant.set_external_sample_id(fmt::format("S{:06}", (i * 7919) % count));
      lubricant.set_condition(i % 10 == 0 ? v1::Lubricant::USED : v1::Lubricant::FRESH);
      lubricant.set_pressure_viscosity_coefficient_per_pascal(1e-8 + 1e-12 * ((i * 31) % count));
      lubricant.clear_labels();
      v1::Label* label = lubricant.add_labels();
      label->set_key("project");
      label->set_value(fmt::format("p{}", i % 10));
      all.push_back({lubricant.name(), lubricant.SerializeAsString()});
    }
    bench_.store().add_project("default", all, system_time());
  }

  void list(const std::string& filter, const std::string& order) {
    v1::ListLubricantsRequest request;
    request.set_page_size(10);
    request.set_filter(filter);
    request.set_order_by(order);
    const auto page = list_lubricants(app_, request);
    if (!page.ok() || page.message().lubricants().empty()) std::abort();
    benchmark::DoNotOptimize(page);
  }

  /// A page from the middle of the list.
  void later_page() {
    if (token_.empty()) {
      v1::ListLubricantsRequest request;
      request.set_page_size(count_ / 2);
      while (request.page_size() > 0) {
        const auto page = list_lubricants(app_, request).message();
        token_ = page.next_page_token();
        request.set_page_token(token_);
        request.set_page_size(std::max(0, request.page_size() - page.lubricants_size()));
      }
    }
    v1::ListLubricantsRequest request;
    request.set_page_size(10);
    request.set_page_token(token_);
    if (list_lubricants(app_, request).message().lubricants_size() != 10) std::abort();
  }

  void get() {
    v1::GetLubricantRequest request;
    request.set_name(fmt::format("lubricants/oil-{:05}", next_++ * 31 % count_));
    if (!get_lubricant(app_, request).ok()) std::abort();
  }

  std::string sample() { return fmt::format("S{:06}", next_++ * 31 % count_); }

 private:
  int count_;
  int next_ = 0;
  std::string token_;
  Bench bench_;
  Application app_ = bench_.application();
};

Library& library(int count) {
  static std::map<int, Library*> kLibraries;
  Library*& found = kLibraries[count];
  if (found == nullptr) found = new Library(count);
  return *found;
}

struct Case {
  const char* name;
  std::function<void(Library&)> run;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> kCases = {
      {"first_page", [](Library& all) { all.list("", ""); }},
      {"later_page", [](Library& all) { all.later_page(); }},
      {"last_names", [](Library& all) { all.list("", "name desc"); }},
      {"filter_by_label", [](Library& all) { all.list("labels.project = p3", ""); }},
      {"filter_by_two",
       [](Library& all) { all.list("labels.project = p0 AND condition = USED", ""); }},
      {"filter_by_sample",
       [](Library& all) { all.list("external_sample_id = " + all.sample(), ""); }},
      {"filter_by_number",
       [](Library& all) { all.list("pressure_viscosity_coefficient_per_pascal < 1.001e-8", ""); }},
      {"filter_and_order",
       [](Library& all) {
         all.list("labels.project = p3", "pressure_viscosity_coefficient_per_pascal desc");
       }},
      {"order_by_number",
       [](Library& all) { all.list("", "pressure_viscosity_coefficient_per_pascal"); }},
      {"get", [](Library& all) { all.get(); }},
  };
  return kCases;
}

/// Keeps the medians for the verdict.
class Reporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.aggregate_name == "median")
        medians_[run.run_name.function_name] = run.GetAdjustedRealTime();
    }
  }

  bool verdict() const {
    bool good = true;
    for (const Case& each : cases()) {
      const double ratio = median(each.name, 10'000) / median(each.name, 100);
      good = good && ratio < kMostRatio;
      fmt::print("{:20} {:6.2f} times as long with 10,000 as with 100{}\n", each.name, ratio,
                 ratio < kMostRatio ? "" : "  TOO SLOW");
    }
    return good;
  }

 private:
  double median(const std::string& name, int count) const {
    const auto found = medians_.find(name + "/" + std::to_string(count));
    return found == medians_.end() ? std::nan("") : found->second;
  }
  std::map<std::string, double> medians_;
};

void add_benchmarks() {
  for (const Case& each : cases()) {
    for (const int count : {100, 10'000}) {
      benchmark::RegisterBenchmark((each.name + ("/" + std::to_string(count))).c_str(),
                                   [each, count](benchmark::State& state) {
                                     Library& all = library(count);
                                     each.run(all);
                                     for (auto _ : state) each.run(all);
                                   })
          ->Unit(benchmark::kMicrosecond)
          ->MinTime(0.05)
          ->Repetitions(9)
          ->ReportAggregatesOnly();
    }
  }
}

}  // namespace
}  // namespace tribodyn::server

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  tribodyn::server::add_benchmarks();
  tribodyn::server::Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return reporter.verdict() ? 0 : 1;
}
