#include "core/lubricant/characterisation.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "core/celsius.h"
#include "core/lubricant/gross_errors.h"
#include "core/lubricant/measured_grade.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/viscosity_index.h"
#include "core/lubricant/walther_vogel.h"
#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {
namespace {

constexpr double kKinematicUncertainty = 0.005;        // relative, ASTM D445
constexpr double kBrookfieldUncertainty = 0.05;        // relative, ASTM D2983
constexpr double kWaltherTemperatureUncertainty = 15;  // of the T_0 that follows D341 [K]
constexpr double kMisfit = 3;                          // standard deviations worth a warning
// Viscosity indices of oils: naphthenic ones reach down, polymer-thickened hydraulic oils up. Below
// are aromatic extracts, above silicones.
constexpr double kLeastUsualIndex = -60, kMostUsualIndex = 300;

using Stated = LubricantParameters<std::optional<KnownParameter>>;
using Known = LubricantParameters<KnownParameter>;

// Gathers a fluid step by step: density, viscosity, then what rests on both.
class Assembly {
 public:
  explicit Assembly(const FluidMeasurements& fluid) : fluid_(fluid) {}

  CharacterisedFluid result() {
    check_measurements();
    check_stated_parameters(fluid_.stated);
    settle_density();
    settle_viscosity();
    take_values();
    check_law();
    settle_pressure_viscosity();
    settle_rheology();
    settle_rest();
    take_values();
    warn_of_unspecified_base_oil();
    describe();
    out_.gross_errors = gross_errors(fluid_, out_);
    return std::move(out_);
  }

 private:
  void take_values() {
    out_.lubricant = values_of(out_.parameters);
    out_.lubricant.pressure_viscosity_law = fluid_.pressure_viscosity_law;
    out_.lubricant.law_parameters = fluid_.law_parameters;
  }

  void warn(const char* code, const char* parameter, const std::string& sentence) {
    out_.warnings.push_back({code, parameter, sentence});
  }

  // Only where an estimate depends on the class.
  void warn_of_unspecified_base_oil() {
    if (fluid_.base_oil != BaseOilClass::kUnspecified) return;
    constexpr const char* kByClass[] = {"pressure_viscosity_coefficient",
                                        "limiting_shear_stress_coefficient", "thermal_conductivity",
                                        "density_at_zero_kelvin", "density_temperature_slope"};
    const bool matters =
        std::any_of(out_.warnings.begin(), out_.warnings.end(), [&](const auto& warning) {
          return std::find(std::begin(kByClass), std::end(kByClass), warning.parameter) !=
                 std::end(kByClass);
        });
    if (!matters) return;
    out_.warnings.insert(
        out_.warnings.begin(),
        {"BASE_OIL_UNSPECIFIED", "",
         "The class of base oil is not set; the estimates are generic values of lubricating "
         "oils."});
  }

  void check_kinematic(const std::optional<double>& viscosity, const char* field) const {
    if (!viscosity ||
        (*viscosity >= kLowestKinematicViscosity && *viscosity <= kHighestKinematicViscosity)) {
      return;
    }
    throw Refusal("PARAMETER_OUT_OF_RANGE", std::string(field) + " of " +
                                                number_text(1e6 * *viscosity) +
                                                " mm2/s is outside 0.21 to 2e7 mm2/s.");
  }

  void check_measurements() const {
    check_kinematic(fluid_.kinematic_viscosity_40, "kinematic_viscosity_40");
    check_kinematic(fluid_.kinematic_viscosity_100, "kinematic_viscosity_100");
    check_kinematic(fluid_.sheared_kinematic_viscosity_100, "sheared_kinematic_viscosity_100");
  }

  // True when the whole set is stated, false when nothing of it is.
  bool stated_set(std::initializer_list<std::optional<KnownParameter> Stated::*> members,
                  const char* set) const {
    const auto given =
        static_cast<std::size_t>(std::count_if(members.begin(), members.end(), [&](auto member) {
          return (fluid_.stated.*member).has_value();
        }));
    if (given != 0 && given != members.size()) {
      throw Refusal("PARAMETER_INCOMPLETE", std::string(set) + " count only together; " +
                                                std::to_string(given) + " of " +
                                                std::to_string(members.size()) + " are stated.");
    }
    return given != 0;
  }

