#pragma once

#include <google/protobuf/io/zero_copy_stream.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/application/authorizer.h"
#include "server/application/call_lanes.h"
#include "server/application/method_table.h"
#include "server/metrics/metrics.h"

namespace tribodyn::server {

/// The longest duration of a method, whatever deadline the client sets. A call that takes longer
/// ends with DEADLINE_EXCEEDED. A stream does too, even if the client reads it: a client opens a
/// further stream to watch a long simulation. A stream ends earlier if the client reads nothing of
/// a message for `unread`.
struct TimeLimits {
  std::chrono::milliseconds call = std::chrono::seconds(30);
  std::chrono::milliseconds stream = std::chrono::hours(1);
  std::chrono::milliseconds unread = std::chrono::minutes(1);
};

/// A call of any transport. The transport owns the object at least until the call is answered.
class IncomingCall {
 public:
  explicit IncomingCall(const Method& its_method) : method(its_method) {}
  virtual ~IncomingCall() = default;

  /// Called once, on a thread of the lane, before the next two: a transport whose requests arrive
  /// in another form than protobuf's binary one converts them here. Returns the error of a request
  /// that cannot be converted, or that has not arrived.
  virtual std::optional<google::rpc::Status> prepare() { return std::nullopt; }
  /// Return the length of the serialised request [bytes], before prepare() an estimate, and a new
  /// reader of it.
  virtual std::size_t request_size() const = 0;
  virtual std::unique_ptr<google::protobuf::io::ZeroCopyInputStream> read_request() = 0;
  /// Frees the serialised request.
  virtual void drop_request() = 0;
  /// Returns true if the thread that passes the call to the dispatcher may run the call itself if
  /// the call is a short read. Other work of that thread then waits for about a millisecond.
  virtual bool may_run_on_calling_thread() const { return false; }

  const Method& method;
  Credentials credentials;
  CallContext context;  ///< its limits are the stricter ones of client and server
  const StopWatch watch;
};

/// A call of a unary method.
class UnaryCall : public IncomingCall {
 public:
  using IncomingCall::IncomingCall;
  /// Called once, on a thread of the lane or by CallDispatcher::answer. Must not throw.
  virtual void answered(Outcome<Reply> outcome) = 0;
};

/// A call of a method that answers with a stream.
class StreamCall : public IncomingCall {
 public:
  using IncomingCall::IncomingCall;
  /// Like UnaryCall::answered. If the outcome is a source, the transport calls
  /// CallDispatcher::ended once after the last message.
  virtual void opened(Outcome<ReplySource> outcome) = 0;
};

/// Answers the calls of every transport: authenticates the caller and checks the scope before
/// anything else happens, then checks the size of a request, runs the use case of its method on a
/// thread of the method's lane, turns exceptions into errors, counts each call, and
/// logs calls that fail or are slow. Safe for concurrent access. Must outlive all calls. The
/// destructor answers the calls that wait.
class CallDispatcher {
 public:
  /// `application` must outlive the object. Throws std::logic_error like method_table().
  explicit CallDispatcher(Application& application, const TimeLimits& limits = {});

  const std::vector<Method>& methods() const { return methods_; }
  const TimeLimits& limits() const { return limits_; }
  const Authorizer& authorizer() const { return *application_.authorizer; }
  /// Returns what the server has to do now, for Metrics::text(). Reads no row.
  Workload workload();

  void answer(UnaryCall& call);
  /// The stream ends with UNAUTHENTICATED as soon as the token of the call is no longer valid.
  void open(StreamCall& call);
  /// Queues the next step of an open stream.
  void step(std::function<void()> task);
  /// Runs a short step (AnyMessageSource::is_short) on the calling thread, or queues it. Requires
  /// that the transport has a further thread that reads requests and writes answers meanwhile.
  void short_step(const std::function<void()>& task);
  /// Counts a call that has ended, and logs it if it failed or was slow. Throws nothing.
  void ended(const IncomingCall& call, const google::rpc::Status& status);

 private:
  /// The rest of a call. `is_here`: it runs on the thread of the transport. Returns false, and has
  /// not answered, if it would take too long for that thread.
  using Task = std::function<bool(bool is_here)>;
  void run(const IncomingCall& call, Task task,
           const std::function<void(const google::rpc::Status&)>& refuse);
  std::optional<google::rpc::Status> authorize(IncomingCall& call) const;
  /// Takes a place among the open streams of the caller, which the last copy of `place` frees.
  /// Returns the error of a caller who has none left; else nullopt.
  static std::optional<google::rpc::Status> take_stream(const CallContext& call,
                                                        std::shared_ptr<void>& place);
  /// The same of the project of the call, for which `place` then stands too. The owner takes none.
  std::optional<google::rpc::Status> take_project_stream(const CallContext& call,
                                                         std::shared_ptr<void>& place) const;
  /// Takes a call of the project. Returns the error of a project that has none left; else nullopt.
  std::optional<google::rpc::Status> take_project_call(const CallContext& call) const;
  /// Runs a short task on the calling thread, without the two changes of threads of a lane. Returns
  /// false if another task runs so: only one may, so that a slow disk blocks at most one thread of
  /// a transport.
  bool run_here(const std::function<void()>& task);
  /// Checks the request, parses it and enters its project. Returns the request.
  Outcome<Reply> accept(IncomingCall& call);
  /// Returns what the use case makes of the request.
  template <class Answer>
  Outcome<Answer> outcome_of(IncomingCall& call, const google::protobuf::Message& request,
                             const Method::UseCase<Answer>& use_case);
  /// Writes a change, or the refusal of a permission, into the audit log.
  void record(const IncomingCall& call, const google::rpc::Status& status, bool changes,
              const std::string& names);

  Application& application_;
  const TimeLimits limits_;
  const std::vector<Method> methods_;
  // Shared, because a stream may outlive the object.
  const std::shared_ptr<std::atomic<int>> open_streams_ = std::make_shared<std::atomic<int>>(0);
  std::atomic<bool> runs_here_ = false;  // a transport's thread is in run_here()
  CallLanes lanes_;                      // last: its threads use all of the above
};

}  // namespace tribodyn::server
