#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/study/operating_point.h"
#include "tests/benchmark/marching_solvers.h"
#include "tests/benchmark/measurements.h"
#include "tests/benchmark/periodic_rivals.h"

namespace tribodyn {

struct Place {
  const char* name;
  double kilometres_per_hour;
  PointStart start;
  double error;  // asked of all
};

/// The errors at which rivals aim, in falling order.
inline constexpr double kTargets[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7};

struct Run {
  double accuracy = 0;  ///< tolerance, steps or intervals
  long contacts = 0;
  double microseconds = 0;
  double error = 0;
};

/// How a rival approaches the steady state: by mesh cycles or iterates.
struct Approach {
  std::vector<double> inefficiency, microseconds;
  std::vector<long> contacts;
};

/// Marches from a cold start, with T_s and the mean speed corrected after every mesh cycle, until
/// the errors are well within a target or fall no more.
Approach march(PreparedScene& scene, const Place& place, const MarchingSolver& solver,
               double accuracy, double least_target, const PointResult& truth);

/// Iterates after as few marched cycles as lead to the response; without iterates if none do.
Approach iterate(PreparedScene& scene, const Place& place, const PeriodicRival& rival,
                 double accuracy, const PointResult& truth);

/// Returns what it takes until the error of each cycle or iterate is and stays within a target, and
/// `recorded` more; nullopt if that never happens.
std::optional<Run> cost_of(const Approach& approach, double truth, double target, int recorded);

/// Returns what a rival takes that does not know the truth: it iterates until an iterate changes by
/// less than a tenth of the target, at finer and finer accuracies until two agree within it.
std::optional<Run> unaided_cost_of(const PeriodicRival& rival,
                                   const std::map<double, Approach>& approaches, double truth,
                                   double target);

inline double microseconds_since(double start) { return 1e6 * (processor_seconds() - start); }

}  // namespace tribodyn
