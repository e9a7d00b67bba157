#include "client/cpp/plot/map_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"

namespace tribodyn::client {
namespace {

constexpr double kMapWidth = 920;
constexpr double kMapLeft = 90;
constexpr double kMapTop = 100;
constexpr double kMapPanelWidth = 560;
constexpr double kMapPanelHeight = 340;
constexpr double kMapPitch = kMapPanelHeight + 100;
constexpr char kContourColour[] = "#222222";

/// Returns the colour of a share, 0 to 1: from pale to dark blue, of falling luminance, so that
/// print without colours keeps the order.
std::string map_colour(double share) {
  struct Anchor {
    double red, green, blue;
  };
  constexpr std::array<Anchor, 5> kAnchors = {
      {{247, 251, 255}, {198, 219, 239}, {107, 174, 214}, {33, 113, 181}, {8, 48, 107}}};
  const double at = std::clamp(share, 0.0, 1.0) * (kAnchors.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kAnchors.size() - 2);
  const double rest = at - static_cast<double>(low);
  const auto mixed = [rest](double from, double to) {
    return static_cast<unsigned>(std::lround(from + rest * (to - from)));
  };
  const Anchor &from = kAnchors[low], &to = kAnchors[low + 1];
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", mixed(from.red, to.red) & 0xFF,
                mixed(from.green, to.green) & 0xFF, mixed(from.blue, to.blue) & 0xFF);
  return text;
}

double coordinate(double value, bool is_logarithmic) {
  return is_logarithmic ? std::log10(value) : value;
}

std::vector<double> coordinates(const MapAxis& axis) {
  std::vector<double> out;
  for (const double value : axis.values) out.push_back(coordinate(value, axis.is_logarithmic));
  return out;
}

/// The figures of a map between its grid points.
class MapGrid {
 public:
  MapGrid(std::vector<double> x, std::vector<double> y, std::vector<double> z)
      : x_(std::move(x)), y_(std::move(y)), z_(std::move(z)) {}

  /// Returns one cell about each grid point that has a figure; `share` gives the place of a figure
  /// on the scale of colours.
  template <class Share>
  std::vector<MapCell> cells(const Share& share) const {
    std::vector<MapCell> out;
    for (std::size_t j = 0; j < y_.size(); ++j) {
      for (std::size_t i = 0; i < x_.size(); ++i) {
        if (!std::isfinite(at(i, j))) continue;
        out.push_back({edge(x_, i, -1), edge(x_, i, 1), edge(y_, j, -1), edge(y_, j, 1),
                       map_colour(share(at(i, j)))});
      }
    }
    return out;
  }

  /// Returns the line on which the figure, bilinear between grid points, has a value: within each
  /// quarter triangle of a square of grid points about its mean, a straight piece.
  Series contour(double value) const {
    Series out;
    out.colour = kContourColour;
    out.width = 0.8;
    for (std::size_t j = 0; j + 1 < y_.size(); ++j) {
      for (std::size_t i = 0; i + 1 < x_.size(); ++i) add_pieces(i, j, value, out);
    }
    return out;
  }

 private:
  struct Corner {
    double x, y, z;
  };

  double at(std::size_t i, std::size_t j) const { return z_[j * x_.size() + i]; }

  /// Returns the boundary between a grid point and the next one in a direction; the outermost
  /// points are themselves boundaries.
  static double edge(const std::vector<double>& points, std::size_t i, int direction) {
    if ((i == 0 && direction < 0) || (i + 1 == points.size() && direction > 0)) return points[i];
    return 0.5 * (points[i] + points[direction < 0 ? i - 1 : i + 1]);
  }

