#include "client/cpp/report/roughness_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// A parameter of the surface and the unit in which it is shown.
struct ShownRoughness {
  double (v1::ProfileRoughness::*value)() const;
  const char* name;
  const char* unit;
  double factor;  ///< of the unit over the SI unit
};
constexpr ShownRoughness kShownRoughness[] = {
    {&v1::ProfileRoughness::composite_rms_height_metres, "height sigma", "um", 1e6},
    {&v1::ProfileRoughness::asperity_density_per_square_metre, "density eta", "1/mm2", 1e-6},
    {&v1::ProfileRoughness::asperity_radius_metres, "radius beta", "um", 1e6},
    {&v1::ProfileRoughness::roughness_product, "sigma eta beta", "-", 1}};

/// Returns e.g. "0.412 ± 0.009"; without uncertainty the value alone.
std::string with_spread(double value, double uncertainty) {
  std::string out = significant(value, 4);
  if (uncertainty > 0) out += " \xC2\xB1 " + significant(uncertainty, 2);
  return out;
}

std::string group_name(const v1::ProfileGroup& group) {
  std::string out = group.member() == v1::FLANK_MEMBER_PINION ? "pinion"
                    : group.member() == v1::FLANK_MEMBER_GEAR ? "gear"
                                                              : "both flanks";
  if (group.direction() == v1::PROFILE_DIRECTION_AXIAL) out += ", axial";
  if (group.direction() == v1::PROFILE_DIRECTION_RADIAL) out += ", radial";
  return out;
}

std::string groups_table(const v1::EvaluateProfilesResponse& answer) {
  using enum Table::Align;
  Table table({{"profiles", "", kLeft},
               {"number", "", kRight},
               {"m0", "um2", kRight},
               {"m2", "-", kRight},
               {"m4", "1/mm2", kRight}});
  for (const v1::ProfileGroup& group : answer.groups()) {
    const v1::ProfileMoments& mean = group.mean();
    const v1::ProfileMoments& spread = group.standard_deviation();
    table.add_row({group_name(group), std::to_string(group.profiles()),
                   with_spread(1e12 * mean.mean_square_height_square_metres(),
                               1e12 * spread.mean_square_height_square_metres()),
                   with_spread(mean.mean_square_slope(), spread.mean_square_slope()),
                   with_spread(1e-6 * mean.mean_square_curvature_per_square_metre(),
                               1e-6 * spread.mean_square_curvature_per_square_metre())});
  }
  return table.text();
}

std::string surfaces_table(const v1::EvaluateProfilesResponse& answer) {
  using enum Table::Align;
  std::vector<Table::Column> columns{{"step", "", kRight}, {"interval", "um", kDecimal}};
  for (const ShownRoughness& each : kShownRoughness) {
    columns.push_back({each.name, each.unit, kRight});
  }
  columns.push_back({"waves", "intervals", kDecimal});
  Table table(columns);
  for (const v1::SampledSurface& surface : answer.surfaces()) {
    std::vector<std::string> row{std::to_string(surface.sampling_step()),
                                 significant(1e6 * surface.spacing_metres(), 4)};
    for (const ShownRoughness& each : kShownRoughness) {
      row.push_back(with_spread(each.factor * (surface.roughness().*each.value)(),
                                each.factor * (surface.standard_uncertainty().*each.value)()));
    }
    row.push_back(significant(surface.wave_length_ratio(), 3));
    table.add_row(std::move(row));
  }
  return table.text();
}

std::string surfaces_csv(const v1::EvaluateProfilesResponse& answer) {
  std::vector<CsvRow> rows;
  for (const v1::SampledSurface& surface : answer.surfaces()) {
    CsvRow row{{"sampling_step", std::to_string(surface.sampling_step())},
               {"spacing_metres", shortest(surface.spacing_metres())}};
    append_fields(surface.roughness(), "", row);
    if (surface.has_standard_uncertainty()) {
      append_fields(surface.standard_uncertainty(), "standard_uncertainty_", row);
    } else {
      append_empty_fields(surface.standard_uncertainty(), "standard_uncertainty_", row);
    }
    row.emplace_back("wave_length_ratio", shortest(surface.wave_length_ratio()));
    rows.push_back(std::move(row));
  }
  return csv_text(rows);
}

/// The line of a parameter over the sampling interval, in common logarithms.
Series line_over_interval(const v1::EvaluateProfilesResponse& answer, const ShownRoughness& shown) {
  Series out;
  out.colour = look_of(0).colour;
  out.marker = Marker::kCircle;
  for (const v1::SampledSurface& surface : answer.surfaces()) {
    const double value = shown.factor * (surface.roughness().*shown.value)();
    out.x.push_back(std::log10(1e6 * surface.spacing_metres()));
    out.y.push_back(std::log10(value));
    if (!surface.has_standard_uncertainty()) continue;
    const double uncertainty = shown.factor * (surface.standard_uncertainty().*shown.value)();
    out.low.push_back(uncertainty < value ? std::log10(value - uncertainty) : std::nan(""));
    out.high.push_back(std::log10(value + uncertainty));
  }
  return out;
}

}  // namespace

std::string roughness_text(const v1::EvaluateProfilesResponse& answer, OutputFormat format) {
  if (format == OutputFormat::kJson) return json_text(answer);
  if (format == OutputFormat::kCsv) return surfaces_csv(answer);
  std::string out =
      "Moments of the profiles; after \xC2\xB1 the standard deviation of single ones\n\n" +
      groups_table(answer) +
      "\nThe surface of all of them by the sampling interval; after \xC2\xB1 the standard "
      "uncertainty by their spread\n\n" +
      surfaces_table(answer) + "\n";
  for (const v1::RangeWarning& each : answer.warnings()) {
    out += wrapped(each.code() + ": " + each.message(), 0) + "\n";
  }
  return out;
}

std::string roughness_plot(const v1::EvaluateProfilesResponse& answer) {
  constexpr double kRoughnessLeft = 80, kPanelTop = 90, kPanelWidth = 360, kPanelHeight = 230;
  constexpr double kColumnPitch = 470, kRowPitch = 320;
  const std::vector<std::string> below = footer_lines(
      {"Parameters of Greenwood and Tripp (eqs 45 to 48) of " +
       std::to_string(answer.measurements_size()) +
       " measured profiles; bands: standard uncertainty by the spread of the profiles."},
      2 * kColumnPitch - kRoughnessLeft);
  const double footer_top = kPanelTop + 2 * kRowPitch + 10;
  Svg svg(2 * kColumnPitch + 40, footer_top + kFooterPitch * static_cast<double>(below.size()));
  svg.text({kRoughnessLeft, 40}, "Surface parameters over the sampling interval",
           {21, "start", "#111", true, 0});
  for (std::size_t k = 0; k < std::size(kShownRoughness); ++k) {
    const ShownRoughness& shown = kShownRoughness[k];
    const std::size_t row = k / 2, column = k % 2;
    Panel panel;
    panel.corner = {kRoughnessLeft + kColumnPitch * static_cast<double>(column),
                    kPanelTop + kRowPitch * static_cast<double>(row)};
    panel.width = kPanelWidth;
    panel.height = kPanelHeight;
    panel.title = std::string(shown.name) + ", " + shown.unit;
    panel.x_title = "Sampling interval, um";
    panel.is_logarithmic_x = panel.is_logarithmic_y = true;
    panel.series.push_back(line_over_interval(answer, shown));
    draw_panel(panel, svg);
  }
  draw_footer(below, {kRoughnessLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
