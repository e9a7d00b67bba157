// Reads the JSON test data into yardstick types.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "yardstick_orbit.h"

namespace tribodyn::yardstick {

/// Parses a JSON file that may hold NaN or Infinity (as Python writes them; read as 1e999 = inf).
nlohmann::json read_json_file(const std::string& path);

/// One worked contact: the `input` object of worked_points.json.
struct ContactCase {
  ContactFriction friction;
  ContactInput input;
};
ContactCase read_contact_case(const nlohmann::json& input, int quadrature_nodes = 16);

/// Lubricant, material, surface and sump temperature of the orbits: `orbit_inputs.values`.
ContactFriction read_orbit_friction(const nlohmann::json& values,
                                    const FrictionOptions& options = {});

/// Calibration A of reference_gear_set.json: blocks blank_geometry, dynamics, fourier, tables.
GearPairParameters read_gear_pair(const nlohmann::json& gear_set);
VehicleParameters read_vehicle(const nlohmann::json& gear_set);

/// `section_state` of an orbit.
SectionState read_section_state(const nlohmann::json& section_state);

}  // namespace tribodyn::yardstick
