#include "client/cpp/report/viscosity_report.h"

#include <cmath>

#include "client/cpp/plot/footer.h"
#include "client/cpp/plot/panel.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kViscosityWidth = 960;
constexpr double kViscosityLeft = 80;
constexpr double kViscosityPanelHeight = 420;

std::string fluid_of(const ViscosityAnswer& of) {
  const std::string& revision = of.answer.lubricant_revision();
  return revision.substr(revision.find('/') + 1);
}

/// Returns e.g. "0.5 GPa"; "ambient" for no pressure.
std::string pressure_text(double pressure) {
  return pressure == 0 ? "ambient" : significant(1e-9 * pressure, 3) + " GPa";
}

double under_pressure(const ViscosityAnswer& of, int temperature, int pressure) {
  return of.answer.dynamic_viscosity_pascal_seconds(
      temperature * of.request.pressures_pascals_size() + pressure);
}

std::string refusal_of(const ViscosityAnswer& of, int temperature) {
  const int number = of.answer.refusal_numbers(temperature);
  return number == 0 ? "" : of.answer.refusals(number - 1).message();
}

std::string table_of(const ViscosityAnswer& of) {
  using enum Table::Align;
  std::vector<Table::Column> columns{{"oil", "C", kDecimal},
                                     {"density", "kg/m3", kDecimal},
                                     {"kinematic", "mm2/s", kDecimal},
                                     {"dynamic", "mPa s", kDecimal},
                                     {"alpha*", "1/GPa", kDecimal}};
  for (const double pressure : of.request.pressures_pascals()) {
    columns.push_back({pressure_text(pressure), "mPa s", kDecimal});
  }
  Table table(columns);
  std::string refusals;
  const v1::EvaluateViscosityResponse& answer = of.answer;
  for (int i = 0; i < of.request.temperatures_celsius_size(); ++i) {
    std::vector<std::string> cells{significant(of.request.temperatures_celsius(i), 4)};
    if (const std::string why = refusal_of(of, i); !why.empty()) {
      refusals += "refused: " + why + "\n";
    } else {
      cells.push_back(fixed(answer.ambient_density_kilograms_per_cubic_metre(i), 1));
      cells.push_back(
          significant(answer.ambient_kinematic_viscosity_square_millimetres_per_second(i), 4));
      cells.push_back(significant(1e3 * answer.ambient_dynamic_viscosity_pascal_seconds(i), 4));
      cells.push_back(significant(1e9 * answer.pressure_viscosity_coefficient_per_pascal(i), 4));
      for (int k = 0; k < of.request.pressures_pascals_size(); ++k) {
        cells.push_back(significant(1e3 * under_pressure(of, i, k), 4));
      }
    }
    table.add_row(std::move(cells));
  }
  return fluid_of(of) + "\n" + table.text() + refusals + "\n";
}

void add_csv_rows(const ViscosityAnswer& of, std::vector<CsvRow>& rows) {
  const v1::EvaluateViscosityResponse& answer = of.answer;
  const int pressures = of.request.pressures_pascals_size();
  for (int i = 0; i < of.request.temperatures_celsius_size(); ++i) {
    for (int k = 0; k < std::max(1, pressures); ++k) {
      CsvRow row{{"lubricant", answer.lubricant_revision()}};
      const auto add = [&row](const char* name, double value) {
        row.emplace_back(name, shortest(value));
      };
      add("temperature_celsius", of.request.temperatures_celsius(i));
      add("pressure_pascals", pressures == 0 ? 0 : of.request.pressures_pascals(k));
      add("dynamic_viscosity_pascal_seconds",
          pressures == 0 ? answer.ambient_dynamic_viscosity_pascal_seconds(i)
                         : under_pressure(of, i, k));
      add("ambient_dynamic_viscosity_pascal_seconds",
          answer.ambient_dynamic_viscosity_pascal_seconds(i));
      add("ambient_kinematic_viscosity_square_millimetres_per_second",
          answer.ambient_kinematic_viscosity_square_millimetres_per_second(i));
      add("ambient_density_kilograms_per_cubic_metre",
          answer.ambient_density_kilograms_per_cubic_metre(i));
      add("pressure_viscosity_coefficient_per_pascal",
          answer.pressure_viscosity_coefficient_per_pascal(i));
      row.emplace_back("refusal", refusal_of(of, i));
      rows.push_back(std::move(row));
    }
  }
}

/// Returns the line of one lubricant at one pressure; at ambient if it has no pressures.
Series line_of(const ViscosityAnswer& of, int pressure) {
  Series out;
  const bool is_ambient = of.request.pressures_pascals().empty();
  for (int i = 0; i < of.request.temperatures_celsius_size(); ++i) {
    out.x.push_back(of.request.temperatures_celsius(i));
    out.y.push_back(
        std::log10(1e3 * (is_ambient ? of.answer.ambient_dynamic_viscosity_pascal_seconds(i)
                                     : under_pressure(of, i, pressure))));
  }
  return out;
}

}  // namespace

std::string viscosity_text(const std::vector<ViscosityAnswer>& answers, OutputFormat format) {
  std::string out;
  std::vector<CsvRow> rows;
  for (const ViscosityAnswer& each : answers) {
    if (format == OutputFormat::kTable) out += table_of(each);
    if (format == OutputFormat::kJson) out += json_text(each.answer);
    if (format == OutputFormat::kCsv) add_csv_rows(each, rows);
  }
  return format == OutputFormat::kCsv ? csv_text(rows) : out;
}

std::string viscosity_plot(const std::vector<ViscosityAnswer>& answers) {
  Panel panel;
  panel.corner = {kViscosityLeft, 90};
  panel.width = 590;
  panel.height = kViscosityPanelHeight;
  panel.title = "Dynamic viscosity, mPa s";
  panel.x_title = "Temperature, \xC2\xB0\x43";
  panel.is_logarithmic_y = true;
  panel.shows_samples = true;
  for (std::size_t fluid = 0; fluid < answers.size(); ++fluid) {
    const ViscosityAnswer& of = answers[fluid];
    const int lines = std::max(1, of.request.pressures_pascals_size());
    for (int k = 0; k < lines; ++k) {
      Series line = line_of(of, k);
      const double pressure =
          of.request.pressures_pascals().empty() ? 0 : of.request.pressures_pascals(k);
      line.colour = look_of(fluid % 6).colour;
      // The same dashes for a pressure of every fluid.
      line.dashes = look_of(6 * (static_cast<std::size_t>(k) % 4)).dashes;
      line.label = fluid_of(of) + ", " + pressure_text(pressure);
      panel.series.push_back(std::move(line));
    }
  }
  const std::vector<std::string> below = footer_lines(
      {"Laws of viscosity of the model, " + answers.front().answer.model_version() + "."},
      kViscosityWidth - 2 * kViscosityLeft);
  const double footer_top = 90 + kViscosityPanelHeight + 66;
  Svg svg(kViscosityWidth, footer_top + kFooterPitch * static_cast<double>(below.size()));
  svg.text({kViscosityLeft, 40}, "Viscosity over temperature and pressure",
           {21, "start", "#111", true, 0});
  draw_panel(panel, svg);
  draw_footer(below, {kViscosityLeft, footer_top}, svg);
  return svg.finish();
}

}  // namespace tribodyn::client
