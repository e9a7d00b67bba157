#pragma once

#include <string>
#include <vector>

#include "client/cpp/paper/figure.h"

namespace tribodyn::client {

/// Laws and misprints with which figures 7 and 10 are tried.
struct TriedVariant {
  std::string name;
  std::vector<std::string> switches;  ///< as in PaperCurve
};
const std::vector<TriedVariant>& tried_variants();
/// Returns the curve of lubricant 1 with a variant at the speeds of its table.
PaperCurve tried_curve(const TriedVariant& variant, bool is_isothermal);
inline const std::vector<double> kTriedSpeeds = {20, 60, 100, 140};  ///< [km/h]

/// Returns the curve with one more switch.
PaperCurve with(PaperCurve curve, const std::string& path);

}  // namespace tribodyn::client
