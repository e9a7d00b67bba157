#include "server/application/call_dispatcher.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/errors.h"
#include "server/application/guard.h"
#include "server/application/request_project.h"
#include "server/application/wire_check.h"

namespace tribodyn::server {
namespace {

constexpr int kBusySeconds = 2;            // [s]; most batches take less
constexpr double kStreamRetrySeconds = 5;  // for a place among the caller's streams
constexpr double kSlowSeconds = 1.0;       // [s]; slower calls are logged

/// Parses the request and frees its bytes. Returns nullopt, or INVALID_ARGUMENT: before parsing, if
/// the request is longer than its method allows or has more elements than any acceptable request
/// (wire_check.h); or if the bytes are not a message of its type.
std::optional<google::rpc::Status> parse_request(IncomingCall& call,
                                                 google::protobuf::Message& request) {
  const google::protobuf::MethodDescriptor& method = *call.method.descriptor;
  const std::size_t size = call.request_size();
  const std::size_t maximum = maximum_request_bytes(method);
  if (size > maximum) {
    return invalid({{"", fmt::format("the request has {} bytes; allowed: at most {} for {}", size,
                                     maximum, method.name())}});
  }
  Violations violations;
  check_wire(*call.read_request(), static_cast<int>(size), *method.input_type(), violations);
  if (!violations.empty()) return invalid(violations);
  if (!request.ParseFromZeroCopyStream(call.read_request().get())) {
    return invalid({unreadable_violation(*method.input_type())});
  }
  call.drop_request();
  return std::nullopt;
}

/// Returns the error of a call whose lane is full. It states the limit and what the client can do.
google::rpc::Status lane_full(CallLane lane) {
  if (lane == CallLane::kHeavy) {
    return exhausted(
        v1::ERROR_REASON_TOO_MANY_LARGE_REQUESTS,
        fmt::format("no more than {} batches, imports and requests above {} MiB may wait, and they "
                    "may have {} MiB together; try again in {} s, or send fewer or smaller ones at "
                    "a time",
                    CallLanes::kHeavyWaiting, kUsualRequestBytes >> 20,
                    CallLanes::kHeavyBytes >> 20, kBusySeconds),
        kBusySeconds);
  }
  return exhausted(
      v1::ERROR_REASON_TOO_MANY_CALLS,
      fmt::format("no more than {} calls of this kind may wait; try again in {} s, or send fewer "
                  "calls at a time",
                  lane == CallLane::kCompute ? CallLanes::kHeavyWaiting : CallLanes::kWaiting,
                  kBusySeconds),
      kBusySeconds);
}

/// The grant of a call that is refused.
const GrantPointer& nobody() {
  static const GrantPointer kNobody = [] {
    auto out = std::make_shared<Grant>();
    out->principal = "-";
    out->is_revoked = true;
    return out;
  }();
  return kNobody;
}

std::string text_of(Scope scope) {
  switch (scope) {
    case Scope::kRead:
      return "read";
    case Scope::kWrite:
      return "write";
    default:
      return "admin";
  }
}

/// The messages of a source until a grant ends.
class GrantedSource final : public AnyMessageSource {
 public:
  GrantedSource(ReplySource source, GrantPointer grant, std::shared_ptr<Authorizer> authorizer,
                std::shared_ptr<void> place, std::shared_ptr<std::atomic<int>> open_streams)
      : open_streams_(std::move(open_streams)),
        place_(std::move(place)),
        source_(std::move(source)),
        grant_(std::move(grant)),
        authorizer_(std::move(authorizer)) {
    ++*open_streams_;
  }
  ~GrantedSource() override { --*open_streams_; }
  GrantedSource(const GrantedSource&) = delete;
  GrantedSource& operator=(const GrantedSource&) = delete;

  void set_order(Order order) override { source_->set_order(order); }

  Step next_message(google::protobuf::Message& out) override {
    has_ended_ = !grant_->is_valid(system_time());
    return has_ended_ ? Step::kEnd : source_->next_message(out);
  }
  void observe(const std::weak_ptr<Observer>& observer) override {
    authorizer_->observers().add(observer);
    source_->observe(observer);
  }
  bool is_short() const override { return source_->is_short(); }
  bool follows_changes() const override { return source_->follows_changes(); }
  std::string tag() const override { return source_->tag(); }
  bool may_continue() const override { return source_->may_continue(); }
  bool may_be_ahead() const override { return source_->may_be_ahead(); }
  google::rpc::Status error() const override {
    return has_ended_ ? token_refused() : source_->error();
  }

