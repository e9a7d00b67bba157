// Jobs, store and application are used by many threads at once; run under ThreadSanitizer.
#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "google/rpc/code.pb.h"
#include "server/application/contacts.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"
#include "tests/service/resource_calls.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

/// Runs the action on `count` threads and waits for all.
void on_threads(int count, const std::function<void(int)>& action) {
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) threads.emplace_back([&action, i] { action(i); });
  for (std::thread& thread : threads) thread.join();
}

v1::Simulation with_history() {
  v1::Simulation simulation = point_simulation();
  simulation.mutable_operating_point()->mutable_history()->add_columns("flank_load_newtons");
  return simulation;
}

/// Watches as the gRPC layer does: asks again at every notification.
class Watcher : public Observer, public std::enable_shared_from_this<Watcher> {
 public:
  using Source = std::shared_ptr<MessageSource<v1::SimulationEvent>>;
  explicit Watcher(Source source) : source_(std::move(source)) {}
  void start() {
    source_->observe(weak_from_this());
    changed();
  }
  void changed() override {
    const std::lock_guard lock(mutex_);
    v1::SimulationEvent event;
    for (;;) {
      const auto step = source_->next(event);
      if (step == MessageSource<v1::SimulationEvent>::Step::kEnd) ended_ = true;
      if (step != MessageSource<v1::SimulationEvent>::Step::kMessage) return;
      EXPECT_GE(event.state(), last_);
      last_ = event.state();
    }
  }
  bool ended() const { return ended_; }

 private:
  std::mutex mutex_;
  Source source_;
  int last_ = 0;
  std::atomic<bool> ended_ = false;
};

TEST(Concurrency, CreateWatchReadCancelAllAtOnce) {
  Bench bench(quick_studies(), 4);
  Application app = bench.application();
  constexpr int kThreads = 6;
  constexpr int kRounds = 15;
  std::atomic<int> ends = 0;
  on_threads(kThreads, [&](int thread) {
    for (int round = 0; round < kRounds; ++round) {
      const std::string name = bench.create(with_history());
      v1::WatchSimulationRequest watch;
      watch.set_name(name);
      auto watcher = std::make_shared<Watcher>(watch_simulation(app, watch).message());
      watcher->start();
      if ((thread + round) % 3 == 0) {
        v1::CancelSimulationRequest cancel;
        cancel.set_name(name);
        EXPECT_TRUE(cancel_simulation(app, cancel).ok());
      }
      EXPECT_TRUE(eventually([&] { return watcher->ended(); }));
      const v1::Simulation done = bench.get(name);
      if (done.state() == v1::Simulation::SUCCEEDED) {
        v1::ReadHistoryRequest read;
        read.set_name(name);
        const auto history = read_history(app, read);
        v1::ReadHistoryResponse part;
        history.message()->next(part);
        EXPECT_EQ(part.schema().row_count(), 192);
        history.message()->next(part);
        EXPECT_EQ(part.chunk().values().size(), 192 * sizeof(double));
      } else {
        EXPECT_EQ(done.state(), v1::Simulation::CANCELLED);
      }
      EXPECT_TRUE(list_simulations(app, {}).ok());
      EXPECT_TRUE(list_gear_sets(app, v1::ListGearSetsRequest()).ok());
      ++ends;
    }
  });
  EXPECT_EQ(ends, kThreads * kRounds);
}

TEST(Concurrency, CancellingFromManyThreadsEndsEachOnce) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 2);
  std::vector<std::string> names;
  names.reserve(12);
  for (int i = 0; i < 12; ++i) names.push_back(bench.create(point_simulation()));
  Application app = bench.application();
  on_threads(4, [&](int) {
    for (const std::string& name : names) {
      v1::CancelSimulationRequest cancel;
      cancel.set_name(name);
      const auto outcome = cancel_simulation(app, cancel);
      EXPECT_EQ(outcome.message().state(), v1::Simulation::CANCELLED);
    }
  });
  const std::string next = bench.create(point_simulation());
  *release = true;
  EXPECT_TRUE(bench.reaches(next, v1::Simulation::SUCCEEDED));
}

