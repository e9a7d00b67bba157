#pragma once

#include "core/study/operating_point.h"

namespace tribodyn::server {

// What an unset field of a request means. The numbers of the solver are the core's own defaults.
inline constexpr double kDefaultSumpTemperatureCelsius = 40;
inline constexpr double kDefaultInletTemperatureRiseKelvin = 20;  // published
inline const int kDefaultMaximumCycles = PointOptions{}.maximum_mesh_cycles;
inline const int kDefaultHistoryCycles = HistoryRequest{}.mesh_cycles;
inline const int kDefaultHistorySamples = HistoryRequest{}.samples_per_mesh_cycle;

}  // namespace tribodyn::server
