#include "server/simulation/study_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/study/history.h"
#include "proto/enum_names.h"
#include "server/contract/constraints.h"
#include "server/contract/resource_names.h"
#include "server/mapping/history_columns.h"
#include "server/mapping/to_core.h"
#include "server/simulation/solver_defaults.h"

namespace tribodyn::server {
namespace {

/// Returns the number of speeds that first, last and step define; 0 if they define none.
double grid_size(const v1::InefficiencyCurveStudy& study) {
  const double first = study.first_speed_kilometres_per_hour();
  const double last = study.last_speed_kilometres_per_hour();
  const double step = study.speed_step_kilometres_per_hour();
  if (!(first > 0) || !(last >= first) || !(step > 0)) return 0;
  return std::floor((last - first) / step + 1e-9) + 1;
}

bool has_range(const v1::InefficiencyCurveStudy& study) {
  return study.first_speed_kilometres_per_hour() != 0 ||
         study.last_speed_kilometres_per_hour() != 0 || study.speed_step_kilometres_per_hour() != 0;
}

void check_speed_range(const v1::InefficiencyCurveStudy& study, const std::string& path,
                       Violations& violations) {
  const double first = study.first_speed_kilometres_per_hour();
  const double last = study.last_speed_kilometres_per_hour();
  const double step = study.speed_step_kilometres_per_hour();
  const auto missing = [&](const char* field, double value) {
    if (value == 0) {
      violations.add(join_path(path, field), "{} is not set; first, last and step need each other",
                     field);
    }
  };
  missing("first_speed_kilometres_per_hour", first);
  missing("last_speed_kilometres_per_hour", last);
  missing("speed_step_kilometres_per_hour", step);
  if (first != 0 && last != 0 && last < first) {
    violations.add(join_path(path, "last_speed_kilometres_per_hour"),
                   "last_speed_kilometres_per_hour = {} km/h; allowed: at least the first speed, "
                   "{} km/h; for a sweep downwards set direction",
                   last, first);
  }
}

void check_columns(const v1::HistoryRequest& history, const std::string& path,
                   Violations& violations) {
  if (history.columns().empty()) {
    violations.add(join_path(path, "columns"),
                   "columns is empty; name at least one, or leave history unset");
  }
  std::set<std::string> seen;
  const std::vector<std::string> known = history_column_names();
  const int count = std::min(history.columns_size(), kMaximumHistoryColumns);
  for (int i = 0; i < count; ++i) {
    const std::string& name = history.columns(i);
    const std::string element = fmt::format("{}.columns[{}]", path, i);
    if (!history_column(name)) {
      violations.add(element, "unknown column{}", meant_text(name, known));
    } else if (!seen.insert(name).second) {
      violations.add(element, "\"{}\" is named twice", name);
    }
  }
}

void check_history(const v1::HistoryRequest& history, const std::string& path,
                   Violations& violations) {
  check_columns(history, path, violations);
  double columns = 0;
  for (const std::string& name : history.columns()) {
    const std::optional<HistoryColumn> column = history_column(name);
    columns += column && is_per_flank(*column) ? kFlankPairs : 1;
  }
  const double cycles = history.mesh_cycles() == 0 ? kDefaultHistoryCycles : history.mesh_cycles();
  const double samples = history.samples_per_mesh_cycle() == 0 ? kDefaultHistorySamples
                                                               : history.samples_per_mesh_cycle();
  const double values = cycles * samples * columns;
  if (values > kMaximumHistoryValues) {
    violations.add(path, "{} cycles of {} samples in {} columns are {} values; allowed: at most {}",
                   cycles, samples, columns, values, kMaximumHistoryValues);
  }
}

}  // namespace

void check_fluid_at_inlet(const v1::Lubricant& lubricant, double sump_temperature_celsius,
                          double inlet_temperature_rise_kelvin, const std::string& path,
                          Violations& violations) {
  const double inlet = sump_temperature_celsius + kZeroCelsius + inlet_temperature_rise_kelvin;
  const double reference = lubricant.vogel_reference_temperature_kelvin();
  const double measured = lubricant.pressure_viscosity_temperature_kelvin();
  if (inlet <= reference) {
    violations.add(path, "T_0,ref = {} K; allowed: below the inlet temperature, {:.6g} K (eq 34)",
                   reference, inlet);
  }
  if (!lubricant.has_improved_yasutomi() && measured <= reference) {
    violations.add(path, "T_0,ref = {} K; allowed: below the temperature of alpha*, {} K (eq 33)",
                   reference, measured);
  }
  const double density = lubricant.density_at_zero_kelvin_kilograms_per_cubic_metre() +
                         lubricant.density_slope_kilograms_per_cubic_metre_kelvin() * inlet;
  if (density <= 0) {
    violations.add(path,
                   "density at the inlet temperature {:.6g} K is {:.6g} kg/m3; "
                   "allowed: positive (eq 26)",
                   inlet, density);
  }
}

void check_pour_point(const v1::Lubricant& lubricant, double sump_temperature_celsius,
                      const std::string& path, Violations& violations, std::string_view name) {
  if (!lubricant.has_pour_point_celsius() ||
      sump_temperature_celsius >= lubricant.pour_point_celsius()) {
    return;
  }
  violations.add(path, "{} is at {} C; allowed: at least the pour point, {} C", name,
                 sump_temperature_celsius, lubricant.pour_point_celsius());
}

std::pair<std::string, std::string> refusal_at_inlet(const v1::Lubricant& lubricant,
                                                     double sump_temperature_celsius,
                                                     double inlet_temperature_rise_kelvin) {
  Violations found;
  check_pour_point(lubricant, sump_temperature_celsius, "lubricant", found);
  if (!found.empty()) return {"BELOW_POUR_POINT", found.front().description};
  check_fluid_at_inlet(lubricant, sump_temperature_celsius, inlet_temperature_rise_kelvin,
                       "lubricant", found);
  if (!found.empty()) return {"INVALID_AT_INLET", found.front().description};
  return {};
}

void check_operating_point(const v1::OperatingPointStudy& study, const std::string& path,
                           Violations& violations) {
  if (study.condition_case() == v1::OperatingPointStudy::CONDITION_NOT_SET) {
    violations.add(join_path(path, "condition"),
                   "not set; allowed: cruise, drive_cycle_snapshot or prescribed_torque");
  }
  if (study.has_history()) check_history(study.history(), join_path(path, "history"), violations);
}

void check_march_tolerances(const v1::SolverOptions& options, v1::PointModel model,
                            const std::string& path, Violations& violations) {
  const bool is_quasi_static = model == v1::POINT_MODEL_QUASI_STATIC;
  if (!is_quasi_static && options.method() != v1::STEADY_STATE_METHOD_SHOOTING) return;
  const auto check = [&](const char* field, double value, double unset) {
    if (value == 0 || value == unset) return;
    violations.add(join_path(path, field),
                   "{} = {} has no effect: {} never marches; leave it unset and set tolerance, "
                   "which every method keeps, or set {}",
                   field, value, is_quasi_static ? "model = QUASI_STATIC" : "method = SHOOTING",
                   is_quasi_static ? "model = FULL and method = MARCH" : "method = MARCH");
  };
  const PointOptions defaults;
  check("march_step_tolerance", options.march_step_tolerance(), defaults.march_step_tolerance);
  check("march_settling_tolerance", options.march_settling_tolerance(),
        defaults.march_settling_tolerance);
}

void check_curve(const v1::InefficiencyCurveStudy& study, const v1::SolverOptions& options,
                 const std::string& path, Violations& violations) {
  if (study.independent_points() && study.direction() != v1::SWEEP_DIRECTION_UNSPECIFIED) {
    violations.add(join_path(path, "direction"),
                   "direction = {} together with independent_points; allowed: unset, as a "
                   "direction is that in which a branch is followed from point to point",
                   short_name(*v1::SweepDirection_descriptor(), study.direction()));
  }
  const bool explicit_speeds = !study.speeds_kilometres_per_hour().empty();
  const std::string speeds = join_path(path, "speeds_kilometres_per_hour");
  if (explicit_speeds && has_range(study)) {
    violations.add(speeds, "set together with first, last and step; allowed: one of the two");
    return;
  }
  if (!explicit_speeds && !has_range(study)) {
    violations.add(speeds, "not set; allowed: explicit speeds, or first, last and step");
    return;
  }
  if (!explicit_speeds) check_speed_range(study, path, violations);
  const double points =
      explicit_speeds ? study.speeds_kilometres_per_hour_size() : grid_size(study);
  const std::string density =
      explicit_speeds ? speeds : join_path(path, "speed_step_kilometres_per_hour");
  if (points > kMaximumCurvePoints) {
    violations.add(density, "{} points; allowed: at most {} (work limit)", points,
                   kMaximumCurvePoints);
    return;
  }
  if (study.sensitivities() && points > kMaximumDifferentiatedCurvePoints) {
    violations.add(density,
                   "{} points with sensitivities; allowed: at most {}, which one answer holds; "
                   "divide the curve, or leave sensitivities unset",
                   points, kMaximumDifferentiatedCurvePoints);
  }
  if (explicit_speeds) {
    const auto& list = study.speeds_kilometres_per_hour();
    std::vector<double> sorted(list.begin(), list.end());
    std::erase_if(sorted, [](double speed) { return !std::isfinite(speed); });
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) {
      violations.add(speeds, "{} km/h is named twice", *twice);
    }
  }
  const double cycles =
      options.maximum_mesh_cycles() == 0 ? kDefaultMaximumCycles : options.maximum_mesh_cycles();
  if (points * cycles > kMaximumCurveMeshCycles) {
    violations.add(
        path, "{} points of up to {} mesh cycles; allowed: a product of at most {} (work limit)",
        points, cycles, kMaximumCurveMeshCycles);
  }
}

