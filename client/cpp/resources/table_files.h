#pragma once

#include <cstddef>
#include <string>

#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::client {

/// The text of a table that a user named, as UTF-8 (table_text.h); says on standard error what was
/// converted. "-" is standard input. Throws Failure.
std::string read_table_file(const std::string& path, std::size_t most_bytes);

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
