#include "server/resources/imports/import_lubricant.h"

#include <cmath>
#include <cstdlib>

#include "server/contract/check_message.h"
#include "server/mapping/to_core.h"
#include "server/resources/accept_resource.h"
#include "server/resources/imports/csv_table.h"

namespace tribodyn::server {
namespace {

constexpr char kTemperature[] = "temperature_celsius";
constexpr char kKinematic[] = "kinematic_viscosity_square_millimetres_per_second";
constexpr char kDynamic[] = "dynamic_viscosity_millipascal_seconds";
constexpr char kUncertainty[] = "relative_standard_uncertainty";
constexpr char kDensity[] = "density_kilograms_per_cubic_metre";

constexpr char kTemperatureNames[] = "temperature|temp|t";
constexpr char kDynamicNames[] = "dynamic_viscosity|viscosity";
constexpr char kDensityNames[] = "density|rho";

// Factors and offsets convert to the units of the contract's measurements.
constexpr CsvColumnForm kViscosityForms[] = {
    {"temperature_celsius", kTemperature, 1, 0, kTemperatureNames, "C"},
    {"temperature_kelvin", kTemperature, 1, -kZeroCelsius, kTemperatureNames, "K"},
    {"kinematic_viscosity_square_millimetres_per_second", kKinematic, 1, 0,
     "kinematic_viscosity|kv|viscosity", "mm2/s|cSt"},
    {"dynamic_viscosity_millipascal_seconds", kDynamic, 1, 0, kDynamicNames, "mPa s|mPas|mPa*s|cP"},
    {"dynamic_viscosity_pascal_seconds", kDynamic, 1e3, 0, kDynamicNames, "Pa s|Pas|Pa*s"},
    {"relative_standard_uncertainty", kUncertainty},
    {"density_kilograms_per_cubic_metre", kDensity, 1, 0, kDensityNames, "kg/m3"},
    {"density_grams_per_cubic_centimetre", kDensity, 1e3, 0, kDensityNames, "g/cm3|g/ml|kg/l"}};

/// Returns the cells of a quantity; all are NaN if the table has no such column.
std::vector<double> cells(const CsvTable& table, const std::vector<CsvColumn>& columns,
                          std::string_view quantity, Violations& violations) {
  const CsvColumn* column = find_column(columns, quantity);
  if (column == nullptr) return std::vector<double>(table.rows.size(), std::nan(""));
  return numbers(table, *column,
                 quantity == kTemperature ? EmptyCells::kViolation : EmptyCells::kAreNaN,
                 violations);
}

/// Checks one row against the table of constraints. The path of a violation is row and column.
void check_row(const google::protobuf::Message& row, const CsvTable& table, int line,
               const std::vector<CsvColumn>& columns, Violations& violations) {
  Violations found;
  check_message(row, "", found);
  for (Violation& each : found) {
    const CsvColumn* column = find_column(columns, each.field);
    each.field = csv_place(table, line, column == nullptr ? each.field : column->form.header);
    if (violations.size() < kMaximumCsvViolations) violations.push_back(std::move(each));
  }
}

/// The position in the table of each viscosity, in the order of the rows.
using Positions = std::vector<std::string>;

void read_table(CsvTable& table, v1::LubricantMeasurements& out, Positions& positions,
                Violations& violations) {
  const std::size_t before = violations.size();
  const std::vector<CsvColumn> columns = match_columns(table, kViscosityForms, violations);
  if (find_column(columns, kTemperature) == nullptr) {
    violations.add(table.name, "has no column temperature_celsius or temperature_kelvin");
  }
  if (violations.size() > before) return;
  check_units_row(table, columns, violations);
  const auto temperature = cells(table, columns, kTemperature, violations);
  const auto kinematic = cells(table, columns, kKinematic, violations);
  const auto dynamic = cells(table, columns, kDynamic, violations);
  const auto uncertainty = cells(table, columns, kUncertainty, violations);
  const auto density = cells(table, columns, kDensity, violations);
  // cells() added a violation for a cell that is not a number; the rest of its row is still
  // checked.
  const auto set_temperature = [&](auto& row, std::size_t i) {
    if (!std::isnan(temperature[i])) row.set_temperature_celsius(temperature[i]);
  };
  const auto add_viscosity = [&](std::size_t i, bool is_kinematic) {
    v1::ViscosityMeasurement* row = out.add_viscosities();
    set_temperature(*row, i);
    if (is_kinematic) {
      row->set_kinematic_viscosity_square_millimetres_per_second(kinematic[i]);
    } else {
      row->set_dynamic_viscosity_millipascal_seconds(dynamic[i]);
    }
    if (!std::isnan(uncertainty[i])) row->set_relative_standard_uncertainty(uncertainty[i]);
    check_row(*row, table, table.rows[i].line, columns, violations);
    const CsvColumn* column = find_column(columns, is_kinematic ? kKinematic : kDynamic);
    positions.push_back(csv_place(table, table.rows[i].line, column->form.header));
  };
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (!std::isnan(kinematic[i])) add_viscosity(i, true);
    if (!std::isnan(dynamic[i])) add_viscosity(i, false);
    if (std::isnan(density[i])) continue;
    v1::DensityMeasurement* row = out.add_densities();
    set_temperature(*row, i);
    row->set_density_kilograms_per_cubic_metre(density[i]);
    check_row(*row, table, table.rows[i].line, columns, violations);
  }
}

/// Replaces the paths of violations of the table's viscosities by their positions in the table.
/// `stated`: number of viscosities before the table's.
void replace_paths(const Positions& positions, int stated, std::size_t begin,
                   Violations& violations) {
  constexpr std::string_view kPath = "lubricant.measurements.viscosities[";
  std::size_t i = 0;
  for (Violation& each : violations) {
    if (i++ < begin) continue;
    std::string& field = each.field;
    if (!field.starts_with(kPath)) continue;
    const int index = std::atoi(field.c_str() + kPath.size()) - stated;
    if (index >= 0 && index < static_cast<int>(positions.size())) {
      field = positions[static_cast<std::size_t>(index)];
    }
  }
}

}  // namespace

std::vector<std::string> viscosity_headers() { return headers_of(kViscosityForms); }

std::optional<v1::Lubricant> import_lubricant(const v1::ImportLubricantRequest& request,
                                              const std::string& name, const ResourceLookup& lookup,
                                              Violations& violations) {
  const std::size_t before = violations.size();
  v1::Lubricant lubricant = request.lubricant();
  lubricant.set_name(name);
  auto table =
      parse_csv(request.viscosity_table_csv(), "viscosity_table_csv", kMaximumCsvBytes, violations);
  Positions positions;
  const int stated = lubricant.measurements().viscosities_size();
  if (table) read_table(*table, *lubricant.mutable_measurements(), positions, violations);
  if (violations.size() > before) {
    check_client_fields(request.lubricant(), lookup, "lubricant", violations);
    return std::nullopt;
  }
  auto accepted = accept(lubricant, nullptr, lookup, "lubricant", violations);
  replace_paths(positions, stated, before, violations);
  return accepted;
}

}  // namespace tribodyn::server