void check_law_options(const v1::Lubricant& lubricant, const v1::ModelOptions& options,
                       const std::string& path, Violations& violations) {
  if (!lubricant.has_improved_yasutomi()) return;
  const auto refuse = [&](const char* field, const char* text) {
    violations.add(join_path(path, field),
                   "{}, as {} follows improved_yasutomi and neither eq 31 nor eq 32", text,
                   lubricant.name().empty() ? "the lubricant" : lubricant.name());
  };
  if (options.as_published().eq31_32_logarithm()) {
    refuse("as_published.eq31_32_logarithm", "true; allowed: false");
  }
  if (options.pressure_viscosity_index() == v1::ModelOptions::PRESSURE_VISCOSITY_INDEX_HOUPERT) {
    refuse("pressure_viscosity_index", "PRESSURE_VISCOSITY_INDEX_HOUPERT; allowed: unset");
  }
}

void check_model_options(const v1::ModelOptions& options, const std::string& path,
                         Violations& violations) {
  if (!options.as_published().eq46_square_root_of_sum()) return;
  violations.add(
      join_path(path, "as_published.eq46_square_root_of_sum"),
      "true; allowed: false, as eq 46 acts where measured profiles become a surface: set "
      "eq46_square_root_of_sum of ImportSurfaceProfilesRequest and use that surface here");
}

void check_mesh_data(const v1::GearSet& gear_set, const v1::ModelOptions& options,
                     const std::string& path, Violations& violations) {
  if (!options.load_dependent_mesh_data()) return;
  if (gear_set.series_by_torque().empty() || gear_set.load_share_by_torque().empty()) {
    violations.add(path,
                   "load_dependent_mesh_data = true; allowed: false, as {} "
                   "holds no data by torque (eqs 8-11)",
                   gear_set.name());
  }
}

std::vector<double> curve_speeds(const v1::InefficiencyCurveStudy& study) {
  const auto& list = study.speeds_kilometres_per_hour();
  std::vector<double> speeds(list.begin(), list.end());
  if (speeds.empty()) {
    const int count = static_cast<int>(std::min(grid_size(study), kMaximumCurvePoints + 1.0));
    for (int i = 0; i < count; ++i) {
      speeds.push_back(study.first_speed_kilometres_per_hour() +
                       i * study.speed_step_kilometres_per_hour());
    }
  }
  std::sort(speeds.begin(), speeds.end());
  return speeds;
}

}  // namespace tribodyn::server
