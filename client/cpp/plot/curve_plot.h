#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Inefficiency curves as a picture: inefficiency against speed (energy mean solid, RMS dashed) for
/// every fluid, speeds at which the flanks separate shaded, below it mesh loss and contact
/// temperature. `titles` names lubricants ("lubricants/1" -> "1 ester-olefin"); others show their
/// id.
std::string curve_plot(const std::vector<v1::Simulation>& simulations,
                       const std::map<std::string, std::string>& titles);

/// Ranges of speed [km/h] in which some simulation reports contact loss, each reaching half way to
/// the neighbouring speeds; ascending, not overlapping.
std::vector<std::pair<double, double>> contact_loss_bands(
    const std::vector<v1::Simulation>& simulations);

}  // namespace tribodyn::client
