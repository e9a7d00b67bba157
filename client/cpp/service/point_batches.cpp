#include "client/cpp/service/point_batches.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace tribodyn::client {
namespace {

/// Points of one call: some 25 ms of a processor, so that progress is smooth and an interruption
/// loses little. Measured with 60,000 points: calls of 2000 take 3 to 7 % less of the server's
/// processor time.
constexpr std::size_t kPointsOfACall = 500;
/// Calls under way. The server computes each on one thread; the third keeps two threads busy while
/// an answer travels.
constexpr int kCallsUnderWay = 3;
/// Answers that wait for an earlier one, at most.
constexpr std::size_t kMostWaiting = 16;

v1::EvaluatePointsRequest request_of(const v1::EvaluatePointsRequest& base,
                                     const std::vector<CandidateParameter>& parameters,
                                     const std::vector<std::size_t>& candidates, std::size_t first,
                                     std::size_t count) {
  v1::EvaluatePointsRequest out = base;
  for (const CandidateParameter& parameter : parameters) {
    v1::CandidateColumn& column = *out.add_candidate_columns();
    column.set_path(parameter.path());
    for (std::size_t i = first; i < first + count; ++i) {
      column.add_values(parameter.values[candidates[i]]);
    }
  }
  return out;
}

/// The batches of all candidates: threads compute them, the caller takes them in order. Safe for
/// concurrent access.
class Batches {
 public:
  Batches(std::size_t candidates, std::size_t batch) : candidates_(candidates), batch_(batch) {}

  /// Returns the next batch to compute, without an answer; one of no candidates if there is none.
  PointBatch next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || done_.size() < kMostWaiting; });
    const std::size_t first = std::min(next_, candidates_);
    const std::size_t count = stopped_ ? 0 : std::min(batch_, candidates_ - first);
    next_ = first + count;
    return {first, count, {}};
  }
  void add(PointBatch batch) {
    const std::scoped_lock lock(mutex_);
    const std::size_t first = batch.first;
    done_.emplace(first, std::move(batch));
    changed_.notify_all();
  }
  void fail(std::exception_ptr error) {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = std::move(error);
    stopped_ = true;
    changed_.notify_all();
  }
  void stop() {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }
  /// Moves the batch that begins at `first` to `out` and returns true; returns false if it is not
  /// there after a tenth of a second. Throws the error of a thread.
  bool take(std::size_t first, PointBatch& out) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(100),
                      [&] { return error_ || done_.count(first) != 0; });
    const auto found = done_.find(first);
    if (found != done_.end()) {
      out = std::move(found->second);
      done_.erase(found);
      changed_.notify_all();
      return true;
    }
    if (error_) std::rethrow_exception(error_);
    return false;
  }

 private:
  const std::size_t candidates_, batch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, PointBatch> done_;
  std::size_t next_ = 0;
  bool stopped_ = false;
  std::exception_ptr error_;
};

}  // namespace

void evaluate_candidates(Connection& connection, const v1::EvaluatePointsRequest& request,
                         const std::vector<CandidateParameter>& parameters,
                         const std::vector<std::size_t>& candidates,
                         const std::function<void(const PointBatch&)>& use,
                         const std::function<bool()>& wait) {
  const auto conditions = static_cast<std::size_t>(request.conditions_size());
  Batches batches(candidates.size(), std::max<std::size_t>(1, kPointsOfACall / conditions));
  std::vector<std::jthread> threads;
  // Without it an exception would wait for all batches.
  struct Stop {
    Batches& batches;
    ~Stop() { batches.stop(); }
  };
  const Stop stop{batches};
  for (int i = 0; i < kCallsUnderWay; ++i) {
    threads.emplace_back([&] {
      try {
        for (PointBatch batch = batches.next(); batch.count > 0; batch = batches.next()) {
          batch.answer = connection.evaluate_points(
              request_of(request, parameters, candidates, batch.first, batch.count));
          batches.add(std::move(batch));
        }
      } catch (...) {
        batches.fail(std::current_exception());
      }
    });
  }
  PointBatch batch{};
  for (std::size_t done = 0; done < candidates.size(); done += batch.count) {
    do {
      if (!wait()) return;
    } while (!batches.take(done, batch));
    use(batch);
  }
}

}  // namespace tribodyn::client
