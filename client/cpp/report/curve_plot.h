#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/report/input_uncertainty.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Panels that a curve plot has on request.
struct CurvePanels {
  std::vector<std::string> names = {};  ///< words of curve_panel_words()
  double half_backlash_metres = 0;      ///< drawn beside the transmission error; 0: not
};
/// Returns the names of the panels, separated by '|'.
std::string curve_panel_words();

/// Draws inefficiency curves: for every fluid the inefficiency against speed (energy mean solid,
/// RMS dashed), with speeds at which flanks separate shaded; below it mesh loss and contact
/// temperature. `titles` maps lubricants to labels ("lubricants/my-oil" -> "my-oil ester-olefin");
/// a lubricant that is not in it is labelled with its id. `uncertainties` are drawn as bands: 95 %
/// intervals of the energy mean. The panels on request stand below.
std::string curve_plot(const std::vector<v1::Simulation>& simulations,
                       const std::map<std::string, std::string>& titles,
                       const CurveUncertainties& uncertainties = {}, const CurvePanels& extra = {});

/// Returns the ranges of speed [km/h] in which some simulation reports contact loss, ascending and
/// without overlap. Each range reaches half way to the neighbouring speeds.
std::vector<std::pair<double, double>> contact_loss_bands(
    const std::vector<v1::Simulation>& simulations);

}  // namespace tribodyn::client
