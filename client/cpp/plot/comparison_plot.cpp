#include "client/cpp/plot/comparison_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/plot/svg.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kComparisonWidth = 960;
constexpr double kComparisonLeft = 80;
constexpr double kComparisonTop = 112;
constexpr double kComparisonPanelHeight = 270;
constexpr double kComparisonPanelPitch = 350;  ///< from one panel to the next

/// Returns the numbers of the conditions by rising speed.
std::vector<int> by_speed(const v1::ComparePointsRequest& request) {
  std::vector<int> out(static_cast<std::size_t>(request.conditions_size()));
  std::iota(out.begin(), out.end(), 0);
  std::stable_sort(out.begin(), out.end(), [&request](int a, int b) {
    return request.conditions(a).speed_kilometres_per_hour() <
           request.conditions(b).speed_kilometres_per_hour();
  });
  return out;
}

/// Returns the line of a figure over speed with its band; null is a condition without the figure.
Series series_of_figure(const v1::ComparePointsRequest& request, std::size_t look_index,
                        const std::function<const v1::UncertainFigure*(int)>& figure_at) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  const Look look = look_of(look_index);
  Series out;
  out.colour = look.colour;
  out.dashes = look.dashes;
  out.marker = look.marker;
  for (const int k : by_speed(request)) {
    const v1::UncertainFigure* figure = figure_at(k);
    const bool has_band = figure != nullptr && figure->standard_uncertainty() > 0;
    out.x.push_back(request.conditions(k).speed_kilometres_per_hour());
    out.y.push_back(figure == nullptr ? kAbsent : figure->value());
    out.low.push_back(has_band ? figure->interval_minimum() : kAbsent);
    out.high.push_back(has_band ? figure->interval_maximum() : kAbsent);
  }
  return out;
}

Panel comparison_panel(int place, const std::string& title) {
  Panel out;
  out.corner = {kComparisonLeft, kComparisonTop + kComparisonPanelPitch * place};
  out.width = 640;
  out.height = kComparisonPanelHeight;
  out.title = title;
  out.x_title = "Vehicle speed, km/h";
  out.shows_samples = true;
  return out;
}

Panel figures_panel(const v1::ComparePointsRequest& request,
                    const v1::ComparePointsResponse& response) {
  Panel out = comparison_panel(0, "Mesh inefficiency (energy mean), % of input power");
  for (int i = 0; i < response.lubricants_size(); ++i) {
    const v1::ComparedLubricant& lubricant = response.lubricants(i);
    Series series = series_of_figure(request, static_cast<std::size_t>(i), [&](int k) {
      const v1::ComparedPoint& point = lubricant.points(k);
      return point.refusal_reason().empty() ? &point.inefficiency_energy_mean_percent() : nullptr;
    });
    series.label = resource_id(lubricant.lubricant_revision());
    out.series.push_back(std::move(series));
  }
  return out;
}

Panel differences_panel(const v1::ComparePointsRequest& request,
                        const v1::ComparePointsResponse& response) {
  Panel out =
      comparison_panel(1, "Less " + resource_id(response.lubricants(0).lubricant_revision()) +
                              ", percentage points");
  out.line_at = 0;
  for (int i = 1; i < response.lubricants_size(); ++i) {
    const v1::ComparedLubricant& lubricant = response.lubricants(i);
    Series series = series_of_figure(request, static_cast<std::size_t>(i), [&](int k) {
      const v1::ComparedDifference& difference = lubricant.differences(k);
      return difference.has_difference_percent() ? &difference.difference_percent() : nullptr;
    });
    for (const int k : by_speed(request)) {
      series.hollow.push_back(lubricant.differences(k).verdict() ==
                              v1::ComparedDifference::CANNOT_BE_TOLD_APART);
    }
    series.label = resource_id(lubricant.lubricant_revision());
    out.series.push_back(std::move(series));
  }
  return out;
}

std::vector<std::string> comparison_footer(const v1::ComparePointsResponse& response) {
  std::vector<std::string> out;
  out.push_back("Bands: 95 % intervals by the stated uncertainties of the inputs, from " +
                std::to_string(response.draws()) +
                " draws; those of differences include the solver's error." +
                (response.lubricants_size() > 1
                     ? " A hollow marker: the two cannot be told apart at this speed. Errors that "
                       "lubricants share leave the difference, so that bands of the upper picture "
                       "may overlap where the difference is sure."
                     : ""));
  out.push_back("Model version " + response.model_version() + "; " + response.gear_set_revision() +
                ", " + response.surface_revision() + ", " + response.vehicle_revision() + ".");
  return out;
}

}  // namespace

std::string comparison_plot(const v1::ComparePointsRequest& request,
                            const v1::ComparePointsResponse& response) {
  const bool has_differences = response.lubricants_size() > 1;
  const std::vector<std::string> lines =
      footer_lines(comparison_footer(response), kComparisonWidth - 2 * kComparisonLeft);
  const double footer_top = kComparisonTop + kComparisonPanelPitch * (has_differences ? 2 : 1);
  Svg svg(kComparisonWidth, footer_top + kFooterPitch * static_cast<double>(lines.size()));
  svg.text({kComparisonLeft, 40},
           has_differences ? "Which lubricant loses less, and how sure that is"
                           : "What the lubricant loses, and how sure that is",
           {21, "start", "#111", true, 0});
  draw_panel(figures_panel(request, response), svg);
  if (has_differences) draw_panel(differences_panel(request, response), svg);
  draw_footer(lines, {kComparisonLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
