#include "client/cpp/report/curve_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/report/variant_report.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

constexpr double kCurveWidth = 960;
constexpr double kFooterTop = 826;          // base line of the first line of the footer
constexpr double kDifferencesHeight = 275;  // of the panel of differences
constexpr double kCurveLeft = 70;
constexpr double kCurveRight = 30;
constexpr char kDegreesCelsius[] = "\xC2\xB0\x43";
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool has_branch_end(const std::vector<v1::Simulation>& simulations) {
  return std::any_of(simulations.begin(), simulations.end(), [](const v1::Simulation& simulation) {
    const auto& points = simulation.result().points();
    return std::any_of(points.begin(), points.end(),
                       [](const v1::CurvePoint& point) { return point.has_branch_end(); });
  });
}

/// Breaks the line where a branch ends: the response jumps there.
template <class Value>
Series series_of(const v1::Simulation& simulation, const Look& look, Value value) {
  Series series;
  series.colour = look.colour;
  series.dashes = look.dashes;
  const bool down = simulation.result().direction() == v1::SWEEP_DIRECTION_DOWN;
  const auto add = [&](double x, double y, bool hollow) {
    series.x.push_back(x);
    series.y.push_back(y);
    series.hollow.push_back(hollow);
  };
  for (const v1::CurvePoint& point : simulation.result().points()) {
    const double jump = point.branch_end().followed_to_kilometres_per_hour();
    if (point.has_branch_end() && !down) add(jump, kNone, false);
    add(point.speed_kilometres_per_hour(), point.has_result() ? value(point.result()) : kNone,
        point.result().contact_loss());
    if (point.has_branch_end() && down) add(jump, kNone, false);
  }
  return series;
}

/// Returns the label of a curve, with a note unless that is empty.
FluidTitle title_of(const v1::Simulation& simulation,
                    const std::map<std::string, std::string>& titles, const std::string& note) {
  const auto found = titles.find(simulation.lubricant());
  FluidTitle out = fluid_title(simulation.lubricant(), found != titles.end() ? found->second : "");
  if (!note.empty()) out.note = note;
  return out;
}

/// Adds the 95 % intervals of an energy mean; none where the line breaks.
void add_band(const CurveUncertainty& uncertainty, Series& mean) {
  for (std::size_t i = 0; i < mean.x.size(); ++i) {
    const auto* figure = std::isfinite(mean.y[i]) ? uncertainty.at(mean.x[i]) : nullptr;
    const bool has_band = figure != nullptr && figure->standard_uncertainty() > 0;
    mean.low.push_back(has_band ? figure->interval_minimum() : kNone);
    mean.high.push_back(has_band ? figure->interval_maximum() : kNone);
  }
}

Panel inefficiency_panel(const std::vector<v1::Simulation>& simulations,
                         const std::map<std::string, std::string>& titles,
                         const CurveUncertainties& uncertainties) {
  Panel panel;
  panel.corner = {kCurveLeft, 118};
  panel.width = 690;
  panel.height = 350;
  panel.title = "Mesh inefficiency, % of input power";
  panel.x_title = "Vehicle speed, km/h";
  panel.shows_samples = true;
  const std::vector<std::string> notes = variant_notes(simulations, kDegreesCelsius);
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    const Look look = look_of(i);
    Series rms = series_of(simulations[i], look, [](const v1::PointResult& result) {
      return result.has_inefficiency_rms_percent() ? result.inefficiency_rms_percent() : kNone;
    });
    rms.width = 1.3;
    rms.dashes = look.side_dashes;
    panel.series.push_back(std::move(rms));
  }
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    const Look look = look_of(i);
    Series mean = series_of(simulations[i], look, [](const v1::PointResult& result) {
      return result.has_inefficiency_energy_mean_percent()
                 ? result.inefficiency_energy_mean_percent()
                 : kNone;
    });
    const auto uncertainty = uncertainties.find(simulations[i].name());
    if (uncertainty != uncertainties.end()) add_band(uncertainty->second, mean);
    mean.width = 2.4;
    mean.marker = look.marker;
    const FluidTitle title = title_of(simulations[i], titles, notes[i]);
    mean.label = title.label;
    mean.note = title.note;
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
    panel.series.push_back(series_of(simulations[i], look_of(i), value));
  }
  return panel;
}