  void settle_density() {
    Known& p = out_.parameters;
    if (stated_set({&Stated::density_at_zero_kelvin, &Stated::density_temperature_slope},
                   "The two parameters of the density law")) {
      p.density_at_zero_kelvin = *fluid_.stated.density_at_zero_kelvin;
      p.density_temperature_slope = *fluid_.stated.density_temperature_slope;
      density_ = {p.density_at_zero_kelvin.value, p.density_temperature_slope.value,
                  p.density_at_zero_kelvin.standard_uncertainty.value_or(0),
                  p.density_temperature_slope.standard_uncertainty.value_or(0)};
      return;
    }
    std::vector<DensityPoint> points = fluid_.densities;
    if (fluid_.density_15) points.insert(points.begin(), {288.15, *fluid_.density_15});
    if (points.empty()) {
      const Estimate typical = estimate_density_15(fluid_.base_oil);
      density_ = density_law(typical.value, fluid_.base_oil);
      if (fluid_.kinematic_viscosity_40 || fluid_.kinematic_viscosity_100) {
        estimated_density_uncertainty_ = typical.standard_uncertainty / typical.value;
      }
      density_.density_at_zero_uncertainty =
          std::hypot(density_.density_at_zero_uncertainty, typical.standard_uncertainty);
      set_density(Provenance::kAssumed, "density at 15 C " + typical.source +
                                            "; expansion by ASTM D1250, lubricating oils");
      warn("DENSITY_ESTIMATED", "density_at_zero_kelvin",
           "No density is given: " + known_text(typical.value, typical.standard_uncertainty) +
               " kg/m3 at 15 C within " + number_text(typical.standard_uncertainty, 2) + ", " +
               typical.source + ".");
      return;
    }
    const auto [coldest, warmest] = std::minmax_element(
        points.begin(), points.end(),
        [](const DensityPoint& a, const DensityPoint& b) { return a.temperature < b.temperature; });
    // density_law refuses what is out of range, so read the temperatures only after it
    density_ = points.size() == 1 && fluid_.density_15
                   ? density_law(*fluid_.density_15, fluid_.base_oil)
                   : density_law(points, fluid_.base_oil);
    if (warmest->temperature - coldest->temperature >= 1) {
      set_density(Provenance::kFitted,
                  "least squares through " + std::to_string(points.size()) + " densities");
      return;
    }
    set_density(Provenance::kDerived, "density measured at " + celsius_text(coldest->temperature) +
                                          "; expansion by ASTM D1250, lubricating oils");
    warn("EXPANSION_ESTIMATED", "density_temperature_slope",
         "Density is known at one temperature; it changes by " +
             known_text(density_.slope, density_.slope_uncertainty) + " kg/(m3 K) within " +
             number_text(density_.slope_uncertainty, 2) + " (ASTM D1250, lubricating oils).");
  }

  void set_density(Provenance provenance, const std::string& source) {
    out_.parameters.density_at_zero_kelvin = {
        density_.density_at_zero_kelvin, density_.density_at_zero_uncertainty, provenance, source};
    out_.parameters.density_temperature_slope = {density_.slope, density_.slope_uncertainty,
                                                 provenance, source};
  }

  double density_at(double temperature) const {
    return density_.density_at_zero_kelvin + density_.slope * temperature;
  }

  void add_viscosity(Measurement measurement, std::size_t row, ViscosityPoint point,
                     double typical_uncertainty) {
    if (point.relative_standard_uncertainty == 0) {
      point.relative_standard_uncertainty = typical_uncertainty;
    }
    out_.measured_viscosities.push_back({measurement, row, point});
  }