/// Reads a watch after event `after` until no event is left. Returns the numbers of the events.
std::vector<std::int64_t> numbers(Application& app, const std::string& name, std::int64_t after) {
  v1::WatchSimulationRequest request;
  request.set_name(name);
  request.set_after_sequence(after);
  auto outcome = watch_simulation(app, request);
  std::vector<std::int64_t> out;
  if (!outcome.ok()) return out;  // the simulation has fewer events
  v1::SimulationEvent event;
  while (outcome.message()->next(event) == MessageSource<v1::SimulationEvent>::Step::kMessage) {
    if (event.kind() == v1::SimulationEvent::STATE_CHANGE) out.push_back(event.sequence());
  }
  return out;
}

TEST(Concurrency, SubmitTwiceWatchCancelAndExpireAllAtOnce) {
  Bench bench(quick_studies(), 4, {.jobs = 100'000}, std::chrono::milliseconds(1));
  Application app = bench.application();
  constexpr int kThreads = 6;
  constexpr int kRounds = 40;
  std::array<std::array<std::string, kRounds>, kThreads> names;
  on_threads(kThreads, [&](int thread) {
    for (int round = 0; round < kRounds; ++round) {
      // Two threads send every request.
      v1::CreateSimulationRequest request;
      *request.mutable_simulation() = point_simulation();
      request.mutable_simulation()->set_sump_temperature_celsius(20 + round % 7);
      if (round % 5 == 0) request.mutable_simulation()->set_deadline_seconds(0.001);
      request.set_force(round % 4 == 0);
      request.set_request_id(std::to_string(thread / 2) + "-" + std::to_string(round));
      const auto created = create_simulation(app, request);
      ASSERT_TRUE(created.ok()) << created.error().message();
      const std::string& name = created.message().name();
      names[static_cast<std::size_t>(thread)][static_cast<std::size_t>(round)] = name;
      auto watcher = std::make_shared<Watcher>([&] {
        v1::WatchSimulationRequest watch;
        watch.set_name(name);
        return watch_simulation(app, watch).message();
      }());
      watcher->start();
      if (round % 3 == 0) {
        v1::CancelSimulationRequest cancel;
        cancel.set_name(name);
        EXPECT_TRUE(cancel_simulation(app, cancel).ok());
      }
      for (std::int64_t after = 0; after <= 2; ++after) {
        std::int64_t expected = after;
        for (const std::int64_t number : numbers(app, name, after)) EXPECT_EQ(number, ++expected);
      }
      EXPECT_TRUE(eventually([&] { return watcher->ended(); }));
      EXPECT_GE(bench.get(name).state(), v1::Simulation::SUCCEEDED);
    }
  });
  for (int thread = 0; thread < kThreads; thread += 2) {
    EXPECT_EQ(names[static_cast<std::size_t>(thread)], names[static_cast<std::size_t>(thread) + 1])
        << "one simulation a request";
  }
}

TEST(Concurrency, DrainingWhileFedWatchedAndCancelled) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 3, {.jobs = 1000}, std::chrono::milliseconds(1));
  Application app = bench.application();
  std::atomic<int> accepted = 0;
  std::thread drainer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    bench.jobs().scheduler().drain(std::chrono::milliseconds(50), [] { return false; });
    bench.jobs().stop();
  });
  on_threads(4, [&](int thread) {
    for (int round = 0; round < 40; ++round) {
      v1::CreateSimulationRequest request;
      *request.mutable_simulation() = point_simulation();
      const auto created = create_simulation(app, request);
      if (!created.ok()) {
        EXPECT_EQ(created.error().code(), google::rpc::UNAVAILABLE);
        continue;
      }
      ++accepted;
      v1::CancelSimulationRequest cancel;
      cancel.set_name(created.message().name());
      if ((thread + round) % 2 != 0) continue;
      EXPECT_TRUE(cancel_simulation(app, cancel).ok());
    }
  });
  drainer.join();
  bench.restart(quick_studies());
  int found = 0;
  v1::ListSimulationsRequest list;
  list.set_page_size(1000);
  Application restarted = bench.application();
  const auto listed = list_simulations(restarted, list);
  for (const auto& each : listed.message().simulations()) {
    ++found;
    EXPECT_TRUE(eventually([&] { return bench.get(each.name()).state() >= 3; }));
  }
  EXPECT_EQ(found, accepted);
}

