#pragma once

#include <cstddef>
#include <string>

#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::client {

/// Returns the text of a table file as UTF-8 (see table_text.h) and prints on standard error if it
/// was converted. "-" is standard input. Throws Failure.
std::string read_table_file(const std::string& path, std::size_t most_bytes);

// Tables in the form that the server's imports read; numbers as their shortest exact text.

/// Returns the flank slots by mesh phase and slot.
std::string tooth_contact_csv(const v1::GearSet& gear_set);
/// Returns the Fourier series at the reference torque.
std::string series_csv(const v1::GearSet& gear_set);
/// Returns measured viscosities and densities, one temperature per line, including KV40, KV100, the
/// density at 15 C and Brookfield viscosities.
std::string viscosity_table_csv(const v1::Lubricant& lubricant);

}  // namespace tribodyn::client
