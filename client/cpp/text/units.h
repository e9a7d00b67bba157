#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tribodyn::client {

inline constexpr double kZeroCelsius = 273.15;  ///< 0 degrees Celsius [K]

/// The symbol of the unit that a field's name ends in: "W/(m K)" of
/// "thermal_conductivity_watts_per_metre_kelvin"; empty for a pure number or a text.
std::string unit_of_field(std::string_view field);

/// The field's name in words, without its unit: "thermal conductivity".
std::string label_of_field(std::string_view field);

/// Whether a number in kelvin or Celsius is a temperature, not a difference or a coefficient: only
/// then do the two convert into each other.
bool is_temperature_field(std::string_view field);

/// How many `to` one `from` is, e.g. 1e-9 of "1/GPa" in "1/Pa"; nothing when they measure different
/// things or one is not known. Units are products of powers in any usual spelling: "mPa s",
/// "mPa*s", "mm2/s", "mm^2/s", "1/GPa", "GPa^-1", "/GPa", "W/(m K)", "W/m/K", "cSt", "cP".
std::optional<double> unit_ratio(std::string_view from, std::string_view to);

/// What "20/GPa", "40 C", "8.86mm2/s" or "0.14" is in `unit`. A number without a unit is in
/// `bare_unit`; empty: it must have one. `temperature`: Celsius and kelvin convert with their
/// zeros. Where `unit` is degrees, a slope in percent is an angle too: "30%" is 16.7 degrees.
/// Otherwise nothing, and `wrong` says in words what is the matter.
std::optional<double> read_quantity(std::string_view text, const std::string& unit,
                                    const std::string& bare_unit, bool temperature,
                                    std::string& wrong);

/// The likely slip behind a quantity outside [low, high] (in `unit`), if the number lies inside in
/// exactly one other usual unit: "0.895 looks like g/cm3: write 0.895g/cm3 or 895". `bare_unit` is
/// that of a number without a unit. Empty: none is known.
std::string unit_slip(std::string_view text, const std::string& unit, const std::string& bare_unit,
                      double low, double high);

/// The unit that the trade uses for a field: 1/GPa for 1/Pa, mPa s for Pa s, MPa for Pa, C for
/// temperatures in kelvin, um for roughness and backlash; others as they are.
std::string trade_unit_of_field(std::string_view field);
double in_trade_unit(std::string_view field, double value);
/// A difference or an uncertainty of the field.
double difference_in_trade_unit(std::string_view field, double difference);

}  // namespace tribodyn::client
