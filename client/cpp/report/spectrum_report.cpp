#include "client/cpp/report/spectrum_report.h"

#include <cmath>
#include <limits>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/report/history_plot.h"
#include "client/cpp/report/results.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

constexpr double kSpectrumWidth = 960;
constexpr double kSpectrumLeft = 80;
constexpr double kSpectrumPanelHeight = 130;
constexpr double kSpectrumPitch = 180;
constexpr double kSpectrumTop = 100;

/// Returns the sentences that define order 1 and describe the transformed samples.
std::string normalisation(const v1::ReadSpectrumResponse& spectrum) {
  std::string out =
      "Order 1 is the mesh frequency, " + significant(spectrum.mesh_frequency_hertz()) +
      " Hz. Amplitudes from zero to peak, over " + std::to_string(spectrum.mesh_cycles()) +
      (spectrum.mesh_cycles() == 1 ? " mesh cycle of " : " mesh cycles of ") +
      std::to_string(spectrum.samples_per_mesh_cycle()) + " samples without window";
  return out + (spectrum.is_periodic()
                    ? ", one period of the response."
                    : ". The response has no period: the amplitudes depend on this length.");
}

std::string table_of(const v1::ReadSpectrumResponse& spectrum) {
  using enum Table::Align;
  Sheet sheet;
  sheet.heading("Over the period");
  for (const v1::OrderSpectrum& column : spectrum.columns()) {
    const ColumnTitle title = column_title(column.name());
    sheet.line(title.title, significant(title.factor * column.mean() + title.offset), "",
               "alternating part, RMS: " +
                   significant(title.factor * column.alternating_root_mean_square_value()));
  }
  std::vector<Table::Column> columns{{"order", "", kDecimal}};
  for (const v1::OrderSpectrum& column : spectrum.columns()) {
    columns.push_back({column_title(column.name()).title, "", kDecimal});
  }
  Table table(columns);
  for (int k = 0; k < spectrum.orders_size(); ++k) {
    std::vector<std::string> cells{significant(spectrum.orders(k), 4)};
    for (const v1::OrderSpectrum& column : spectrum.columns()) {
      cells.push_back(significant(column_title(column.name()).factor * column.amplitudes(k), 4));
    }
    table.add_row(std::move(cells));
  }
  return sheet.text() + "\n" + table.text() + "\n" + wrapped(normalisation(spectrum), 0) + "\n";
}

std::string csv_of(const v1::ReadSpectrumResponse& spectrum, const std::string& warnings) {
  std::vector<CsvRow> rows;
  for (int k = 0; k < spectrum.orders_size(); ++k) {
    CsvRow row{{"order", shortest(spectrum.orders(k))}};
    for (const v1::OrderSpectrum& column : spectrum.columns()) {
      row.emplace_back("amplitude_" + column.name(), shortest(column.amplitudes(k)));
      row.emplace_back("phase_angle_radians_" + column.name(),
                       shortest(column.phase_angles_radians(k)));
    }
    row.emplace_back("warnings", warnings);
    rows.push_back(std::move(row));
  }
  return csv_text(rows);
}

}  // namespace

std::string spectrum_text(const v1::Simulation& simulation,
                          const v1::ReadSpectrumResponse& spectrum, OutputFormat format) {
  const std::vector<CurveWarning> found = curve_warnings({simulation});
  const std::vector<ShownWarning> warnings(found.begin(), found.end());
  if (format == OutputFormat::kJson) {
    return json_with(json_text(spectrum), "warnings", warnings_json(warnings));
  }
  if (format == OutputFormat::kCsv) return csv_of(spectrum, codes_of(warnings));
  Sheet notes;
  add_input_warnings(spectrum.input_warnings(), notes);
  add_warnings(warnings, notes);
  return printable(simulation.name()) + ": " + study_text(simulation) + ", " +
         printable(simulation.lubricant()) + ", " + inputs_text(simulation) + "\n\n" +
         table_of(spectrum) + notes.text();
}

std::string spectrum_plot(const v1::Simulation& simulation,
                          const v1::ReadSpectrumResponse& spectrum) {
  std::vector<std::string> texts{normalisation(spectrum)};
  for (std::string& text : footer_texts({simulation})) texts.push_back(std::move(text));
  const std::vector<std::string> below = footer_lines(texts, kSpectrumWidth - 2 * kSpectrumLeft);
  const double footer_top =
      kSpectrumTop + kSpectrumPitch * static_cast<double>(spectrum.columns_size()) + 8;
  Svg svg(kSpectrumWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  svg.text({kSpectrumLeft, 38},
           "Orders of the steady state with " + fluid_title(simulation.lubricant(), "").label +
               ": " + study_text(simulation),
           {19, "start", "#111", true, 0});
  svg.text({kSpectrumLeft, 60}, inputs_text(simulation, "\xC2\xB0\x43"),
           {12, "start", "#555", false, 0});
  double top = kSpectrumTop;
  for (const v1::OrderSpectrum& column : spectrum.columns()) {
    const ColumnTitle title = column_title(column.name());
    Panel panel;
    panel.corner = {kSpectrumLeft, top};
    panel.width = kSpectrumWidth - 2 * kSpectrumLeft;
    panel.height = kSpectrumPanelHeight;
    panel.title = title.title;
    panel.starts_at_zero = true;
    if (&column == &*spectrum.columns().rbegin()) panel.x_title = "Order of the mesh frequency";
    Series stems;
    stems.colour = look_of(0).colour;
    for (int k = 0; k < spectrum.orders_size(); ++k) {
      for (const double y :
           {0.0, title.factor * column.amplitudes(k), std::numeric_limits<double>::quiet_NaN()}) {
        stems.x.push_back(spectrum.orders(k));
        stems.y.push_back(y);
      }
    }
    stems.x.insert(stems.x.begin(), 0);  // the axis begins at order 0
    stems.y.insert(stems.y.begin(), std::numeric_limits<double>::quiet_NaN());
    panel.series.push_back(std::move(stems));
    draw_panel(panel, svg);
    top += kSpectrumPitch;
  }
  draw_footer(below, {kSpectrumLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
