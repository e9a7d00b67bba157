#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/refusal.h"
#include "core/study/cycle_loss.h"
#include "core/study/screening.h"
#include "core/uncertainty/drawn_value.h"
#include "core/uncertainty/normal_draws.h"
#include "core/uncertainty/spread.h"
#include "core/vehicle/drive_cycle.h"
#include "core/vehicle/vehicle.h"
#include "tests/benchmark/measurements.h"
#include "tests/benchmark/varied_scenes.h"
#include "tests/support/cruise.h"
#include "tests/support/figure_error.h"

// Error against work of what users wait for, on the reference gear set, one thread, processor time:
//
// - cycle: the mesh loss of a drive cycle at tolerances of the map from 1e-1 to 1e-4, and point by
//   point; points at the usual tolerance. The truth is point by point at 1e-5. Two cycles: the
//   NEDC, whose pieces repeat, and a trace of half an hour in which hardly any do.
// - draws: the 95 % interval of the inefficiency at 100 km/h by the number of draws, from several
//   seeds, over the interval of 20,000 draws. Every draw is solved.
// - campaign: random lubricants at 20 to 140 km/h and three sumps by tolerance: median and largest
//   error, against the same points at 1e-7.
namespace tribodyn {
namespace {

/// A point of a curve.
struct Row {
  std::string study, curve;
  double setting;         ///< tolerance, or number of draws; 0: point by point
  double points;          ///< of the model
  double seconds;         ///< of the whole; campaign: of a point
  double value;           ///< error of the loss; median of widths over the right one; median error
  double least, largest;  ///< over seeds or points; cycle: both the estimated error
};

template <class Run>
double seconds_of(Run&& run) {
  const double start = processor_seconds();
  run();
  return processor_seconds() - start;
}

/// Solves a place of a map as the service does.
LossForces loss_forces(PreparedScene& prepared, double tolerance) {
  return [&prepared, tolerance](const std::vector<MapPlace>& places, LossEffort effort) {
    const Vehicle& vehicle = prepared.scene().vehicle;
    PointOptions options;
    options.tolerance = tolerance;
    options.gives_up_early = effort == LossEffort::kBrief;
    if (effort == LossEffort::kQuasiStatic) options.model = PointModel::kQuasiStatic;
    std::vector<std::optional<LossForce>> out;
    for (const auto& [speed, torque, temperature] : places) {
      OperatingCondition condition;
      condition.kind = OperatingCondition::Kind::kDriveCycleSnapshot;
      condition.vehicle_speed = speed;
      condition.acceleration =
          (torque - wheel_torque(vehicle, speed, 0, 0)) / (vehicle.wheel_radius * vehicle.mass);
      try {
        const PointFigures figures = solve_point_figures(prepared, condition, options);
        const double force = figures.mesh_loss_power / speed;
        constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
        out.push_back(
            LossForce{force, force * figures.estimated_relative_error.value_or(kUnknown)});
      } catch (const Refusal& refusal) {
        if (effort != LossEffort::kBrief || refusal.reason() != "NOT_FOUND_BY_SHOOTING") throw;
        out.push_back(std::nullopt);
      }
    }
    return out;
  };
}

/// Town, country and motorway in turns, once a second, as recorded to 0.1 km/h.
DriveCycle restless_trace() {
  DriveCycle out{"restless trace", {}};
  for (int second = 0; second <= 1800; ++second) {
    const auto wave = [&](double period) {
      return std::sin(2 * std::numbers::pi * second / period);
    };
    const double cruise = 60 - 45 * std::cos(2 * std::numbers::pi * second / 900);
    const double speed =
        std::max(0.0, cruise * (1 + 0.1 * wave(41)) + 12 * wave(67) + 6 * wave(23));
    out.places.push_back({1.0 * second, std::round(10 * speed) / 10 / 3.6});
  }
  return out;
}

std::vector<Row> cycle_rows() {
  constexpr double kExact = 1e-5;
  const Scene scene = reference_scene();
  std::vector<Row> out;
  for (DriveCycle trace : {nedc(), restless_trace()}) {
    for (CyclePlace& place : trace.places) place.sump_temperature = scene.sump_temperature;
    const DrivenCycle cycle = driven_cycle(pieces_of(trace), scene.vehicle);
    const auto loss_of = [&](double point_tolerance, const LossMapOptions& options) {
      PreparedScene prepared(scene);
      return cycle_loss(cycle, loss_forces(prepared, point_tolerance), options);
    };
    const auto sum = [](const CycleLoss& loss) {
      return std::accumulate(loss.energies.begin(), loss.energies.end(), 0.0);
    };
    LossMapOptions by_point;
    by_point.is_point_by_point = true;
    const double exact = sum(loss_of(kExact, by_point));
    const auto add = [&](const std::string& curve, double setting, const LossMapOptions& options) {
      CycleLoss loss;
      const double seconds = seconds_of([&] { loss = loss_of(PointOptions{}.tolerance, options); });
      const double estimate = loss.map_error / exact;
      out.push_back({"cycle", trace.name + curve, setting, static_cast<double>(loss.points),
                     seconds, std::abs(sum(loss) / exact - 1), estimate, estimate});
    };
    for (const double tolerance : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4}) {
      LossMapOptions options;
      options.tolerance = tolerance;
      add(" by map", tolerance, options);
    }
    add(" point by point", 0, by_point);
  }
  return out;
}

/// The width of the interval of the inefficiency [%] over draws of the varied parameters.
double interval_width(const std::shared_ptr<PreparedGearSet>& gear_set, int count,
                      std::uint64_t seed) {
  constexpr double kKilometresPerHour = 100;
  const Scene stated = reference_scene();
  const NormalDraws draws(count, static_cast<int>(std::size(kVariedParameters)), seed);
  std::vector<double> drawn;
  for (int n = 0; n < count; ++n) {
    Scene scene = stated;
    for (std::size_t i = 0; i < std::size(kVariedParameters); ++i) {
      const VariedParameter& each = kVariedParameters[i];
      double& value = each.of(scene);
      value = drawn_value(value, 0.5 * each.share * value, draws.at(n, static_cast<int>(i)));
    }
    PreparedScene prepared(scene, gear_set);
    drawn.push_back(
        screen_point(prepared, cruise(kKilometresPerHour), {}).inefficiency_energy_mean.value());
  }
  const Spread spread = spread_of(std::move(drawn));
  return spread.high - spread.low;
}

std::vector<Row> draw_rows(int seeds) {
  constexpr int kMany = 20'000;
  const Scene scene = reference_scene();
  const auto gear_set =
      std::make_shared<PreparedGearSet>(scene.gear_set, scene.solid, scene.options);
  const double exact = interval_width(gear_set, kMany, 0);
  std::vector<Row> out;
  for (const int count : {10, 20, 50, 100, 200, 500, 1000, 2000}) {
    std::vector<double> widths;
    const double seconds = seconds_of([&] {
      for (int seed = 1; seed <= seeds; ++seed) {
        widths.push_back(interval_width(gear_set, count, static_cast<std::uint64_t>(seed)) / exact);
      }
    });
    const auto [least, largest] = std::minmax_element(widths.begin(), widths.end());
    out.push_back({"draws", "95 % interval", 1.0 * count, 1.0 * count, seconds / seeds,
                   median(widths), *least, *largest});
  }
  return out;
}

std::vector<Row> campaign_rows(int lubricants) {
  constexpr double kExact = 1e-7;
  const std::vector<Scene> scenes = varied_scenes(lubricants);
  const auto gear_set =
      std::make_shared<PreparedGearSet>(scenes[0].gear_set, scenes[0].solid, scenes[0].options);
  const auto for_all = [&](const auto& solve) {
    for (const Scene& scene : scenes) {
      PreparedScene prepared(scene, gear_set);
      for (double speed = 20; speed <= 140; speed += 10) solve(prepared, cruise(speed));
    }
  };
  std::vector<PointResult> exact;
  for_all([&](PreparedScene& prepared, const OperatingCondition& condition) {
    PointOptions options;
    options.model = PointModel::kFull;
    options.tolerance = kExact;
    exact.push_back(solve_prepared_point(prepared, condition, options));
  });
  std::vector<Row> out;
  for (const double tolerance : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5}) {
    std::vector<PointFigures> found;
    const double seconds = seconds_of([&] {
      for_all([&](PreparedScene& prepared, const OperatingCondition& condition) {
        PointOptions options;
        options.tolerance = tolerance;
        found.push_back(screen_point(prepared, condition, options));
      });
    });
    std::vector<double> errors;
    for (std::size_t i = 0; i < found.size(); ++i) errors.push_back(true_error(found[i], exact[i]));
    const auto [least, largest] = std::minmax_element(errors.begin(), errors.end());
    const double points = static_cast<double>(errors.size());
    out.push_back({"campaign", "random lubricants", tolerance, points, seconds / points,
                   median(errors), *least, *largest});
  }
  return out;
}

