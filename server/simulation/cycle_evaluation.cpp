#include "server/simulation/cycle_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "core/celsius.h"
#include "core/refusal.h"
#include "core/study/range_warnings.h"
#include "core/study/warning_kinds.h"
#include "core/version.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/mapping/from_core.h"
#include "server/mapping/to_core.h"
#include "server/resources/lubricant_parameters.h"
#include "server/simulation/solver_defaults.h"

namespace tribodyn::server {
namespace {

constexpr double kNoEnergy = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegreesPerRadian = 180 / std::numbers::pi;  // [degrees]
constexpr double kBaseSpeed = 50;  // of the base, which no figure uses [km/h]

double first_sump(const v1::EvaluateCycleRequest& request) {
  if (request.places_size() > 0 && request.places(0).has_sump_temperature_celsius()) {
    return request.places(0).sump_temperature_celsius();
  }
  return request.has_sump_temperature_celsius() ? request.sump_temperature_celsius()
                                                : kDefaultSumpTemperatureCelsius;
}

/// Returns the cycle of the request, whose numbers must be valid.
DriveCycle requested_cycle(const v1::EvaluateCycleRequest& request) {
  DriveCycle out;
  if (request.places().empty()) {
    out = nedc();
    for (CyclePlace& place : out.places)
      place.sump_temperature = first_sump(request) + kZeroCelsius;
    return out;
  }
  for (const v1::CyclePlace& place : request.places()) {
    const double sump = place.has_sump_temperature_celsius() ? place.sump_temperature_celsius()
                                                             : first_sump(request);
    out.places.push_back({place.time_seconds(), place.speed_kilometres_per_hour() / 3.6,
                          place.ascent_angle_degrees() / kDegreesPerRadian, sump + kZeroCelsius});
  }
  return out;
}

/// Checks what a place must be beside the one before. Numbers that are not finite are found by
/// check_message().
void check_succession(const v1::EvaluateCycleRequest& request, Violations& violations) {
  int count = 0;
  const auto add = [&](int place, const char* field, const std::string& text) {
    if (++count > kMaximumReportedElements) return;
    violations.add(fmt::format("places[{}].{}", place, field), text);
  };
  const Constraint& limit =
      *find_constraint("DriveCycleSnapshot", "acceleration_metres_per_second_squared");
  const bool has_sump = request.places(0).has_sump_temperature_celsius();
  for (int i = 1; i < request.places_size(); ++i) {
    const v1::CyclePlace& from = request.places(i - 1);
    const v1::CyclePlace& to = request.places(i);
    const double duration = to.time_seconds() - from.time_seconds();
    const double gain = (to.speed_kilometres_per_hour() - from.speed_kilometres_per_hour()) / 3.6;
    if (duration <= 0) {
      add(i, "time_seconds",
          fmt::format("time_seconds = {} s; allowed: above that of the place before, {} s",
                      to.time_seconds(), from.time_seconds()));
    } else if (std::abs(gain / duration) > limit.maximum) {
      add(i, "speed_kilometres_per_hour",
          fmt::format("speed_kilometres_per_hour = {} km/h {:.4g} s after {} km/h is an "
                      "acceleration of {:.4g} m/s2; allowed: {} to {} m/s2",
                      to.speed_kilometres_per_hour(), duration, from.speed_kilometres_per_hour(),
                      gain / duration, limit.minimum, limit.maximum));
    }
    if (to.has_sump_temperature_celsius() != has_sump) {
      add(i, "sump_temperature_celsius",
          fmt::format("{}; allowed: as in places[0], where it is {}", has_sump ? "not set" : "set",
                      has_sump ? "set" : "not set"));
    }
  }
  if (count > kMaximumReportedElements) {
    violations.add("places", "{} more places do not follow their predecessor",
                   count - kMaximumReportedElements);
  }
}

void check_cycle(const v1::EvaluateCycleRequest& request, Violations& violations) {
  const int places = request.places_size();
  if (places == 0 && request.named_cycle() == v1::NAMED_CYCLE_UNSPECIFIED) {
    violations.add("places", "not set; allowed: two places or more, or a named_cycle");
  }
  if (places > 0 && request.named_cycle() != v1::NAMED_CYCLE_UNSPECIFIED) {
    violations.add("places", "set together with named_cycle; allowed: one of the two");
  }
  if (places == 1) violations.add("places", "1 place; allowed: two places or more");
  if (places > 1) check_succession(request, violations);
}

void check_cycle_lubricants(const v1::EvaluateCycleRequest& request, Violations& violations) {
  const int lubricants = request.lubricants_size();
  if (lubricants > 0 && lubricants <= kMostCycleLubricants) return;
  violations.add("lubricants", "{} lubricants; allowed: 1 to {}", lubricants, kMostCycleLubricants);
}

void check_map_tolerance(const v1::EvaluateCycleRequest& request, Violations& violations) {
  if (!request.point_by_point() || request.map_tolerance() == 0) return;
  violations.add(
      "map_tolerance",
      "map_tolerance = {} has no effect: with point_by_point every piece is solved and no "
      "map is made; leave one of the two unset, or set tolerance, which is the error of "
      "each point",
      request.map_tolerance());
}

/// Returns the pieces of the cycle, or none and a violation if they are too many.
std::vector<CyclePiece> cut_cycle(const v1::EvaluateCycleRequest& request, Violations& violations) {
  const DriveCycle cycle = requested_cycle(request);
  const double duration = cycle.places.back().time - cycle.places.front().time;
  std::vector<CyclePiece> out;
  if (duration <= kMaximumCyclePieces) out = pieces_of(cycle);
  if (out.empty() || out.size() > kMaximumCyclePieces) {
    violations.add("places",
                   "{} places over {} s are more than {} pieces of at most 1 s; send "
                   "the parts of the cycle in several requests",
                   request.places_size(), duration, kMaximumCyclePieces);
    return {};
  }
  const std::size_t points = out.size() * static_cast<std::size_t>(request.lubricants_size());
  if (request.point_by_point() && points > kMaximumCyclePoints) {
    violations.add("point_by_point",
                   "true; {} pieces of {} lubricants are {} points; allowed: at most {} in one "
                   "request; send several, or let the server make a map",
                   out.size(), request.lubricants_size(), points, kMaximumCyclePoints);
  }
  return out;
}

/// Returns the request for a point of one lubricant. If numbers of the request are wrong, which is
/// known by then, it has none of them.
v1::EvaluatePointsRequest cycle_base(const v1::EvaluateCycleRequest& request,
                                     const std::string& lubricant, bool is_valid) {
  v1::EvaluatePointsRequest out;
  out.set_lubricant(lubricant);
  out.set_gear_set(request.gear_set());
  out.set_surface(request.surface());
  out.set_vehicle(request.vehicle());
  out.set_sheared_lubricant(request.sheared_lubricant());
  v1::PointCondition& condition = *out.add_conditions();
  condition.set_speed_kilometres_per_hour(kBaseSpeed);
  if (!is_valid) return out;
  if (request.has_model_options()) *out.mutable_model_options() = request.model_options();
  out.set_tolerance(request.tolerance());
  condition.set_sump_temperature_celsius(first_sump(request));
  if (request.has_inlet_temperature_rise_kelvin()) {
    condition.set_inlet_temperature_rise_kelvin(request.inlet_temperature_rise_kelvin());
  }
  return out;
}

/// Solves points of one fluid.
class FluidPoints {
 public:
  FluidPoints(const PointEvaluation& fluid, const std::shared_ptr<PreparedGearSet>& gear_set,
              const std::function<bool()>& is_over)
      : fluid_(fluid),
        gear_set_(gear_set),
        physical_(scene(fluid.base)),
        options_(point_options(fluid)) {
    fluid_.shares_orbits = false;
    options_.progress = [&is_over](double) { return !is_over(); };
  }

