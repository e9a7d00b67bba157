#include "client/cpp/plot/panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tribodyn::client {
namespace {

constexpr double kLabelSize = 12;
constexpr double kLabelDistance = 17;  // between two labels at the right edge
constexpr double kNoteDistance = 15;   // between a label and its note
constexpr char kGridColour[] = "#e4e4e4";
constexpr char kInkColour[] = "#444";
constexpr char kBandColour[] = "#9a9a9a";

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return !(low <= high); }
};

/// Places values in the frame.
struct Scale {
  Range x, y;
  const Panel& panel;
  double at_x(double value) const {
    return panel.corner.x + panel.width * (value - x.low) / (x.high - x.low);
  }
  double at_y(double value) const {
    return panel.corner.y + panel.height * (1 - (value - y.low) / (y.high - y.low));
  }
};

void draw_grid(const Panel& panel, const Scale& scale, const std::vector<double>& x_ticks,
               const std::vector<double>& y_ticks, Svg& svg) {
  const double bottom = panel.corner.y + panel.height;
  const auto x_labels = tick_labels(x_ticks);
  const auto y_labels = tick_labels(y_ticks);
  for (std::size_t i = 0; i < y_ticks.size(); ++i) {
    const double y = scale.at_y(y_ticks[i]);
    svg.line({panel.corner.x, y}, {panel.corner.x + panel.width, y}, {kGridColour, 1, ""});
    svg.text({panel.corner.x - 8, y + 4}, y_labels[i], {kLabelSize, "end", kInkColour, false, 0});
  }
  for (std::size_t i = 0; i < x_ticks.size(); ++i) {
    if (x_ticks[i] < scale.x.low - 1e-9 || x_ticks[i] > scale.x.high + 1e-9) continue;
    const double x = scale.at_x(x_ticks[i]);
    svg.line({x, panel.corner.y}, {x, bottom}, {kGridColour, 1, ""});
    svg.line({x, bottom}, {x, bottom + 4}, {kInkColour, 1, ""});
    if (!panel.shows_x_numbers) continue;
    svg.text({x, bottom + 18}, x_labels[i], {kLabelSize, "middle", kInkColour, false, 0});
  }
  svg.line({panel.corner.x, bottom}, {panel.corner.x + panel.width, bottom}, {kInkColour, 1, ""});
}

void draw_series(const Series& series, const Scale& scale, Svg& svg) {
  std::vector<Point> piece;
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const auto end_piece = [&] {
    svg.polyline(piece, {series.colour, series.width, series.dashes});
    piece.clear();
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) {
      end_piece();
    } else {
      piece.push_back({scale.at_x(series.x[i]), scale.at_y(series.y[i])});
    }
  }
  end_piece();
  if (!series.has_markers) return;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    const bool hollow = i < series.hollow.size() && series.hollow[i];
    svg.circle({scale.at_x(series.x[i]), scale.at_y(series.y[i])}, hollow ? 3.4 : 2.4,
               hollow ? "#fff" : series.colour, {series.colour, hollow ? 1.6 : 0, ""});
  }
}

/// Labels at the ends of their lines, pushed apart where lines end close together.
void draw_labels(const Panel& panel, const Scale& scale, Svg& svg) {
  struct Label {
    double y;
    const Series* series;
  };
  std::vector<Label> labels;
  for (const Series& series : panel.series) {
    if (series.label.empty()) continue;
    for (std::size_t i = std::min(series.x.size(), series.y.size()); i-- > 0;) {
      if (!std::isfinite(series.y[i])) continue;
      labels.push_back({scale.at_y(series.y[i]), &series});
      break;
    }
  }
  std::sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
  for (int pass = 0; pass < 100; ++pass) {
    for (std::size_t i = 1; i < labels.size(); ++i) {
      const double overlap = kLabelDistance +
                             (labels[i - 1].series->note.empty() ? 0 : kNoteDistance) -
                             (labels[i].y - labels[i - 1].y);
      if (overlap <= 0) continue;
      labels[i].y += overlap / 2;
      labels[i - 1].y -= overlap / 2;
    }
  }
  // None below the frame, where the numbers of the axis stand.
  double lowest = panel.corner.y + panel.height;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->y = std::min(label->y, lowest - (label->series->note.empty() ? 0 : kNoteDistance) - 4);
    lowest = label->y - kLabelDistance + 4;
  }
  for (const Label& label : labels) {
    svg.text({panel.corner.x + panel.width + 10, label.y + 4}, label.series->label,
             {kLabelSize + 0.5, "start", label.series->colour, true, 0});
    svg.text({panel.corner.x + panel.width + 10, label.y + 4 + kNoteDistance}, label.series->note,
             {kLabelSize - 0.5, "start", kInkColour, false, 0});
  }
}

}  // namespace

const std::string& series_colour(std::size_t index) {
  static const std::array<std::string, 6> kColours = {"#0072b2", "#d55e00", "#009e73",
                                                      "#cc79a7", "#e69f00", "#56b4e9"};
  return kColours[index % kColours.size()];
}

void draw_panel(const Panel& panel, Svg& svg) {
  Scale scale{{}, {}, panel};
  for (const Series& series : panel.series) {
    for (const double value : series.x) scale.x.include(value);
    for (const double value : series.y) scale.y.include(value);
  }
  if (panel.line_at) scale.y.include(*panel.line_at);
  if (panel.starts_at_zero) scale.y.include(0);
  if (scale.x.empty()) scale.x = {0, 1};
  if (scale.y.empty()) scale.y = {0, 1};
  if (scale.x.low == scale.x.high) scale.x = {scale.x.low - 1, scale.x.high + 1};
  const auto x_ticks = nice_ticks(scale.x.low, scale.x.high, static_cast<int>(panel.width / 60));
  const auto y_ticks =
      nice_ticks(scale.y.low, scale.y.high, std::max(4, static_cast<int>(panel.height / 45)));
  scale.y = {y_ticks.front(), y_ticks.back()};

  const double bottom = panel.corner.y + panel.height;
  svg.text({panel.corner.x, panel.corner.y - 10}, panel.title, {13, "start", "#222", true, 0});
  svg.begin_clip(panel.corner, panel.width, panel.height);
  for (const auto& [from, to] : panel.bands) {
    svg.rectangle({scale.at_x(from), panel.corner.y}, scale.at_x(to) - scale.at_x(from),
                  panel.height, kBandColour, 0.18);
  }
  svg.end_clip();
  draw_grid(panel, scale, x_ticks, y_ticks, svg);
  if (panel.line_at) {
    const double y = scale.at_y(*panel.line_at);
    svg.line({panel.corner.x, y}, {panel.corner.x + panel.width, y}, {kInkColour, 1, "2 3"});
  }
  for (const Series& series : panel.series) draw_series(series, scale, svg);
  draw_labels(panel, scale, svg);
  if (!panel.x_title.empty()) {
    svg.text({panel.corner.x + panel.width / 2, bottom + 36}, panel.x_title,
             {12.5, "middle", kInkColour, false, 0});
  }
}

}  // namespace tribodyn::client
