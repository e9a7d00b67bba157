#include "client/cpp/report/variant_report.h"

#include <algorithm>
#include <map>

#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

bool are_of_one_scene(const v1::Simulation& one, const v1::Simulation& other) {
  const Inputs first = inputs_of(one), second = inputs_of(other);
  return first.lubricant == second.lubricant && first.surface == second.surface &&
         first.sump_temperature_celsius == second.sump_temperature_celsius;
}

/// Returns the energy means in percent, by speed [km/h].
std::map<double, double> energy_means(const v1::Simulation& simulation) {
  std::map<double, double> out;
  for (const v1::CurvePoint& point : simulation.result().points()) {
    if (!point.result().has_inefficiency_energy_mean_percent()) continue;
    out[point.speed_kilometres_per_hour()] = point.result().inefficiency_energy_mean_percent();
  }
  return out;
}

}  // namespace

std::vector<Variant> variants_of(const std::vector<v1::Simulation>& simulations) {
  std::vector<Variant> out;
  for (std::size_t i = 0; i < simulations.size(); ++i) {
    const auto base = std::find_if(simulations.begin(), simulations.end(), [&](const auto& each) {
      return are_of_one_scene(each, simulations[i]);
    });
    if (&*base != &simulations[i]) out.push_back({&*base, &simulations[i], i});
  }
  return out;
}

std::vector<std::string> variant_notes(const std::vector<v1::Simulation>& simulations,
                                       const char* celsius) {
  const Differences all = differences_of(simulations);
  Differences of_bases = all;
  of_bases.sweeps = all.sweeps && !all.models;
  std::vector<std::string> out;
  for (const v1::Simulation& each : simulations) {
    out.push_back(distinction(each, of_bases, celsius));
  }
  for (const Variant& variant : variants_of(simulations)) {
    Differences own = differences_of({*variant.base, *variant.other});
    own.sumps = all.sumps;
    own.surfaces = all.surfaces;
    out[variant.index] = distinction(*variant.other, own, celsius);
  }
  return out;
}

std::vector<std::pair<double, double>> relative_differences(const Variant& variant) {
  std::vector<std::pair<double, double>> out;
  const std::map<double, double> others = energy_means(*variant.other);
  for (const auto& [speed, mean] : energy_means(*variant.base)) {
    const auto found = others.find(speed);
    if (found != others.end() && mean != 0) {
      out.emplace_back(speed, 100 * (found->second - mean) / mean);
    }
  }
  return out;
}

std::string variant_report(const std::vector<v1::Simulation>& simulations) {
  const Differences differences = differences_of(simulations);
  const std::vector<Variant> variants = variants_of(simulations);
  std::string out;
  for (const v1::Simulation& base : simulations) {
    std::vector<Table::Column> columns = {
        {"speed", "km/h", Table::Align::kDecimal},
        {"inefficiency %", distinction(base, differences), Table::Align::kDecimal}};
    std::vector<std::map<double, double>> changes;
    for (const Variant& each : variants) {
      if (each.base != &base) continue;
      columns.push_back({"difference %",
                         distinction(*each.other, differences_of({base, *each.other})),
                         Table::Align::kDecimal});
      const auto pairs = relative_differences(each);
      changes.emplace_back(pairs.begin(), pairs.end());
    }
    if (changes.empty()) continue;
    Table table(columns);
    for (const auto& [speed, mean] : energy_means(base)) {
      std::vector<std::string> row = {significant(speed), significant(mean, 4)};
      for (const auto& change : changes) {
        const auto found = change.find(speed);
        row.push_back(found == change.end() ? "-" : signed_fixed(found->second, 2));
      }
      table.add_row(std::move(row));
    }
    out += (out.empty() ? "" : "\n") + resource_id(base.lubricant()) +
           ": difference of the energy mean from the first column, in percent of it\n\n" +
           table.text();
  }
  return out;
}

}  // namespace tribodyn::client
