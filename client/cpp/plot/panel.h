#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/plot/svg.h"

namespace tribodyn::client {

enum class Marker { kNone, kCircle, kSquare, kTriangle, kDiamond, kInvertedTriangle };

/// How the lines of one fluid look. Six colours stay apart for colour-blind readers and in print
/// (Okabe and Ito, 2008); the seventh fluid has the first colour again, but other dashes. So no two
/// of kDistinctLooks fluids have both in common.
struct Look {
  std::string colour;
  std::string dashes;       ///< of the main line; empty: solid
  std::string side_dashes;  ///< of a second, thinner line; never one of the main lines'
  Marker marker;
};
inline constexpr char kHatchColour[] = "#c9a55c";
inline constexpr std::size_t kDistinctLooks = 24;
/// Throws std::out_of_range from kDistinctLooks on.
Look look_of(std::size_t index);

/// One line of a panel. A NaN breaks it.
struct Series {
  std::string label;  ///< written beside the frame, level with the line's end; empty: none
  std::string note;   ///< a second, lighter line below the label
  std::string colour;
  std::vector<double> x, y;
  double width = 2;
  std::string dashes;
  Marker marker = Marker::kNone;
  std::vector<bool> hollow;  ///< markers drawn open; may be empty
};

/// Ranges of x marked by a hatched strip along the foot of a panel, under a letter.
struct Strip {
  std::string letter;
  std::vector<std::pair<double, double>> ranges;
};

/// A chart: axes, grid, shaded bands of x, lines.
struct Panel {
  Point corner;  ///< of the frame, top left
  double width, height;
  std::string title;    ///< above the frame, with the unit
  std::string x_title;  ///< below; empty: none
  bool shows_x_numbers = true;
  bool starts_at_zero = false;
  /// The zero of the axis means nothing, as that of degrees Celsius; else an axis that leaves zero
  /// out bears the mark of a break.
  bool has_arbitrary_zero = false;
  std::vector<std::pair<double, double>> bands;    ///< shaded
  std::vector<std::pair<double, double>> hatched;  ///< hatched from foot to head
  std::vector<Strip> strips;                       ///< one above the other
  std::string hatch_note;                          ///< written at the top of the range below
  std::pair<double, double> hatch_note_range;
  bool shows_samples = false;     ///< a piece of each line in front of its label
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