  void gather_viscosities() {
    const auto add_kinematic = [&](Measurement measurement, const std::optional<double>& viscosity,
                                   double temperature) {
      if (!viscosity) return;
      add_viscosity(measurement, 0, {temperature, *viscosity * density_at(temperature), 0},
                    kKinematicUncertainty);
    };
    add_kinematic(Measurement::kKinematicViscosity40, fluid_.kinematic_viscosity_40, kFortyCelsius);
    add_kinematic(Measurement::kKinematicViscosity100, fluid_.kinematic_viscosity_100,
                  kHundredCelsius);
    for (std::size_t i = 0; i < fluid_.viscosities.size(); ++i) {
      add_viscosity(Measurement::kViscosity, i, fluid_.viscosities[i],
                    kTypicalViscosityUncertainty);
    }
    for (std::size_t i = 0; i < fluid_.cold_viscosities.size(); ++i) {
      add_viscosity(Measurement::kColdViscosity, i, fluid_.cold_viscosities[i],
                    kBrookfieldUncertainty);
    }
  }

  void settle_viscosity() {
    Known& p = out_.parameters;
    gather_viscosities();
    if (stated_set({&Stated::vogel_viscosity_prefactor, &Stated::vogel_temperature_coefficient,
                    &Stated::vogel_reference_temperature},
                   "The three Vogel parameters")) {
      p.vogel_viscosity_prefactor = *fluid_.stated.vogel_viscosity_prefactor;
      p.vogel_temperature_coefficient = *fluid_.stated.vogel_temperature_coefficient;
      p.vogel_reference_temperature = *fluid_.stated.vogel_reference_temperature;
      return;
    }
    const auto& measured = out_.measured_viscosities;
    if (measured.size() < 2) {
      throw Refusal("FLUID_UNDERDETERMINED",
                    "Give viscosities at two or more temperatures, e.g. kinematic ones at 40 and "
                    "100 C; " +
                        std::to_string(measured.size()) + " given.");
    }
    std::vector<ViscosityPoint> points;
    for (const MeasuredViscosity& each : measured) points.push_back(each.point);
    std::optional<ViscosityTemperatureLine> line;
    if (fluid_.kinematic_viscosity_40 && fluid_.kinematic_viscosity_100) {
      line = viscosity_temperature_line({kFortyCelsius, *fluid_.kinematic_viscosity_40},
                                        {kHundredCelsius, *fluid_.kinematic_viscosity_100});
    }
    const bool kinematic_alone = line && points.size() == 2;
    std::string source;
    if (kinematic_alone) {
      out_.viscosity_fit = fit_vogel_at(points, walther_reference_temperature(*line, density_),
                                        kWaltherTemperatureUncertainty);
      source = "through the kinematic viscosities at 40 and 100 C, T_0 following ASTM D341";
    } else {
      out_.viscosity_fit = fitted(points);
      source = "least squares through " + std::to_string(points.size()) + " viscosities";
    }
    const VogelFit& fit = *out_.viscosity_fit;
    const auto deviation = [&](int i) { return std::sqrt(fit.covariance(i, i)); };
    p.vogel_viscosity_prefactor = {fit.viscosity_prefactor, fit.viscosity_prefactor * deviation(0),
                                   Provenance::kFitted, source};
    p.vogel_temperature_coefficient = {fit.temperature_coefficient, deviation(1),
                                       Provenance::kFitted, source};
    const bool assumed = fit.reference_temperature_assumed && !kinematic_alone;
    p.vogel_reference_temperature = {
        fit.reference_temperature, deviation(2),
        assumed ? Provenance::kAssumed : Provenance::kFitted,
        assumed ? "typical of gear oils: the viscosities leave it open" : source};
    if (assumed) {
      warn("VOGEL_REFERENCE_TEMPERATURE_ASSUMED", "vogel_reference_temperature",
           "T_0 cannot be fitted to the given viscosities and was set to " +
               known_text(fit.reference_temperature, deviation(2)) + " +/- " +
               number_text(deviation(2), 2) +
               " K. Add a viscosity at a third temperature far from the others, best a low one, to "
               "determine it.");
    }
    if (kinematic_alone) {
      constexpr double kCold = 263.15;
      warn("VOGEL_REFERENCE_TEMPERATURE_ASSUMED", "vogel_reference_temperature",
           "T_0 cannot be fitted to two viscosities and was set from ASTM D341 to " +
               known_text(fit.reference_temperature, deviation(2)) + " +/- " +
               number_text(deviation(2), 2) + " K; the viscosity at " + celsius_text(kCold) +
               " is then uncertain by " +
               number_text(100 * relative_viscosity_uncertainty(fit, kCold), 2) +
               " %. Add a viscosity at a low temperature to determine it.");
    }
    warn_of_misfits(fit);
    warn_of_extrapolation();
    if (line) compare_with_walther(*line, fit);
  }

