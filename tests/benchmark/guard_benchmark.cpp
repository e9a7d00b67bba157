// What authorization adds to a get: the same call by a token, which is hashed, looked up and
// counted against its quota, and by the owner over a Unix socket, who is recognised by the
// connection. The two take turns in one run, without a transport, so that the difference is the
// guard's alone. usage: guard_benchmark RESULTS.json [calls]
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/application/call_dispatcher.h"
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

double percentile_99(std::vector<double> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), place, values.end());
  return *place;
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
  const std::vector<Measurement> out = {
      {"get: p99 with authorization, without a transport", 1e6 * p99_with, "us", {}},
      {"get: p99 without authorization, without a transport", 1e6 * p99_without, "us", {}},
      {"get: median that authorization adds", 1e6 * (median(with) - median(without)), "us", {}},
      {"get: p99 with authorization over without", p99_with / p99_without, "", 1.10}};
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
  return tribodyn::server::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 100'000);
}
