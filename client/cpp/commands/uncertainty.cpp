#include "client/cpp/commands/uncertainty.h"

#include <algorithm>
#include <cmath>

#include "client/cpp/report/comparison_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Draws at each speed of a curve: the 95 % interval then ends between the second and third draw
/// from either end, and a curve with its uncertainty takes 2.5 to 3.7 times the processor
/// time of one without (25 speeds; an oil of a data sheet takes most).
constexpr int kCurveDraws = 99;
constexpr int kSpeedsOfARequest = 100;  // the server computes 10000 points at once
/// Largest relative difference of a curve's figure and that of the screened point, besides the
/// errors of both solvers, at which both are on one branch.
constexpr double kSameBranch = 0.01;

/// Whether screened points stand for those of the study: they start at the quasi-static
/// equilibrium and choose their model.
template <class Study>
bool is_screened(const v1::Simulation& simulation, const Study& study) {
  return simulation.state() == v1::Simulation::SUCCEEDED &&
         study.start() != v1::POINT_START_LARGE_VIBRATION &&
         study.model() != v1::POINT_MODEL_QUASI_STATIC &&
         simulation.solver_options().method() != v1::STEADY_STATE_METHOD_MARCH;
}

/// Returns a request for the lubricant and scene of a simulation, without conditions.
v1::ComparePointsRequest request_of(const v1::Simulation& simulation) {
  v1::ComparePointsRequest out;
  out.add_lubricants(simulation.lubricant_revision());
  out.set_gear_set(simulation.gear_set_revision());
  out.set_surface(simulation.surface_revision());
  out.set_vehicle(simulation.vehicle_revision());
  out.set_sheared_lubricant(simulation.sheared_lubricant());
  *out.mutable_model_options() = simulation.model_options();
  out.set_tolerance(simulation.solver_options().tolerance());
  return out;
}

void add_condition(const v1::Simulation& simulation, double kilometres_per_hour,
                   double ascent_degrees, v1::ComparePointsRequest& request) {
  v1::PointCondition& condition = *request.add_conditions();
  condition.set_speed_kilometres_per_hour(kilometres_per_hour);
  condition.set_ascent_angle_degrees(ascent_degrees);
  if (simulation.has_sump_temperature_celsius()) {
    condition.set_sump_temperature_celsius(simulation.sump_temperature_celsius());
  }
  if (simulation.has_inlet_temperature_rise_kelvin()) {
    condition.set_inlet_temperature_rise_kelvin(simulation.inlet_temperature_rise_kelvin());
  }
}

std::string not_computed(const ServiceError& error) {
  return std::string("The uncertainty of the inputs was not computed: ") + printable(error.what());
}

bool is_same_branch(const v1::PointResult& result, const v1::UncertainFigure& screened) {
  const double value = result.inefficiency_energy_mean_percent();
  const double allowed =
      (kSameBranch + result.estimated_relative_error()) * std::abs(value) + screened.solver_error();
  return std::abs(value - screened.value()) <= allowed;
}

CurveUncertainty uncertainty_of(const v1::Simulation& simulation, Connection& connection) {
  CurveUncertainty out;
  std::vector<const v1::CurvePoint*> points;
  for (const v1::CurvePoint& point : simulation.result().points()) {
    if (point.result().has_inefficiency_energy_mean_percent()) points.push_back(&point);
  }
  int elsewhere = 0;
  for (std::size_t first = 0; first < points.size(); first += kSpeedsOfARequest) {
    v1::ComparePointsRequest request = request_of(simulation);
    request.set_draws(kCurveDraws);
    const std::size_t end = std::min(points.size(), first + kSpeedsOfARequest);
    for (std::size_t i = first; i < end; ++i) {
      add_condition(simulation, points[i]->speed_kilometres_per_hour(),
                    simulation.inefficiency_curve().ascent_angle_degrees(), request);
    }
    const v1::ComparePointsResponse response = connection.compare_points(request);
    const v1::ComparedLubricant& lubricant = response.lubricants(0);
    for (std::size_t i = first; i < end; ++i) {
      const v1::ComparedPoint& screened = lubricant.points(static_cast<int>(i - first));
      const v1::UncertainFigure& figure = screened.inefficiency_energy_mean_percent();
      if (!screened.refusal_reason().empty() || !is_same_branch(points[i]->result(), figure)) {
        ++elsewhere;
        continue;
      }
      out.figures[points[i]->speed_kilometres_per_hour()] = figure;
    }
    if (first == 0) out.remark = curve_uncertainty_remark(response);
  }
  if (elsewhere > 0) {
    out.remark += " At " + std::to_string(elsewhere) +
                  " of the speeds it is not known: the curve follows another branch than points "
                  "from the quasi-static equilibrium.";
  }
  return out;
}

}  // namespace

std::string point_uncertainty(const v1::Simulation& simulation, Connection& connection) {
  const v1::OperatingPointStudy& point = simulation.operating_point();
  if (!point.has_cruise() || !is_screened(simulation, point)) return "";
  v1::ComparePointsRequest request = request_of(simulation);
  request.set_contact_figures(true);
  add_condition(simulation, point.cruise().speed_kilometres_per_hour(),
                point.cruise().ascent_angle_degrees(), request);
  try {
    return uncertainty_report(connection.compare_points(request));
  } catch (const ServiceError& error) {  // the result stands without it
    return wrapped(not_computed(error), 2);
  }
}

CurveUncertainties curve_uncertainties(const std::vector<v1::Simulation>& simulations,
                                       Connection& connection) {
  CurveUncertainties out;
  for (const v1::Simulation& simulation : simulations) {
    if (!is_screened(simulation, simulation.inefficiency_curve())) continue;
    try {
      out[simulation.name()] = uncertainty_of(simulation, connection);
    } catch (const ServiceError& error) {  // the result stands without it
      out[simulation.name()].remark = not_computed(error);
    }
  }
  return out;
}

}  // namespace tribodyn::client
