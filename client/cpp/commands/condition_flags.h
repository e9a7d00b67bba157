#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/text/text.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// The conditions at which compare, explain and screen evaluate points: every speed at every sump
/// temperature, and the weights of both in means.
struct ConditionFlags {
  std::vector<double> speeds, sumps;                ///< [km/h], [C]; empty: 60 km/h, the default
  std::vector<double> speed_weights, sump_weights;  ///< one for each; empty: equal
  v1::PointCondition common;                        ///< what all conditions have

  /// Returns the conditions by sump temperature, then by speed.
  std::vector<v1::PointCondition> conditions() const;
  bool has_weights() const { return !speed_weights.empty() || !sump_weights.empty(); }
  /// Returns the weight of the speed and sump temperature with these positions.
  double weight(std::size_t speed, std::size_t sump) const;
  /// Returns the weights of conditions().
  std::vector<double> weights() const;
};

enum class SumpCount { kOne, kSeveral };

/// Adds speeds, sump temperatures, their weights, ascent and inlet temperature rise; with
/// SumpCount::kOne one sump temperature without a weight.
void add_condition_flags(FlagList& list, SumpCount sumps, ConditionFlags& flags);

/// Checks that there is one weight for each of so many speeds and sump temperatures.
void check_weight_counts(const ConditionFlags& flags, std::size_t speeds, std::size_t sumps,
                         Complaints& complaints);
/// The same, of the speeds and sump temperatures that the flags state or that are the default.
void check_condition_flags(const ConditionFlags& flags, Complaints& complaints);

/// Sets the conditions of a request, and their weights if flags state some.
template <class Request>
void set_conditions(const ConditionFlags& flags, Request& request) {
  for (v1::PointCondition& each : flags.conditions()) *request.add_conditions() = std::move(each);
  if (!flags.has_weights()) return;
  const std::vector<double> weights = flags.weights();
  *request.mutable_condition_weights() = {weights.begin(), weights.end()};
}

/// Adds --gear-set, --surface and --vehicle. `surface_text`: what the surface is to the command.
template <class Request>
void add_hardware_flags(FlagList& list, const std::string& surface_text, Request& request) {
  list.text("--gear-set", "NAME", "Gear set with its driveline. Default: reference-axle.",
            [&request](const std::string& name) {
              request.set_gear_set(resource_name("gearSets", name));
            })
      .collection = "gearSets";
  list.text("--surface", "NAME", surface_text + " Default: run-in.",
            [&request](const std::string& name) {
              request.set_surface(resource_name("surfaces", name));
            })
      .collection = "surfaces";
  list.text("--vehicle", "NAME", "Vehicle: road load. Default: passenger-car.",
            [&request](const std::string& name) {
              request.set_vehicle(resource_name("vehicles", name));
            })
      .collection = "vehicles";
}

/// Adds the standard uncertainties of the conditions, and the correlation of estimates.
template <class Request>
void add_input_uncertainty_flags(FlagList& list, Request& request) {
  list.number("--sump-temperature-uncertainty-kelvin,--sump-uncertainty", {"K", "0 to 100", "0"},
              "Standard uncertainty of the temperature of the oil bath",
              [&request](double value) { request.set_sump_temperature_uncertainty_kelvin(value); });
  list.number(
      "--inlet-temperature-rise-uncertainty-kelvin", {"K", "0 to 100", "0"},
      "Standard uncertainty of the temperature rise to the inlet",
      [&request](double value) { request.set_inlet_temperature_rise_uncertainty_kelvin(value); });
  list.number("--estimate-correlation", {"-", "0 to 1", "0.5"},
              "Correlation of the errors of estimates that one estimator made for lubricants of "
              "one class of base oil",
              [&request](double value) { request.set_estimate_correlation(value); });
}

/// Adds --tolerance of every point. `standard`: the default.
template <class Request>
void add_point_tolerance_flag(FlagList& list, const std::string& standard, Request& request) {
  list.number("--tolerance", {"-", "1e-8 to 0.01", standard},
              "Target of the relative solver error of every point",
              [&request](double value) { request.set_tolerance(value); });
}

}  // namespace tribodyn::client