 private:
  const std::shared_ptr<std::atomic<int>> open_streams_;
  const std::shared_ptr<void> place_;  // among the streams of the principal
  const ReplySource source_;
  const GrantPointer grant_;
  const std::shared_ptr<Authorizer> authorizer_;
  bool has_ended_ = false;
};

/// Returns true if a call of the method may take about a millisecond or less.
bool may_be_short(const Method& method) {
  return method.lane == CallLane::kRead || method.is_short != nullptr;
}

/// Returns true if a call takes about a millisecond or less.
bool is_short(const Method& method, const google::protobuf::Message& request) {
  return method.lane == CallLane::kRead || (method.is_short != nullptr && method.is_short(request));
}

}  // namespace

CallDispatcher::CallDispatcher(Application& application, const TimeLimits& limits)
    : application_(application), limits_(limits), methods_(method_table()) {
  const google::protobuf::EnumDescriptor& reasons = *v1::ErrorReason_descriptor();
  for (int i = 0; i < reasons.value_count(); ++i) {
    const auto reason = static_cast<v1::ErrorReason>(reasons.value(i)->number());
    application.jobs.metrics().count_refusal(reason_text(reason), 0);
  }
}

Workload CallDispatcher::workload() {
  return {.simulations = application_.jobs.scheduler().occupancy(),
          .campaigns = application_.jobs.campaigns().totals(),
          .lanes = lanes_.occupancy(),
          .open_streams = static_cast<std::size_t>(*open_streams_)};
}

/// Sets the grant of a call. Returns UNAUTHENTICATED, or PERMISSION_DENIED if the scope of the
/// grant is too small. Reads nothing of the request and no row.
std::optional<google::rpc::Status> CallDispatcher::authorize(IncomingCall& call) const {
  // Moved, so that a long stream keeps no memory of what its client has shown.
  const Credentials shown = std::move(call.credentials);
  auto grant = application_.authorizer->authenticate(shown, system_time());
  if (!grant.ok()) {
    call.context.grant = nobody();
    return grant.error();
  }
  call.context.grant = std::move(grant.message());
  const Grant& caller = *call.context.grant;
  if (const double rate = caller.quota.calls_per_second; rate > 0) {
    const double wait = caller.allowance.take_call(rate, std::chrono::steady_clock::now());
    if (wait > 0) {
      return over_quota(caller.principal, "calls-per-second",
                        fmt::format("{:.3g} calls a second", rate), wait);
    }
  }
  if (caller.scope < call.method.scope) {
    auto refused = scope_too_small(text_of(call.method.scope));
    application_.audit.record(call.context, call.method.descriptor->name(), refused, "");
    return refused;
  }
  return std::nullopt;
}

std::optional<google::rpc::Status> CallDispatcher::take_stream(const CallContext& call,
                                                               std::shared_ptr<void>& place) {
  const GrantPointer& caller = call.grant;
  const int most = caller->quota.streams;
  if (most == 0) return std::nullopt;
  if (!caller->allowance.open_stream(most)) {
    return over_quota(caller->principal, "streams", fmt::format("{} open streams", most),
                      kStreamRetrySeconds);
  }
  place = std::shared_ptr<void>(nullptr, [caller](void*) { caller->allowance.close_stream(); });
  return std::nullopt;
}

std::optional<google::rpc::Status> CallDispatcher::take_project_call(
    const CallContext& call) const {
  const double rate = application_.project_quotas->quota().calls_per_second;
  if (rate <= 0 || call.grant->principal == kOwner) return std::nullopt;
  const auto allowance = application_.project_quotas->of(call.project);
  const double wait = allowance->take_call(rate, std::chrono::steady_clock::now());
  if (wait <= 0) return std::nullopt;
  return over_quota("project " + call.project, "project-calls-per-second",
                    fmt::format("{:.3g} calls a second", rate), wait);
}

std::optional<google::rpc::Status> CallDispatcher::take_project_stream(
    const CallContext& call, std::shared_ptr<void>& place) const {
  const int most = application_.project_quotas->quota().streams;
  if (most == 0 || call.grant->principal == kOwner) return std::nullopt;
  const auto allowance = application_.project_quotas->of(call.project);
  if (!allowance->open_stream(most)) {
    return over_quota("project " + call.project, "project-streams",
                      fmt::format("{} open streams", most), kStreamRetrySeconds);
  }
  place = std::shared_ptr<void>(nullptr, [allowance, own = std::move(place)](void*) mutable {
    own = nullptr;
    allowance->close_stream();
  });
  return std::nullopt;
}

Outcome<Reply> CallDispatcher::accept(IncomingCall& call) {
  Outcome<Reply> out = guarded<Reply>([&]() -> Outcome<Reply> {
    const CallLimits& limits = call.context.limits;
    if (limits.are_over()) return call_over(limits);
    if (auto refused = call.prepare()) return *std::move(refused);
    Reply request(call.method.request->New());
    if (auto refused = parse_request(call, *request)) return *std::move(refused);
    if (auto refused = enter_project(application_, *request, call.context)) {
      return *std::move(refused);
    }
    if (auto refused = take_project_call(call.context)) return *std::move(refused);
    return request;
  });
  call.drop_request();
  if (!out.ok()) record(call, out.error(), call.method.scope > Scope::kRead, "");
  return out;
}

template <class Answer>
Outcome<Answer> CallDispatcher::outcome_of(IncomingCall& call,
                                           const google::protobuf::Message& request,
                                           const Method::UseCase<Answer>& use_case) {
  std::string names;
  bool changes = call.method.scope > Scope::kRead;
  Outcome<Answer> out = guarded<Answer>([&]() -> Outcome<Answer> {
    changes = changes && !validates_only(request);
    if (changes) names = audited_names(request);
    if (call.context.limits.are_over()) return call_over(call.context.limits);
    return use_case(application_, request, call.context);
  });
  if constexpr (std::is_same_v<Answer, Reply>) {
    // A new simulation has its name from the server.
    if (changes && names.empty() && out.ok()) names = audited_names(*out.message());
  }
  record(call, out.ok() ? google::rpc::Status() : out.error(), changes, names);
  return out;
}

void CallDispatcher::record(const IncomingCall& call, const google::rpc::Status& status,
                            bool changes, const std::string& names) {
  if (!changes && status.code() != google::rpc::PERMISSION_DENIED) return;
  application_.audit.record(call.context, call.method.descriptor->name(), status, names);
}

void CallDispatcher::run(const IncomingCall& call, Task task,
                         const std::function<void(const google::rpc::Status&)>& refuse) {
  const std::size_t bytes = call.request_size();
  const CallLane lane = bytes > kUsualRequestBytes ? CallLane::kHeavy : call.method.lane;
  const bool may_run_here = lane == call.method.lane && may_be_short(call.method);
  if (may_run_here && call.may_run_on_calling_thread() && lanes_.is_empty(lane)) {
    bool is_answered = false;
    if (run_here([&] { is_answered = task(true); }) && is_answered) return;
  }
  std::function<void()> queued = [own_task = std::move(task)] { own_task(false); };
  if (lanes_.run(lane, bytes, queued, payer(call.context))) return;
  refuse(lane_full(lane));
}

bool CallDispatcher::run_here(const std::function<void()>& task) {
  if (runs_here_.exchange(true)) return false;
  task();
  runs_here_ = false;
  return true;
}

void CallDispatcher::answer(UnaryCall& call) {
  const auto finish = [this, &call](Outcome<Reply> outcome) {
    ended(call, outcome.ok() ? google::rpc::Status() : outcome.error());
    call.answered(std::move(outcome));
  };
  if (auto refused = authorize(call)) return finish(*std::move(refused));
  run(
      call,
      [this, &call, finish, request = std::make_shared<Reply>()](bool is_here) {
        if (*request == nullptr) {
          Outcome<Reply> accepted = accept(call);
          if (!accepted.ok()) {
            finish(accepted.error());
            return true;
          }
          *request = std::move(accepted.message());
        }
        if (is_here && !is_short(call.method, **request)) return false;
        finish(outcome_of(call, **request, call.method.answer));
        return true;
      },
      [&](const google::rpc::Status& refusal) { finish(refusal); });
}

void CallDispatcher::open(StreamCall& call) {
  const auto finish = [this, &call](Outcome<ReplySource> outcome) {
    if (!outcome.ok()) ended(call, outcome.error());
    call.opened(std::move(outcome));
  };
  if (auto refused = authorize(call)) return finish(*std::move(refused));
  std::shared_ptr<void> place;
  if (auto refused = take_stream(call.context, place)) return finish(*std::move(refused));
  run(
      call,
      [this, &call, finish, kept = std::move(place)](bool) mutable {
        const Outcome<Reply> request = accept(call);
        Outcome<ReplySource> outcome = request.ok()
                                           ? outcome_of(call, *request.message(), call.method.open)
                                           : Outcome<ReplySource>(request.error());
        if (outcome.ok()) {
          if (auto refused = take_project_stream(call.context, kept)) outcome = *std::move(refused);
        }
        if (outcome.ok()) {
          outcome.message() = std::make_shared<GrantedSource>(
              std::move(outcome.message()), call.context.grant, application_.authorizer,
              std::move(kept), open_streams_);
        }
        kept = nullptr;  // its place is free before the answer
        finish(std::move(outcome));
        return true;
      },
      [&](const google::rpc::Status& refusal) { finish(refusal); });
}

void CallDispatcher::step(std::function<void()> task) { lanes_.run(CallLane::kStream, 0, task); }

void CallDispatcher::short_step(const std::function<void()>& task) {
  if (!run_here(task)) step(task);
}

void CallDispatcher::ended(const IncomingCall& call, const google::rpc::Status& status) try {
  const double seconds = call.watch.seconds();
  const google::protobuf::MethodDescriptor& method = *call.method.descriptor;
  const std::string& code = google::rpc::Code_Name(static_cast<google::rpc::Code>(status.code()));
  application_.jobs.metrics().count_call(method.full_name(), code, seconds);
  const bool is_refused = status.code() != google::rpc::OK;
  const std::string reason = is_refused ? reason_text(reason_of(status)) : "";
  if (is_refused) application_.jobs.metrics().count_refusal(reason);
  const bool is_slow = seconds > kSlowSeconds && !method.server_streaming();
  if (!is_refused && !is_slow) return;
  spdlog::info(
      "event=call method={} code={} reason={} seconds={:.3f} client={} call={} principal={}",
      method.name(), code, reason, seconds, call.context.client, call.context.request_id,
      call.context.grant->principal);
} catch (const std::exception&
             failure) {  // e.g. out of memory: the call is answered although it is not counted
  spdlog::error("event=call_not_counted cause=\"{}\"", failure.what());
}

}  // namespace tribodyn::server
