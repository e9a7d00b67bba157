#include "client/cpp/report/comparison_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/plot/svg.h"
#include "client/cpp/report/comparison_report.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kComparisonWidth = 960;
constexpr double kComparisonLeft = 80;
constexpr double kComparisonTop = 112;
constexpr double kComparisonPanelHeight = 270;
constexpr double kComparisonPanelPitch = 350;  ///< from one panel to the next

/// Hatches the speeds at which a warning withholds the verdict on a lubricant, at any sump
/// temperature.
void add_hatching(const v1::ComparePointsRequest& request,
                  const v1::ComparePointsResponse& response, Panel& panel) {
  std::map<double, bool> is_withheld;  // by speed
  for (int k = 0; k < request.conditions_size(); ++k) {
    bool& each = is_withheld[request.conditions(k).speed_kilometres_per_hour()];
    for (const v1::ComparedLubricant& lubricant : response.lubricants()) {
      each = each || !withheld_by(lubricant.points(k).warnings()).empty();
    }
  }
  hatch(bands_where(is_withheld), panel);
}

double plotted_sump(const v1::PointCondition& condition) {
  return condition.has_sump_temperature_celsius() ? condition.sump_temperature_celsius() : 40;
}

/// The conditions at one sump temperature.
struct PlottedSump {
  double celsius;
  std::vector<int> conditions;  ///< by rising speed
};

/// Returns the conditions by sump temperature, in the order of the request.
std::vector<PlottedSump> by_sump(const v1::ComparePointsRequest& request) {
  std::vector<PlottedSump> out;
  for (int k = 0; k < request.conditions_size(); ++k) {
    const double sump = plotted_sump(request.conditions(k));
    auto found = std::find_if(out.begin(), out.end(),
                              [sump](const PlottedSump& each) { return each.celsius == sump; });
    if (found == out.end()) found = out.insert(out.end(), {sump, {}});
    found->conditions.push_back(k);
  }
  for (PlottedSump& each : out) {
    std::stable_sort(each.conditions.begin(), each.conditions.end(), [&request](int a, int b) {
      return request.conditions(a).speed_kilometres_per_hour() <
             request.conditions(b).speed_kilometres_per_hour();
    });
  }
  return out;
}

