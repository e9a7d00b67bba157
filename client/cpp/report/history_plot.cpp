#include "client/cpp/report/history_plot.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <vector>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/report/history_report.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

constexpr double kHistoryWidth = 960;
constexpr double kHistoryLeft = 80;
constexpr double kHistoryRight = 90;
constexpr double kPanelHeight = 130;
constexpr double kPanelPitch = 180;
constexpr double kTop = 100;

struct UnitSuffix {
  const char* suffix;
  const char* unit;
  double factor;
  double offset = 0;
};

// Longest suffix first: "_metres_per_second" before "_per_second".
constexpr UnitSuffix kUnits[] = {
    {"_radians_per_second", "rad/s", 1},
    {"_metres_per_second", "m/s", 1},
    {"_newton_metres", "N m", 1},
    {"_per_second", "10\xE2\x81\xB6/s", 1e-6},
    {"_newtons", "N", 1},
    {"_metres", "\xC2\xB5m", 1e6},
    {"_seconds", "ms", 1e3},
    {"_watts", "W", 1},
    {"_temperature_kelvin", "\xC2\xB0\x43", 1, -kZeroCelsius},
    {"_kelvin", "K", 1},
    {"_pascals", "GPa", 1e-9},
    {"_percent", "%", 1},
};

bool is_abscissa(const std::string& name) {
  return name == kTimeColumn || name.rfind("mesh_phase", 0) == 0;
}

/// Groups the columns by quantity, in their given order.
std::vector<std::pair<std::string, std::vector<const v1::History::Column*>>> grouped(
    const v1::History& history) {
  std::vector<std::pair<std::string, std::vector<const v1::History::Column*>>> groups;
  for (const auto& column : history.columns()) {
    if (is_abscissa(column.name())) continue;
    const std::string quantity = column_quantity(column.name());
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [&](const auto& group) { return group.first == quantity; });
    if (found != groups.end()) {
      found->second.push_back(&column);
    } else {
      groups.push_back({quantity, {&column}});
    }
  }
  return groups;
}

std::vector<double> scaled(const v1::History::Column& column, double factor, double offset = 0) {
  std::vector<double> values;
  values.reserve(column.values_size());
  const bool has_gaps = zero_means_no_contact(column.name());
  for (const double value : column.values()) {
    values.push_back(has_gaps && value == 0 ? std::numeric_limits<double>::quiet_NaN()
                                            : factor * value + offset);
  }
  return values;
}

/// Returns title and values of the horizontal axis: time in ms if the history has it, else mesh
/// phase, else the row.
std::pair<std::string, std::vector<double>> abscissa(const v1::History& history) {
  const v1::History::Column* phase = nullptr;
  for (const auto& column : history.columns()) {
    if (column.name() == kTimeColumn) return {"Time, ms", scaled(column, 1e3)};
    if (is_abscissa(column.name())) phase = &column;
  }
  if (phase != nullptr) return {"Mesh phase, cycles", scaled(*phase, 1)};
  std::vector<double> rows;
  const int count = history.columns_size() > 0 ? history.columns(0).values_size() : 0;
  rows.reserve(count);
  for (int i = 0; i < count; ++i) rows.push_back(i);
  return {"Sample", rows};
}

}  // namespace

ColumnTitle column_title(const std::string& column) {
  std::string words = column_quantity(column);
  ColumnTitle title;
  std::string unit;
  for (const UnitSuffix& known : kUnits) {
    const std::string suffix = known.suffix;
    if (words.size() <= suffix.size() ||
        words.compare(words.size() - suffix.size(), suffix.size(), suffix) != 0) {
      continue;
    }
    words.erase(words.size() - suffix.size());
    if (known.offset != 0) words += "_temperature";  // the suffix removed a word of the quantity
    unit = known.unit;
    title.factor = known.factor;
    title.offset = known.offset;
    break;
  }
  std::replace(words.begin(), words.end(), '_', ' ');
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  title.title = unit.empty() ? words : words + ", " + unit;
  return title;
}

std::string history_plot(const v1::Simulation& simulation, const v1::History& history,
                         const std::string& lubricant_title) {
  const auto groups = grouped(history);
  const auto [x_title, x] = abscissa(history);
  std::vector<std::string> texts = {"Model " + model_options_text(simulation.model_options()) +
                                    "."};
  for (std::string& text : footer_texts({simulation})) texts.push_back(std::move(text));
  const std::vector<std::string> below =
      footer_lines(texts, kHistoryWidth - kHistoryLeft - kHistoryRight);
  const double footer_top = kTop + kPanelPitch * static_cast<double>(groups.size()) + 8;
  Svg svg(kHistoryWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  const FluidTitle fluid = fluid_title(simulation.lubricant(), lubricant_title);
  svg.text({kHistoryLeft, 38}, "Steady state with " + fluid.label + ": " + study_text(simulation),
           {19, "start", "#111", true, 0});
  svg.text({kHistoryLeft, 60},
           (fluid.note.empty() ? "" : fluid.note + "; ") + inputs_text(simulation, "\xC2\xB0\x43"),
           {12, "start", "#555", false, 0});
  double top = kTop;
  for (const auto& [quantity, columns] : groups) {
    const ColumnTitle title = column_title(quantity);
    Panel panel;
    panel.corner = {kHistoryLeft, top};
    panel.width = kHistoryWidth - kHistoryLeft - kHistoryRight;
    panel.height = kPanelHeight;
    panel.title = title.title;
    panel.has_arbitrary_zero = title.offset != 0;
    panel.shows_x_numbers = true;
    if (&quantity == &groups.back().first) panel.x_title = x_title;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      Series series;
      series.colour = look_of(i).colour;
      series.x = x;
      series.y = scaled(*columns[i], title.factor, title.offset);
      series.width = 1.8;
      if (columns.size() > 1)
        series.label = "flank " + columns[i]->name().substr(columns[i]->name().size() - 1);
      panel.series.push_back(std::move(series));
    }
    draw_panel(panel, svg);
    top += kPanelPitch;
  }
  draw_footer(below, {kHistoryLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
