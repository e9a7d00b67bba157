#include "core/study/figure_limits.h"

#include <algorithm>
#include <utility>

namespace tribodyn {

std::vector<FigureLimit> figure_limits(const FluidGrounds& fluid, const StatedLimits& stated) {
  using enum LimitedFigure;
  const std::string stated_source = stated.source.empty() ? "stated" : "stated: " + stated.source;
  std::vector<FigureLimit> out = {
      {kFilmRatioMinimum, kSparseAsperities, {}, "sparse asperities (Greenwood and Tripp)"},
      {kFilmRatioMinimum,
       kBoundaryLubrication,
       {},
       "boundary lubrication below (Hamrock, Schmid and Jacobson 2004)"},
      {kPressureMaximum, kLowestComparedPressure, kHighestComparedPressure,
       "friction model compared with measurements (fig 5)"}};
  if (const auto& measured = fluid.viscosity_measured) {
    const char* source = "viscosity of the lubricant measured";
    out.push_back({kContactTemperatureMinimum, measured->lowest, {}, source});
    out.push_back({kContactTemperatureMaximum, {}, measured->highest, source});
  }
  if (stated.film_ratio_minimum) {
    out.push_back({kFilmRatioMinimum, stated.film_ratio_minimum, {}, stated_source});
  }
  for (const auto& [figure, maximum] :
       {std::pair{kPressureMaximum, stated.pressure_maximum},
        std::pair{kContactTemperatureMaximum, stated.contact_temperature_maximum},
        std::pair{kFlashTemperatureMaximum, stated.flash_temperature_maximum}}) {
    if (maximum) out.push_back({figure, {}, maximum, stated_source});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const FigureLimit& a, const FigureLimit& b) { return a.figure < b.figure; });
  return out;
}

}  // namespace tribodyn
