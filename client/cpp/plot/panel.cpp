#include "client/cpp/plot/panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tribodyn::client {
namespace {

constexpr double kLabelSize = 12;
constexpr double kLabelDistance = 17;  // between two labels at the right edge
constexpr double kNoteDistance = 15;   // between a label and its note
constexpr char kGridColour[] = "#e4e4e4";
constexpr char kInkColour[] = "#444";
constexpr char kBandColour[] = "#9a9a9a";
constexpr char kHatchInk[] = "#8a5a00";
constexpr double kHatchNoteSize = 12;
constexpr double kStripHeight = 8;
constexpr double kSampleWidth = 26;  // of the piece of line in front of its label

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

/// Maps values to positions in the frame.
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
  const auto labels = [](bool is_logarithmic) {
    return is_logarithmic ? logarithmic_tick_labels : tick_labels;
  };
  const auto x_labels = labels(panel.is_logarithmic_x)(x_ticks);
  const auto y_labels = labels(panel.is_logarithmic_y)(y_ticks);
  for (std::size_t i = 0; i < y_ticks.size(); ++i) {
    if (y_ticks[i] < scale.y.low - 1e-9 || y_ticks[i] > scale.y.high + 1e-9) continue;
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

/// Draws the vertical axis. A zigzag near its lower or upper end marks that zero lies beyond.
void draw_axis(const Panel& panel, const Scale& scale, Svg& svg) {
  constexpr double kBreakStart = 6;  // from the end of the axis
  constexpr double kBreakLength = 12;
  constexpr double kBreakWidth = 5;
  const double x = panel.corner.x;
  const double top = panel.corner.y;
  const double bottom = top + panel.height;
  const bool has_no_zero = panel.has_arbitrary_zero || panel.is_logarithmic_y;
  const bool cut_below = scale.y.low > 0 && !has_no_zero;
  const bool cut_above = scale.y.high < 0 && !has_no_zero;
  std::vector<Point> axis = {{x, bottom}};
  const auto add_break = [&](double start) {  // upwards from `start`
    axis.push_back({x, start});
    axis.push_back({x - kBreakWidth, start - 0.25 * kBreakLength});
    axis.push_back({x + kBreakWidth, start - 0.75 * kBreakLength});
    axis.push_back({x, start - kBreakLength});
  };
  if (cut_below) add_break(bottom - kBreakStart);
  if (cut_above) add_break(top + kBreakStart + kBreakLength);
  axis.push_back({x, top});
  svg.polyline(axis, {kInkColour, 1, ""});
}

void draw_marker(Marker marker, Point at, bool hollow, const std::string& colour, Svg& svg) {
  const double r = hollow ? 3.4 : 2.6;
  const std::string fill = hollow ? "#fff" : colour;
  const Stroke stroke{colour, hollow ? 1.6 : 0, ""};
  switch (marker) {
    case Marker::kNone:
      return;
    case Marker::kCircle:
      return svg.circle(at, r, fill, stroke);
    case Marker::kSquare:
      return svg.polygon(
          {{at.x - r, at.y - r}, {at.x + r, at.y - r}, {at.x + r, at.y + r}, {at.x - r, at.y + r}},
          fill, stroke);
    case Marker::kTriangle:
      return svg.polygon({{at.x, at.y - 1.3 * r},
                          {at.x + 1.2 * r, at.y + 0.9 * r},
                          {at.x - 1.2 * r, at.y + 0.9 * r}},
                         fill, stroke);
    case Marker::kInvertedTriangle:
      return svg.polygon({{at.x, at.y + 1.3 * r},
                          {at.x - 1.2 * r, at.y - 0.9 * r},
                          {at.x + 1.2 * r, at.y - 0.9 * r}},
                         fill, stroke);
    case Marker::kDiamond:
      return svg.polygon({{at.x, at.y - 1.4 * r},
                          {at.x + 1.4 * r, at.y},
                          {at.x, at.y + 1.4 * r},
                          {at.x - 1.4 * r, at.y}},
                         fill, stroke);
  }
}

void draw_cells(const Panel& panel, const Scale& scale, Svg& svg) {
  constexpr double kOverlap = 0.6;  // hides the seams that smoothed edges leave [pixels]
  svg.begin_clip(panel.corner, panel.width, panel.height);
  for (const MapCell& cell : panel.cells) {
    const double left = scale.at_x(cell.left), top = scale.at_y(cell.high);
    svg.rectangle({left, top}, scale.at_x(cell.right) - left + kOverlap,
                  scale.at_y(cell.low) - top + kOverlap, cell.colour);
  }
  svg.end_clip();
}

void draw_series_band(const Series& series, const Scale& scale, Svg& svg) {
  constexpr double kOpacity = 0.13;
  std::vector<Point> upper, lower;
  const auto end_piece = [&] {
    upper.insert(upper.end(), lower.rbegin(), lower.rend());
    if (upper.size() > 2) svg.polygon(upper, series.colour, {series.colour, 0, ""}, kOpacity);
    upper.clear();
    lower.clear();
  };
  for (std::size_t i = 0; i < series.low.size() && i < series.high.size(); ++i) {
    if (!std::isfinite(series.low[i]) || !std::isfinite(series.high[i])) {
      end_piece();
    } else {
      upper.push_back({scale.at_x(series.x[i]), scale.at_y(series.high[i])});
      lower.push_back({scale.at_x(series.x[i]), scale.at_y(series.low[i])});
    }
  }
  end_piece();
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
  if (series.marker == Marker::kNone) return;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    const bool hollow = i < series.hollow.size() && series.hollow[i];
    draw_marker(series.marker, {scale.at_x(series.x[i]), scale.at_y(series.y[i])}, hollow,
                series.colour, svg);
  }
}

/// A label beside the frame and the end of its line.
struct EndLabel {
  double y;
  Point line_end;
  const Series* series;
};

std::vector<EndLabel> end_labels(const Panel& panel, const Scale& scale) {
  std::vector<EndLabel> labels;
  for (const Series& series : panel.series) {
    if (series.label.empty()) continue;
    for (std::size_t i = std::min(series.x.size(), series.y.size()); i-- > 0;) {
      if (!std::isfinite(series.y[i])) continue;
      const Point end{scale.at_x(series.x[i]), scale.at_y(series.y[i])};
      labels.push_back({end.y, end, &series});
      break;
    }
  }
  std::sort(labels.begin(), labels.end(),
            [](const EndLabel& a, const EndLabel& b) { return a.y < b.y; });
  return labels;
}

/// Draws labels near the ends of their lines, moved apart where lines end close together. A thin
/// line connects a label with an end that is not beside it.
void draw_labels(const Panel& panel, const Scale& scale, Svg& svg) {
  std::vector<EndLabel> labels = end_labels(panel, scale);
  // Omits notes that would push labels out of the frame.
  const bool shows_notes =
      static_cast<double>(labels.size()) * (kLabelDistance + kNoteDistance) <= panel.height;
  const auto note_height = [&](const EndLabel& label) {
    return shows_notes && !label.series->note.empty() ? kNoteDistance : 0;
  };
  for (int pass = 0; pass < 100; ++pass) {
    for (std::size_t i = 1; i < labels.size(); ++i) {
      const double overlap =
          kLabelDistance + note_height(labels[i - 1]) - (labels[i].y - labels[i - 1].y);
      if (overlap <= 0) continue;
      labels[i].y += overlap / 2;
      labels[i - 1].y -= overlap / 2;
    }
  }
  // Labels stay above the foot of the frame: the numbers of the axis are below it.
  double lowest = panel.corner.y + panel.height;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->y = std::min(label->y, lowest - note_height(*label) - 4);
    lowest = label->y - kLabelDistance + 4;
  }
  const double right = panel.corner.x + panel.width;
  for (const EndLabel& label : labels) {
    const std::string colour = legible_on_white(label.series->colour);
    const bool is_beside = right - label.line_end.x < 1 && std::abs(label.y - label.line_end.y) < 9;
    if (!is_beside) svg.line(label.line_end, {right + 8, label.y}, {colour, 0.7, "1.5 2.5"});
    double x = right + 10;
    if (panel.shows_samples) {
      svg.line({x, label.y}, {x + kSampleWidth, label.y},
               {label.series->colour, label.series->width, label.series->dashes});
      draw_marker(label.series->marker, {x + kSampleWidth / 2, label.y}, false,
                  label.series->colour, svg);
      x += kSampleWidth + 6;
    }
    svg.text({x, label.y + 4}, label.series->label, {kLabelSize + 0.5, "start", colour, true, 0});
    if (!shows_notes) continue;
    svg.text({x, label.y + 4 + kNoteDistance}, label.series->note,
             {kLabelSize - 0.5, "start", kInkColour, false, 0});
  }
}