TEST(Concurrency, StoppingWhileWatchedAndFed) {
  auto release = std::make_shared<std::atomic<bool>>(false);
  Bench bench(patient_studies(release), 3);
  Application app = bench.application();
  std::vector<std::string> names;
  names.reserve(6);
  for (int i = 0; i < 6; ++i) names.push_back(bench.create(curve_simulation()));
  std::thread stopper([&] { bench.jobs().stop(); });
  on_threads(3, [&](int) {
    for (const std::string& name : names) {
      v1::WatchSimulationRequest watch;
      watch.set_name(name);
      EXPECT_TRUE(watch_simulation(app, watch).ok());
      v1::CreateSimulationRequest create;
      *create.mutable_simulation() = point_simulation();
      create_simulation(app, create);  // accepting and refusing are both correct
    }
  });
  stopper.join();
  for (const std::string& name : names) {
    EXPECT_EQ(bench.get(name).state(), v1::Simulation::QUEUED);
  }
}

TEST(Concurrency, NoUpdateIsLostAndNoRevisionIsMadeTwice) {
  Bench bench;
  Application app = bench.application();
  constexpr int kThreads = 4;
  constexpr int kRounds = 15;
  std::atomic<int> updated = 0;
  on_threads(kThreads, [&](int thread) {
    for (int round = 0; round < kRounds; ++round) {
      v1::UpdateLubricantRequest update;
      update.mutable_lubricant()->set_name("lubricants/paper-fluid-1");
      update.mutable_lubricant()->set_lims_id(std::to_string(thread) + "." + std::to_string(round));
      update.mutable_update_mask()->add_paths("lims_id");
      const auto outcome = update_lubricant(app, update);
      if (outcome.ok()) {
        ++updated;
      } else {
        EXPECT_EQ(outcome.error().code(), google::rpc::ABORTED) << "others keep changing it";
      }
      v1::ListLubricantsRequest list;
      list.set_filter("lims_id:" + std::to_string(thread) + ".");
      EXPECT_TRUE(list_lubricants(app, list).ok());
      v1::DeleteVehicleRequest remove;
      remove.set_name("vehicles/passenger-car");
      EXPECT_TRUE(delete_vehicle(app, remove).ok());
      v1::UndeleteVehicleRequest restore;
      restore.set_name(remove.name());
      const auto restored = undelete_vehicle(app, restore);
      EXPECT_TRUE(restored.ok() || restored.error().code() == google::rpc::ALREADY_EXISTS)
          << "another thread may have undeleted it";
    }
  });
  v1::GetLubricantRequest get;
  get.set_name("lubricants/paper-fluid-1");
  EXPECT_EQ(get_lubricant(app, get).message().revision(), 1 + updated);
}

TEST(Concurrency, ContactsAreEvaluatedSideBySideWithEqualBits) {
  Bench bench;
  Application app = bench.application();
  const auto expected = evaluate_contact(app, contact_request());
  ASSERT_TRUE(expected.ok()) << expected.error().message();
  on_threads(4, [&](int) {
    for (int i = 0; i < 50; ++i) {
      const auto outcome = evaluate_contact(app, contact_request());
      ASSERT_TRUE(outcome.ok());
      EXPECT_EQ(outcome.message().SerializeAsString(), expected.message().SerializeAsString());
    }
  });
}

}  // namespace
}  // namespace tribodyn::server
