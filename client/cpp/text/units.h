#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tribodyn::client {

inline constexpr double kZeroCelsius = 273.15;  ///< 0 degrees Celsius [K]

/// Returns the symbol of the unit at the end of a field's name, e.g. "W/(m K)" for
/// "thermal_conductivity_watts_per_metre_kelvin"; empty for a pure number or a text.
std::string unit_of_field(std::string_view field);

/// Returns the field's name in words and without its unit, e.g. "thermal conductivity".
std::string label_of_field(std::string_view field);

/// Whether a field in kelvin or Celsius is a temperature. A difference of temperatures or a
/// coefficient is not: its value is the same in kelvin and in Celsius.
bool is_temperature_field(std::string_view field);

/// Returns the value of one `from` in `to`, e.g. 1e-9 for "1/GPa" in "1/Pa"; nullopt if the
/// dimensions differ or a unit is unknown. Units are products of powers in any usual spelling: "mPa
/// s", "mPa*s", "mm2/s", "mm^2/s", "1/GPa", "GPa^-1", "/GPa", "W/(m K)", "W/m/K", "cSt", "cP".
std::optional<double> unit_ratio(std::string_view from, std::string_view to);

/// Returns the value in `unit` of a text such as "20/GPa", "40 C", "8.86mm2/s" or "0.14". A number
/// without a unit is in `bare_unit`; if that is empty, the text must state a unit. With
/// `temperature`, Celsius and kelvin convert by their zeros. In degrees, "30%" is a slope: 16.7
/// degrees. On failure returns nullopt and sets `wrong` to the second half of a sentence whose
/// subject is the text.
std::optional<double> read_quantity(std::string_view text, const std::string& unit,
                                    const std::string& bare_unit, bool temperature,
                                    std::string& wrong);

/// Returns the likely slip behind a quantity outside [low, high] (in `unit`) if the number lies
/// inside that range in exactly one other usual unit: "0.895 looks like g/cm3: write 0.895g/cm3 or
/// 895". `bare_unit` is the unit of a number without one. Returns an empty text otherwise.
std::string unit_slip(std::string_view text, const std::string& unit, const std::string& bare_unit,
                      double low, double high);

/// Returns the usual unit of data sheets for a field: 1/GPa for 1/Pa, mPa s for Pa s, MPa for Pa, C
/// for temperatures in kelvin, um for roughness and backlash; otherwise the field's own unit.
std::string trade_unit_of_field(std::string_view field);
double in_trade_unit(std::string_view field, double value);
/// Converts a difference or an uncertainty of the field.
double difference_in_trade_unit(std::string_view field, double difference);

}  // namespace tribodyn::client
