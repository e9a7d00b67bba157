// What authorization adds to a get: the same call by a token, which is hashed, looked up and
// counted against its quota, and by the owner over a Unix socket, who is recognised by the
// connection. The two take turns in one run, without a transport, so that the difference is the
// guard's alone. Then how long one principal waits for gets and INTERACTIVE simulations while
// another one floods the server with calls and simulations.
// usage: guard_benchmark RESULTS.json [calls]
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/application/call_dispatcher.h"
#include "server/application/simulations.h"
#include "server/contract/resource_names.h"
#include "tests/benchmark/measurements.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

constexpr char kToken[] =
    "tribodyn_0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
constexpr int kWarmUp = 2000;

/// A get without a transport.
class Get : public UnaryCall {
 public:
  Get(const Method& row, const std::string& request, bool has_token)
      : UnaryCall(row), request_(request) {
    credentials.is_owner = !has_token;
    if (has_token) credentials.authorization = std::string("Bearer ") + kToken;
  }
  /// Returns the time until the answer [s].
  double seconds(CallDispatcher& dispatcher) {
    const auto begin = std::chrono::steady_clock::now();
    dispatcher.answer(*this);
    answered_.get_future().get();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  std::size_t request_size() const override { return request_.size(); }
  std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() override {
    return std::make_unique<google::protobuf::io::ArrayInputStream>(
        request_.data(), static_cast<int>(request_.size()));
  }
  void drop_request() override {}
  void answered(Outcome<Reply> outcome) override {
    if (!outcome.ok()) std::fprintf(stderr, "%s\n", outcome.error().message().c_str());
    answered_.set_value();
  }

 private:
  const std::string& request_;
  std::promise<void> answered_;
};

/// A get of the principal "flood" that is repeated as soon as it is answered, until `is_stopping`.
class EndlessGet : public UnaryCall {
 public:
  EndlessGet(const Method& row, const std::string& request, CallDispatcher& dispatcher,
             std::atomic<bool>& is_stopping, std::atomic<int>& open)
      : UnaryCall(row),
        request_(request),
        dispatcher_(dispatcher),
        is_stopping_(is_stopping),
        open_(open) {
    credentials.authorization = "Bearer flood";
  }
  /// Deletes itself when it has been answered.
  void start() {
    ++open_;
    dispatcher_.answer(*this);
  }
  std::size_t request_size() const override { return request_.size(); }
  std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() override {
    return std::make_unique<google::protobuf::io::ArrayInputStream>(
        request_.data(), static_cast<int>(request_.size()));
  }
  void drop_request() override {}
  void answered(Outcome<Reply>) override {
    const std::unique_ptr<EndlessGet> self(this);
    if (!is_stopping_) {
      (new EndlessGet(method, request_, dispatcher_, is_stopping_, open_))->start();
    }
    --open_;
  }

