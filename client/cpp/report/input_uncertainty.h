#pragma once

#include <map>
#include <string>

#include "tribodyn/v1/points.pb.h"

namespace tribodyn::client {

/// The inefficiency (energy mean) of a curve with the uncertainty of its inputs, by speed [km/h],
/// where it is known.
struct CurveUncertainty {
  std::map<double, v1::UncertainFigure> figures;
  std::string remark;  ///< what makes the uncertainty, or why it is not known; may be empty

  /// Returns null if the uncertainty at the speed is not known.
  const v1::UncertainFigure* at(double kilometres_per_hour) const {
    const auto found = figures.find(kilometres_per_hour);
    return found == figures.end() ? nullptr : &found->second;
  }
};

/// By the names of simulations.
using CurveUncertainties = std::map<std::string, CurveUncertainty>;

}  // namespace tribodyn::client