  /// One warning of each code, about the point furthest outside, with the number of the points that
  /// have it.
  std::vector<RangeWarning> warnings() const {
    std::vector<RangeWarning> out = warnings_;
    for (RangeWarning& each : out) {
      each.sentence =
          fmt::format("at {} of {} points: {}", counts_.at(each.code), points_, each.sentence);
    }
    return out;
  }

  /// As LossForces. Throws Refusal of the first point that the core refuses.
  std::vector<std::optional<LossForce>> loss_forces(const std::vector<MapPlace>& places,
                                                    LossEffort effort) {
    set_conditions(places);
    PointOptions options = options_;
    options.gives_up_early = effort == LossEffort::kBrief;
    if (effort == LossEffort::kQuasiStatic) options.model = PointModel::kQuasiStatic;
    const std::vector<EvaluatedPoint> points =
        evaluate_conditions(fluid_, *fluid_.base.lubricant, physical_, {}, options, gear_set_);
    std::vector<std::optional<LossForce>> out;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (options.gives_up_early && points[i].refusal_reason == "NOT_FOUND_BY_SHOOTING") {
        out.push_back(std::nullopt);
        continue;
      }
      if (!points[i].figures) {
        throw Refusal(points[i].refusal_reason,
                      fmt::format("at {:.4g} km/h and {:.4g} N m at the ring gear: {}",
                                  3.6 * places[i][0], places[i][1], points[i].refusal_message));
      }
      const PointFigures& figures = *points[i].figures;
      count_warnings(figures);
      const double force = figures.mesh_loss_power / places[i][0];
      out.push_back(LossForce{force, force * figures.estimated_relative_error.value_or(kNoEnergy)});
    }
    return out;
  }