 private:
  const std::string& request_;
  CallDispatcher& dispatcher_;
  std::atomic<bool>& is_stopping_;
  std::atomic<int>& open_;
};

/// Studies of 10 ms that could stop each millisecond.
StudyFunctions short_studies() {
  StudyFunctions out = quick_studies();
  out.solve_operating_point = [inner = out.solve_operating_point](
                                  const Scene& scene, const OperatingCondition& condition,
                                  const PointOptions& options, const auto& gear_set) {
    for (int i = 0; i < 10; ++i) {
      options.progress(0.1 * i);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return inner(scene, condition, options, gear_set);
  };
  return out;
}

double percentile_99(std::vector<double> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Creates a simulation that is computed in any case. Returns its name.
std::string create(Application& app, const std::string& principal, v1::SchedulingClass kind) {
  auto grant = std::make_shared<Grant>();
  grant->principal = principal;
  CallContext call;
  call.grant = grant;
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = point_simulation();
  request.set_force(true);
  request.set_scheduling_class(kind);
  return create_simulation(app, request, call).message().name();
}

/// Times of `count` gets of the principal "anna" [s].
std::vector<double> gets(CallDispatcher& dispatcher, const Method& row, const std::string& request,
                         int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    out.push_back(Get(row, request, true).seconds(dispatcher));
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return out;
}

/// Times from the submission of INTERACTIVE simulations of "anna" to their results [s].
std::vector<double> simulations(Bench& bench, Application& app, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string name = create(app, "anna", v1::SCHEDULING_CLASS_INTERACTIVE);
    const std::int64_t id = *simulation_id(name);
    while (bench.store().simulation(id)->state != StoredState::kSucceeded) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    out.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return out;
}

std::vector<Measurement> measure_flood() {
  constexpr int kGets = 5000, kSimulations = 200, kFloodCalls = 500, kFloodSimulations = 5000;
  Bench bench(short_studies());
  Application app = bench.application();
  app.authorizer = std::make_shared<Authorizer>();
  app.authorizer->set_tokens(
      {{.name = "anna", .hash = token_hash(kToken), .scope = Scope::kRead},
       {.name = "flood", .hash = token_hash("flood"), .scope = Scope::kRead}},
      0);
  CallDispatcher dispatcher(app);
  const auto row =
      std::find_if(dispatcher.methods().begin(), dispatcher.methods().end(),
                   [](const Method& each) { return each.descriptor->name() == "GetLubricant"; });
  v1::GetLubricantRequest message;
  message.set_name("lubricants/paper-fluid-1");
  const std::string request = message.SerializeAsString();
  const double gets_alone = percentile_99(gets(dispatcher, *row, request, kGets));
  const double simulations_alone = percentile_99(simulations(bench, app, kSimulations));
  for (int i = 0; i < kFloodSimulations; ++i)
    create(app, "flood", v1::SCHEDULING_CLASS_UNSPECIFIED);
  const double simulations_beside = percentile_99(simulations(bench, app, kSimulations));
  std::atomic<bool> is_stopping = false;
  std::atomic<int> open = 0;
  for (int i = 0; i < kFloodCalls; ++i) {
    (new EndlessGet(*row, request, dispatcher, is_stopping, open))->start();
  }
  const double gets_beside = percentile_99(gets(dispatcher, *row, request, kGets));
  is_stopping = true;
  while (open > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return {
      {"flood: p99 of a get alone", 1e3 * gets_alone, "ms", {}},
      {"flood: p99 of a get while another principal has 500 waiting", 1e3 * gets_beside, "ms", {}},
      {"flood: p99 of an INTERACTIVE simulation of 10 ms alone", 1e3 * simulations_alone, "ms", {}},
      {"flood: the same while another principal has thousands waiting",
       1e3 * simulations_beside,
       "ms",
       {}}};
}

int run(const std::string& results, int calls) {
  Bench bench;
  Application app = bench.application();
  app.authorizer = std::make_shared<Authorizer>(Quota{.calls_per_second = 1e6, .streams = 200});
  std::vector<StoredToken> tokens;
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "other-" + std::to_string(i);
    tokens.push_back({.name = name, .hash = token_hash(name), .scope = Scope::kRead});
  }
  tokens.push_back({.name = "anna", .hash = token_hash(kToken), .scope = Scope::kRead});
  app.authorizer->set_tokens(tokens, 0);
  CallDispatcher dispatcher(app);
  const auto& methods = dispatcher.methods();
  const auto row = std::find_if(methods.begin(), methods.end(), [](const Method& each) {
    return each.descriptor->name() == "GetLubricant";
  });
  if (row == methods.end()) throw std::logic_error("no method GetLubricant");
  v1::GetLubricantRequest message;
  message.set_name("lubricants/paper-fluid-1");
  const std::string request = message.SerializeAsString();
  std::vector<double> with, without;
  for (int i = -kWarmUp; i < calls; ++i) {
    const bool is_token_first = i % 2 == 0;
    double seconds[2];
    for (const bool has_token : {is_token_first, !is_token_first}) {
      seconds[has_token ? 1 : 0] = Get(*row, request, has_token).seconds(dispatcher);
    }
    if (i < 0) continue;
    without.push_back(seconds[0]);
    with.push_back(seconds[1]);
  }
  const double p99_with = percentile_99(with), p99_without = percentile_99(without);
  std::vector<Measurement> out = {
      {"get: p99 with authorization, without a transport", 1e6 * p99_with, "us", {}},
      {"get: p99 without authorization, without a transport", 1e6 * p99_without, "us", {}},
      {"get: median that authorization adds", 1e6 * (median(with) - median(without)), "us", {}},
      {"get: p99 with authorization over without", p99_with / p99_without, "", 1.10}};
  for (const Measurement& each : measure_flood()) out.push_back(each);
  std::printf("%s\n", machine_name().c_str());
  print(out);
  record(results, out);
  return 0;
}

}  // namespace
}  // namespace tribodyn::server

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: guard_benchmark RESULTS.json [calls]\n");
    return 2;
  }
  try {
    return tribodyn::server::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 100'000);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "guard_benchmark: %s\n", failure.what());
    return 1;
  }
}
