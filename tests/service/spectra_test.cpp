// ReadSpectrum: spectra of stored histories over orders of the mesh frequency.
#include "server/application/spectra.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "google/rpc/code.pb.h"
#include "server/application/simulations.h"
#include "server/application/streams.h"
#include "tests/service/support.h"

namespace tribodyn::server {
namespace {

using testing::HasSubstr;

/// Studies whose responses repeat after some mesh cycles; 0: never.
StudyFunctions studies_of_period(int mesh_cycles) {
  StudyFunctions out = quick_studies();
  out.solve_operating_point = [quick = out.solve_operating_point, mesh_cycles](
                                  const Scene& scene, const OperatingCondition& condition,
                                  const PointOptions& options, const auto& gear_set) {
    PointResult result = quick(scene, condition, options, gear_set);
    result.period_in_mesh_cycles = mesh_cycles;
    result.mesh_frequency = 500;
    return result;
  };
  return out;
}

class ReadSpectrum : public testing::Test {
 protected:
  explicit ReadSpectrum(int period = 1) : bench_(studies_of_period(period)) {}

  /// Returns the name of a finished point with a history.
  std::string history(int cycles, int samples) {
    v1::Simulation point = point_simulation();
    v1::HistoryRequest& request = *point.mutable_operating_point()->mutable_history();
    for (const char* column : {"time_seconds", "dynamic_transmission_error_metres",
                               "inefficiency_percent", "flank_load_newtons"}) {
      request.add_columns(column);
    }
    request.set_mesh_cycles(cycles);
    request.set_samples_per_mesh_cycle(samples);
    std::string name = bench_.create(point);
    EXPECT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
    return name;
  }

  Outcome<v1::ReadSpectrumResponse> read(const std::string& name, double order = 0,
                                         const std::vector<std::string>& columns = {}) {
    v1::ReadSpectrumRequest request;
    request.set_name(name);
    request.set_maximum_order(order);
    for (const std::string& column : columns) request.add_columns(column);
    return read_spectrum(app_, request, {});
  }

  std::vector<double> samples_of(const std::string& name, const std::string& column) {
    v1::ReadHistoryRequest request;
    request.set_name(name);
    request.add_columns(column);
    const auto rows = read_history(app_, request, {});
    std::vector<double> out;
    v1::ReadHistoryResponse part;
    while (rows.message()->next(part) == MessageSource<v1::ReadHistoryResponse>::Step::kMessage) {
      if (!part.has_chunk()) continue;
      const std::string& bytes = part.chunk().values();
      const std::size_t before = out.size();
      out.resize(before + bytes.size() / sizeof(double));
      std::memcpy(out.data() + before, bytes.data(), bytes.size());
    }
    return out;
  }