  VogelFit fitted(const std::vector<ViscosityPoint>& points) const {
    try {
      return fit_vogel(points);
    } catch (const Refusal& refusal) {
      throw Refusal(refusal.reason(), refusal.what() + likely_slip(out_.measured_viscosities));
    }
  }

  // By how much the law is off the measurement: on the basis of the table of residuals.
  void warn_of_misfits(const VogelFit& fit) {
    for (std::size_t i = 0; i < fit.residuals.size(); ++i) {
      const ViscosityPoint& point = out_.measured_viscosities[i].point;
      const double off = std::expm1(-fit.residuals[i]);
      if (std::abs(fit.residuals[i]) <= kMisfit * point.relative_standard_uncertainty) continue;
      warn("VISCOSITY_MISFIT", "vogel_viscosity_prefactor",
           "The fitted law is " + number_text(100 * std::abs(off), 3) + " % " +
               (off > 0 ? "above" : "below") + " the viscosity measured at " +
               celsius_text(point.temperature) + ", more than three times its uncertainty.");
    }
  }

  void warn_of_extrapolation() {
    const auto [coldest, warmest] =
        std::minmax_element(out_.measured_viscosities.begin(), out_.measured_viscosities.end(),
                            [](const MeasuredViscosity& a, const MeasuredViscosity& b) {
                              return a.point.temperature < b.point.temperature;
                            });
    if (coldest->point.temperature <= kFortyCelsius + 0.5 &&
        warmest->point.temperature >= kHundredCelsius - 0.5) {
      return;
    }
    warn("VISCOSITY_EXTRAPOLATED", "vogel_viscosity_prefactor",
         "Viscosity was measured from " + celsius_text(coldest->point.temperature) + " to " +
             celsius_text(warmest->point.temperature) +
             "; axle oil works from below 40 to above 100 C, where the law extrapolates.");
  }

  void compare_with_walther(const ViscosityTemperatureLine& line, const VogelFit& fit) {
    for (int celsius = -10; celsius <= 150; celsius += 10) {
      const double temperature = kZeroCelsius + celsius;
      if (temperature <= fit.reference_temperature) continue;
      try {
        const double walther =
            tribodyn::kinematic_viscosity(line, temperature) * density_at(temperature);
        const double vogel = std::exp(log_viscosity(fit, temperature));
        if (std::isfinite(vogel)) out_.walther_comparison.push_back({temperature, walther, vogel});
      } catch (const Refusal&) {  // the line ends here
      }
    }
  }

  // The laws must hold where everything else is evaluated.
  void check_law() const {
    const Lubricant& fluid = out_.lubricant;
    for (const double temperature : {kFortyCelsius, kTypicalRheologyTemperature, kHundredCelsius}) {
      const bool warm = temperature > fluid.vogel_reference_temperature;
      const double viscosity = warm ? ambient_viscosity(fluid, temperature) : 0;
      const double rho = density(fluid, temperature);
      if (warm && std::isnormal(viscosity) && viscosity < 1e12 && rho > 0) continue;
      throw Refusal("PARAMETER_OUT_OF_RANGE",
                    "At " + celsius_text(temperature) + " the laws of viscosity and density give " +
                        (warm ? number_text(viscosity) + " Pa s" : "no viscosity") + " and " +
                        number_text(rho) + " kg/m3.");
    }
  }

