#include "client/cpp/plot/curve_plot.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "client/cpp/plot/panel.h"
#include "client/cpp/report/inputs.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

constexpr double kCurveWidth = 960;
constexpr double kHeight = 860;
constexpr double kCurveLeft = 70;
constexpr char kDegreesCelsius[] = "\xC2\xB0\x43";
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kLongestLabel = 22;
constexpr int kLongestNote = 30;

bool has_branch_end(const std::vector<v1::Simulation>& simulations) {
  return std::any_of(simulations.begin(), simulations.end(), [](const v1::Simulation& simulation) {
    const auto& points = simulation.result().points();
    return std::any_of(points.begin(), points.end(),
                       [](const v1::CurvePoint& point) { return point.has_branch_end(); });
  });
}

/// The line is broken where a branch ends: the response jumps there.
template <class Value>
Series series_of(const v1::Simulation& simulation, std::size_t index, Value value) {
  Series series;
  series.colour = series_colour(index);
  const bool down = simulation.result().direction() == v1::DOWN;
  const auto add = [&](double x, double y, bool hollow) {
    series.x.push_back(x);
    series.y.push_back(y);
    series.hollow.push_back(hollow);
  };
  for (const v1::CurvePoint& point : simulation.result().points()) {
    const double jump = point.branch_end().followed_to_kilometers_per_hour();
    if (point.has_branch_end() && !down) add(jump, kNone, false);
    add(point.speed_kilometers_per_hour(), point.has_result() ? value(point.result()) : kNone,
        point.result().contact_loss());
    if (point.has_branch_end() && down) add(jump, kNone, false);
  }
  return series;
}

/// "Lubricant 1: ester-olefin copolymer" becomes a label and a note; without a title, the id does.
std::pair<std::string, std::string> label_and_note(
    const v1::Simulation& simulation, const std::map<std::string, std::string>& titles) {
  const auto found = titles.find(simulation.lubricant());
  const std::string title = found != titles.end() ? found->second : "";
  const std::size_t colon = title.find(": ");
  const std::string label = title.substr(0, colon);
  const std::string note = colon == std::string::npos ? "" : title.substr(colon + 2);
  if (label.empty() || display_width(label) > kLongestLabel) {
    return {"lubricant " + resource_id(simulation.lubricant()), ""};
  }
  return {label, display_width(note) > kLongestNote ? "" : note};
}

Panel inefficiency_panel(const std::vector<v1::Simulation>& simulations,
                         const std::map<std::string, std::string>& titles) {
  Panel panel;
  panel.corner = {kCurveLeft, 118};
  panel.width = 690;
  panel.height = 350;
  panel.title = "Mesh inefficiency, % of input power";
  panel.x_title = "Vehicle speed, km/h";
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    Series rms = series_of(simulations[i], i, [](const v1::PointResult& result) {
      return result.has_inefficiency_rms_percent() ? result.inefficiency_rms_percent() : kNone;
    });
    rms.width = 1.3;
    rms.dashes = "5 4";
    panel.series.push_back(std::move(rms));
  }
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    Series mean = series_of(simulations[i], i, [](const v1::PointResult& result) {
      return result.has_inefficiency_energy_mean_percent()
                 ? result.inefficiency_energy_mean_percent()
                 : kNone;
    });
    mean.width = 2.4;
    mean.has_markers = true;
    std::tie(mean.label, mean.note) = label_and_note(simulations[i], titles);
    panel.series.push_back(std::move(mean));
  }
  return panel;
}

template <class Value>
Panel small_panel(const std::vector<v1::Simulation>& simulations, Point corner,
                  const std::string& title, Value value) {
  Panel panel;
  panel.corner = corner;
  panel.width = 390;
  panel.height = 200;
  panel.title = title;
  panel.x_title = "Vehicle speed, km/h";
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    panel.series.push_back(series_of(simulations[i], i, value));
  }
  return panel;
}