  Bench bench_;
  Application app_ = bench_.application();
};

TEST_F(ReadSpectrum, TheSeriesOfItsOrdersIsTheHistory) {
  const std::string name = history(1, 96);
  const auto answer = read(name, 48);
  ASSERT_TRUE(answer.ok()) << answer.error().message();
  const v1::ReadSpectrumResponse& spectrum = answer.message();
  EXPECT_EQ(spectrum.mesh_cycles(), 1);
  EXPECT_EQ(spectrum.samples_per_mesh_cycle(), 96);
  EXPECT_TRUE(spectrum.is_periodic());
  EXPECT_EQ(spectrum.mesh_frequency_hertz(), 500);
  ASSERT_EQ(spectrum.orders_size(), 48);
  ASSERT_EQ(spectrum.columns_size(), 5) << "three flanks; no time";
  for (const v1::OrderSpectrum& column : spectrum.columns()) {
    SCOPED_TRACE(column.name());
    const std::vector<double> samples = samples_of(name, column.name());
    double squares = 0;
    for (int k = 0; k < 48; ++k) {
      squares += (k == 47 ? 1 : 0.5) * column.amplitudes(k) * column.amplitudes(k);
    }
    const double square = std::pow(column.alternating_root_mean_square_value(), 2);
    EXPECT_NEAR(squares, square, 1e-12 * square) << "Parseval";
    for (int i = 0; i < 96; i += 7) {
      double value = column.mean();
      for (int k = 0; k < 48; ++k) {
        value +=
            column.amplitudes(k) * std::cos(2 * std::numbers::pi * spectrum.orders(k) * i / 96 +
                                            column.phase_angles_radians(k));
      }
      EXPECT_NEAR(value, samples[static_cast<std::size_t>(i)],
                  1e-12 * (std::abs(column.mean()) + column.alternating_root_mean_square_value()));
    }
  }
  EXPECT_EQ(spectrum.columns(0).unit(), "m");
}

class ReadSpectrumOfPeriodTwo : public ReadSpectrum {
 protected:
  ReadSpectrumOfPeriodTwo() : ReadSpectrum(2) {}
};

TEST_F(ReadSpectrumOfPeriodTwo, APeriodOfALongHistoryIsTransformed) {
  const auto four = read(history(4, 96)), two = read(history(2, 96));
  ASSERT_TRUE(four.ok());
  EXPECT_EQ(four.message().mesh_cycles(), 2);
  EXPECT_EQ(four.message().orders_size(), 40);
  EXPECT_EQ(four.message().orders(0), 0.5);
  EXPECT_TRUE(four.message().SerializeAsString() == two.message().SerializeAsString());
}

TEST_F(ReadSpectrumOfPeriodTwo, AHistoryShorterThanThePeriodIsRefusedWithWhatToComputeInstead) {
  const auto answer = read(history(1, 96));
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().code(), google::rpc::FAILED_PRECONDITION);
  EXPECT_THAT(answer.error().message(),
              HasSubstr("repeats after 2 mesh cycles, and its history holds fewer; compute it with "
                        "history.mesh_cycles = 2"));
}

class ReadSpectrumWithoutPeriod : public ReadSpectrum {
 protected:
  ReadSpectrumWithoutPeriod() : ReadSpectrum(0) {}
};

TEST_F(ReadSpectrumWithoutPeriod, TheWholeHistoryIsTransformed) {
  const auto answer = read(history(3, 96));
  ASSERT_TRUE(answer.ok());
  EXPECT_FALSE(answer.message().is_periodic());
  EXPECT_EQ(answer.message().mesh_cycles(), 3);
  EXPECT_EQ(answer.message().orders_size(), 60);
}

TEST_F(ReadSpectrum, AColumnOfFlanksStandsForItsThreeFlanks) {
  const std::string name = history(1, 96);
  const auto answer = read(name, 2, {"flank_load_newtons"});
  ASSERT_TRUE(answer.ok());
  ASSERT_EQ(answer.message().columns_size(), 3);
  EXPECT_EQ(answer.message().columns(2).name(), "flank_load_newtons_flank_2");
  EXPECT_EQ(answer.message().columns(2).amplitudes_size(), 2);
}

TEST_F(ReadSpectrum, RefusesWhatItCannotTransform) {
  const std::string name = history(1, 99'991);  // a prime
  const auto answer = read(name);
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().code(), google::rpc::FAILED_PRECONDITION);
  EXPECT_THAT(answer.error().message(), HasSubstr("has a history of 99991 samples to transform"));
  const auto many = read(name, 30'000);
  ASSERT_FALSE(many.ok());
  EXPECT_THAT(many.error().message(), HasSubstr("30000 orders of 5 columns; allowed: at most"));
  const auto column = read(name, 1, {"flank_lode_newtons"});
  ASSERT_FALSE(column.ok());
  EXPECT_THAT(column.error().message(), HasSubstr("no such column here; did you mean"));
  const auto order = read(name, -1);
  EXPECT_THAT(order.error().message(), HasSubstr("maximum_order = -1"));
}

TEST_F(ReadSpectrum, RefusesASimulationWithoutHistory) {
  const std::string name = bench_.create(point_simulation());
  EXPECT_TRUE(bench_.reaches(name, v1::Simulation::SUCCEEDED));
  EXPECT_EQ(read(name).error().code(), google::rpc::NOT_FOUND);
  EXPECT_EQ(read("simulations/99").error().code(), google::rpc::NOT_FOUND);
}

}  // namespace
}  // namespace tribodyn::server
