#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/plot/svg.h"

namespace tribodyn::client {

enum class Marker { kNone, kCircle, kSquare, kTriangle, kDiamond, kInvertedTriangle };

/// Colour, dashes and markers of one fluid's lines. The six colours are distinct for colour-blind
/// readers and in print (Okabe and Ito, 2008). The seventh fluid has the first colour again with
/// other dashes: the first kDistinctLooks fluids all differ in colour or dashes.
struct Look {
  std::string colour;
  std::string dashes;  ///< of the main line; empty: solid
  std::string
      side_dashes;  ///< of a second, thinner line; differs from the dashes of all main lines
  Marker marker;
};
inline constexpr char kHatchColour[] = "#c9a55c";
/// What stands on hatched ranges.
inline constexpr char kHatchNote[] = "do not rank oils here";
inline constexpr std::size_t kDistinctLooks = 24;
/// Returns the look of the fluid at `index`. Throws std::out_of_range from kDistinctLooks on.
Look look_of(std::size_t index);

/// One line of a panel; a NaN interrupts it.
struct Series {
  std::string label;  ///< written beside the frame, level with the end of the line; empty: none
  std::string note;   ///< a second line below the label, in a lighter colour
  std::string colour;
  std::vector<double> x, y;
  double width = 2;
  std::string dashes;
  Marker marker = Marker::kNone;
  std::vector<bool> hollow;  ///< markers drawn open; may be empty
  /// Edges of a translucent band about the line, as many as x; a NaN interrupts it. May be empty.
  std::vector<double> low, high;
};

/// Ranges of x that a hatched strip marks at the foot of a panel, with a letter.
struct Strip {
  std::string letter;
  std::vector<std::pair<double, double>> ranges;
};

/// A filled rectangle of a map, in the coordinates of the axes.
struct MapCell {
  double left, right, low, high;
  std::string colour;
};

/// A chart: axes, grid, shaded ranges of x, lines.
struct Panel {
  Point corner;  ///< top left corner of the frame
  double width, height;
  std::string title;    ///< above the frame, with the unit
  std::string x_title;  ///< below the frame; empty: none
  bool shows_x_numbers = true;
  bool starts_at_zero = false;
  /// Set where the zero of the axis has no meaning, e.g. for degrees Celsius. Otherwise an axis
  /// that omits zero has a break mark.
  bool has_arbitrary_zero = false;
  /// The coordinates of the series are then common logarithms, and labels show the powers.
  bool is_logarithmic_x = false, is_logarithmic_y = false;
  std::vector<std::pair<double, double>> bands;    ///< shaded
  std::vector<std::pair<double, double>> hatched;  ///< hatched from foot to head
  std::vector<Strip> strips;                       ///< drawn one above another
  std::string hatch_note;                          ///< written at the top of hatch_note_range
  std::pair<double, double> hatch_note_range;
  bool shows_samples = false;     ///< draws a piece of each line in front of its label
  std::optional<double> line_at;  ///< a thin horizontal reference line
  /// Drawn below the lines. The axes of a panel with cells end at the outermost of them.
  std::vector<MapCell> cells;
  std::vector<Series> series;
};

/// Returns the widest range; requires one.
std::pair<double, double> widest_range(const std::vector<std::pair<double, double>>& ranges);

/// Hatches ranges in which oils must not be ranked, with that note in the widest one.
void hatch(std::vector<std::pair<double, double>> ranges, Panel& panel);

void draw_panel(const Panel& panel, Svg& svg);

/// Returns about `count` + 1 round numbers that cover [low, high]: the first is at most `low`, the
/// last at least `high`, the step 1, 2, 2.5 or 5 times a power of ten. low == high gives a range
/// around it.
std::vector<double> nice_ticks(double low, double high, int count);

/// Returns the ticks with as few decimals as keep them distinct.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

/// Returns the common logarithms of 1, 2 and 5 times powers of ten that cover [low, high], which
/// are logarithms too, and of a wide range those of the powers alone.
std::vector<double> logarithmic_ticks(double low, double high);

/// Returns the numbers of which the ticks are the logarithms.
std::vector<std::string> logarithmic_tick_labels(const std::vector<double>& ticks);

}  // namespace tribodyn::client