void print(const std::vector<Row>& rows, std::ofstream& csv) {
  std::printf("\n%-34s %8s %8s %12s %10s %10s %10s\n", rows[0].study.c_str(), "setting", "points",
              "milliseconds", "value", "least", "largest");
  for (const Row& row : rows) {
    std::printf("%-34s %8g %8g %12.4g %10.3g %10.3g %10.3g\n", row.curve.c_str(), row.setting,
                row.points, 1e3 * row.seconds, row.value, row.least, row.largest);
    csv << row.study << ',' << row.curve << ',' << row.setting << ',' << row.points << ','
        << row.seconds << ',' << row.value << ',' << row.least << ',' << row.largest << '\n';
  }
}

int run(const std::string& table, int lubricants, int seeds) {
  std::ofstream csv(table);
  csv << "study,curve,setting,points,seconds,value,least,largest\n";
  std::printf("%s; %d lubricants, %d seeds\n", machine_name().c_str(), lubricants, seeds);
  print(cycle_rows(), csv);
  print(draw_rows(seeds), csv);
  print(campaign_rows(lubricants), csv);
  return 0;
}

}  // namespace
}  // namespace tribodyn

/// usage: user_waits_benchmark [table.csv [lubricants [seeds]]]
int main(int count, char** arguments) try {
  return tribodyn::run(count > 1 ? arguments[1] : "/dev/null",
                       count > 2 ? std::atoi(arguments[2]) : 30,
                       count > 3 ? std::atoi(arguments[3]) : 20);
} catch (const std::exception& error) {
  std::fprintf(stderr, "user_waits_benchmark: %s\n", error.what());
  return 1;
}
