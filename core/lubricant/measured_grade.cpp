#include "core/lubricant/measured_grade.h"

#include "core/celsius.h"
#include "core/lubricant/gross_errors.h"
#include "core/lubricant/viscosity.h"
#include "core/number_text.h"

namespace tribodyn {
namespace {

bool is_cold(const MeasuredViscosity& each) {
  return each.measurement == Measurement::kColdViscosity ||
         (each.measurement == Measurement::kViscosity && each.point.temperature < kZeroCelsius);
}

}  // namespace

GearViscosityGrade measured_grade(const FluidMeasurements& fluid, const CharacterisedFluid& known) {
  GearViscosityGrade grade;
  const auto add = [&grade](const std::string& sentence) {
    grade.note += (grade.note.empty() ? "" : " ") + sentence;
  };
  const auto& sheared = fluid.sheared_kinematic_viscosity_100;
  const auto& viscosity = sheared ? sheared : fluid.kinematic_viscosity_100;
  if (!viscosity) {
    const std::string law = gear_viscosity_grade(known.kinematic_viscosity_100, {}).designation;
    add("SAE J306 grades measured viscosities, and KV100 was not measured" +
        (law.empty() ? std::string(".") : "; that of the law would make grade " + law + "."));
    return grade;
  }
  std::vector<ViscosityPoint> cold;
  std::string contradictions;
  for (const MeasuredViscosity& each : known.measured_viscosities) {
    if (!is_cold(each)) continue;
    const double law = ambient_viscosity(known.lubricant, each.point.temperature);
    if (!contradicts(gross_error_limit("VISCOSITY_CONTRADICTED"), each.point, law)) {
      cold.push_back(each.point);
    } else {
      contradictions += " The viscosity at " + celsius_text(each.point.temperature) +
                        " contradicts the law and proves no W grade.";
    }
  }
  grade = gear_viscosity_grade(viscosity, cold);
  if (!contradictions.empty()) add(contradictions.substr(1));
  if (!sheared && !grade.designation.empty()) {
    add("Based on the fresh oil: SAE J306 requires the limits at 100 C after the 20 h KRL shear "
        "test (CEC L-45).");
  }
  return grade;
}

}  // namespace tribodyn
