#include "client/cpp/resources/table_files.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <iostream>
#include <set>
#include <vector>

#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/table_text.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

void append_series(const char* quantity, const v1::FourierSeries& series, std::string& text) {
  const int harmonics = std::max(series.sine_size(), series.cosine_size());
  for (int i = 0; i <= harmonics; ++i) {
    const double sine = i > 0 && i <= series.sine_size() ? series.sine(i - 1) : 0;
    double cosine = i > 0 && i <= series.cosine_size() ? series.cosine(i - 1) : 0;
    if (i == 0) cosine = series.mean();
    text += csv_line({quantity, std::to_string(i), shortest(sine), shortest(cosine)});
  }
}

}  // namespace

std::string read_table_file(const std::string& path, std::size_t most_bytes) {
  static std::set<std::string> noted;  // files are read twice; prints a note once
  std::string note;
  std::string text = table_text(read_file(path, most_bytes), path, note);
  if (!note.empty() && noted.insert(path).second)
    std::cerr << "tribodyn: " << printable(note) << "\n";
  return text;
}

std::string tooth_contact_csv(const v1::GearSet& gear_set) {
  const auto* type = v1::FlankSlot::descriptor();
  const auto& reflection = *v1::FlankSlot::GetReflection();
  // Omits columns that no slot has.
  std::vector<const FieldDescriptor*> columns;
  std::vector<std::string> header = {"mesh_phase", "slot"};
  for (int i = 0; i < type->field_count(); ++i) {
    const bool used = std::any_of(
        gear_set.flank_slots().begin(), gear_set.flank_slots().end(),
        [&](const auto& slot) { return reflection.FieldSize(slot, type->field(i)) > 0; });
    if (!used) continue;
    columns.push_back(type->field(i));
    header.push_back(type->field(i)->name());
  }
  std::string text = csv_line(header);
  for (int s = 0; s < gear_set.flank_slots_size(); ++s) {
    const v1::FlankSlot& slot = gear_set.flank_slots(s);
    const int samples = slot.load_share_size();
    for (int k = 0; k < samples; ++k) {
      std::vector<std::string> cells = {shortest(static_cast<double>(k) / (samples - 1)),
                                        std::to_string(s)};
      for (const FieldDescriptor* column : columns) {
        cells.push_back(k < reflection.FieldSize(slot, column)
                            ? shortest(reflection.GetRepeatedDouble(slot, column, k))
                            : "");
      }
      text += csv_line(cells);
    }
  }
  return text;
}

std::string series_csv(const v1::GearSet& gear_set) {
  std::string text = csv_line({"quantity", "harmonic", "sine", "cosine"});
  const v1::MeshSeries& series = gear_set.series();
  append_series("pinion_contact_radius_metres", series.pinion_contact_radius_metres(), text);
  append_series("gear_contact_radius_metres", series.gear_contact_radius_metres(), text);
  append_series("mesh_stiffness_newtons_per_metre", series.mesh_stiffness_newtons_per_metre(),
                text);
  append_series("static_transmission_error_metres", series.static_transmission_error_metres(),
                text);
  return text;
}

std::string viscosity_table_csv(const v1::Lubricant& lubricant) {
  const v1::LubricantMeasurements& measured = lubricant.measurements();
  std::string text =
      csv_line({"temperature_celsius", "kinematic_viscosity_square_millimetres_per_second",
                "dynamic_viscosity_millipascal_seconds", "density_kilograms_per_cubic_metre"});
  const auto add = [&](double celsius, double kinematic, double dynamic, double density) {
    const auto cell = [](double value) { return value == 0 ? std::string() : shortest(value); };
    text += csv_line({shortest(celsius), cell(kinematic), cell(dynamic), cell(density)});
  };
  if (const double kv40 = measured.kinematic_viscosity_40_celsius_square_millimetres_per_second();
      kv40 != 0) {
    add(40, kv40, 0, 0);
  }
  if (const double kv100 = measured.kinematic_viscosity_100_celsius_square_millimetres_per_second();
      kv100 != 0) {
    add(100, kv100, 0, 0);
  }
  for (const auto& viscosity : measured.viscosities()) {
    add(viscosity.temperature_celsius(),
        viscosity.kinematic_viscosity_square_millimetres_per_second(),
        viscosity.dynamic_viscosity_millipascal_seconds(), 0);
  }
  for (const auto& viscosity : measured.brookfield_viscosities()) {
    add(viscosity.temperature_celsius(), 0, viscosity.dynamic_viscosity_millipascal_seconds(), 0);
  }
  if (const double density = measured.density_15_celsius_kilograms_per_cubic_metre();
      density != 0) {
    add(15, 0, 0, density);
  }
  for (const auto& density : measured.densities()) {
    add(density.temperature_celsius(), 0, 0, density.density_kilograms_per_cubic_metre());
  }
  return text;
}

}  // namespace tribodyn::client