  void add_pieces(std::size_t i, std::size_t j, double value, Series& out) const {
    const Corner corners[] = {{x_[i], y_[j], at(i, j)},
                              {x_[i + 1], y_[j], at(i + 1, j)},
                              {x_[i + 1], y_[j + 1], at(i + 1, j + 1)},
                              {x_[i], y_[j + 1], at(i, j + 1)}};
    Corner middle{0, 0, 0};
    for (const Corner& each : corners) {
      middle.x += each.x / 4;
      middle.y += each.y / 4;
      middle.z += each.z / 4;
    }
    if (!std::isfinite(middle.z)) return;
    for (int k = 0; k < 4; ++k) {
      std::vector<Point> ends;
      const Corner triangle[] = {corners[k], corners[(k + 1) % 4], middle};
      for (int side = 0; side < 3; ++side) {
        const Corner &a = triangle[side], &b = triangle[(side + 1) % 3];
        if ((a.z < value) == (b.z < value)) continue;
        const double part = (value - a.z) / (b.z - a.z);
        ends.push_back({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
      }
      if (ends.size() != 2) continue;
      for (const Point& end : ends) {
        out.x.push_back(end.x);
        out.y.push_back(end.y);
      }
      out.x.push_back(std::numeric_limits<double>::quiet_NaN());
      out.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
  }

  std::vector<double> x_, y_, z_;
};

/// Draws the scale of colours to the right of the first panel.
void draw_colour_scale(const std::vector<double>& ticks, bool is_logarithmic,
                       const std::string& title, Svg& svg) {
  constexpr int kSteps = 64;
  constexpr double kScaleWidth = 18;
  const double left = kMapLeft + kMapPanelWidth + 40, bottom = kMapTop + kMapPanelHeight;
  const double step = kMapPanelHeight / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    svg.rectangle({left, bottom - (i + 1) * step}, kScaleWidth, step + 0.5,
                  map_colour((i + 0.5) / kSteps));
  }
  const auto labels = is_logarithmic ? logarithmic_tick_labels(ticks) : tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double share = (ticks[i] - ticks.front()) / (ticks.back() - ticks.front());
    const double y = bottom - share * kMapPanelHeight;
    svg.line({left, y}, {left + kScaleWidth + 4, y}, {"#444", 1, ""});
    svg.text({left + kScaleWidth + 8, y + 4}, labels[i], {12, "start", "#444", false, 0});
  }
  svg.text({left, kMapTop - 10}, title, {12.5, "start", "#222", true, 0});
}

}  // namespace

std::string map_plot(const MapPicture& picture) {
  std::vector<MapGrid> grids;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const FigureMap& map : picture.maps) {
    std::vector<double> z;
    for (const double value : map.values) {
      z.push_back(coordinate(value, picture.has_logarithmic_colours));
      if (!std::isfinite(z.back())) continue;
      low = std::min(low, z.back());
      high = std::max(high, z.back());
    }
    grids.emplace_back(coordinates(picture.x), coordinates(picture.y), std::move(z));
  }
  if (!(low <= high)) low = high = 0;
  constexpr int kContours = 8;
  const std::vector<double> ticks = picture.has_logarithmic_colours
                                        ? logarithmic_ticks(low, high)
                                        : nice_ticks(low, high, kContours);
  const auto share = [&ticks](double value) {
    return (value - ticks.front()) / (ticks.back() - ticks.front());
  };
  const std::vector<std::string> below = footer_lines({picture.footer}, kMapWidth - 2 * kMapLeft);
  const double footer_top = kMapTop + kMapPitch * static_cast<double>(grids.size()) - 30;
  Svg svg(kMapWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  svg.text({kMapLeft, 40}, picture.title, {21, "start", "#111", true, 0});
  for (std::size_t k = 0; k < grids.size(); ++k) {
    Panel panel;
    panel.corner = {kMapLeft, kMapTop + kMapPitch * static_cast<double>(k)};
    panel.width = kMapPanelWidth;
    panel.height = kMapPanelHeight;
    panel.title = picture.maps[k].title + ": " + picture.y.title;
    panel.x_title = picture.x.title;
    panel.has_arbitrary_zero = true;
    panel.is_logarithmic_x = picture.x.is_logarithmic;
    panel.is_logarithmic_y = picture.y.is_logarithmic;
    panel.cells = grids[k].cells(share);
    for (const double tick : ticks) panel.series.push_back(grids[k].contour(tick));
    draw_panel(panel, svg);
  }
  draw_colour_scale(ticks, picture.has_logarithmic_colours, picture.figure_title, svg);
  draw_footer(below, {kMapLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
