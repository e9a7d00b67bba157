#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/plot/svg.h"

namespace tribodyn::client {

/// Colours that stay apart for colour-blind readers and in print (Okabe and Ito, 2008).
const std::string& series_colour(std::size_t index);

/// One line of a panel. A NaN breaks it.
struct Series {
  std::string label;  ///< written at the line's end; empty: none
  std::string note;   ///< a second, lighter line below the label
  std::string colour;
  std::vector<double> x, y;
  double width = 2;
  std::string dashes;
  bool has_markers = false;
  std::vector<bool> hollow;  ///< markers drawn open; may be empty
};

/// A chart: axes, grid, shaded bands of x, lines.
struct Panel {
  Point corner;  ///< of the frame, top left
  double width, height;
  std::string title;    ///< above the frame, with the unit
  std::string x_title;  ///< below; empty: none
  bool shows_x_numbers = true;
  bool starts_at_zero = false;
  std::vector<std::pair<double, double>> bands;
  std::optional<double> line_at;  ///< a thin horizontal reference line
  std::vector<Series> series;
};

void draw_panel(const Panel& panel, Svg& svg);

/// Round numbers that cover [low, high]: the first at most low, the last at least high, about
/// `count` steps of 1, 2, 2.5 or 5 times a power of ten. low == high gives a range around it.
std::vector<double> nice_ticks(double low, double high, int count);

/// The ticks with as many decimals as they need to differ.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

}  // namespace tribodyn::client