/// Draws by how many percent each variant differs from the first curve of its inputs.
Panel difference_panel(const std::vector<Variant>& variants) {
  Panel panel;
  panel.corner = {kCurveLeft, 840};
  panel.width = 690;
  panel.height = 200;
  panel.title = "Difference of the energy mean from the first curve of the same inputs, %";
  panel.x_title = "Vehicle speed, km/h";
  panel.line_at = 0;
  for (const Variant& variant : variants) {
    const Look look = look_of(variant.index);
    Series series;
    series.colour = look.colour;
    series.dashes = look.dashes;
    series.marker = look.marker;
    for (const auto& [speed, percent] : relative_differences(variant)) {
      series.x.push_back(speed);
      series.y.push_back(percent);
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// Draws one line that explains the kinds of line.
void draw_key(bool has_bands, bool has_hatching, Svg& svg) {
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
  word("RMS (Paouris et al. 2018, eq 30)");
  if (has_bands) {
    svg.rectangle({x, y - 7}, 28, 14, "#9a9a9a", 0.18);
    svg.circle({x + 14, y}, 3.4, "#fff", {"#444", 1.6, ""});
    x += 36;
    word("flanks separate");
  }
  if (has_hatching) {
    svg.hatched_rectangle({x, y - 7}, 28, 14, kHatchColour);
    x += 36;
    word("outside a validated range");
  }
}

/// Returns what all curves have in common; the labels show what differs.
std::string caption(const std::vector<v1::Simulation>& simulations) {
  if (simulations.empty()) return "";
  const v1::Simulation& first = simulations.front();
  const Differences differences = differences_of(simulations);
  std::string text = inputs_text(first, kDegreesCelsius, differences);
  text[0] = 'G';
  if (!differences.sweeps) text += "; " + sweep_text(first.inefficiency_curve());
  if (!differences.models) text += "; model " + model_options_text(first.model_options());
  return text + ".";
}

bool has_uncertainty(const CurveUncertainties& uncertainties) {
  return std::any_of(uncertainties.begin(), uncertainties.end(), [](const auto& each) {
    const auto& figures = each.second.figures;
    return std::any_of(figures.begin(), figures.end(),
                       [](const auto& figure) { return figure.second.standard_uncertainty() > 0; });
  });
}

std::vector<std::string> texts_below(const std::vector<v1::Simulation>& simulations,
                                     bool has_bands) {
  std::vector<std::string> texts = {
      caption(simulations),
      std::string("Loss at the tooth contact only; it excludes bearings, churning and seals.") +
          (has_branch_end(simulations)
               ? " A line breaks where its branch of steady states ends: the response jumps."
               : "")};
  if (has_bands) {
    texts.emplace_back(
        "Bands: 95 % intervals of the energy mean by the stated uncertainties of the inputs; "
        "errors "
        "that fluids share make bands overlap more than differences do (tribodyn compare).");
  }
  for (std::string& text : footer_texts(simulations)) texts.push_back(std::move(text));
  return texts;
}

/// Hatches the full height of the panels at speeds where oils must not be ranked, and a strip of
/// the main panel at speeds where a law is outside its validated range otherwise.
struct Hatching {
  std::vector<std::pair<double, double>> bands;
  std::string note;
  std::pair<double, double> note_band;
  std::vector<Strip> strips;
};

Hatching hatching_of(const std::vector<v1::Simulation>& simulations) {
  Hatching hatching;
  for (const CurveWarning& warning : curve_warnings(simulations)) {
    if (!warning.mark.empty()) hatching.strips.push_back({warning.mark, warning.bands});
    if (!withholds_verdict(warning.level)) continue;
    hatching.bands.insert(hatching.bands.end(), warning.bands.begin(), warning.bands.end());
    hatching.note = kHatchNote;
    hatching.note_band = widest_range(warning.bands);
  }
  hatching.bands = merged_bands(std::move(hatching.bands));
  return hatching;
}

constexpr double kExtraPitch = 275;  // from one row of panels on request to the next

using PointFigure = double (*)(const v1::PointResult&);

/// A panel on request: lines for each curve, the first one solid.
struct ExtraPanel {
  const char* name;
  const char* title;
  bool starts_at_zero;
  std::vector<PointFigure> figures;
};

const std::vector<ExtraPanel>& extra_panels() {
  static const std::vector<ExtraPanel> panels = {
      {"transmission-error",
       "Transmission error, \xC2\xB5m",
       false,
       {[](const v1::PointResult& r) { return 1e6 * r.dynamic_transmission_error_metres().mean(); },
        [](const v1::PointResult& r) {
          return 1e6 * r.dynamic_transmission_error_metres().minimum();
        },
        [](const v1::PointResult& r) {
          return 1e6 * r.dynamic_transmission_error_metres().maximum();
        }}},
      {"friction-torque",
       "Friction torque on the pinion, N m: mean, extremes",
       false,
       {[](const v1::PointResult& r) { return r.pinion_friction_torque_newton_metres().mean(); },
        [](const v1::PointResult& r) { return r.pinion_friction_torque_newton_metres().minimum(); },
        [](const v1::PointResult& r) {
          return r.pinion_friction_torque_newton_metres().maximum();
        }}},
      {"boundary-ratio",
       "Boundary over viscous friction, RMS",
       true,
       {[](const v1::PointResult& r) { return r.boundary_to_viscous_friction_ratio(); }}},
      {"film-ratio",
       "Film ratio: mean, least",
       true,
       {[](const v1::PointResult& r) { return r.film_ratio().mean(); },
        [](const v1::PointResult& r) { return r.film_ratio().minimum(); }}},
      {"temperature-rise", "Largest rise above the inlet, K", true, {}}};
  return panels;
}

/// Returns a panel on request at its place among them.
Panel extra_panel(const ExtraPanel& kind, const std::vector<v1::Simulation>& simulations,
                  Point corner, double half_backlash_metres) {
  Panel panel =
      small_panel(simulations, corner, kind.title, [](const v1::PointResult&) { return kNone; });
  panel.series.clear();
  panel.starts_at_zero = kind.starts_at_zero;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    const Look look = look_of(i);
    for (const PointFigure figure : kind.figures) {
      panel.series.push_back(series_of(simulations[i], look, figure));
      if (figure == kind.figures.front()) continue;
      panel.series.back().dashes = look.side_dashes;
      panel.series.back().width = 1.3;
    }
    if (!kind.figures.empty()) continue;
    const Inputs inputs = inputs_of(simulations[i]);
    const double inlet =
        inputs.sump_temperature_celsius + inputs.inlet_temperature_rise_kelvin + kZeroCelsius;
    panel.series.push_back(series_of(simulations[i], look, [inlet](const v1::PointResult& result) {
      return result.contact_temperature_kelvin().maximum() - inlet;
    }));
  }
  if (half_backlash_metres > 0 && std::string_view(kind.name) == "transmission-error") {
    panel.line_at = 1e6 * half_backlash_metres;
    panel.title += " (dotted: half backlash)";
  }
  return panel;
}

}  // namespace

std::string curve_panel_words() {
  std::string out;
  for (const ExtraPanel& each : extra_panels()) {
    out += (out.empty() ? "" : "|") + std::string(each.name);
  }
  return out;
}

std::vector<std::pair<double, double>> contact_loss_bands(
    const std::vector<v1::Simulation>& simulations) {
  return speed_bands(simulations,
                     [](const v1::PointResult& result) { return result.contact_loss(); });
}

std::string curve_plot(const std::vector<v1::Simulation>& simulations,
                       const std::map<std::string, std::string>& titles,
                       const CurveUncertainties& uncertainties, const CurvePanels& extra) {
  const auto bands = contact_loss_bands(simulations);
  const Hatching hatching = hatching_of(simulations);
  const std::vector<std::string> below =
      footer_lines(texts_below(simulations, has_uncertainty(uncertainties)),
                   kCurveWidth - kCurveLeft - kCurveRight);
  const std::vector<Variant> variants = variants_of(simulations);
  const double extra_top = 840 + (variants.empty() ? 0 : kDifferencesHeight);
  const std::size_t extra_rows = (extra.names.size() + 1) / 2;
  const double footer_top = kFooterTop + (variants.empty() ? 0 : kDifferencesHeight) +
                            kExtraPitch * static_cast<double>(extra_rows);
  Svg svg(kCurveWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  svg.text({kCurveLeft, 40}, "What each fluid costs in the gear mesh",
           {21, "start", "#111", true, 0});
  draw_key(!bands.empty(), !hatching.bands.empty() || !hatching.strips.empty(), svg);
  Panel panels[] = {
      inefficiency_panel(simulations, titles, uncertainties),
      small_panel(simulations, {kCurveLeft, 565}, "Mesh loss, W",
                  [](const v1::PointResult& result) { return result.mesh_loss_power_watts(); }),
      small_panel(simulations, {kCurveLeft + 390 + 75, 565},
                  std::string("Hottest contact over the mesh cycle, ") + kDegreesCelsius,
                  [](const v1::PointResult& result) {
                    return result.contact_temperature_kelvin().maximum() - kZeroCelsius;
                  })};
  panels[0].strips = hatching.strips;
  panels[0].hatch_note = hatching.note;
  panels[0].hatch_note_range = hatching.note_band;
  panels[1].starts_at_zero = true;
  panels[2].has_arbitrary_zero = true;
  for (Panel& panel : panels) {
    panel.bands = bands;
    panel.hatched = hatching.bands;
    draw_panel(panel, svg);
  }
  if (!variants.empty()) {
    Panel panel = difference_panel(variants);
    panel.bands = bands;
    draw_panel(panel, svg);
  }
  for (std::size_t i = 0; i < extra.names.size(); ++i) {
    const auto kind =
        std::find_if(extra_panels().begin(), extra_panels().end(),
                     [&](const ExtraPanel& each) { return each.name == extra.names[i]; });
    if (kind == extra_panels().end()) continue;
    const std::size_t row = i / 2;
    const Point corner{kCurveLeft + (i % 2 == 0 ? 0 : 390 + 75),
                       extra_top + kExtraPitch * static_cast<double>(row)};
    Panel panel = extra_panel(*kind, simulations, corner, extra.half_backlash_metres);
    panel.bands = bands;
    draw_panel(panel, svg);
  }
  draw_footer(below, {kCurveLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
