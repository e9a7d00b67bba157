#include "client/cpp/resources/measurement_cells.h"

#include <google/protobuf/descriptor.h>

#include <optional>

#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "tribodyn/v1/lubricants.pb.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

v1::LubricantMeasurements& as_measurements(Message& message) {
  return dynamic_cast<v1::LubricantMeasurements&>(message);
}

/// The parts of "205 mm2/s at 20 C +- 0.01".
struct MeasurementText {
  std::string value;
  double celsius = 0;
  double uncertainty = 0;
};

std::optional<MeasurementText> split_measurement(const std::string& text, std::string& wrong) {
  constexpr std::string_view kAt = " at ", kWithin = "+-";
  MeasurementText out;
  const std::size_t at = text.find(kAt);
  if (at == std::string::npos) {
    wrong = "must be \"VALUE UNIT at TEMPERATURE C\"; separate several values by semicolons";
    return std::nullopt;
  }
  out.value = text.substr(0, at);
  std::string temperature = text.substr(at + kAt.size());
  if (const std::size_t within = temperature.find(kWithin); within != std::string::npos) {
    const auto uncertainty =
        read_quantity(temperature.substr(within + kWithin.size()), "", "", false, wrong);
    if (!uncertainty) return std::nullopt;
    out.uncertainty = *uncertainty;
    temperature.resize(within);
  }
  const auto celsius = read_quantity(temperature, "C", "C", true, wrong);
  if (!celsius) return std::nullopt;
  out.celsius = *celsius;
  return out;
}

bool add_brookfield(const MeasurementText& text, v1::LubricantMeasurements& out,
                    std::string& wrong) {
  const auto value = read_quantity(text.value, "mPa s", "mPa s", false, wrong);
  if (!value) return false;
  auto& row = *out.add_brookfield_viscosities();
  row.set_temperature_celsius(text.celsius);
  row.set_dynamic_viscosity_millipascal_seconds(*value);
  return true;
}

bool add_density(const MeasurementText& text, v1::LubricantMeasurements& out, std::string& wrong) {
  const auto value = read_quantity(text.value, "kg/m3", "kg/m3", false, wrong);
  if (!value) return false;
  auto& row = *out.add_densities();
  row.set_temperature_celsius(text.celsius);
  row.set_density_kilograms_per_cubic_metre(*value);
  return true;
}

bool add_viscosity(const MeasurementText& text, v1::LubricantMeasurements& out,
                   std::string& wrong) {
  const auto kinematic = read_quantity(text.value, "mm2/s", "", false, wrong);
  const auto dynamic = read_quantity(text.value, "mPa s", "", false, wrong);
  if (!kinematic && !dynamic) {
    wrong = "must be a kinematic viscosity (mm2/s) or a dynamic one (mPa s)";
    return false;
  }
  auto& row = *out.add_viscosities();
  row.set_temperature_celsius(text.celsius);
  if (kinematic) {
    row.set_kinematic_viscosity_square_millimetres_per_second(*kinematic);
  } else {
    row.set_dynamic_viscosity_millipascal_seconds(*dynamic);
  }
  row.set_relative_standard_uncertainty(text.uncertainty);
  return true;
}

}  // namespace

bool is_measurement_list(const FieldDescriptor& field) {
  return field.is_repeated() && field.containing_type() == v1::LubricantMeasurements::descriptor();
}

std::string read_measurement_cell(const FieldDescriptor& list, const std::string& text,
                                  Message& measurements) {
  v1::LubricantMeasurements read;
  std::string wrong;
  for (const std::string& part : split(text, ';')) {
    if (part.find_first_not_of(' ') == std::string::npos) continue;
    const auto each = split_measurement(part, wrong);
    if (!each) return wrong;
    const bool added = list.message_type() == v1::BrookfieldViscosity::descriptor()
                           ? add_brookfield(*each, read, wrong)
                       : list.message_type() == v1::DensityMeasurement::descriptor()
                           ? add_density(*each, read, wrong)
                           : add_viscosity(*each, read, wrong);
    if (!added) return wrong;
  }
  measurements.GetReflection()->ClearField(&measurements, &list);
  as_measurements(measurements).MergeFrom(read);
  return "";
}

std::string measurement_cell(const FieldDescriptor& list, const Message& measurements) {
  const auto& from = dynamic_cast<const v1::LubricantMeasurements&>(measurements);
  std::string text;
  const auto add = [&](double value, const char* unit, double celsius, double uncertainty) {
    text += (text.empty() ? "" : "; ") + shortest(value) + " " + unit + " at " + shortest(celsius) +
            " C";
    if (uncertainty != 0) text += " +- " + shortest(uncertainty);
  };
  if (list.message_type() == v1::BrookfieldViscosity::descriptor()) {
    for (const auto& row : from.brookfield_viscosities()) {
      add(row.dynamic_viscosity_millipascal_seconds(), "mPa s", row.temperature_celsius(), 0);
    }
  } else if (list.message_type() == v1::DensityMeasurement::descriptor()) {
    for (const auto& row : from.densities()) {
      add(row.density_kilograms_per_cubic_metre(), "kg/m3", row.temperature_celsius(), 0);
    }
  } else {
    for (const auto& row : from.viscosities()) {
      const bool kinematic = row.has_kinematic_viscosity_square_millimetres_per_second();
      add(kinematic ? row.kinematic_viscosity_square_millimetres_per_second()
                    : row.dynamic_viscosity_millipascal_seconds(),
          kinematic ? "mm2/s" : "mPa s", row.temperature_celsius(),
          row.relative_standard_uncertainty());
    }
  }
  return text;
}

void remove_cold_viscosity(double temperature_celsius, Message& measurements) {
  auto& rows = *as_measurements(measurements).mutable_brookfield_viscosities();
  for (int i = rows.size() - 1; i >= 0; --i) {
    if (rows.Get(i).temperature_celsius() == temperature_celsius) rows.DeleteSubrange(i, 1);
  }
}

std::string add_cold_viscosity(double temperature_celsius, const std::string& text,
                               const std::string& bare_unit, Message& measurements) {
  std::string wrong;
  const auto value = read_quantity(text, "mPa s", bare_unit, false, wrong);
  if (!value) return wrong;
  remove_cold_viscosity(temperature_celsius, measurements);
  auto& row = *as_measurements(measurements).add_brookfield_viscosities();
  row.set_temperature_celsius(temperature_celsius);
  row.set_dynamic_viscosity_millipascal_seconds(*value);
  return "";
}

}  // namespace tribodyn::client
