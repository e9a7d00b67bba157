#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "client/cpp/report/resource_report.h"
#include "client/cpp/text/colour.h"
#include "client/cpp/text/table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

std::string residual_table(const v1::LubricantCharacterisation& fluid) {
  Table table({{"Viscosity at", "C"}, {"measured", "mPa s"}, {"fitted", "mPa s"}, {"off by", "%"}});
  for (const auto& residual : fluid.viscosity_residuals()) {
    table.add_row({significant(residual.temperature_celsius()),
                   significant(residual.measured_dynamic_viscosity_millipascal_seconds()),
                   significant(residual.fitted_dynamic_viscosity_millipascal_seconds()),
                   fixed(100 * std::expm1(-residual.residual()), 2)});
  }
  return table.text();
}

/// Returns the largest differences between the two laws, below and above.
std::string comparison_text(const v1::LubricantCharacterisation& fluid) {
  double lowest = 0;
  double highest = 0;
  for (const auto& at : fluid.walther_comparison()) {
    const double difference = at.vogel_dynamic_viscosity_millipascal_seconds() /
                                  at.walther_dynamic_viscosity_millipascal_seconds() -
                              1;
    lowest = std::min(lowest, difference);
    highest = std::max(highest, difference);
  }
  const auto& table = fluid.walther_comparison();
  return wrapped("Between " + significant(table.begin()->temperature_celsius()) + " and " +
                     significant(table.rbegin()->temperature_celsius()) +
                     " C the fitted Vogel law differs from ASTM D341 (same data) by " +
                     fixed(100 * lowest, 1) + " to +" + fixed(100 * highest, 1) + " %.",
                 2);
}

/// Returns the warnings. Estimated parameters share one line: the table of parameters shows the
/// uncertainty and source of each.
std::string warnings_text(const v1::LubricantCharacterisation& fluid) {
  std::vector<std::string> estimated;
  std::string text;
  const auto add = [&](const std::string& sentence) {
    text += caution(wrapped("! " + printable(sentence), 2));
  };
  for (const auto& warning : fluid.warnings()) {
    if (warning.code() == "PARAMETER_ESTIMATED") {
      estimated.push_back(label_of_field(warning.field()));
    } else {
      add(warning.sentence());
    }
  }
  if (!estimated.empty()) {
    add("Estimated, not measured (uncertainty and source: see the parameters): " +
        joined(estimated, ", ") + ".");
  }
  return text;
}

}  // namespace

std::string characterisation_sheet(const v1::Lubricant& lubricant) {
  if (!lubricant.has_characterisation()) return "";
  const v1::LubricantCharacterisation& fluid = lubricant.characterisation();
  Sheet sheet;
  sheet.heading("Data-sheet values");
  sheet.line("KV40",
             significant(fluid.kinematic_viscosity_40_celsius_square_millimetres_per_second()),
             "mm2/s");
  sheet.line("KV100",
             significant(fluid.kinematic_viscosity_100_celsius_square_millimetres_per_second()),
             "mm2/s");
  if (fluid.has_viscosity_index()) {
    sheet.line("viscosity index", significant(fluid.viscosity_index(), 3), "", "ASTM D2270");
  }
  sheet.line("density at 15 C", significant(fluid.density_15_celsius_kilograms_per_cubic_metre()),
             "kg/m3");
  sheet.line("SAE J306 grade", fluid.sae_j306_grade().empty() ? "none" : fluid.sae_j306_grade());
  if (fluid.has_temperature_of_150_pascal_seconds_celsius()) {
    sheet.line("reaches 150 Pa s at",
               significant(fluid.temperature_of_150_pascal_seconds_celsius(), 3), "C",
               "fitted law; consistent with " + (fluid.expected_low_temperature_grade().empty()
                                                     ? std::string("no W grade")
                                                     : fluid.expected_low_temperature_grade()));
  }
  if (!fluid.sae_j306_grade_note().empty()) sheet.remark("Grade: " + fluid.sae_j306_grade_note());
  std::string text = "\n" + sheet.text();
  // A law with as many parameters as viscosities fits exactly: no residuals to show.
  if (fluid.root_mean_square_residual() > 1e-9) {
    text += "\n" + residual_table(fluid) + "  root mean square " +
            fixed(100 * fluid.root_mean_square_residual(), 2) + " %\n";
  }
  if (fluid.walther_comparison_size() > 0) text += comparison_text(fluid);
  const std::string warnings = warnings_text(fluid);
  return text +
         (warnings.empty() ? "" : "\n" + heading("Limits of these values") + "\n" + warnings);
}

std::string characterisation_warnings(const v1::Lubricant& lubricant) {
  return warnings_text(lubricant.characterisation());
}

}  // namespace tribodyn::client
