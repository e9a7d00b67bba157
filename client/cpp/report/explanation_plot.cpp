#include "client/cpp/report/explanation_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/plot/svg.h"
#include "client/cpp/report/explanation_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kExplanationWidth = 960;
constexpr double kExplanationLeft = 80;
constexpr double kExplanationTop = 110;
constexpr double kCausePitch = 30;    ///< from one bar to the next
constexpr double kStackHeight = 300;  ///< of the stacked bars
constexpr char kExplanationInk[] = "#444";
constexpr char kExplanationGrid[] = "#e4e4e4";

/// Returns the colour of a group: the same in both parts of the picture.
std::string group_colour(v1::ParameterGroup group) {
  return look_of(static_cast<std::size_t>(group) - 1).colour;
}

double share_of(const v1::DifferenceExplanation& point, v1::ParameterGroup group) {
  return point.causes(static_cast<int>(group) - 1).inefficiency_percent().shapley_value().value();
}

bool has_interval(const v1::DrawnFigure& figure) {
  return figure.standard_uncertainty() > 0 && std::isfinite(figure.interval_minimum());
}

/// Maps values to pixels between the first and the last tick.
struct TickScale {
  std::vector<double> ticks;
  double from, to;  ///< pixels of the first and the last tick

  double at(double value) const {
    return from + (to - from) * (value - ticks.front()) / (ticks.back() - ticks.front());
  }
};

/// Draws one bar for each group and one for the difference.
void draw_mean(const v1::DifferenceExplanation& mean, double top, Svg& svg) {
  const std::vector<v1::DifferenceCause> causes = ranked_causes(mean);
  struct Bar {
    std::string label, colour;
    v1::DrawnFigure figure;
  };
  std::vector<Bar> bars;
  for (const v1::DifferenceCause& cause : causes) {
    bars.push_back({parameter_group_text(cause.group()), group_colour(cause.group()),
                    cause.inefficiency_percent().shapley_value()});
  }
  bars.push_back({"difference", kExplanationInk, mean.inefficiency_difference_percent()});
  double low = 0, high = 0;
  for (const Bar& bar : bars) {
    low = std::min(low, bar.figure.value());
    high = std::max(high, bar.figure.value());
    if (!has_interval(bar.figure)) continue;
    low = std::min(low, bar.figure.interval_minimum());
    high = std::max(high, bar.figure.interval_maximum());
  }
  const TickScale scale{nice_ticks(low, high, 6), 330, kExplanationWidth - 110};
  const std::vector<std::string> labels = tick_labels(scale.ticks);
  const double bottom = top + kCausePitch * static_cast<double>(bars.size());
  for (std::size_t i = 0; i < scale.ticks.size(); ++i) {
    const double x = scale.at(scale.ticks[i]);
    svg.line({x, top}, {x, bottom}, {kExplanationGrid, 1, ""});
    svg.text({x, bottom + 18}, labels[i], {12, "middle", kExplanationInk, false, 0});
  }
  svg.line({scale.at(0), top}, {scale.at(0), bottom}, {kExplanationInk, 1, ""});
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Bar& bar = bars[i];
    const double y = top + kCausePitch * (static_cast<double>(i) + 0.5);
    const double value = scale.at(bar.figure.value());
    svg.rectangle({std::min(scale.at(0), value), y - 9}, std::abs(value - scale.at(0)), 18,
                  bar.colour, 0.8);
    double end = std::max(scale.at(0), value);
    if (has_interval(bar.figure)) {
      const double from = scale.at(bar.figure.interval_minimum());
      const double to = scale.at(bar.figure.interval_maximum());
      svg.line({from, y}, {to, y}, {"#222", 1.5, ""});
      for (const double edge : {from, to})
        svg.line({edge, y - 5}, {edge, y + 5}, {"#222", 1.5, ""});
      end = std::max(end, to);
    }
    svg.text({320, y + 4}, bar.label, {12, "end", kExplanationInk, i + 1 == bars.size(), 0});
    svg.text({end + 8, y + 4}, significant(bar.figure.value(), 3),
             {12, "start", kExplanationInk, false, 0});
  }
}

