#pragma once

#include <string>

#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::client {

// The tables that the server's imports read, written from a resource; numbers as their shortest
// exact text.

/// Flank slots by mesh phase and slot.
std::string tooth_contact_csv(const v1::GearSet& gear_set);
/// The Fourier series at the reference torque.
std::string series_csv(const v1::GearSet& gear_set);
/// Measured viscosities and densities, one temperature a line. KV40, KV100, the density at 15 C and
/// Brookfield viscosities are lines like any other.
std::string viscosity_table_csv(const v1::Lubricant& lubricant);

}  // namespace tribodyn::client