/// Draws shaded ranges of x behind the lines.
void draw_bands(const Panel& panel, const Scale& scale, Svg& svg) {
  svg.begin_clip(panel.corner, panel.width, panel.height);
  for (const auto& [from, to] : panel.bands) {
    svg.rectangle({scale.at_x(from), panel.corner.y}, scale.at_x(to) - scale.at_x(from),
                  panel.height, kBandColour, 0.18);
  }
  for (const auto& [from, to] : panel.hatched) {
    svg.hatched_rectangle({scale.at_x(from), panel.corner.y}, scale.at_x(to) - scale.at_x(from),
                          panel.height, kHatchColour);
  }
  svg.end_clip();
}

/// Draws strips from the foot of the frame upwards, each with its letter at the start of its first
/// range.
void draw_strips(const Panel& panel, const Scale& scale, Svg& svg) {
  double y = panel.corner.y + panel.height - kStripHeight - 2;
  for (const Strip& strip : panel.strips) {
    for (const auto& [from, to] : strip.ranges) {
      const double width = scale.at_x(to) - scale.at_x(from);
      svg.rectangle({scale.at_x(from), y - 1}, width, kStripHeight + 2, "#fff");
      svg.hatched_rectangle({scale.at_x(from), y}, width, kStripHeight, kHatchColour);
    }
    if (!strip.ranges.empty()) {
      const double x = scale.at_x(strip.ranges.front().first) + 3;
      svg.rectangle({x, y - 1}, kStripHeight, kStripHeight + 2, "#fff");
      svg.text({x + kStripHeight / 2, y + kStripHeight - 1}, strip.letter,
               {kStripHeight + 2, "middle", kHatchInk, true, 0});
    }
    y -= kStripHeight + 3;
  }
}