  // A stated parameter, or an estimate with its warning.
  void settle(std::optional<KnownParameter> Stated::*stated, KnownParameter Known::*known,
              const char* parameter, double in_unit, const char* unit, const auto& estimator) {
    if (fluid_.stated.*stated) {
      out_.parameters.*known = *(fluid_.stated.*stated);
      return;
    }
    const Estimate estimate = estimator();
    out_.parameters.*known = {estimate.value, estimate.standard_uncertainty, Provenance::kAssumed,
                              std::string(name(fluid_.base_oil)) + " base oil: " + estimate.source};
    warn("PARAMETER_ESTIMATED", parameter,
         std::string(parameter) + " is not measured: " +
             within_text(in_unit * estimate.value, in_unit * estimate.standard_uncertainty) + unit +
             " (" + name(fluid_.base_oil) + " base oil; " + estimate.source + ").");
    if (!estimate.inside_range) {
      warn("ESTIMATE_OUT_OF_RANGE", parameter,
           std::string("The estimate of ") + parameter +
               " is for the edge of its range: the fluid lies outside.");
    }
  }

  // A temperature that belongs to another parameter.
  void settle_temperature(std::optional<KnownParameter> Stated::*temperature,
                          KnownParameter Known::*known, const char* parameter, bool belongs,
                          double typical) {
    if (fluid_.stated.*temperature && belongs) {
      out_.parameters.*known = *(fluid_.stated.*temperature);
      return;
    }
    out_.parameters.*known = {typical, std::nullopt, Provenance::kAssumed,
                              belongs ? "not stated" : "temperature of the estimate"};
    if (belongs) {
      warn("TEMPERATURE_ASSUMED", parameter,
           std::string(parameter) + " is not stated; " + celsius_text(typical) + " is taken.");
    }
  }

  // alpha* of a law that determines it.
  void settle_pressure_viscosity_by_law() {
    check_greatest_viscosity(out_.lubricant, kFortyCelsius);
    const GrowthLaw<double> law =
        laws::growth_law(out_.lubricant, std::log(out_.lubricant.vogel_viscosity_prefactor));
    constexpr char kSource[] = "of the pressure-viscosity law at 40 C";
    out_.parameters.pressure_viscosity_temperature = {kFortyCelsius, std::nullopt,
                                                      Provenance::kDerived, kSource};
    out_.parameters.pressure_viscosity_coefficient = {
        reciprocal_asymptotic_of_growth(law, kFortyCelsius), std::nullopt, Provenance::kDerived,
        kSource};
  }

  void settle_pressure_viscosity() {
    if (fluid_.pressure_viscosity_law != PressureViscosityLaw::kRoelands) {
      settle_pressure_viscosity_by_law();
      return;
    }
    settle_temperature(&Stated::pressure_viscosity_temperature,
                       &Known::pressure_viscosity_temperature, "pressure_viscosity_temperature",
                       fluid_.stated.pressure_viscosity_coefficient.has_value(), kFortyCelsius);
    settle(&Stated::pressure_viscosity_coefficient, &Known::pressure_viscosity_coefficient,
           "pressure_viscosity_coefficient", 1e9, " 1/GPa", [&] {
             const double v40 = kinematic_viscosity(out_.lubricant, kFortyCelsius);
             return estimate_pressure_viscosity_coefficient(
                 fluid_.base_oil, v40, density_at(kFortyCelsius), line_slope(v40));
           });
  }

  // B of ASTM D341 for the law itself; NaN, and so outside every range, where D341 has no line.
  double line_slope(double v40) const {
    try {
      const double v100 = kinematic_viscosity(out_.lubricant, kHundredCelsius);
      return viscosity_temperature_line({kFortyCelsius, v40}, {kHundredCelsius, v100}).slope;
    } catch (const Refusal&) {
      return NAN;
    }
  }