/// What the kinds of line mean, on one line.
void draw_key(bool has_bands, Svg& svg) {
  const double y = 72;
  const TextStyle style{12.5, "start", "#444", false, 0};
  double x = kCurveLeft;
  const auto word = [&](const char* text) {
    svg.text({x, y + 4}, text, style);
    x += text_width(text, style.size) + 26;
  };
  svg.line({x, y}, {x + 28, y}, {"#444", 2.4, ""});
  svg.circle({x + 14, y}, 2.4, "#444", {"#444", 0, ""});
  x += 36;
  word("energy mean");
  svg.line({x, y}, {x + 28, y}, {"#444", 1.3, "5 4"});
  x += 36;
  word("RMS over time (eq 30)");
  if (!has_bands) return;
  svg.rectangle({x, y - 7}, 28, 14, "#9a9a9a", 0.18);
  svg.circle({x + 14, y}, 3.4, "#fff", {"#444", 1.6, ""});
  x += 36;
  word("flanks separate (vibro-impact)");
}

/// What all curves share; what differs is left to the labels.
std::string caption(const std::vector<v1::Simulation>& simulations) {
  if (simulations.empty()) return "";
  const v1::Simulation& first = simulations.front();
  std::string text = inputs_text(first, kDegreesCelsius);
  text[0] = 'G';
  text += first.inefficiency_curve().direction() == v1::DOWN ? "; down-sweep" : "; up-sweep";
  text += "; model " + model_options_text(first.model_options());
  return text + " (" + first.result().model_version() + ").";
}

}  // namespace

std::vector<std::pair<double, double>> contact_loss_bands(
    const std::vector<v1::Simulation>& simulations) {
  std::vector<std::pair<double, double>> spans;
  for (const v1::Simulation& simulation : simulations) {
    const auto& points = simulation.result().points();
    for (int i = 0; i < points.size(); ++i) {
      if (!points[i].result().contact_loss()) continue;
      const double speed = points[i].speed_kilometers_per_hour();
      const double before = i > 0 ? points[i - 1].speed_kilometers_per_hour() : speed;
      const double after =
          i + 1 < points.size() ? points[i + 1].speed_kilometers_per_hour() : speed;
      spans.emplace_back((before + speed) / 2, (speed + after) / 2);
    }
  }
  std::sort(spans.begin(), spans.end());
  std::vector<std::pair<double, double>> bands;
  for (const auto& span : spans) {
    if (!bands.empty() && span.first <= bands.back().second) {
      bands.back().second = std::max(bands.back().second, span.second);
    } else {
      bands.push_back(span);
    }
  }
  return bands;
}

std::string curve_plot(const std::vector<v1::Simulation>& simulations,
                       const std::map<std::string, std::string>& titles) {
  const auto bands = contact_loss_bands(simulations);
  Svg svg(kCurveWidth, kHeight);
  svg.text({kCurveLeft, 40}, "What each fluid costs in the gear mesh",
           {21, "start", "#111", true, 0});
  draw_key(!bands.empty(), svg);
  Panel panels[] = {
      inefficiency_panel(simulations, titles),
      small_panel(simulations, {kCurveLeft, 565}, "Mesh loss, W",
                  [](const v1::PointResult& result) { return result.mesh_loss_power_watts(); }),
      small_panel(simulations, {kCurveLeft + 390 + 75, 565},
                  std::string("Hottest contact over the mesh cycle, ") + kDegreesCelsius,
                  [](const v1::PointResult& result) {
                    return result.contact_temperature_kelvin().maximum() - kZeroCelsius;
                  })};
  panels[1].starts_at_zero = true;
  for (Panel& panel : panels) {
    panel.bands = bands;
    draw_panel(panel, svg);
  }
  svg.text({kCurveLeft, kHeight - 30}, caption(simulations), {11.5, "start", "#555", false, 0});
  svg.text(
      {kCurveLeft, kHeight - 13},
      std::string("Mesh (conjunctional) loss only: bearings, churning and seals are not in it.") +
          (has_branch_end(simulations)
               ? " Lines break where the branch that they follow ends: the response jumps."
               : ""),
      {11.5, "start", "#555", false, 0});
  return svg.finish();
}

}  // namespace tribodyn::client
