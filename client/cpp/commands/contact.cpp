#include <google/protobuf/descriptor.h>

#include <array>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "client/cpp/commands/scenario.h"
#include "client/cpp/report/contact_report.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// A number of the request: its field, unit, allowed range, default and meaning.
struct ContactInput {
  const char* field;
  const char* unit;
  const char* range;
  double standard;
  const char* description;
};

// Defaults: a hypoid flank of a passenger car near 70 km/h; steel; a run-in surface.
constexpr std::array kInputs = {
    ContactInput{"load_newtons", "N", "0 to 1e6", 1000, "Normal load W"},
    ContactInput{"radius_x_metres", "m", "1e-5 to 1e4", 0.02, "Effective radius R_zx along x"},
    ContactInput{"radius_y_metres", "m", "1e-5 to 1e4", 1.09, "Effective radius R_zy along y"},
    ContactInput{"pinion_velocity_x_metres_per_second", "m/s", "-1e3 to 1e3", 5,
                 "Surface velocity u_s,p"},
    ContactInput{"pinion_velocity_y_metres_per_second", "m/s", "-1e3 to 1e3", 6,
                 "Surface velocity v_s,p"},
    ContactInput{"gear_velocity_x_metres_per_second", "m/s", "-1e3 to 1e3", 4,
                 "Surface velocity u_s,g"},
    ContactInput{"gear_velocity_y_metres_per_second", "m/s", "-1e3 to 1e3", -1,
                 "Surface velocity v_s,g"},
    ContactInput{"sump_temperature_celsius", "C", "-70 to 200", 40, "Temperature of the oil bath"},
    ContactInput{"inlet_temperature_rise_kelvin", "K", "0 to 300", 20,
                 "Temperature rise from the oil bath to the inlet (eq 14)"},
    ContactInput{"youngs_modulus_pascals", "Pa", "1e6 to 1e13", 206e9,
                 "Young's modulus of both solids (eq 13)"},
    ContactInput{"poissons_ratio", "-", "-0.99 to 0.5", 0.3,
                 "Poisson's ratio of both solids (eq 13)"},
    ContactInput{"solid_thermal_conductivity_watts_per_metre_kelvin", "W/(m K)", "1e-3 to 1e4", 46,
                 "Thermal conductivity of both solids (eq 35)"},
    ContactInput{"solid_density_kilograms_per_cubic_metre", "kg/m3", "1 to 1e5", 7850,
                 "Density of both solids (eq 35)"},
    ContactInput{"solid_specific_heat_capacity_joules_per_kilogram_kelvin", "J/(kg K)", "1 to 1e5",
                 470, "Specific heat capacity of both solids (eq 35)"},
    ContactInput{"asperity_density_per_square_metre", "1/m2", "1e3 to 1e16", 2.5e9,
                 "Greenwood-Tripp eta_G (eq 41)"},
    ContactInput{"asperity_radius_metres", "m", "1e-9 to 1", 40e-6,
                 "Greenwood-Tripp beta_G (eq 41)"},
    ContactInput{"composite_rms_height_metres", "m", "1e-10 to 1e-2", 0.4e-6,
                 "Roughness sigma_G of both surfaces (eq 41)"},
    ContactInput{"tribofilm_shear_strength_pascals", "Pa", "0 to 1e9", 2e6, "tau_0 of eq 40"},
    ContactInput{"asperity_friction_coefficient", "-", "0 to 2", 0.17, "zeta of eq 40"},
};

/// The 95 % interval ends at the fifth draw from either end.
constexpr int kContactDraws = 199;

void set_number(v1::EvaluateContactRequest& request, const char* field, double value) {
  request.GetReflection()->SetDouble(
      &request, v1::EvaluateContactRequest::descriptor()->FindFieldByName(field), value);
}

