#include "client/cpp/report/sensitivity_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

constexpr int kLongestBar = 24;         // [characters]
constexpr std::size_t kMostSpeeds = 7;  // of a curve, evenly chosen
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

constexpr char kElasticityRemark[] =
    "Elasticities: a parameter that rises by 1 % moves the figure by so many percent; temperatures "
    "count from 0 K.";

std::string missing_text(const v1::PointResult& result) {
  for (const v1::RangeWarning& warning : result.warnings()) {
    if (warning.code() == "NO_SENSITIVITIES") return warning.message();
  }
  return "they were not asked for";
}

/// A point of a curve that has sensitivities.
struct DifferentiatedPoint {
  double speed_kilometres_per_hour;
  const v1::PointSensitivities* sensitivities;

  /// Of the ranked figure by parameter i.
  double elasticity(int i) const {
    return elasticity_of(sensitivities->parameters(i), place_of(*sensitivities, kRankedFigure));
  }
};

/// Returns the points that have sensitivities. Adds remarks about the others, and about those at
/// the edge of an event.
std::vector<DifferentiatedPoint> differentiated_points(const v1::SimulationResult& result,
                                                       Sheet& sheet) {
  std::vector<DifferentiatedPoint> out;
  std::map<std::string, std::string> remarks;  // with the speeds that each is about
  for (const v1::CurvePoint& point : result.points()) {
    if (!point.has_result()) continue;
    const v1::PointSensitivities& sensitivities = point.result().sensitivities();
    const bool has_some = point.result().has_sensitivities();
    if (has_some) out.push_back({point.speed_kilometres_per_hour(), &sensitivities});
    if (has_some && !sensitivities.one_sided()) continue;
    std::string& speeds =
        remarks[has_some ? "the response is at the edge of an event: the elasticities hold for one "
                           "direction only."
                         : "there are none: " + missing_text(point.result()) + "."];
    speeds += (speeds.empty() ? "" : ", ") + significant(point.speed_kilometres_per_hour());
  }
  for (const auto& [text, speeds] : remarks) sheet.remark(speeds + " km/h: " + text);
  return out;
}

/// Returns the elasticities of the ranked figure: a line for each parameter, that with the largest
/// one first, and a column for each of a few speeds. Requires points.
Table curve_elasticity_table(const std::vector<DifferentiatedPoint>& points) {
  const v1::PointSensitivities& first = *points.front().sensitivities;
  std::vector<std::pair<double, int>> ranks;  // minus the largest elasticity, and the parameter
  for (int i = 0; i < first.parameters_size(); ++i) {
    double largest = 0;
    for (const DifferentiatedPoint& each : points) {
      largest = std::max(largest, std::abs(each.elasticity(i)));
    }
    ranks.emplace_back(-largest, i);
  }
  std::sort(ranks.begin(), ranks.end());
  std::vector<const DifferentiatedPoint*> shown;
  std::vector<Table::Column> columns = {{"parameter", "", Table::Align::kLeft}};
  const std::size_t speeds = std::min(points.size(), kMostSpeeds);
  for (std::size_t k = 0; k < speeds; ++k) {
    shown.push_back(&points[k == 0 ? 0 : k * (points.size() - 1) / (speeds - 1)]);
    columns.push_back(
        {significant(shown.back()->speed_kilometres_per_hour), "km/h", Table::Align::kDecimal});
  }
  Table out(columns);
  for (const auto& [rank, parameter] : ranks) {
    std::vector<std::string> row = {parameter_words(first.parameters(parameter).parameter())};
    for (const auto* each : shown) row.push_back(fixed(each->elasticity(parameter), 4));
    out.add_row(std::move(row));
  }
  return out;
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
  sheet.remark(std::string(kElasticityRemark) + " Bars show those of the inefficiency.");
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

std::string curve_sensitivity_report(const v1::SimulationResult& result) {
  Sheet sheet;
  sheet.heading("Sensitivities of the inefficiency");
  const std::vector<DifferentiatedPoint> found = differentiated_points(result, sheet);
  if (found.empty()) return sheet.text();
  sheet.remark(std::string(kElasticityRemark) +
               " Derivatives and elasticities of all figures at all speeds are in CSV and JSON.");
  return sheet.text() + "\n" + curve_elasticity_table(found).text();
}

CsvRow empty_sensitivity_cells(const std::vector<v1::Simulation>& simulations) {
  CsvRow out;
  std::set<std::string> names;
  for (const v1::Simulation& simulation : simulations) {
    for (const v1::CurvePoint& point : simulation.result().points()) {
      const v1::PointSensitivities& all = point.result().sensitivities();
      for (const v1::ParameterSensitivity& each : all.parameters()) {
        if (!names.insert(each.parameter()).second) continue;
        for (const std::string& figure : all.figures()) {
          out.emplace_back("derivative." + figure + "." + each.parameter(), "");
          out.emplace_back("elasticity." + figure + "." + each.parameter(), "");
        }
      }
    }
  }
  return out;
}

void fill_sensitivity_cells(const v1::PointResult& result, CsvRow& cells) {
  std::map<std::string, std::string> values;
  const v1::PointSensitivities& all = result.sensitivities();
  for (const v1::ParameterSensitivity& each : all.parameters()) {
    for (int f = 0; f < all.figures_size() && f < each.derivatives_size(); ++f) {
      const std::string name = "." + all.figures(f) + "." + each.parameter();
      values["derivative" + name] = shortest(each.derivatives(f));
      values["elasticity" + name] = shortest(elasticity_of(each, f));
    }
  }
  for (auto& [name, value] : cells) {
    const auto found = values.find(name);
    if (found != values.end()) value = found->second;
  }
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
    row.emplace_back("warnings", codes_of(result.warnings()));
    rows.push_back(std::move(row));
  }
  return rows.empty() ? "" : csv_text(rows);
}

}  // namespace tribodyn::client
