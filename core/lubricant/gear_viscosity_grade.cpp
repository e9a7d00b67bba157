#include "core/lubricant/gear_viscosity_grade.h"

#include <cmath>

#include "core/celsius.h"
#include "core/number_text.h"

namespace tribodyn {
namespace {

constexpr double kTemperatureTolerance = 0.05;  // K: conversions from Celsius
constexpr double kRounding = 1e-12;             // relative: conversions from mm2/s

struct LowTemperatureGrade {
  const char* name;
  double temperature_celsius;
  double least_viscosity;  // at 100 C [mm2/s]
};
constexpr LowTemperatureGrade kLowTemperatureGrades[] = {
    {"70W", -55, 3.8}, {"75W", -40, 3.8}, {"80W", -26, 8.5}, {"85W", -12, 11.0}};

struct HighTemperatureGrade {
  const char* name;
  double least_viscosity;  // at 100 C [mm2/s]; up to the next one's
};
constexpr HighTemperatureGrade kHighTemperatureGrades[] = {
    {"65", 3.8},  {"70", 5.0},   {"75", 6.5},   {"80", 8.5},   {"85", 11.0},
    {"90", 13.5}, {"110", 18.5}, {"140", 24.0}, {"190", 32.5}, {"250", 41.0}};

bool reaches(double viscosity, double limit) { return viscosity >= limit * (1 - kRounding); }

enum class Verdict { kMet, kMissed, kUnproven };

// What measurements say of 150 Pa s at a temperature, the oil thickening as it cools.
Verdict verdict(std::span<const ViscosityPoint> points, double temperature) {
  Verdict result = Verdict::kUnproven;
  for (const ViscosityPoint& point : points) {
    if (!(point.viscosity > 0) || !std::isfinite(point.temperature)) continue;
    if (point.viscosity > kColdViscosityLimit &&
        point.temperature >= temperature - kTemperatureTolerance) {
      return Verdict::kMissed;
    }
    if (point.viscosity <= kColdViscosityLimit &&
        point.temperature <= temperature + kTemperatureTolerance) {
      result = Verdict::kMet;
    }
  }
  return result;
}

void add(std::string& note, const std::string& sentence) {
  if (!note.empty()) note += ' ';
  note += sentence;
}

}  // namespace

GearViscosityGrade gear_viscosity_grade(std::optional<double> kinematic_viscosity_100,
                                        std::span<const ViscosityPoint> cold_viscosities) {
  GearViscosityGrade grade;
  const double v = kinematic_viscosity_100 ? 1e6 * *kinematic_viscosity_100 : NAN;
  if (!(v > 0 && std::isfinite(v))) {
    grade.note = "SAE J306 wants the kinematic viscosity at 100 C.";
    return grade;
  }
  for (const HighTemperatureGrade& candidate : kHighTemperatureGrades) {
    if (reaches(v, candidate.least_viscosity)) grade.high_temperature_grade = candidate.name;
  }
  if (grade.high_temperature_grade.empty()) {
    grade.note = number_text(v) + " mm2/s at 100 C is below the 3.8 of SAE 65.";
    return grade;
  }
  for (const LowTemperatureGrade& candidate : kLowTemperatureGrades) {
    const Verdict cold = verdict(cold_viscosities, kZeroCelsius + candidate.temperature_celsius);
    if (cold == Verdict::kMissed) continue;
    const std::string limit = std::string(candidate.name) + " (150 Pa s at " +
                              number_text(candidate.temperature_celsius) + " C)";
    if (!reaches(v, candidate.least_viscosity)) {
      if (cold == Verdict::kMet) {
        add(grade.note, limit + " wants " + number_text(candidate.least_viscosity) +
                            " mm2/s at 100 C at least.");
      }
      continue;
    }
    if (cold == Verdict::kMet) {
      grade.low_temperature_grade = candidate.name;
      break;
    }
    if (!cold_viscosities.empty()) add(grade.note, "No measurement shows " + limit + ".");
  }
  if (cold_viscosities.empty()) {
    add(grade.note, "No W grade without a Brookfield viscosity at low temperature.");
  }
  grade.designation = grade.low_temperature_grade.empty()
                          ? grade.high_temperature_grade
                          : grade.low_temperature_grade + "-" + grade.high_temperature_grade;
  return grade;
}

std::string low_temperature_grade_of(double temperature_of_150_pascal_seconds,
                                     double kinematic_viscosity_100) {
  for (const LowTemperatureGrade& candidate : kLowTemperatureGrades) {
    if (temperature_of_150_pascal_seconds <=
            kZeroCelsius + candidate.temperature_celsius + kTemperatureTolerance &&
        reaches(1e6 * kinematic_viscosity_100, candidate.least_viscosity)) {
      return candidate.name;
    }
  }
  return "";
}

}  // namespace tribodyn