void add_contact_flags(FlagList& list, v1::EvaluateContactRequest& request) {
  list.group("Contact");
  request.set_lubricant("lubricants/paper-fluid-1");
  list.text("--lubricant,-l", "NAME",
            "Lubricant, e.g. my-oil or lubricants/my-oil. Default: paper-fluid-1.",
            [&request](const std::string& name) {
              request.set_lubricant(resource_name("lubricants", name));
            });
  for (const ContactInput& input : kInputs) {
    set_number(request, input.field, input.standard);
    const bool is_sump = std::string_view(input.field) == "sump_temperature_celsius";
    list.number(
        flag_of_field(input.field) + (is_sump ? ",--sump" : ""),
        {input.unit, input.range, significant(input.standard)}, input.description,
        [&request, field = input.field](double value) { set_number(request, field, value); });
  }
  list.group("Uncertainty");
  request.set_draws(kContactDraws);
  list.whole_number("--draws", {"-", "0, or 19 to 1999", significant(kContactDraws)},
                    "Draws of the lubricant's parameters for the uncertainties of the figures; 0: "
                    "none",
                    [&request](int value) { request.set_draws(value); });
  add_model_flags(list, *request.mutable_model_options());
}

/// Adds a cell for each figure, whether it has an uncertainty or not: equal commands have equal
/// headers.
void append_uncertainties(const v1::EvaluateContactResponse& contact, CsvRow& row) {
  std::map<std::string, double> uncertainties;
  for (const v1::UncertainContactFigure& each : contact.uncertainties()) {
    uncertainties[each.figure()] = each.value().standard_uncertainty();
  }
  const auto& descriptor = *contact.GetDescriptor();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const auto* field = descriptor.field(i);
    if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) continue;
    const auto found = uncertainties.find(field->name());
    row.emplace_back(field->name() + "_standard_uncertainty",
                     found == uncertainties.end() ? "" : shortest(found->second));
  }
}

int run_contact(const v1::EvaluateContactRequest& request, const CommonOptions& options) {
  const v1::EvaluateContactResponse contact = options.connect().evaluate_contact(request);
  switch (options.output_format) {
    case OutputFormat::kTable:
      std::cout << contact_report(contact);
      break;
    case OutputFormat::kCsv: {
      CsvRow row;
      v1::EvaluateContactResponse figures = contact;
      figures.clear_friction_shares();
      figures.clear_inputs_without_uncertainty();
      figures.clear_uncertainties();
      append_fields(figures, "", row);
      append_uncertainties(contact, row);
      std::cout << csv_text({row});
      break;
    }
    case OutputFormat::kJson:
      std::cout << json_text(contact);
  }
  return kExitOk;
}

}  // namespace

Command contact_command() {
  const auto request = std::make_shared<v1::EvaluateContactRequest>();
  Command command{
      "contact",
      "one flank contact from explicit inputs, with every intermediate quantity",
      "Solves one lubricated flank contact and prints every quantity with symbol and equation, and "
      "with the standard uncertainty that the stated uncertainties of the lubricant make. x is the "
      "direction of radius x, y that of radius y. The defaults are a typical hypoid flank.",
      {"tribodyn contact --lubricant paper-fluid-1 --load-newtons 2000",
       "tribodyn contact --lubricant paper-fluid-2 --gear-velocity-y-metres-per-second 0 "
       "--newtonian "
       "--output csv"},
      {},
      {},
      {}};
  add_contact_flags(command.flags, *request);
  command.main_flags = {"--lubricant",
                        "--load-newtons",
                        "--radius-x-metres",
                        "--radius-y-metres",
                        "--pinion-velocity-x-metres-per-second",
                        "--pinion-velocity-y-metres-per-second",
                        "--gear-velocity-x-metres-per-second",
                        "--gear-velocity-y-metres-per-second",
                        "--sump",
                        "--inlet-temperature-rise-kelvin"};
  command.run = [request](const CommonOptions& options) { return run_contact(*request, options); };
  return command;
}

}  // namespace tribodyn::client