/// Draws the note about hatching, on white, at the top of its range.
void draw_hatch_note(const Panel& panel, const Scale& scale, Svg& svg) {
  if (panel.hatch_note.empty()) return;
  const auto& [from, to] = panel.hatch_note_range;
  const double width = text_width(panel.hatch_note, kHatchNoteSize) + 12;
  const double middle = (std::max(scale.at_x(from), panel.corner.x) +
                         std::min(scale.at_x(to), panel.corner.x + panel.width)) /
                        2;
  const double left = std::clamp(middle - width / 2, panel.corner.x,
                                 std::max(panel.corner.x, panel.corner.x + panel.width - width));
  svg.rectangle({left, panel.corner.y + 6}, width, 20, "#fff", 0.85);
  svg.text({left + width / 2, panel.corner.y + 20}, panel.hatch_note,
           {kHatchNoteSize, "middle", kHatchInk, true, 0});
}

}  // namespace

Look look_of(std::size_t index) {
  static const std::array<std::string, 6> kColours = {"#0072b2", "#d55e00", "#009e73",
                                                      "#cc79a7", "#e69f00", "#56b4e9"};
  static const std::array<std::pair<const char*, const char*>, 4> kDashes = {
      {{"", "5 4"}, {"10 3", "1.5 3"}, {"10 3 2 3", "5 2 1.5 2"}, {"2.5 3", "8 5"}}};
  static constexpr std::array<Marker, 5> kMarkers = {Marker::kCircle, Marker::kSquare,
                                                     Marker::kTriangle, Marker::kDiamond,
                                                     Marker::kInvertedTriangle};
  static_assert(kColours.size() * kDashes.size() == kDistinctLooks);
  const auto& [dashes, side_dashes] = kDashes.at(index / kColours.size());
  return {kColours[index % kColours.size()], dashes, side_dashes,
          kMarkers[index % kMarkers.size()]};
}