  void settle_rheology() {
    settle_temperature(&Stated::rheology_reference_temperature,
                       &Known::rheology_reference_temperature, "rheology_reference_temperature",
                       fluid_.stated.relaxation_time.has_value(), kTypicalRheologyTemperature);
    settle(&Stated::relaxation_time, &Known::relaxation_time, "relaxation_time", 1e6, " us", [&] {
      return estimate_relaxation_time(
          ambient_viscosity(out_.lubricant, kTypicalRheologyTemperature));
    });
    settle(&Stated::havriliak_negami_alpha, &Known::havriliak_negami_alpha,
           "havriliak_negami_alpha", 1, "", estimate_havriliak_negami_alpha);
    settle(&Stated::havriliak_negami_beta, &Known::havriliak_negami_beta, "havriliak_negami_beta",
           1, "", estimate_havriliak_negami_beta);
  }

  void settle_rest() {
    settle(&Stated::limiting_shear_stress_at_zero_pressure,
           &Known::limiting_shear_stress_at_zero_pressure, "limiting_shear_stress_at_zero_pressure",
           1e-6, " MPa",
           [&] { return estimate_limiting_shear_stress_at_zero_pressure(fluid_.base_oil); });
    settle(&Stated::limiting_shear_stress_coefficient, &Known::limiting_shear_stress_coefficient,
           "limiting_shear_stress_coefficient", 1, "",
           [&] { return estimate_limiting_shear_stress_coefficient(fluid_.base_oil); });
    settle(&Stated::thermal_conductivity, &Known::thermal_conductivity, "thermal_conductivity", 1,
           " W/(m K)", [&] {
             return estimate_thermal_conductivity(fluid_.base_oil, density_at(288.15),
                                                  kFortyCelsius);
           });
  }

  void describe() {
    const Lubricant& fluid = out_.lubricant;
    out_.kinematic_viscosity_40 =
        fluid_.kinematic_viscosity_40.value_or(kinematic_viscosity(fluid, kFortyCelsius));
    out_.kinematic_viscosity_100 =
        fluid_.kinematic_viscosity_100.value_or(kinematic_viscosity(fluid, kHundredCelsius));
    try {
      out_.viscosity_index =
          viscosity_index(1e6 * out_.kinematic_viscosity_40, 1e6 * out_.kinematic_viscosity_100);
    } catch (const Refusal& refusal) {
      warn("VISCOSITY_INDEX_UNDEFINED", "", refusal.what());
    }
    warn_of_unusual_index();
    const std::optional<double>& sheared = fluid_.sheared_kinematic_viscosity_100;
    const std::optional<double> for_grade = sheared ? sheared : fluid_.kinematic_viscosity_100;
    out_.grade = measured_grade(fluid_, out_);
    out_.temperature_of_150_pascal_seconds =
        kColdViscosityLimit > fluid.vogel_viscosity_prefactor
            ? temperature_of_viscosity(fluid, kColdViscosityLimit)
            : fluid.vogel_reference_temperature;
    out_.expected_low_temperature_grade = low_temperature_grade_of(
        out_.temperature_of_150_pascal_seconds, for_grade.value_or(out_.kinematic_viscosity_100));
  }

  void warn_of_unusual_index() {
    if (!out_.viscosity_index) return;
    const double index = *out_.viscosity_index;
    if (index >= kLeastUsualIndex && index <= kMostUsualIndex) return;
    warn("VISCOSITY_INDEX_UNUSUAL", "",
         "The viscosity index is " + number_text(index, 3) + "; usual: " +
             number_text(kLeastUsualIndex) + " to " + number_text(kMostUsualIndex) + ". " +
             (index < kLeastUsualIndex ? "Only aromatic extracts lie below"
                                       : "Only silicones lie above") +
             ": check the viscosities.");
  }

  const FluidMeasurements& fluid_;
  CharacterisedFluid out_{};
  DensityLaw density_{};
  double estimated_density_uncertainty_ = 0;  // relative
};

}  // namespace

CharacterisedFluid characterise(const FluidMeasurements& fluid) { return Assembly(fluid).result(); }

}  // namespace tribodyn