 private:
  void count_warnings(const PointFigures& figures) {
    ++points_;
    for (const RangeWarning& each : figures.warnings) ++counts_[each.code];
    keep_furthest(figures.warnings, warnings_);
  }

  /// A place of the map is the level road at the acceleration that gives its torque.
  void set_conditions(const std::vector<MapPlace>& places) {
    const Vehicle& vehicle = physical_.vehicle;
    std::map<double, std::vector<std::pair<int, OperatingCondition>>> by_temperature;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& [speed, torque, temperature] = places[i];
      OperatingCondition condition;
      condition.kind = OperatingCondition::Kind::kDriveCycleSnapshot;
      condition.vehicle_speed = speed;
      condition.acceleration =
          (torque - wheel_torque(vehicle, speed, 0, 0)) / (vehicle.wheel_radius * vehicle.mass);
      by_temperature[temperature].emplace_back(static_cast<int>(i), condition);
    }
    const double rise = physical_.inlet_temperature_rise;
    fluid_.groups.clear();
    for (auto& [temperature, conditions] : by_temperature) {
      fluid_.groups.push_back({temperature - kZeroCelsius, rise, std::move(conditions)});
    }
    fluid_.conditions = static_cast<int>(places.size());
  }

  PointEvaluation fluid_;
  std::shared_ptr<PreparedGearSet> gear_set_;
  Scene physical_;
  PointOptions options_;
  int points_ = 0;  // that have figures
  std::vector<RangeWarning> warnings_;
  std::map<std::string, int> counts_;  // points by code
};

v1::CyclePartKind part_kind(CyclePartKind kind) {
  switch (kind) {
    case CyclePartKind::kAll:
      return v1::CYCLE_PART_KIND_ALL;
    case CyclePartKind::kStandstill:
      return v1::CYCLE_PART_KIND_STANDSTILL;
    case CyclePartKind::kDrive:
      return v1::CYCLE_PART_KIND_DRIVE;
    case CyclePartKind::kDriveAccelerating:
      return v1::CYCLE_PART_KIND_DRIVE_ACCELERATING;
    case CyclePartKind::kDriveSteady:
      return v1::CYCLE_PART_KIND_DRIVE_STEADY;
    case CyclePartKind::kDriveDecelerating:
      return v1::CYCLE_PART_KIND_DRIVE_DECELERATING;
    case CyclePartKind::kCoast:
      return v1::CYCLE_PART_KIND_COAST;
    case CyclePartKind::kSpeedBand:
      break;
  }
  return v1::CYCLE_PART_KIND_SPEED_BAND;
}

