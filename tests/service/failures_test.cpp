// Tests of the answer and the log line when the server fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <stdexcept>

#include "google/rpc/code.pb.h"
#include "server/application/errors.h"
#include "server/application/guard.h"
#include "server/application/log_text.h"
#include "server/application/message_source.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr char kCause[] = "row 7 of the table\nforged=1";

google::rpc::Status failure_of(const std::function<void()>& body) {
  const auto outcome = guarded<v1::Simulation>([&]() -> Outcome<v1::Simulation> {
    body();
    return v1::Simulation();
  });
  return outcome.ok() ? google::rpc::Status() : outcome.error();
}

/// Returns the word between `before` and `after`.
std::string between(const std::string& text, const std::string& before, char after) {
  const std::size_t begin = text.find(before) + before.size();
  return text.substr(begin, text.find(after, begin) - begin);
}

TEST(Failures, ADefectIsLoggedWithItsCauseAndAnsweredWithAnIdOnly) {
  const LogCapture log;
  const google::rpc::Status told = failure_of([] { throw std::logic_error(kCause); });
  EXPECT_EQ(told.code(), google::rpc::INTERNAL);
  EXPECT_THAT(told.message(), Not(HasSubstr("row 7")));
  const std::string id = between(log.text(), "id=", ' ');
  EXPECT_EQ(id.size(), 16U) << log.text();
  EXPECT_THAT(told.message(), HasSubstr(id));
  EXPECT_THAT(log.text(), HasSubstr("cause=\"row 7 of the table?forged=1\"")) << "on one line";
}

TEST(Failures, AThrownValueOfAnyTypeIsHandled) {
  EXPECT_EQ(failure_of([] { throw 7; }).code(), google::rpc::INTERNAL);
}

TEST(Failures, LackOfMemoryIsNotADefect) {
  const google::rpc::Status told = failure_of([] { throw std::bad_alloc(); });
  EXPECT_EQ(told.code(), google::rpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(reason_of(told), v1::ERROR_REASON_OUT_OF_MEMORY);
}

/// A stream that fails at its second message.
class FailingSource : public MessageSource<v1::SimulationEvent> {
 public:
  explicit FailingSource(std::function<void()> fail) : fail_(std::move(fail)) {}
  Step next(v1::SimulationEvent&) override {
    if (++asked_ > 1) fail_();
    return Step::kMessage;
  }

 private:
  std::function<void()> fail_;
  int asked_ = 0;
};

TEST(Failures, AFailedStreamIsLoggedWithItsCauseAndEndsWithAnIdOnly) {
  const LogCapture log;
  FailingSource source([] { throw std::logic_error(kCause); });
  v1::SimulationEvent event;
  google::rpc::Status end;
  EXPECT_EQ(next_step(source, event, end), FailingSource::Step::kMessage);
  EXPECT_EQ(next_step(source, event, end), FailingSource::Step::kEnd);
  EXPECT_EQ(end.code(), google::rpc::INTERNAL);
  EXPECT_THAT(end.message(), HasSubstr(between(log.text(), "id=", ' ')));
  EXPECT_THAT(end.message(), Not(HasSubstr("row 7")));
  EXPECT_THAT(log.text(), HasSubstr("row 7"));
}

TEST(Failures, AStreamWithoutMemoryEndsWithResourceExhausted) {
  FailingSource source([] { throw std::bad_alloc(); });
  v1::SimulationEvent event;
  google::rpc::Status end;
  next_step(source, event, end);
  EXPECT_EQ(next_step(source, event, end), FailingSource::Step::kEnd);
  EXPECT_EQ(end.code(), google::rpc::RESOURCE_EXHAUSTED);
}

TEST(Failures, ForeignTextIsOneWordOfALogLine) {
  EXPECT_EQ(log_word("unix:/tmp/x\n[critical] forged=1\x80", 100),
            "unix:/tmp/x_[critical]_forged_1_");
  EXPECT_EQ(log_word("abcdef", 3), "abc");
  EXPECT_EQ(log_text("a b=c\r\nd", 100), "a b=c??d");
}

}  // namespace
}  // namespace tribodyn::server
