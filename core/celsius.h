#pragma once

namespace tribodyn {

inline constexpr double kZeroCelsius = 273.15;                 ///< 0 degrees Celsius [K]
inline constexpr double kFortyCelsius = kZeroCelsius + 40;     ///< 40 degrees Celsius [K]
inline constexpr double kHundredCelsius = kZeroCelsius + 100;  ///< 100 degrees Celsius [K]

}  // namespace tribodyn
