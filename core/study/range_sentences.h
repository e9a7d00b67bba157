#pragma once

#include <string>

#include "core/lubricant/fluid_grounds.h"
#include "core/model_options.h"
#include "core/surface/surface.h"

// Warnings of points and rigs where a law leaves the range in which it was measured or checked.
// Each is empty inside the range.

namespace tribodyn {

/// A sentence says where a range is left, not by how many digits.
inline constexpr int kRangeDigits = 3;

/// Of the film's temperatures [K]; empty also if the range of the measurements is not known.
std::string viscosity_sentence(const FluidGrounds& grounds, double inlet_temperature,
                               double highest_temperature);
/// Of the largest contact pressure [Pa].
std::string pressure_sentence(double pressure);
/// Of the least film ratio [-].
std::string film_ratio_sentence(double film_ratio);
std::string roughness_product_sentence(const Roughness& roughness);
/// Of the share of the loaded area on the limiting shear stress [-].
std::string limiting_stress_sentence(const FluidGrounds& grounds, double area_share);
/// Of what shear heating of the inlet thins the film to [-], if the model leaves it out.
std::string inlet_heating_sentence(double heating_factor, const ModelOptions& options);
/// Of the same, if the model includes it: oil as thick starves the inlet too.
std::string starvation_sentence(double heating_factor, const ModelOptions& options);
/// Of the viscosity at the contact inlet [Pa s].
std::string viscosity_range_sentence(double viscosity);
/// Of the thickness of the film [m].
std::string thick_film_sentence(double film_thickness);
/// Empty for what a lubricated contact can have.
std::string no_lubricated_contact_sentence(double friction, double temperature);
std::string isothermal_sentence(const ModelOptions& options);

}  // namespace tribodyn
