#include "server/simulation/rig_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/refusal.h"
#include "core/study/figure_limits.h"
#include "core/study/range_warnings.h"
#include "core/version.h"
#include "server/contract/check_message.h"
#include "server/mapping/to_core.h"
#include "server/resources/lubricant_parameters.h"
#include "server/simulation/fluid_grounds.h"
#include "server/simulation/refused_rows.h"
#include "server/simulation/rig_uncertainty.h"
#include "server/simulation/row_warnings.h"
#include "server/simulation/study_checks.h"

namespace tribodyn::server {
namespace {

constexpr Solid kRigSteel{.youngs_modulus = 210e9,
                          .poissons_ratio = 0.3,
                          .thermal_conductivity = 46,
                          .density = 7850,
                          .specific_heat_capacity = 470};

Solid solid(bool is_set, const v1::RigBody& body) {
  if (!is_set) return kRigSteel;
  return {.youngs_modulus = body.youngs_modulus_pascals(),
          .poissons_ratio = body.poissons_ratio(),
          .thermal_conductivity = body.thermal_conductivity_watts_per_metre_kelvin(),
          .density = body.density_kilograms_per_cubic_metre(),
          .specific_heat_capacity = body.specific_heat_capacity_joules_per_kilogram_kelvin()};
}

/// sigma_G of the specimens in place of that of the surface; eta_G beta_G sigma_G stays.
Roughness with_height(Roughness surface, double height) {
  if (height == 0) return surface;
  surface.asperity_density *= surface.composite_rms_height / height;
  surface.composite_rms_height = height;
  return surface;
}

SolidPair solids_of(const v1::EvaluateRigRequest& request) {
  return {solid(request.has_body_1(), request.body_1()),
          solid(request.has_body_2(), request.body_2())};
}

EffectiveRadii radii_of(const v1::EvaluateRigRequest& request) {
  const double radius_y = request.radius_y_metres();
  return {request.radius_x_metres(), radius_y == 0 ? request.radius_x_metres() : radius_y};
}

constexpr RigColumn kRigColumns[] = {
    {"traction_coefficient", &v1::EvaluateRigResponse::mutable_traction_coefficient,
     &RigPoint::traction_coefficient},
    {"central_film_thickness_metres",
     &v1::EvaluateRigResponse::mutable_central_film_thickness_metres,
     &RigPoint::central_film_thickness},
    {"minimum_film_thickness_metres",
     &v1::EvaluateRigResponse::mutable_minimum_film_thickness_metres,
     &RigPoint::minimum_film_thickness},
    {"film_ratio", &v1::EvaluateRigResponse::mutable_film_ratio, &RigPoint::film_ratio},
    {"mean_pressure_pascals", &v1::EvaluateRigResponse::mutable_mean_pressure_pascals,
     &RigPoint::mean_pressure},
    {"maximum_pressure_pascals", &v1::EvaluateRigResponse::mutable_maximum_pressure_pascals,
     &RigPoint::maximum_pressure},
    {"contact_temperature_kelvin", &v1::EvaluateRigResponse::mutable_contact_temperature_kelvin,
     &RigPoint::contact_temperature},
    {"flash_temperature_rise_kelvin",
     &v1::EvaluateRigResponse::mutable_flash_temperature_rise_kelvin,
     &RigPoint::flash_temperature_rise},
    {"boundary_friction_share", &v1::EvaluateRigResponse::mutable_boundary_friction_share,
     &RigPoint::boundary_friction_share},
    {"limiting_stress_area_share", &v1::EvaluateRigResponse::mutable_limiting_stress_area_share,
     &RigPoint::limiting_stress_area_share},
};

/// Rows times (draws + 1) of one request. A contact takes about 4.5 us, of cold oil under fast
/// sliding 13 us (measured over 5000 rows with 199 draws): a request takes seconds.
constexpr long kMaximumRigContacts = 1'000'000;
constexpr double kLeastRigLoad = 1e-6, kMostRigLoad = 1e6;  // [N], of RigCondition

/// Returns the loads of a grid: as stated, or under which the dry contact has its mean pressures.
std::vector<double> grid_loads(const v1::EvaluateRigRequest& request) {
  const v1::RigGrid& grid = request.grid();
  std::vector<double> out(grid.loads_newtons().begin(), grid.loads_newtons().end());
  for (const double pressure : grid.mean_pressures_pascals()) {
    out.push_back(load_of_mean_pressure(solids_of(request), radii_of(request), pressure));
  }
  return out;
}

double combinations_of(const v1::RigGrid& grid) {
  double out = grid.loads_newtons_size() + grid.mean_pressures_pascals_size();
  for (const int values :
       {grid.supply_temperatures_celsius_size(), grid.entrainment_speeds_metres_per_second_size(),
        grid.slide_roll_ratios_percent_size()}) {
    out *= values;
  }
  return out;
}

/// Adds a violation for each list that is missing or too much, and for too many combinations.
void check_grid(const v1::RigGrid& grid, int most, Violations& violations) {
  if (grid.loads_newtons().empty() == grid.mean_pressures_pascals().empty()) {
    violations.add("grid.loads_newtons", "{}; allowed: either loads or mean pressures",
                   grid.loads_newtons().empty() ? "not set, nor are mean_pressures_pascals"
                                                : "set together with mean_pressures_pascals");
  }
  const auto count = [&](const char* field, int values) {
    if (values == 0) {
      violations.add(std::string("grid.") + field, "not set; allowed: at least one value");
    }
  };
  count("supply_temperatures_celsius", grid.supply_temperatures_celsius_size());
  count("entrainment_speeds_metres_per_second", grid.entrainment_speeds_metres_per_second_size());
  count("slide_roll_ratios_percent", grid.slide_roll_ratios_percent_size());
  const double combinations = combinations_of(grid);
  if (combinations > most) {
    violations.add("grid", "{} combinations; allowed: at most {}", combinations, most);
  }
}

/// Adds a violation if the rows are too many for the draws. Rows beyond their own limit are not
/// named twice.
void check_draws(const v1::EvaluateRigRequest& request, Violations& violations) {
  const double rows = rig_condition_count(request);
  if (request.draws() <= 0 || rows > kMaximumRigConditions) return;
  const long contacts = std::lround(rows) * (request.draws() + 1L);
  if (contacts <= kMaximumRigContacts) return;
  violations.add("draws",
                 "{} draws of {} rows are {} contacts; allowed: at most {}, rows times "
                 "(draws + 1): take at most {} draws, or send fewer rows at once",
                 request.draws(), rows, contacts, kMaximumRigContacts,
                 kMaximumRigContacts / std::lround(rows) - 1);
}

void check_grid_loads(const v1::EvaluateRigRequest& request, Violations& violations) {
  const v1::RigGrid& grid = request.grid();
  const std::vector<double> loads = grid_loads(request);
  for (int i = 0; i < grid.mean_pressures_pascals_size(); ++i) {
    const double load =
        loads[static_cast<std::size_t>(grid.loads_newtons_size()) + static_cast<std::size_t>(i)];
    if (load >= kLeastRigLoad && load <= kMostRigLoad) continue;
    violations.add(fmt::format("grid.mean_pressures_pascals[{}]", i),
                   "{} Pa needs a load of {:.4g} N; allowed: {} to {} N",
                   grid.mean_pressures_pascals(i), load, kLeastRigLoad, kMostRigLoad);
  }
}

}  // namespace

std::vector<RangeWarning> rig_warnings(const RigScene& scene, const FluidGrounds& grounds,
                                       double supply_temperature_celsius, const RigPoint& point,
                                       bool with_sentences) {
  RangeFigures figures;
  figures.maximum_pressure = point.maximum_pressure;
  figures.film_ratio = point.film_ratio;
  figures.film_thickness = point.central_film_thickness;
  figures.contact_temperature = point.contact_temperature;
  figures.limiting_stress_area_share = point.limiting_stress_area_share;
  figures.inlet_heating_factor = point.inlet_heating_factor;
  figures.inlet_viscosity = point.inlet_viscosity;
  return range_warnings(
      {grounds, scene.options, scene.roughness, supply_temperature_celsius + kZeroCelsius}, figures,
      with_sentences);
}

std::span<const RigColumn> rig_columns() { return kRigColumns; }

void set_surface(const v1::Surface& surface, double composite_rms_height, RigScene& scene) {
  scene.roughness = with_height(roughness(surface), composite_rms_height);
  scene.boundary = boundary_friction(surface);
}

double rig_condition_count(const v1::EvaluateRigRequest& request) {
  return request.has_grid() ? combinations_of(request.grid()) : request.conditions_size();
}

std::vector<v1::RigCondition> rig_conditions(const v1::EvaluateRigRequest& request) {
  std::vector<v1::RigCondition> out(request.conditions().begin(), request.conditions().end());
  if (!request.has_grid()) return out;
  const v1::RigGrid& grid = request.grid();
  const std::vector<double> loads = grid_loads(request);
  for (const double temperature : grid.supply_temperatures_celsius()) {
    for (const double load : loads) {
      for (const double speed : grid.entrainment_speeds_metres_per_second()) {
        for (const double slide : grid.slide_roll_ratios_percent()) {
          v1::RigCondition& condition = out.emplace_back();
          condition.set_supply_temperature_celsius(temperature);
          condition.set_load_newtons(load);
          condition.set_entrainment_speed_metres_per_second(speed);
          condition.set_slide_roll_ratio_percent(slide);
        }
      }
    }
  }
  return out;
}

std::optional<RigEvaluation> read_rig(const v1::EvaluateRigRequest& request,
                                      const ResourceLookup& lookup, Violations& violations,
                                      int most) {
  const std::size_t before = violations.size();
  check_message(request, "", violations);
  check_model_options(request.model_options(), "model_options", violations);
  if (request.has_grid()) {
    check_grid(request.grid(), most, violations);
    if (!request.conditions().empty()) {
      violations.add("conditions", "set together with grid; allowed: one of the two");
    }
  } else if (request.conditions().empty()) {
    violations.add("conditions", "not set; allowed: at least one");
  } else if (request.conditions_size() > most) {
    violations.add("conditions", "{} conditions; allowed: at most {}", request.conditions_size(),
                   most);
  }
  check_draws(request, violations);
  RigEvaluation out{};  // zeros: smooth specimens
  RigScene& scene = out.scene;
  auto lubricant = find_resource<v1::Lubricant>(lookup, request.lubricant(), kLubricants,
                                                "lubricant", violations);
  if (!request.surface().empty()) {
    const auto surface =
        find_resource<v1::Surface>(lookup, request.surface(), kSurfaces, "surface", violations);
    if (surface) {
      out.surface = surface->resource;
      out.composite_rms_height = request.composite_rms_height_metres();
      set_surface(*out.surface, out.composite_rms_height, scene);
      out.surface_revision = surface->revision_name;
    }
  } else if (request.composite_rms_height_metres() != 0) {
    violations.add("composite_rms_height_metres",
                   "set without a surface; allowed: 0, which means smooth specimens, or a "
                   "surface whose height it replaces");
  }
  if (lubricant) {
    check_law_options(*lubricant->resource, request.model_options(), "model_options", violations);
  }
  if (!lubricant || violations.size() > before) return std::nullopt;
  out.lubricant = lubricant->resource;
  out.lubricant_revision = lubricant->revision_name;
  set_lubricant(*lubricant->resource, scene);
  scene.solids = solids_of(request);
  scene.radii = radii_of(request);
  scene.options = to_core(request.model_options());
  scene.options.hertz_solution = HertzSolution::kExact;
  check_grid_loads(request, violations);
  if (violations.size() > before) return std::nullopt;
  return out;
}

v1::EvaluateRigResponse evaluate_rig(const v1::EvaluateRigRequest& request,
                                     const RigEvaluation& evaluation,
                                     const std::function<bool()>& is_over) {
  v1::EvaluateRigResponse out;
  const std::vector<v1::RigCondition> conditions = rig_conditions(request);
  const int rows = static_cast<int>(conditions.size());
  for (const RigColumn& each : kRigColumns) {
    (out.*each.column)()->Resize(rows, std::numeric_limits<double>::quiet_NaN());
  }
  RefusedRows refused(rows, *out.mutable_refusal_numbers(), *out.mutable_refusals());
  RowWarnings warnings;
  const FluidGrounds grounds = fluid_grounds(*evaluation.lubricant);
  std::map<double, Rig> rigs;  // by supply temperature
  for (int i = 0; i < rows; ++i) {
    if (is_over()) throw Cancelled();
    const v1::RigCondition& condition = conditions[static_cast<std::size_t>(i)];
    out.add_load_newtons(condition.load_newtons());
    const double celsius = condition.supply_temperature_celsius();
    try {
      auto rig = rigs.find(celsius);
      if (rig == rigs.end()) {
        const auto [reason, message] = refusal_at_inlet(*evaluation.lubricant, celsius, 0);
        if (!reason.empty()) {
          refused.add(i, reason, message);
          continue;
        }
        rig = rigs.emplace(celsius, Rig(evaluation.scene, celsius + kZeroCelsius)).first;
      }
      const RigPoint point =
          rig->second.at({condition.load_newtons(), condition.entrainment_speed_metres_per_second(),
                          0.01 * condition.slide_roll_ratio_percent()});
      for (const RigColumn& each : kRigColumns) {
        (out.*each.column)()->Set(i, point.*each.figure);
      }
      warnings.add(i, rig_warnings(evaluation.scene, grounds, celsius, point),
                   *out.mutable_range_warnings());
    } catch (const Refusal& refusal) {
      refused.add(i, refusal.reason(), refusal.what());
    }
  }
  out.set_lubricant_revision(evaluation.lubricant_revision);
  out.set_surface_revision(evaluation.surface_revision);
  out.set_model_version(kModelVersion);
  for (v1::RangeWarning& each : fluid_warnings(*evaluation.lubricant)) {
    *out.add_input_warnings() = std::move(each);
  }
  if (request.draws() > 0) {
    add_rig_uncertainties(evaluation, conditions, request.draws(), is_over, out);
  }
  return out;
}

}  // namespace tribodyn::server
