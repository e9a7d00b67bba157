#include "client/cpp/report/sensitivity_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/cpp/text/csv.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr int kLongestBar = 24;  // [characters]
/// Figures of the table, by their fields.
constexpr const char* kRankedFigure = "inefficiency_energy_mean_percent";
constexpr struct {
  const char* figure;
  const char* header;
} kOtherFigures[] = {{"mesh_loss_power_watts", "loss power"},
                     {"film_ratio.mean", "film ratio"},
                     {"contact_temperature_kelvin.mean", "contact temp."}};

int place_of(const v1::PointSensitivities& sensitivities, const std::string& figure) {
  const auto& figures = sensitivities.figures();
  return static_cast<int>(std::find(figures.begin(), figures.end(), figure) - figures.begin());
}

double elasticity_of(const v1::ParameterSensitivity& parameter, int figure) {
  return figure < parameter.elasticities_size() ? parameter.elasticities(figure) : 0;
}

/// Returns "pressure viscosity coefficient" for "lubricant.pressure_viscosity_coefficient".
std::string parameter_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  std::replace(name.begin(), name.end(), '.', ' ');
  return name;
}

/// Returns a bar to the left of the axis for a negative number, to the right for a positive one.
std::string bar_text(double value, double largest) {
  const int half = kLongestBar / 2;
  const int length =
      largest > 0 ? static_cast<int>(std::lround(half * std::abs(value) / largest)) : 0;
  const std::string blanks(static_cast<std::size_t>(half - length), ' ');
  const std::string full(static_cast<std::size_t>(length), '#');
  return value < 0 ? blanks + full + "|"
                   : std::string(static_cast<std::size_t>(half), ' ') + "|" + full;
}

std::string missing_text(const v1::PointResult& result) {
  for (const v1::RangeWarning& warning : result.warnings()) {
    if (warning.code() == "NO_SENSITIVITIES") return warning.message();
  }
  return "they were not asked for";
}

}  // namespace

std::string sensitivity_report(const v1::PointResult& result) {
  Sheet sheet;
  sheet.heading("Sensitivities");
  if (!result.has_sensitivities()) {
    sheet.remark("There are none: " + missing_text(result) + ".");
    return sheet.text();
  }
  const v1::PointSensitivities& sensitivities = result.sensitivities();
  sheet.remark(
      "Elasticities: a parameter that rises by 1 % moves the figure by so many percent; "
      "temperatures count from 0 K. Bars show those of the inefficiency.");
  if (sensitivities.one_sided()) {
    sheet.remark(
        "The response is at the edge of an event: the elasticities hold for one direction only.");
  }
  const int ranked = place_of(sensitivities, kRankedFigure);
  std::vector<const v1::ParameterSensitivity*> sorted;
  double largest = 0;
  for (const v1::ParameterSensitivity& each : sensitivities.parameters()) {
    sorted.push_back(&each);
    largest = std::max(largest, std::abs(elasticity_of(each, ranked)));
  }
  std::stable_sort(sorted.begin(), sorted.end(), [ranked](const auto* a, const auto* b) {
    return std::abs(elasticity_of(*a, ranked)) > std::abs(elasticity_of(*b, ranked));
  });
  std::vector<Table::Column> columns = {{"parameter", "", Table::Align::kLeft},
                                        {"value", "", Table::Align::kRight},
                                        {"unit", "", Table::Align::kLeft},
                                        {"inefficiency", "", Table::Align::kDecimal}};
  for (const auto& each : kOtherFigures)
    columns.push_back({each.header, "", Table::Align::kDecimal});
  columns.push_back({"", "", Table::Align::kLeft});
  Table table(columns);
  for (const v1::ParameterSensitivity* each : sorted) {
    const double elasticity = elasticity_of(*each, ranked);
    std::vector<std::string> row = {parameter_words(each->parameter()), significant(each->value()),
                                    each->unit() == "1" ? "" : each->unit(), fixed(elasticity, 4)};
    for (const auto& other : kOtherFigures) {
      row.push_back(fixed(elasticity_of(*each, place_of(sensitivities, other.figure)), 4));
    }
    row.push_back(bar_text(elasticity, largest));
    table.add_row(row);
  }
  return sheet.text() + "\n" + table.text();
}

std::string sensitivity_csv(const v1::PointResult& result) {
  std::vector<CsvRow> rows;
  const v1::PointSensitivities& sensitivities = result.sensitivities();
  for (const v1::ParameterSensitivity& each : sensitivities.parameters()) {
    CsvRow row = {
        {"parameter", each.parameter()}, {"unit", each.unit()}, {"value", shortest(each.value())}};
    for (int f = 0; f < sensitivities.figures_size() && f < each.derivatives_size(); ++f) {
      row.emplace_back("derivative." + sensitivities.figures(f), shortest(each.derivatives(f)));
      row.emplace_back("elasticity." + sensitivities.figures(f), shortest(elasticity_of(each, f)));
    }
    rows.push_back(std::move(row));
  }
  return rows.empty() ? "" : csv_text(rows);
}

}  // namespace tribodyn::client