std::pair<double, double> widest_range(const std::vector<std::pair<double, double>>& ranges) {
  return *std::max_element(ranges.begin(), ranges.end(), [](const auto& a, const auto& b) {
    return a.second - a.first < b.second - b.first;
  });
}

void hatch(std::vector<std::pair<double, double>> ranges, Panel& panel) {
  if (ranges.empty()) return;
  panel.hatch_note = kHatchNote;
  panel.hatch_note_range = widest_range(ranges);
  panel.hatched = std::move(ranges);
}

void draw_panel(const Panel& panel, Svg& svg) {
  Scale scale{{}, {}, panel};
  for (const Series& series : panel.series) {
    for (const double value : series.x) scale.x.include(value);
    for (const auto* values : {&series.y, &series.low, &series.high}) {
      for (const double value : *values) scale.y.include(value);
    }
  }
  for (const MapCell& cell : panel.cells) {
    for (const double value : {cell.left, cell.right}) scale.x.include(value);
    for (const double value : {cell.low, cell.high}) scale.y.include(value);
  }
  if (panel.line_at) scale.y.include(*panel.line_at);
  if (panel.starts_at_zero) scale.y.include(0);
  if (scale.x.empty()) scale.x = {0, 1};
  if (scale.y.empty()) scale.y = {0, 1};
  if (scale.x.low == scale.x.high) scale.x = {scale.x.low - 1, scale.x.high + 1};
  const auto ticks = [](bool is_logarithmic, const Range& range, int count) {
    return is_logarithmic ? logarithmic_ticks(range.low, range.high)
                          : nice_ticks(range.low, range.high, count);
  };
  const auto x_ticks = ticks(panel.is_logarithmic_x, scale.x, static_cast<int>(panel.width / 60));
  const auto y_ticks =
      ticks(panel.is_logarithmic_y, scale.y, std::max(4, static_cast<int>(panel.height / 45)));
  if (panel.cells.empty()) scale.y = {y_ticks.front(), y_ticks.back()};

  const double bottom = panel.corner.y + panel.height;
  svg.text({panel.corner.x, panel.corner.y - 10}, panel.title, {13, "start", "#222", true, 0});
  draw_bands(panel, scale, svg);
  draw_grid(panel, scale, x_ticks, y_ticks, svg);
  draw_cells(panel, scale, svg);
  draw_axis(panel, scale, svg);
  draw_strips(panel, scale, svg);
  if (panel.line_at) {
    const double y = scale.at_y(*panel.line_at);
    svg.line({panel.corner.x, y}, {panel.corner.x + panel.width, y}, {kInkColour, 1, "2 3"});
  }
  for (const Series& series : panel.series) draw_series_band(series, scale, svg);
  for (const Series& series : panel.series) draw_series(series, scale, svg);
  draw_labels(panel, scale, svg);
  draw_hatch_note(panel, scale, svg);
  if (!panel.x_title.empty()) {
    svg.text({panel.corner.x + panel.width / 2, bottom + 36}, panel.x_title,
             {12.5, "middle", kInkColour, false, 0});
  }
}

}  // namespace tribodyn::client
