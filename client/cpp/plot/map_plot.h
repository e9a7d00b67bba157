#pragma once

#include <string>
#include <vector>

namespace tribodyn::client {

/// What a map is drawn over.
struct MapAxis {
  std::string title;
  std::vector<double> values;  ///< ascending, at least two; positive if logarithmic
  bool is_logarithmic = false;
};

/// A figure over two axes. values[j * (number of x) + i] belongs to the i-th x and the j-th y; NaN
/// leaves a gap.
struct FigureMap {
  std::string title;
  std::vector<double> values;
};

/// Maps of one figure that share axes and colours.
struct MapPicture {
  std::string title;
  std::string figure_title;  ///< with its unit
  bool has_logarithmic_colours = false;
  MapAxis x, y;
  std::vector<FigureMap> maps;
  std::string footer;
};

/// Draws the maps below one another as coloured cells with contour lines, and the scale of colours.
std::string map_plot(const MapPicture& picture);

}  // namespace tribodyn::client
