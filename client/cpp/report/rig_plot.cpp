#include <algorithm>
#include <cmath>
#include <map>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/report/rig_rows.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kRigWidth = 960;
constexpr double kRigLeft = 80;
constexpr double kRigPanelHeight = 420;

/// The rows of one line of the picture.
struct RigLine {
  std::string name;  ///< fluid and what is not swept
  bool is_isothermal;
  std::vector<const RigRow*> swept, measured;
};

/// Returns e.g. "shell-t9, 38 N, 2 m/s, 40 C".
std::string line_name(const RigRow& row, const RigView& view) {
  const v1::RigCondition& at = row.condition;
  std::string out = row.fluid.substr(row.fluid.find('/') + 1);
  out = out.substr(0, out.find('@')) + ", " + significant(at.load_newtons(), 4) + " N";
  const bool sweeps_speed = std::string(view.x) == "entrainment_speed_metres_per_second";
  out += sweeps_speed ? ", " + significant(at.slide_roll_ratio_percent(), 4) + " %"
                      : ", " + significant(at.entrainment_speed_metres_per_second(), 4) + " m/s";
  return out + ", " + significant(at.supply_temperature_celsius(), 4) + " C";
}

std::vector<RigLine> lines_of(const std::vector<RigRow>& rows, const RigView& view) {
  std::vector<RigLine> out;
  for (const RigRow& row : rows) {
    if (row.figures.empty()) continue;
    const std::string name = line_name(row, view);
    auto at = std::find_if(out.begin(), out.end(), [&](const RigLine& line) {
      return line.name == name && line.is_isothermal == row.is_isothermal;
    });
    if (at == out.end()) at = out.insert(at, {name, row.is_isothermal, {}, {}});
    (row.measured ? at->measured : at->swept).push_back(&row);
  }
  return out;
}

/// Adds the interval of the view's y at one place; none where no uncertainty of the inputs moves
/// it.
void add_rig_band(const RigRow& row, const RigView& view, Series& line) {
  const auto edge = [&](double RigBand::*end) {
    const auto band = row.bands.find(view.y);
    if (band == row.bands.end()) return std::nan("");
    const double value = band->second.*end * view.y_factor;
    if (!view.is_logarithmic) return value;
    return value > 0 ? std::log10(value) : std::nan("");
  };
  line.low.push_back(edge(&RigBand::interval_minimum));
  line.high.push_back(edge(&RigBand::interval_maximum));
}

/// Hatches the places at which a warning withholds the verdict on a fluid.
template <class XOf>
void hatch_withheld(const std::vector<RigRow>& rows, const XOf& x_of, Panel& panel) {
  std::map<double, bool> is_withheld;
  for (const RigRow& row : rows) {
    bool& each = is_withheld[x_of(row)];
    each = each || !withheld_by(row.warnings).empty();
  }
  hatch(bands_where(is_withheld), panel);
}

bool has_bands(const std::vector<RigRow>& rows, const RigView& view) {
  return std::any_of(rows.begin(), rows.end(),
                     [&view](const RigRow& row) { return row.bands.contains(view.y); });
}

}  // namespace

std::string rig_plot(const std::vector<RigRow>& rows, const RigView& view,
                     const std::string& model_version) {
  const auto axis = [&view](double value) {
    return view.is_logarithmic ? std::log10(value) : value;
  };
  const auto x_of = [&](const RigRow& row) {
    return axis(row.condition.GetReflection()->GetDouble(
        row.condition, v1::RigCondition::descriptor()->FindFieldByName(view.x)));
  };
  Panel panel;
  panel.corner = {kRigLeft, 90};
  panel.width = 590;
  panel.height = kRigPanelHeight;
  panel.title = view.y_title;
  panel.x_title = view.x_title;
  panel.is_logarithmic_x = panel.is_logarithmic_y = view.is_logarithmic;
  panel.shows_samples = true;
  std::vector<std::string> looks;  // names in the order of their colours
  for (const RigLine& line : lines_of(rows, view)) {
    auto known = std::find(looks.begin(), looks.end(), line.name);
    if (known == looks.end()) known = looks.insert(known, line.name);
    const Look look = look_of(static_cast<std::size_t>(known - looks.begin()) % kDistinctLooks);
    Series computed;
    computed.colour = look.colour;
    computed.dashes = line.is_isothermal ? look.side_dashes : look.dashes;
    computed.label = line.name;
    computed.note = line.is_isothermal ? "isothermal" : "";
    for (const RigRow* row : line.swept) {
      computed.x.push_back(x_of(*row));
      computed.y.push_back(axis(row->figures.at(view.y) * view.y_factor));
      add_rig_band(*row, view, computed);
    }
    Series measured;
    measured.colour = look.colour;
    measured.width = 0;
    measured.marker = Marker::kCircle;
    for (const RigRow* row : line.measured) {
      measured.x.push_back(x_of(*row));
      measured.y.push_back(axis(*row->measured * view.y_factor));
      measured.hollow.push_back(true);
    }
    if (!computed.x.empty()) panel.series.push_back(std::move(computed));
    if (!measured.x.empty() && !line.is_isothermal) panel.series.push_back(std::move(measured));
  }
  std::vector<std::string> texts{
      std::string("Contact of a rig by the model of the axle, ") + model_version +
      (std::any_of(rows.begin(), rows.end(), [](const RigRow& row) { return row.is_isothermal; })
           ? ". Dashed: isothermal."
           : ".")};
  if (has_bands(rows, view)) {
    texts.emplace_back(
        "Bands: 95 % intervals by the stated uncertainties of the inputs; errors that curves share "
        "make bands overlap more than differences do.");
  }
  hatch_withheld(rows, x_of, panel);
  for (std::string& each : warning_footers(rig_warnings(rows, view), true)) {
    texts.push_back(std::move(each));
  }
  const std::vector<std::string> below = footer_lines(texts, kRigWidth - 2 * kRigLeft);
  const double footer_top = 90 + kRigPanelHeight + 66;
  Svg svg(kRigWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  svg.text({kRigLeft, 40}, view.title, {21, "start", "#111", true, 0});
  draw_panel(panel, svg);
  draw_footer(below, {kRigLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
