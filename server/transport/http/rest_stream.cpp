#include "server/transport/http/rest_stream.h"

#include <optional>
#include <string>
#include <utility>

#include "server/application/errors.h"
#include "server/application/guard.h"
#include "server/application/stream_machine.h"
#include "server/support/sha256.h"
#include "server/transport/http/byte_range.h"
#include "server/transport/http/rest_answer.h"
#include "server/transport/http/rest_call.h"

namespace tribodyn::server {
namespace {

/// A stream over HTTP that a StreamMachine drives. LiveStreams keeps it alive until its end.
class RestStream final : public RestCall<StreamCall>,
                         public StreamTransport,
                         public LiveStream,
                         public HttpStream,
                         public std::enable_shared_from_this<RestStream> {
 public:
  using Reply = std::function<void(HttpResponse)>;

  RestStream(CallDispatcher& dispatcher, std::shared_ptr<LiveStreams> live, RouteMatch its_route,
             HttpRequest its_request, std::shared_ptr<const std::atomic<bool>> cancelled,
             std::unique_ptr<StreamFormat> format, Reply reply)
      : RestCall(std::move(its_route), std::move(its_request), std::move(cancelled),
                 dispatcher.limits().stream),
        dispatcher_(dispatcher),
        live_(std::move(live)),
        format_(std::move(format)),
        reply_(std::move(reply)),
        machine_(*this, *method.response, dispatcher.limits().unread) {}

  /// Hands the call to the dispatcher; alive until opened() at least.
  void open() {
    self_ = shared_from_this();
    dispatcher_.open(*this);
  }

  void opened(Outcome<ReplySource> outcome) override {
    const auto self = std::move(self_);
    // The dispatcher has counted a refusal of its own.
    if (!outcome.ok()) return reply_(error_response(outcome.error()));
    if (const auto refused = live_->add(self, request.peer)) {
      dispatcher_.ended(*this, *refused);
      return reply_(error_response(*refused));
    }
    source_ = std::move(outcome.message());
    source_->set_order(format_->order());
    HttpResponse response;
    response.headers = format_->headers();
    google::rpc::Status status;
    if (!begin_fixed_body(response, status)) return refuse(response, status);
    response.stream = self;
    reply_(std::move(response));
  }

  void start(std::shared_ptr<HttpStreamWriter> writer) override {
    writer_ = std::move(writer);
    // The first message may take long: not on the thread of all connections.
    dispatcher_.step([self = shared_from_this()] { self->open_machine(); });
  }
  void written(bool ok) override { machine_.written(ok); }
  void hang_up() override {
    const auto status =
        error(google::rpc::CANCELLED, v1::ERROR_REASON_CANCELLED, "the client hung up");
    if (writer_ == nullptr) return machine_.refuse(status);
    machine_.close(status);
  }
  void shut_down(const google::rpc::Status& status) override { machine_.shut_down(status); }
  std::optional<StreamMachine::Clock::time_point> look_at_clock() override {
    return machine_.look_at_clock();
  }

 private:
  /// Gives the response of a body that never changes its ETag, its length and the requested range.
  /// Returns false if it has no body: the client has it, or there is none in that range, or a
  /// failure, which `status` then is.
  bool begin_fixed_body(HttpResponse& response, google::rpc::Status& status) {
    const std::string tag = source_->tag();
    if (tag.empty() || !format_->has_length()) return true;
    set_etag(sha256(tag + response.headers["Content-Type"]), request, response);
    if (response.status == 304) return false;
    try {
      const std::unique_ptr<google::protobuf::Message> schema(method.response->New());
      if (next_step(*source_, *schema, status) == AnyMessageSource::Step::kMessage) {
        beginning_ = format_->part(*schema);
      }
    } catch (...) {
      status = error_of_exception();
    }
    const auto length = format_->length();
    if (!length) return false;
    if (const auto range = offer_range(request, *length, response)) {
      cutter_.emplace(*range);
      response.headers["Content-Length"] = std::to_string(range->last - range->first + 1);
    } else {
      response.headers["Content-Length"] = std::to_string(*length);
    }
    return response.status != 416;
  }
  void refuse(HttpResponse& response, const google::rpc::Status& status) {
    dispatcher_.ended(*this, status);
    live_->remove(this);
    source_ = nullptr;
    reply_(status.code() == google::rpc::OK ? std::move(response) : error_response(status));
  }
  /// Returns what the response contains of the next text.
  std::string cut(std::string part) {
    part.insert(0, std::exchange(beginning_, {}));
    return cutter_ ? cutter_->cut(part) : part;
  }
  void open_machine() {
    source_->observe(std::shared_ptr<Observer>(shared_from_this(), &machine_));
    machine_.open(std::move(source_), context.limits.deadline);
    live_->follow_clock(*this);
  }
  void run_step() override {
    dispatcher_.step([self = shared_from_this()] { self->machine_.step(); });
  }
  std::optional<google::rpc::Status> write(const google::protobuf::Message& message) override {
    std::string part;
    try {
      part = cut(format_->part(message));
    } catch (...) {
      return error_of_exception();
    }
    if (cutter_ && cutter_->is_complete()) machine_.close({});
    if (part.empty()) {
      machine_.written(true);
    } else {
      writer_->write(std::move(part));
    }
    return std::nullopt;
  }
  void finish(const google::rpc::Status& status) override {
    const auto self = shared_from_this();
    dispatcher_.ended(*this, status);
    if (writer_ != nullptr) {
      if (auto last = end_text(status)) {
        writer_->finish(*std::move(last));
      } else {
        writer_->cut_off();
      }
    }
    live_->remove(this);  // last: until then a failure leaves the time limits in force
  }
  std::optional<std::string> end_text(const google::rpc::Status& status) {
    try {
      auto out = format_->end(status);
      if (out) out = cut(*std::move(out));
      return out;
    } catch (const std::exception&) {  // no memory for the text
      return std::nullopt;
    }
  }
  void cut_off() override { writer_->cut_off(); }

  CallDispatcher& dispatcher_;
  // A last step may run on the dispatcher when the handler is gone.
  const std::shared_ptr<LiveStreams> live_;
  const std::unique_ptr<StreamFormat> format_;
  const Reply reply_;
  std::shared_ptr<RestStream> self_;          // until opened()
  ReplySource source_;                        // from opened() to start()
  std::string beginning_;                     // text that precedes that of the next message
  std::optional<RangeCutter> cutter_;         // of a response with a part of the body
  std::shared_ptr<HttpStreamWriter> writer_;  // set by start()
  StreamMachine machine_;
};

}  // namespace

void open_rest_stream(CallDispatcher& dispatcher, std::shared_ptr<LiveStreams> live,
                      RouteMatch route, HttpRequest request,
                      std::shared_ptr<const std::atomic<bool>> cancelled,
                      std::unique_ptr<StreamFormat> format,
                      std::function<void(HttpResponse)> reply) {
  std::make_shared<RestStream>(dispatcher, std::move(live), std::move(route), std::move(request),
                               std::move(cancelled), std::move(format), std::move(reply))
      ->open();
}

}  // namespace tribodyn::server
