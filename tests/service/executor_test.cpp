// What becomes of jobs that take longer than they are estimated to, and of those that people wait
// for: on real threads, with studies that take processor time until they are released.
#include "server/execution/executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>

#include "core/refusal.h"
#include "server/application/simulations.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

constexpr double kSlowSpeed = 30;  // points below it are slow [km/h]

/// Studies whose slow points and curves compute until `release` is set; estimates do not know it.
StudyFunctions slow_studies(const std::shared_ptr<std::atomic<bool>>& release) {
  StudyFunctions out = quick_studies();
  const auto compute = [release](const std::function<bool(double)>& progress) {
    while (!*release) {
      if (!progress(0.5)) throw Cancelled();
    }
  };
  out.solve_operating_point = [compute, inner = out.solve_operating_point](
                                  const Scene& scene, const OperatingCondition& condition,
                                  const PointOptions& options, const auto& gear_set) {
    if (3.6 * condition.vehicle_speed < kSlowSpeed) compute(options.progress);
    return inner(scene, condition, options, gear_set);
  };
  out.sweep_speed = [compute, inner = out.sweep_speed](
                        const Scene& scene, const std::vector<double>& speeds, double angle,
                        const SweepOptions& options,
                        const std::function<void(const SweepPoint&)>& on_point,
                        const auto& gear_set) {
    compute(options.point.progress);
    return inner(scene, speeds, angle, options, on_point, gear_set);
  };
  return out;
}

class ExecutorTest : public testing::Test {
 protected:
  ~ExecutorTest() override { *release_ = true; }

  std::string create(const std::string& client, double speed,
                     v1::SchedulingClass requested = v1::SCHEDULING_CLASS_UNSPECIFIED) {
    v1::CreateSimulationRequest request;
    *request.mutable_simulation() = point_simulation();
    request.mutable_simulation()
        ->mutable_operating_point()
        ->mutable_cruise()
        ->set_speed_kilometres_per_hour(speed);
    request.set_scheduling_class(requested);
    CallContext call;
    call.client = client;
    Application application = bench_->application();
    const auto outcome = create_simulation(application, request, call);
    if (!outcome.ok()) throw std::runtime_error(outcome.error().message());
    return outcome.message().name();
  }
  void begin(int threads) { bench_ = std::make_unique<Bench>(slow_studies(release_), threads); }

  std::shared_ptr<std::atomic<bool>> release_ = std::make_shared<std::atomic<bool>>(false);
  std::unique_ptr<Bench> bench_;
};

TEST_F(ExecutorTest, SmallJobsOfAClientEndBesideJobsOfAnotherThatOutrunTheirEstimates) {
  const LogCapture log;
  begin(2);
  const std::string first = create("hog", 10);
  const std::string second = create("hog", 11);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(bench_->reaches(create("other", 60 + i), v1::Simulation::SUCCEEDED));
  }
  EXPECT_EQ(bench_->get(first).state(), v1::Simulation::RUNNING);
  EXPECT_EQ(bench_->get(second).state(), v1::Simulation::RUNNING);
  *release_ = true;
  EXPECT_TRUE(bench_->reaches(first, v1::Simulation::SUCCEEDED));
  EXPECT_TRUE(bench_->reaches(second, v1::Simulation::SUCCEEDED));
  bench_.reset();
  EXPECT_THAT(log.text(), testing::HasSubstr("event=simulation_reclassified simulation=" + first));
}

TEST_F(ExecutorTest, AnInteractiveJobEndsBesideTheLongJobOfItsClientOnTheOnlyThread) {
  begin(1);
  const std::string curve = bench_->create(curve_simulation());
  ASSERT_TRUE(bench_->reaches(curve, v1::Simulation::RUNNING));
  const std::string waiting = create("", 70);
  const std::string point = create("", 60, v1::SCHEDULING_CLASS_INTERACTIVE);
  EXPECT_TRUE(bench_->reaches(point, v1::Simulation::SUCCEEDED));
  EXPECT_EQ(bench_->get(curve).state(), v1::Simulation::RUNNING);
  *release_ = true;
  EXPECT_TRUE(bench_->reaches(waiting, v1::Simulation::SUCCEEDED));
  EXPECT_TRUE(bench_->reaches(curve, v1::Simulation::SUCCEEDED));
}

TEST_F(ExecutorTest, AJobEndsWhileTheLongHistoryOfAnotherIsWritten) {
  begin(1);
  v1::Simulation with_history = point_simulation();
  v1::HistoryRequest* history = with_history.mutable_operating_point()->mutable_history();
  for (const char* column : {"mesh_force_newtons", "mesh_loss_power_watts", "time_seconds"}) {
    history->add_columns(column);
  }
  history->set_mesh_cycles(50);
  history->set_samples_per_mesh_cycle(100'000);
  const std::string large = bench_->create(with_history);
  const std::string point = create("", 70);
  ASSERT_TRUE(bench_->reaches(point, v1::Simulation::SUCCEEDED));
  EXPECT_EQ(bench_->get(large).state(), v1::Simulation::RUNNING);
  EXPECT_TRUE(bench_->reaches(large, v1::Simulation::SUCCEEDED));
}

TEST_F(ExecutorTest, AnInteractiveJobThatOutrunsItsEstimateOnALentThreadWaitsAgain) {
  begin(1);
  const std::string curve = bench_->create(curve_simulation());
  ASSERT_TRUE(bench_->reaches(curve, v1::Simulation::RUNNING));
  const std::string slow = create("", 10, v1::SCHEDULING_CLASS_INTERACTIVE);
  const std::int64_t id = *simulation_id(slow);
  ASSERT_TRUE(eventually([&] { return bench_->store().next_event(id, 2).has_value(); }));
  const auto event = bench_->store().next_event(id, 2);
  EXPECT_EQ(event->state, StoredState::kQueued);
  EXPECT_EQ(event->reason, "OUTRAN_ESTIMATE");
  EXPECT_EQ(bench_->get(curve).state(), v1::Simulation::RUNNING);
  const std::string point = create("", 60, v1::SCHEDULING_CLASS_INTERACTIVE);
  EXPECT_TRUE(bench_->reaches(point, v1::Simulation::SUCCEEDED)) << "its thread is free again";
  *release_ = true;
  EXPECT_TRUE(bench_->reaches(curve, v1::Simulation::SUCCEEDED));
  EXPECT_TRUE(bench_->reaches(slow, v1::Simulation::SUCCEEDED));
}

}  // namespace
}  // namespace tribodyn::server
