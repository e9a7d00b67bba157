#include "client/cpp/report/contact_report.h"

#include <google/protobuf/descriptor.h>

#include <array>
#include <string>

#include "client/cpp/report/comparison_report.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "client/cpp/text/warnings.h"

namespace tribodyn::client {
namespace {

/// How one field of the response is shown: value * factor + offset, in `unit`.
struct Quantity {
  const char* field;
  const char* label;
  const char* symbol;
  const char* unit;
  double factor;
  double offset;
  const char* equation;
};

constexpr double kDegreesPerRadian = 57.29577951308232;

constexpr std::array kQuantities = {
    Quantity{"film_load_newtons", "load on the film", "W_EHL", "N", 1, 0, ""},
    Quantity{"asperity_load_newtons", "load on asperities", "W_asp", "N", 1, 0, "41"},
    Quantity{"semi_major_axis_metres", "semi-major axis", "a_c", "um", 1e6, 0, "20"},
    Quantity{"semi_minor_axis_metres", "semi-minor axis", "b_c", "um", 1e6, 0, "20"},
    Quantity{"contact_area_square_metres", "contact area", "A_EHL", "mm2", 1e6, 0, "20"},
    Quantity{"asperity_area_square_metres", "asperity area", "A_asp", "mm2", 1e6, 0, "42"},
    Quantity{"maximum_pressure_pascals", "maximum pressure", "p_max", "GPa", 1e-9, 0, "19"},
    Quantity{"reduced_modulus_pascals", "reduced modulus", "E'", "GPa", 1e-9, 0, "13"},
    Quantity{"entrainment_angle_radians", "entrainment angle", "theta", "degrees",
             kDegreesPerRadian, 0, "17"},
    Quantity{"entrainment_radius_metres", "radius along entrainment", "R_e", "mm", 1e3, 0, "15"},
    Quantity{"side_leakage_radius_metres", "radius across entrainment", "R_s", "mm", 1e3, 0, "16"},
    Quantity{"entrainment_speed_metres_per_second", "entrainment speed", "U_eff", "m/s", 1, 0,
             "17"},
    Quantity{"sliding_speed_metres_per_second", "sliding speed", "V_s", "m/s", 1, 0, ""},
    Quantity{"pinion_specific_sliding", "specific sliding, pinion", "V_s/|U_p|", "", 1, 0, ""},
    Quantity{"gear_specific_sliding", "specific sliding, gear", "V_s/|U_g|", "", 1, 0, ""},
    Quantity{"inlet_viscosity_pascal_seconds", "inlet viscosity", "eta_0", "mPa s", 1e3, 0, "34"},
    Quantity{"inlet_pressure_viscosity_coefficient_per_pascal",
             "inlet pressure-viscosity coefficient", "alpha*", "1/GPa", 1e9, 0, "33"},
    Quantity{"pressure_viscosity_index", "pressure-viscosity index", "Z", "", 1, 0, "33"},
    Quantity{"central_film_thickness_metres", "central film thickness", "h_cen", "um", 1e6, 0,
             "12"},
    Quantity{"inlet_heating_factor", "film factor of inlet shear heating", "", "", 1, 0, ""},
    Quantity{"film_ratio", "film ratio", "lambda_s", "", 1, 0, ""},
    Quantity{"shear_rate_per_second", "shear rate", "gamma_dot", "1e6/s", 1e-6, 0, "18"},
    Quantity{"contact_temperature_kelvin", "contact temperature", "T_c", "C", 1, -kZeroCelsius,
             "38"},
    Quantity{"flash_temperature_rise_kelvin", "flash temperature rise", "dT_f", "K", 1, 0, "39"},
    Quantity{"oil_temperature_rise_kelvin", "oil temperature rise", "dT_oil", "K", 1, 0, "39"},
    Quantity{"pinion_active_length_metres", "active length, pinion", "l_p", "um", 1e6, 0, "36"},
    Quantity{"gear_active_length_metres", "active length, gear", "l_g", "um", 1e6, 0, "36"},
    Quantity{"film_thermal_resistance_kelvin_per_watt", "thermal resistance, film", "R_f", "K/W", 1,
             0, "35"},
    Quantity{"pinion_thermal_resistance_kelvin_per_watt", "thermal resistance, pinion", "R_p",
             "K/W", 1, 0, "35"},
    Quantity{"gear_thermal_resistance_kelvin_per_watt", "thermal resistance, gear", "R_g", "K/W", 1,
             0, "35"},
    Quantity{"heat_partition", "heat partition", "a_h", "", 1, 0, "37"},
    Quantity{"heat_rate_watts", "heat rate", "Q", "W", 1, 0, ""},
    Quantity{"mean_shear_stress_pascals", "mean shear stress", "tau", "MPa", 1e-6, 0, ""},
    Quantity{"limiting_stress_area_share", "area on the limiting stress", "", "%", 100, 0, ""},
    Quantity{"viscous_friction_newtons", "viscous friction", "F_v", "N", 1, 0, "27"},
    Quantity{"boundary_friction_newtons", "boundary friction", "F_b", "N", 1, 0, "40"},
    Quantity{"friction_newtons", "friction", "F_fr", "N", 1, 0, "28"},
    Quantity{"friction_coefficient", "friction coefficient", "mu", "", 1, 0, ""},
};

/// Returns half the 95 % interval of a quantity; empty if no stated uncertainty moves it.
std::string input_error(const v1::EvaluateContactResponse& contact, const Quantity& quantity) {
  for (const v1::UncertainContactFigure& each : contact.uncertainties()) {
    if (each.figure() == quantity.field) {
      const v1::UncertainFigure& figure = each.value();
      const double width = figure.interval_maximum() - figure.interval_minimum();
      return significant(0.5 * quantity.factor * width, 2);
    }
  }
  return "";
}

}  // namespace

std::string contact_report(const v1::EvaluateContactResponse& contact) {
  Table table({{"Quantity", "", Table::Align::kLeft},
               {"Symbol", "", Table::Align::kLeft},
               {"Value", ""},
               {"+/- 95 %", ""},
               {"Unit", "", Table::Align::kLeft},
               {"Eq", ""}});
  for (const Quantity& quantity : kQuantities) {
    const auto* field = contact.GetDescriptor()->FindFieldByName(quantity.field);
    const double value = contact.GetReflection()->GetDouble(contact, field);
    table.add_row({quantity.label, quantity.symbol,
                   significant(quantity.factor * value + quantity.offset, 6),
                   input_error(contact, quantity), quantity.unit, quantity.equation});
  }
  std::string text = table.text();
  Sheet sheet;
  add_contact_uncertainty(contact, sheet);
  WarningCollector warnings({""}, "", "", {""});
  warnings.add(contact.range_warnings(), 0, 0);
  add_warnings(warnings.warnings(), sheet);
  add_input_warnings(contact.input_warnings(), sheet);
  text +=
      std::string("\nstatus ") +
      (contact.status() == v1::CONTACT_STATUS_NO_LOAD ? "NO_LOAD" : "OK") +
      "; limiting stress at the centre: " + (contact.limiting_stress_at_centre() ? "yes" : "no") +
      " (" + std::to_string(contact.limiting_stress_switches()) +
      " switches); thermal roots: " + std::to_string(contact.thermal_roots()) + "\nmodel version " +
      printable(contact.model_version()) + "\n";
  return text + sheet.text();
}

}  // namespace tribodyn::client