/// Returns the line of a figure of the lubricant at `index` over speed with its band; null is a
/// condition without the figure. Sump temperatures differ in dashes and markers.
Series series_of_figure(const v1::ComparePointsRequest& request, std::size_t index,
                        std::size_t sump_index, const PlottedSump& sump,
                        const std::function<const v1::UncertainFigure*(int)>& figure_at) {
  constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t kColours = 6, kDashes = 4;  // of look_of()
  Series out;
  out.colour = look_of(index).colour;
  out.dashes = look_of((index / kColours + sump_index) % kDashes * kColours).dashes;
  out.marker = look_of((index + sump_index) % kDistinctLooks).marker;
  for (const int k : sump.conditions) {
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

/// Returns "my-oil", or "my-oil, 90 C" where there are several sump temperatures.
std::string plotted_label(const v1::ComparedLubricant& lubricant,
                          const std::vector<PlottedSump>& sumps, const PlottedSump& sump) {
  return resource_id(lubricant.lubricant_revision()) +
         (sumps.size() == 1 ? "" : ", " + shortest(sump.celsius) + " C");
}

Panel figures_panel(const v1::ComparePointsRequest& request,
                    const v1::ComparePointsResponse& response) {
  Panel out = comparison_panel(0, "Mesh inefficiency (energy mean), % of input power");
  const std::vector<PlottedSump> sumps = by_sump(request);
  for (int i = 0; i < response.lubricants_size(); ++i) {
    const v1::ComparedLubricant& lubricant = response.lubricants(i);
    for (std::size_t j = 0; j < sumps.size(); ++j) {
      Series series =
          series_of_figure(request, static_cast<std::size_t>(i), j, sumps[j], [&](int k) {
            const v1::ComparedPoint& point = lubricant.points(k);
            return point.refusal_reason().empty() ? &point.inefficiency_energy_mean_percent()
                                                  : nullptr;
          });
      series.label = plotted_label(lubricant, sumps, sumps[j]);
      out.series.push_back(std::move(series));
    }
  }
  return out;
}

Panel differences_panel(const v1::ComparePointsRequest& request,
                        const v1::ComparePointsResponse& response) {
  Panel out =
      comparison_panel(1, "Less " + resource_id(response.lubricants(0).lubricant_revision()) +
                              ", percentage points");
  out.line_at = 0;
  const std::vector<PlottedSump> sumps = by_sump(request);
  for (int i = 1; i < response.lubricants_size(); ++i) {
    const v1::ComparedLubricant& lubricant = response.lubricants(i);
    for (std::size_t j = 0; j < sumps.size(); ++j) {
      Series series =
          series_of_figure(request, static_cast<std::size_t>(i), j, sumps[j], [&](int k) {
            const v1::ComparedDifference& difference = lubricant.differences(k);
            return states_interval(difference) ? &difference.difference_percent() : nullptr;
          });
      for (const int k : sumps[j].conditions) {
        series.hollow.push_back(lubricant.differences(k).verdict() ==
                                v1::ComparedDifference::CANNOT_BE_TOLD_APART);
      }
      series.label = plotted_label(lubricant, sumps, sumps[j]);
      out.series.push_back(std::move(series));
    }
  }
  return out;
}

std::vector<std::string> comparison_footer(const v1::ComparePointsRequest& request,
                                           const v1::ComparePointsResponse& response) {
  std::vector<std::string> sumps;
  for (const PlottedSump& each : by_sump(request)) {
    sumps.push_back(shortest(each.celsius) + " \xC2\xB0\x43");
  }
  std::vector<std::string> out = {"Sump " + joined(sumps, ", ") + ". " + response.not_included()};
  out.push_back("Bands: 95 % intervals by the stated uncertainties of the inputs, from " +
                std::to_string(response.draws()) +
                " draws; those of differences include the solver's error." +
                (response.lubricants_size() > 1
                     ? " A hollow marker: the two cannot be told apart at this speed. Errors that "
                       "lubricants share leave the difference, so that bands of the upper picture "
                       "may overlap where the difference is sure."
                     : ""));
  std::vector<std::string> unstated;
  for (const v1::ComparedLubricant& each : response.lubricants()) {
    if (!each.uncertainty_stated()) unstated.push_back(resource_id(each.lubricant_revision()));
  }
  if (!unstated.empty()) out.push_back("Uncertainty not stated: " + joined(unstated, ", ") + ".");
  for (const v1::ComparedLubricant& each : response.lubricants()) {
    const std::string refusal = refusal_text(request, each);
    if (!refusal.empty()) {
      out.push_back("No figure of " + resource_id(each.lubricant_revision()) + ": " + refusal +
                    ".");
    }
  }
  for (std::string& each : warning_footers(comparison_warnings(request, response), true)) {
    out.push_back(std::move(each));
  }
  out.push_back("Model " + model_options_text(request.model_options()) + ", version " +
                response.model_version() + "; " + response.gear_set_revision() + ", " +
                response.surface_revision() + ", " + response.vehicle_revision() + ".");
  return out;
}

}  // namespace

std::string comparison_plot(const v1::ComparePointsRequest& request,
                            const v1::ComparePointsResponse& response) {
  const bool has_differences = response.lubricants_size() > 1;
  const std::vector<std::string> lines =
      footer_lines(comparison_footer(request, response), kComparisonWidth - 2 * kComparisonLeft);
  const double footer_top = kComparisonTop + kComparisonPanelPitch * (has_differences ? 2 : 1);
  Svg svg(kComparisonWidth, footer_top + kFooterPitch * static_cast<double>(lines.size()));
  svg.text({kComparisonLeft, 40},
           has_differences ? "Which lubricant loses less, and how sure that is"
                           : "What the lubricant loses, and how sure that is",
           {21, "start", "#111", true, 0});
  Panel figures = figures_panel(request, response);
  add_hatching(request, response, figures);
  draw_panel(figures, svg);
  if (has_differences) draw_panel(differences_panel(request, response), svg);
  draw_footer(lines, {kComparisonLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
