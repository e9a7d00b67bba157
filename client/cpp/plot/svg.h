#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribodyn::client {

/// A place on the drawing; y grows downwards.
struct Point {
  double x, y;
};

struct Stroke {
  std::string colour = "#000";
  double width = 1;
  std::string dashes;  ///< e.g. "5 3"; empty: solid
};

struct TextStyle {
  double size = 12;
  std::string anchor = "start";  ///< start, middle, end
  std::string colour = "#333";
  bool bold = false;
  double rotation_degrees = 0;
};

/// A self-contained SVG drawing on white, written by hand: no scripts, fonts or links.
class Svg {
 public:
  Svg(double width, double height);
  void rectangle(Point corner, double width, double height, const std::string& fill,
                 double opacity = 1);
  void line(Point from, Point to, const Stroke& stroke);
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  void polygon(const std::vector<Point>& corners, const std::string& fill, const Stroke& stroke);
  void circle(Point centre, double radius, const std::string& fill, const Stroke& stroke);
  /// A rectangle filled with thin oblique lines.
  void hatched_rectangle(Point corner, double width, double height, const std::string& colour);
  void text(Point at, std::string_view text, const TextStyle& style = {});
  /// Following elements are cut at this rectangle until the clip ends.
  void begin_clip(Point corner, double width, double height);
  void end_clip();
  std::string finish() const;

 private:
  double width_, height_;
  int clips_ = 0;
  std::vector<std::string> hatch_colours_;
  std::string body_;
};

/// Text with &, <, >, quotes and control characters made harmless in XML.
std::string xml_escaped(std::string_view text);

/// The colour "#rrggbb" as it is, or so much darker that text in it has a contrast of 4.5 to 1 with
/// white, which WCAG 2.1 asks of small text.
std::string legible_on_white(const std::string& colour);

/// Roughly how wide sans-serif text comes out, for placing labels.
double text_width(std::string_view text, double size);

}  // namespace tribodyn::client
