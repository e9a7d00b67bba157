#include "client/cpp/commands/rig_map.h"

#include <cmath>

#include "client/cpp/plot/footer.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

std::vector<double> steps(double first, double last, int count) {
  std::vector<double> out;
  for (int i = 0; i <= count; ++i) out.push_back(first + (last - first) * i / count);
  return out;
}

/// Returns every how many of `count` values a table shows.
std::size_t stride(std::size_t count) {
  constexpr std::size_t kMostShown = 13;
  return (count + kMostShown - 1) / kMostShown;
}

}  // namespace

std::vector<double> powers(double first, double last, int per_decade) {
  std::vector<double> out;
  const int count = static_cast<int>(std::lround(per_decade * std::log10(last / first)));
  for (int i = 0; i <= count; ++i) out.push_back(first * std::pow(last / first, 1.0 * i / count));
  return out;
}

const std::vector<RigAxis>& rig_axes() {
  static const std::vector<RigAxis> axes{
      {"slide-roll-ratio", "Slide-roll ratio, % of the mean speed", &RigSettings::slide_roll_ratios,
       false, steps(0, 50, 48), 1, 3},
      {"temperature", "Oil at the inlet, \xC2\xB0\x43", &RigSettings::temperatures, false,
       steps(20, 120, 48), 1, 0},
      {"speed", "Entrainment speed, m/s", &RigSettings::speeds, true, powers(0.03, 3, 24), 1, 2},
      {"load", "Load, N", &RigSettings::loads, true, powers(1, 100, 24), 1, 1},
      {"pressure", "Mean pressure, GPa", &RigSettings::mean_pressures, false,
       steps(0.3e9, 1.5e9, 48), 1e-9, 1}};
  return axes;
}

const RigAxis* rig_axis(const std::string& word) {
  for (const RigAxis& axis : rig_axes()) {
    if (word == axis.word) return &axis;
  }
  return nullptr;
}

MapPicture map_of(const std::vector<RigRow>& rows, const RigView& view, const RigAxis& x,
                  const RigAxis& y, const RigSettings& settings, const std::string& model_version) {
  MapPicture out;
  const auto axis = [&settings](const RigAxis& of) {
    MapAxis made{of.title, settings.*of.values, of.is_logarithmic};
    for (double& value : made.values) value *= of.factor;
    return made;
  };
  out.title = std::string(view.title) + ", map";
  out.figure_title = view.y_title;
  out.has_logarithmic_colours = view.is_logarithmic;
  out.x = axis(x);
  out.y = axis(y);
  const std::size_t width = out.x.values.size(), height = out.y.values.size();
  const bool is_x_inner = x.loop > y.loop;
  for (std::size_t first = 0; first + width * height <= rows.size(); first += width * height) {
    const std::string fluid = rows[first].fluid.substr(rows[first].fluid.find('/') + 1);
    FigureMap map{fluid + (rows[first].is_isothermal ? ", isothermal" : ""), {}};
    for (std::size_t j = 0; j < height; ++j) {
      for (std::size_t i = 0; i < width; ++i) {
        const RigRow& row = rows[first + (is_x_inner ? j * width + i : i * height + j)];
        map.values.push_back(row.figures.empty() ? std::nan("")
                                                 : view.y_factor * row.figures.at(view.y));
      }
    }
    out.maps.push_back(std::move(map));
  }
  out.footer = "Contact of a rig by the model of the axle, " + model_version + ".";
  for (const RigAxis& each : rig_axes()) {
    if (&each == &x || &each == &y || (settings.*each.values).empty()) continue;
    out.footer += " " + std::string(each.title) + ": " +
                  significant(each.factor * (settings.*each.values).front(), 4) + ".";
  }
  for (const std::string& each : warning_footers(rig_warnings(rows, view))) {
    out.footer += " " + each;
  }
  return out;
}

std::string map_table(const MapPicture& picture) {
  std::string out;
  for (const FigureMap& map : picture.maps) {
    out += map.title + ": " + picture.figure_title + "\nacross: " + picture.x.title +
           "; down: " + picture.y.title + "\n";
    std::vector<Table::Column> columns{{"", "", Table::Align::kDecimal}};
    const std::size_t width = picture.x.values.size(), across = stride(width);
    for (std::size_t i = 0; i < width; i += across) {
      columns.push_back({significant(picture.x.values[i], 3), "", Table::Align::kDecimal});
    }
    Table table(columns);
    const std::size_t height = picture.y.values.size();
    for (std::size_t j = 0; j < height; j += stride(height)) {
      std::vector<std::string> cells{significant(picture.y.values[j], 3)};
      for (std::size_t i = 0; i < width; i += across) {
        cells.push_back(significant(map.values[j * width + i], 3));
      }
      table.add_row(std::move(cells));
    }
    out += table.text() + "\n";
  }
  return out;
}

}  // namespace tribodyn::client