void set_cycle_energies(const CycleEvaluation& evaluation, const std::vector<CyclePart>& parts,
                        const CycleLoss& loss, v1::CycleLubricant& out) {
  for (const CyclePart& part : parts) {
    const CycleEnergy energy = energy_of(part, evaluation.cycle, loss.energies);
    v1::CyclePartLoss& message = *out.add_parts();
    message.set_input_joules(energy.input);
    message.set_loss_joules(energy.loss);
    message.set_inefficiency_percent(energy.input > 0 ? 100 * energy.loss / energy.input
                                                      : kNoEnergy);
  }
  const double whole = out.parts(0).loss_joules();
  for (v1::CyclePartLoss& part : *out.mutable_parts()) {
    part.set_loss_share_percent(whole > 0 ? 100 * part.loss_joules() / whole : 0);
  }
  out.set_input_joules(out.parts(0).input_joules());
  out.set_loss_joules(whole);
  out.set_inefficiency_percent(out.parts(0).inefficiency_percent());
  for (std::size_t i = 0; i < loss.energies.size(); ++i) {
    out.add_mesh_loss_power_watts(loss.energies[i] / evaluation.cycle.pieces[i].duration);
  }
}

v1::CycleLubricant cycle_lubricant(const CycleEvaluation& evaluation, const PointEvaluation& fluid,
                                   const std::vector<CyclePart>& parts,
                                   const std::shared_ptr<PreparedGearSet>& gear_set,
                                   const std::function<bool()>& is_over) {
  v1::CycleLubricant out;
  out.set_lubricant_revision(fluid.base.effective.lubricant_revision());
  for (v1::RangeWarning& each : fluid_warnings(*fluid.base.lubricant)) {
    *out.add_input_warnings() = std::move(each);
  }
  try {
    FluidPoints points(fluid, gear_set, is_over);
    const CycleLoss loss = cycle_loss(
        evaluation.cycle,
        [&points](const std::vector<MapPlace>& places, LossEffort effort) {
          return points.loss_forces(places, effort);
        },
        evaluation.options);
    set_cycle_energies(evaluation, parts, loss, out);
    out.set_map_error_joules(loss.map_error);
    out.set_solver_error_joules(loss.solver_error);
    out.set_points(loss.points);
    add_warnings(points.warnings(), out.mutable_warnings());
  } catch (const Refusal& refusal) {
    out.set_refusal_reason(refusal.reason());
    out.set_refusal_message(refusal.what());
    out.set_input_joules(kNoEnergy);
    out.set_loss_joules(kNoEnergy);
    out.set_inefficiency_percent(kNoEnergy);
    out.set_map_error_joules(kNoEnergy);
    out.set_solver_error_joules(kNoEnergy);
  }
  return out;
}

void set_loss_differences(v1::EvaluateCycleResponse& response) {
  const v1::CycleLubricant first = response.lubricants(0);
  for (v1::CycleLubricant& lubricant : *response.mutable_lubricants()) {
    for (int i = 0; i < lubricant.parts_size(); ++i) {
      v1::CyclePartLoss& part = *lubricant.mutable_parts(i);
      const double loss = i < first.parts_size() ? first.parts(i).loss_joules() : kNoEnergy;
      part.set_loss_difference_percent(
          part.loss_joules() > 0 && loss > 0 ? 100 * (part.loss_joules() / loss - 1) : kNoEnergy);
    }
  }
}

