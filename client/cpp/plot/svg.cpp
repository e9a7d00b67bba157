#include "client/cpp/plot/svg.h"

#include <cmath>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Two decimals are a fiftieth of a pixel; more is only weight.
std::string number(double value) {
  std::string text = fixed(value, 2);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + number(value) + "\"";
}

std::string attribute(const char* name, std::string_view value) {
  return std::string(" ") + name + "=\"" + xml_escaped(value) + "\"";
}

std::string stroke_attributes(const Stroke& stroke) {
  std::string text = attribute("stroke", stroke.colour) + attribute("stroke-width", stroke.width);
  if (!stroke.dashes.empty()) text += attribute("stroke-dasharray", stroke.dashes);
  return text;
}

}  // namespace

Svg::Svg(double width, double height) : width_(width), height_(height) {
  rectangle({0, 0}, width, height, "#fff");
}

void Svg::rectangle(Point corner, double width, double height, const std::string& fill,
                    double opacity) {
  body_ += "<rect" + attribute("x", corner.x) + attribute("y", corner.y) +
           attribute("width", width) + attribute("height", height) + attribute("fill", fill);
  if (opacity < 1) body_ += attribute("fill-opacity", opacity);
  body_ += "/>\n";
}

void Svg::line(Point from, Point to, const Stroke& stroke) {
  body_ += "<line" + attribute("x1", from.x) + attribute("y1", from.y) + attribute("x2", to.x) +
           attribute("y2", to.y) + stroke_attributes(stroke) + "/>\n";
}

void Svg::polyline(const std::vector<Point>& points, const Stroke& stroke) {
  if (points.size() < 2) return;
  std::string list;
  for (const Point& point : points) {
    list += (list.empty() ? "" : " ") + number(point.x) + "," + number(point.y);
  }
  body_ += "<polyline" + attribute("points", list) + attribute("fill", "none") +
           stroke_attributes(stroke) + " stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n";
}

void Svg::circle(Point centre, double radius, const std::string& fill, const Stroke& stroke) {
  body_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) +
           attribute("r", radius) + attribute("fill", fill) + stroke_attributes(stroke) + "/>\n";
}

void Svg::text(Point at, std::string_view text, const TextStyle& style) {
  if (text.empty()) return;
  body_ += "<text" + attribute("x", at.x) + attribute("y", at.y) +
           attribute("font-size", style.size) + attribute("fill", style.colour);
  if (style.anchor != "start") body_ += attribute("text-anchor", style.anchor);
  if (style.bold) body_ += attribute("font-weight", "600");
  if (style.rotation_degrees != 0) {
    body_ += attribute("transform", "rotate(" + number(style.rotation_degrees) + " " +
                                        number(at.x) + " " + number(at.y) + ")");
  }
  body_ += ">" + xml_escaped(text) + "</text>\n";
}

void Svg::begin_clip(Point corner, double width, double height) {
  const std::string id = "clip" + std::to_string(++clips_);
  body_ += "<clipPath" + attribute("id", id) + "><rect" + attribute("x", corner.x) +
           attribute("y", corner.y) + attribute("width", width) + attribute("height", height) +
           "/></clipPath>\n<g" + attribute("clip-path", "url(#" + id + ")") + ">\n";
}

void Svg::end_clip() { body_ += "</g>\n"; }

std::string Svg::finish() const {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", width_) +
         attribute("height", height_) +
         attribute("viewBox", "0 0 " + number(width_) + " " + number(height_)) +
         attribute("font-family", "Helvetica, Arial, 'DejaVu Sans', sans-serif") + ">\n" + body_ +
         "</svg>\n";
}

std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : printable(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

double text_width(std::string_view text, double size) { return 0.56 * size * display_width(text); }

}  // namespace tribodyn::client