/// Draws for each condition the positive shares upwards and the negative ones downwards, and a line
/// at their sum, the difference.
void draw_stacks(const v1::ExplainPointsRequest& request, const v1::ExplainPointsResponse& response,
                 double top, Svg& svg) {
  double low = 0, high = 0;
  for (const v1::DifferenceExplanation& point : response.points()) {
    double up = 0, down = 0;
    for (const v1::DifferenceCause& cause : point.causes()) {
      const double share = share_of(point, cause.group());
      (share > 0 ? up : down) += share;
    }
    high = std::max(high, up);
    low = std::min(low, down);
  }
  const double right = kExplanationWidth - 60;
  const TickScale scale{nice_ticks(low, high, 6), top + kStackHeight, top};
  const std::vector<std::string> labels = tick_labels(scale.ticks);
  for (std::size_t i = 0; i < scale.ticks.size(); ++i) {
    const double y = scale.at(scale.ticks[i]);
    svg.line({kExplanationLeft, y}, {right, y}, {kExplanationGrid, 1, ""});
    svg.text({kExplanationLeft - 8, y + 4}, labels[i], {12, "end", kExplanationInk, false, 0});
  }
  const int count = response.points_size();
  const double pitch = (right - kExplanationLeft) / count, width = std::min(46.0, 0.7 * pitch);
  const int every = 1 + static_cast<int>(34.0 / pitch);  // speeds need 34 pixels each
  const std::vector<v1::DifferenceCause> causes = ranked_causes(response.mean());
  for (int k = 0; k < count; ++k) {
    const v1::DifferenceExplanation& point = response.points(k);
    const double x = kExplanationLeft + pitch * (k + 0.5);
    if (k % every == 0) {
      svg.text({x, top + kStackHeight + 18},
               significant(request.conditions(k).speed_kilometres_per_hour(), 4),
               {12, "middle", kExplanationInk, false, 0});
    }
    if (!withheld_by(point.warnings()).empty()) {
      svg.hatched_rectangle({x - pitch / 2, top}, pitch, kStackHeight, kHatchColour);
    }
    if (point.causes().empty()) continue;
    double up = 0, down = 0;
    for (const v1::DifferenceCause& cause : causes) {
      const double share = share_of(point, cause.group());
      double& start = share > 0 ? up : down;
      const double from = scale.at(start), to = scale.at(start + share);
      svg.rectangle({x - width / 2, std::min(from, to)}, width, std::abs(to - from),
                    group_colour(cause.group()), 0.8);
      start += share;
    }
    const double y = scale.at(point.inefficiency_difference_percent().value());
    svg.line({x - width / 2 - 4, y}, {x + width / 2 + 4, y}, {"#111", 2.5, ""});
  }
  svg.line({kExplanationLeft, scale.at(0)}, {right, scale.at(0)}, {kExplanationInk, 1, ""});
  svg.text({(kExplanationLeft + right) / 2, top + kStackHeight + 38}, "speed, km/h",
           {12, "middle", kExplanationInk, false, 0});
}

std::vector<std::string> explanation_footer(const v1::ExplainPointsRequest& request,
                                            const v1::ExplainPointsResponse& response) {
  const std::string a = resource_id(response.lubricant_revision());
  const std::string b = resource_id(response.other_lubricant_revision());
  std::vector<std::string> out = {response.not_included()};
  out.push_back("Share: what a group of parameters of " + b + " adds to " + a +
                ", averaged over all orders in which the six groups are exchanged (Shapley value). "
                "The shares sum to the difference" +
                (response.points_size() > 1 ? ", the black line." : "."));
  out.push_back(response.draws() > 0
                    ? "Lines with ends: 95 % intervals from " + std::to_string(response.draws()) +
                          " draws of the uncertain inputs."
                    : "No input has a stated uncertainty.");
  for (std::string& each :
       warning_footers(explanation_warnings(request, response), response.points_size() > 1)) {
    out.push_back(std::move(each));
  }
  out.push_back("Model version " + response.model_version() + "; " + response.gear_set_revision() +
                ", " + response.surface_revision() +
                (response.other_surface_revision() == response.surface_revision()
                     ? ""
                     : " and " + response.other_surface_revision()) +
                ", " + response.vehicle_revision() + ".");
  return out;
}

}  // namespace

std::string explanation_plot(const v1::ExplainPointsRequest& request,
                             const v1::ExplainPointsResponse& response) {
  const bool has_stacks = response.points_size() > 1;
  const double bars = static_cast<double>(response.mean().causes_size() + 1);
  const double mean_bottom = kExplanationTop + kCausePitch * bars + 40;
  const double stacks_top = mean_bottom + 50;
  const double footer_top = (has_stacks ? stacks_top + kStackHeight + 44 : mean_bottom) + 30;
  const std::vector<std::string> lines =
      footer_lines(explanation_footer(request, response), kExplanationWidth - 2 * kExplanationLeft);
  Svg svg(kExplanationWidth, footer_top + kFooterPitch * static_cast<double>(lines.size()));
  svg.text({kExplanationLeft, 40},
           "Why " + resource_id(response.other_lubricant_revision()) + " differs from " +
               resource_id(response.lubricant_revision()),
           {21, "start", "#111", true, 0});
  svg.text({kExplanationLeft, kExplanationTop - 24},
           std::string("Share in the difference of mesh inefficiency, percentage points") +
               (has_stacks ? ", mean of all speeds" : ""),
           {13, "start", "#222", true, 0});
  draw_mean(response.mean(), kExplanationTop, svg);
  if (has_stacks) {
    svg.text({kExplanationLeft, stacks_top - 24},
             "The shares at each speed, percentage points; the black line is the difference",
             {13, "start", "#222", true, 0});
    draw_stacks(request, response, stacks_top, svg);
  }
  draw_footer(lines, {kExplanationLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