void set_cycle_columns(const DrivenCycle& cycle, const std::vector<CyclePart>& parts,
                       v1::EvaluateCycleResponse& out) {
  for (const CyclePart& part : parts) {
    v1::CyclePart& message = *out.add_parts();
    message.set_kind(part_kind(part.kind));
    message.set_minimum_speed_kilometres_per_hour(std::round(3.6 * part.low));
    message.set_maximum_speed_kilometres_per_hour(std::round(3.6 * part.high));
    message.set_duration_seconds(part.duration);
    message.set_distance_metres(part.distance);
  }
  out.set_duration_seconds(parts[0].duration);
  out.set_distance_metres(parts[0].distance);
  out.set_standstill_seconds(parts[1].duration);
  for (std::size_t i = 0; i < cycle.pieces.size(); ++i) {
    const CyclePiece& piece = cycle.pieces[i];
    out.add_start_seconds(piece.start);
    out.add_piece_seconds(piece.duration);
    out.add_speed_kilometres_per_hour(3.6 * piece.speed);
    out.add_acceleration_metres_per_second_squared(piece.acceleration);
    out.add_ascent_angle_degrees(piece.ascent_angle * kDegreesPerRadian);
    out.add_sump_temperature_celsius(piece.sump_temperature - kZeroCelsius);
    out.add_wheel_torque_newton_metres(cycle.wheel_torques[i]);
  }
}

}  // namespace

std::optional<CycleEvaluation> read_cycle(const v1::EvaluateCycleRequest& request,
                                          const ResourceLookup& lookup, Violations& violations) {
  const std::size_t before = violations.size();
  check_message(request, "", violations);
  check_cycle_lubricants(request, violations);
  check_map_tolerance(request, violations);
  check_cycle(request, violations);
  const bool is_valid = violations.size() == before;
  CycleEvaluation out;
  std::vector<CyclePiece> pieces;
  if (is_valid) pieces = cut_cycle(request, violations);
  for (int i = 0; i < std::min(request.lubricants_size(), kMostCycleLubricants); ++i) {
    Violations found;
    auto fluid = read_points(cycle_base(request, request.lubricants(i), is_valid), lookup, found);
    for (Violation each : found) {
      const bool is_about_lubricant = each.field.starts_with("lubricant");
      if (is_about_lubricant) {
        each.field = fmt::format("lubricants[{}]{}", i, each.field.substr(9));
      }
      if (i == 0 || is_about_lubricant || each.field == "sheared_lubricant") {
        violations.push_back(std::move(each));
      }
    }
    if (fluid) out.fluids.push_back(std::move(*fluid));
  }
  if (violations.size() > before) return std::nullopt;
  out.cycle = driven_cycle(std::move(pieces), scene(out.fluids.front().base).vehicle);
  if (request.map_tolerance() != 0) out.options.tolerance = request.map_tolerance();
  out.options.most_points = kMaximumCyclePoints / request.lubricants_size();
  out.options.is_point_by_point = request.point_by_point();
  return out;
}

v1::EvaluateCycleResponse evaluate_cycle(const v1::EvaluateCycleRequest& request,
                                         const CycleEvaluation& evaluation,
                                         PreparedGearSets& gear_sets,
                                         const std::function<bool()>& is_over) {
  v1::EvaluateCycleResponse out;
  out.set_named_cycle(request.named_cycle());
  const std::vector<CyclePart> parts = parts_of(evaluation.cycle);
  set_cycle_columns(evaluation.cycle, parts, out);
  const SimulationInputs& base = evaluation.fluids.front().base;
  const Scene physical = scene(base);
  const std::shared_ptr<PreparedGearSet> gear_set = gear_sets.take(base.gear_set, physical);
  for (const PointEvaluation& fluid : evaluation.fluids) {
    *out.add_lubricants() = cycle_lubricant(evaluation, fluid, parts, gear_set, is_over);
  }
  gear_sets.give_back(base.gear_set, physical.options, gear_set);
  set_loss_differences(out);
  out.set_gear_set_revision(base.effective.gear_set_revision());
  out.set_surface_revision(base.effective.surface_revision());
  out.set_vehicle_revision(base.effective.vehicle_revision());
  out.set_not_included(kToothContactOnly);
  out.set_model_version(kModelVersion);
  return out;
}

}  // namespace tribodyn::server
