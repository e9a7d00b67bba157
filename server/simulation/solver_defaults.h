#pragma once

#include "core/study/operating_point.h"

namespace tribodyn::server {

// Values of unset fields of a request. Those of the solver are the core's defaults.
inline constexpr double kDefaultSumpTemperatureCelsius = 40;
inline constexpr double kDefaultInletTemperatureRiseKelvin = 20;  // eq 14, published value
inline const int kDefaultMaximumCycles = PointOptions{}.maximum_mesh_cycles;
inline const int kDefaultHistoryCycles = HistoryRequest{}.mesh_cycles;
inline const int kDefaultHistorySamples = HistoryRequest{}.samples_per_mesh_cycle;

}  // namespace tribodyn::server
