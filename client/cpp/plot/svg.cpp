#include "client/cpp/plot/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Two decimals are a hundredth of a pixel; more would only enlarge the file.
std::string number(double value) {
  std::string text = fixed(value, 2);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

/// Returns the linear-light value of a channel of sRGB, both from 0 to 1 (IEC 61966-2-1).
double linear_light(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

/// Returns red, green and blue of "#rrggbb", each from 0 to 255.
std::array<double, 3> channels_of(const std::string& colour) {
  std::array<double, 3> channels{};
  for (std::size_t i = 0; i < 3; ++i) {
    channels[i] = static_cast<double>(std::stoi(colour.substr(1 + 2 * i, 2), nullptr, 16));
  }
  return channels;
}

/// Returns the contrast ratio with white as WCAG 2.1 defines it: 1 to 21.
double contrast_with_white(const std::array<double, 3>& channels) {
  const double luminance = 0.2126 * linear_light(channels[0] / 255) +
                           0.7152 * linear_light(channels[1] / 255) +
                           0.0722 * linear_light(channels[2] / 255);
  return 1.05 / (luminance + 0.05);
}

std::string points_text(const std::vector<Point>& points) {
  std::string list;
  for (const Point& point : points) {
    list += (list.empty() ? "" : " ") + number(point.x) + "," + number(point.y);
  }
  return list;
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
  body_ += "<polyline" + attribute("points", points_text(points)) + attribute("fill", "none") +
           stroke_attributes(stroke) + " stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n";
}

void Svg::polygon(const std::vector<Point>& corners, const std::string& fill, const Stroke& stroke,
                  double opacity) {
  body_ += "<polygon" + attribute("points", points_text(corners)) + attribute("fill", fill);
  if (opacity < 1) body_ += attribute("fill-opacity", opacity);
  body_ += stroke_attributes(stroke) + "/>\n";
}

void Svg::hatched_rectangle(Point corner, double width, double height, const std::string& colour) {
  auto found = std::find(hatch_colours_.begin(), hatch_colours_.end(), colour);
  if (found == hatch_colours_.end()) found = hatch_colours_.insert(found, colour);
  const std::string id = "hatch" + std::to_string(found - hatch_colours_.begin());
  rectangle(corner, width, height, "url(#" + id + ")");
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
  std::string hatches;
  for (std::size_t i = 0; i < hatch_colours_.size(); ++i) {
    hatches += "<pattern" + attribute("id", "hatch" + std::to_string(i)) +
               R"( width="7" height="7" patternUnits="userSpaceOnUse")" +
               attribute("patternTransform", "rotate(45)") +
               R"(><line x1="0" y1="0" x2="0" y2="7")" +
               stroke_attributes({hatch_colours_[i], 1.1, ""}) + "/></pattern>\n";
  }
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", width_) +
         attribute("height", height_) +
         attribute("viewBox", "0 0 " + number(width_) + " " + number(height_)) +
         attribute("font-family", "Helvetica, Arial, 'DejaVu Sans', sans-serif") + ">\n" + hatches +
         body_ + "</svg>\n";
}

std::string legible_on_white(const std::string& colour) {
  constexpr double kLeastContrast = 4.5;
  std::array<double, 3> channels = channels_of(colour);
  while (contrast_with_white(channels) < kLeastContrast) {
    for (double& channel : channels) channel = std::floor(0.97 * channel);
  }
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", static_cast<int>(channels[0]),
                static_cast<int>(channels[1]), static_cast<int>(channels[2]));
  return text.data();
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

std::vector<std::string> text_lines(std::string_view text, double size, double width) {
  std::vector<std::string> lines =
      split(wrapped(text, 0, static_cast<int>(width / text_width("x", size))), '\n');
  if (!lines.empty()) lines.pop_back();  // behind the last line feed
  return lines;
}

}  // namespace tribodyn::client
