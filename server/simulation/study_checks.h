#pragma once

#include <string>
#include <vector>

#include "server/contract/violations.h"
#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::server {

// Rules between fields and limits on work: what the table of constraints cannot say. Each adds all
// it finds.

/// The fluid's laws hold at the inlet: T_0,ref below T_in (eq 34), density positive there (eq 26),
/// and alpha* measured above T_0,ref (eq 33).
void check_fluid_at_inlet(const v1::Lubricant& lubricant, double sump_temperature_celsius,
                          double inlet_temperature_rise_kelvin, const std::string& path,
                          Violations& violations);

/// Condition stated, history columns known and distinct, rows times columns within the limit.
void check_operating_point(const v1::OperatingPointStudy& study, const std::string& path,
                           Violations& violations);

/// Speeds stated in exactly one way, distinct, not too many; work within the limit; no direction of
/// independent points.
void check_curve(const v1::InefficiencyCurveStudy& study, const v1::SolverOptions& options,
                 const std::string& path, Violations& violations);

/// No switch that acts elsewhere than in a contact.
void check_model_options(const v1::ModelOptions& options, const std::string& path,
                         Violations& violations);

/// Data by torque are there when the option asks for them.
void check_mesh_data(const v1::GearSet& gear_set, const v1::ModelOptions& options,
                     const std::string& path, Violations& violations);

/// The speeds of a curve in ascending order [km/h]; empty when they are not stated properly.
std::vector<double> curve_speeds(const v1::InefficiencyCurveStudy& study);

}  // namespace tribodyn::server
