#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribodyn::client {

/// A position in the drawing [pixels]; y increases downwards.
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

/// A self-contained SVG drawing on a white background, without scripts, fonts or links.
class Svg {
 public:
  Svg(double width, double height);
  void rectangle(Point corner, double width, double height, const std::string& fill,
                 double opacity = 1);
  void line(Point from, Point to, const Stroke& stroke);
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  void polygon(const std::vector<Point>& corners, const std::string& fill, const Stroke& stroke,
               double opacity = 1);
  void circle(Point centre, double radius, const std::string& fill, const Stroke& stroke);
  /// Draws a rectangle filled with thin oblique lines.
  void hatched_rectangle(Point corner, double width, double height, const std::string& colour);
  void text(Point at, std::string_view text, const TextStyle& style = {});
  /// Clips the following elements at this rectangle until end_clip().
  void begin_clip(Point corner, double width, double height);
  void end_clip();
  std::string finish() const;

 private:
  double width_, height_;
  int clips_ = 0;
  std::vector<std::string> hatch_colours_;
  std::string body_;
};

/// Returns the text with &, <, > and quotes escaped for XML and without control characters.
std::string xml_escaped(std::string_view text);

/// Returns "#rrggbb" unchanged, or darkened until text in it has a contrast of 4.5 to 1 with white,
/// the least that WCAG 2.1 allows for small text.
std::string legible_on_white(const std::string& colour);

/// Returns the approximate width of sans-serif text [pixels].
double text_width(std::string_view text, double size);

/// Breaks the text into lines of at most `width` pixels.
std::vector<std::string> text_lines(std::string_view text, double size, double width);

}  // namespace tribodyn::client
