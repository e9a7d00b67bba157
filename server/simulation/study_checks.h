#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/contract/violations.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

// These functions check rules between fields and limits on work, which the table of constraints
// cannot express. Each adds all violations that it finds.

/// Adds a violation if the sump is below the pour point that the lubricant states. `name` is that
/// of the oil in the message.
void check_pour_point(const v1::Lubricant& lubricant, double sump_temperature_celsius,
                      const std::string& path, Violations& violations,
                      std::string_view name = "the oil");

/// Checks that the lubricant's laws are valid at the inlet: T_0,ref below T_in (eq 34), positive
/// density (eq 26), alpha* measured above T_0,ref (eq 33).
void check_fluid_at_inlet(const v1::Lubricant& lubricant, double sump_temperature_celsius,
                          double inlet_temperature_rise_kelvin, const std::string& path,
                          Violations& violations);

/// Returns why points have no figures at a temperature of the sump, UPPER_SNAKE_CASE and one
/// sentence; empty texts if they may have.
std::pair<std::string, std::string> refusal_at_inlet(const v1::Lubricant& lubricant,
                                                     double sump_temperature_celsius,
                                                     double inlet_temperature_rise_kelvin);

/// Checks that the condition is set, that history columns exist and differ, and that rows times
/// columns are within the limit.
void check_operating_point(const v1::OperatingPointStudy& study, const std::string& path,
                           Violations& violations);

/// Checks that speeds are set in exactly one way, differ and are not too many, that the work is
/// within the limit, and that independent points have no direction.
void check_curve(const v1::InefficiencyCurveStudy& study, const v1::SolverOptions& options,
                 const std::string& path, Violations& violations);

/// Refuses tolerances of a march, other than their defaults, if the method or the model never
/// marches.
void check_march_tolerances(const v1::SolverOptions& options, v1::PointModel model,
                            const std::string& path, Violations& violations);

/// Refuses what concerns eqs 31 to 33 alone if the lubricant follows another law of viscosity under
/// pressure.
void check_law_options(const v1::Lubricant& lubricant, const v1::ModelOptions& options,
                       const std::string& path, Violations& violations);

/// Refuses switches that have no effect in a contact.
void check_model_options(const v1::ModelOptions& options, const std::string& path,
                         Violations& violations);

/// Checks that the gear set has data by torque if the option needs them.
void check_mesh_data(const v1::GearSet& gear_set, const v1::ModelOptions& options,
                     const std::string& path, Violations& violations);

/// Returns the speeds of a curve in ascending order [km/h]; empty if they are not set correctly.
std::vector<double> curve_speeds(const v1::InefficiencyCurveStudy& study);

}  // namespace tribodyn::server
