#include "core/study/range_warnings.h"

#include <string>

#include "core/celsius.h"
#include "core/number_text.h"

namespace tribodyn {

std::vector<RangeWarning> range_warnings(const Scene& scene, const PointResult& r) {
  std::vector<RangeWarning> out;
  const auto warn = [&out](const char* code, const std::string& sentence) {
    out.push_back({code, sentence});
  };
  const double inlet = scene.sump_temperature + scene.inlet_temperature_rise - kZeroCelsius;
  const double hottest = r.contact_temperature.maximum - kZeroCelsius;
  if (inlet < 10 || hottest > 140) {
    warn("VISCOSITY_TEMPERATURE", "film between " + number_text(inlet) + " and " +
                                      number_text(hottest) +
                                      " degrees Celsius; the viscosity law was measured from 10 to "
                                      "140 (section 2.3 of the paper)");
  }
  if (r.maximum_pressure.maximum > 1.35e9) {
    warn("PRESSURE",
         "maximum pressure " + number_text(r.maximum_pressure.maximum * 1e-9) +
             " GPa; the friction model was compared with measurements from 0.85 to 1.35 "
             "GPa (fig 5)");
  }
  if (r.film_ratio.minimum < 0.5 && r.film_ratio.maximum > 0) {
    warn("FILM_RATIO", "film ratio down to " + number_text(r.film_ratio.minimum) +
                           ": below about 0.5 Greenwood and Tripp's sparse asperities overlap");
  }
  const double product = scene.roughness.asperity_density * scene.roughness.asperity_radius *
                         scene.roughness.composite_rms_height;
  if (product < 0.03 || product > 0.05) {
    warn("ROUGHNESS_PRODUCT", "eta_G beta_G sigma_G is " + number_text(product) +
                                  "; Greenwood and Tripp expect 0.03 to 0.05 for steel on steel");
  }
  if (r.limiting_stress_area_share > 0.5) {
    warn("LIMITING_STRESS",
         number_text(100 * r.limiting_stress_area_share) +
             " % of the loaded area sits on the limiting shear stress, which was "
             "measured at 40 degrees Celsius and is held independent of "
             "temperature");
  }
  if (inlet < 20) {
    warn("COLD_INLET",
         "inlet at " + number_text(inlet) +
             " degrees Celsius: inlet shear heating and starvation are not modelled and "
             "thin the film of cold oil");
  }
  if (!r.settled) {
    warn("NOT_SETTLED", "no period of 1 to 4 mesh cycles settled within " +
                            std::to_string(r.statistics.mesh_cycles) +
                            " mesh cycles: the figures are averages over " +
                            std::to_string(r.recorded_mesh_cycles) + " recorded cycles");
  } else if (r.period_in_mesh_cycles > 1) {
    warn("PERIOD",
         "the response repeats after " + std::to_string(r.period_in_mesh_cycles) + " mesh cycles");
  }
  if (r.model == PointModel::kQuasiStatic) {
    warn("QUASI_STATIC",
         r.estimated_relative_error
             ? "no dynamics: with the grid's error the figures are estimated to be within " +
                   number_text(100 * *r.estimated_relative_error, 2) + " % of the full model's"
             : "no dynamics, and their effect cannot be told: flanks may part, or the mesh "
               "resonates; the inefficiency can be 10 to 45 % low");
  }
  if (r.model == PointModel::kOneDegree) {
    warn("ONE_DEGREE",
         r.estimated_relative_error
             ? "shafts carry constant torques: with the grid's error the figures are estimated to "
               "be within " +
                   number_text(100 * *r.estimated_relative_error, 2) + " % of the full model's"
             : "shafts carry constant torques, and the effect of that cannot be told: flanks part "
               "or may, what the shafts change is not small, or the response was marched");
  }
  if (scene.options.isothermal) {
    warn("ISOTHERMAL", "contact temperature held at the inlet's: friction at speed is too high");
  }
  return out;
}

}  // namespace tribodyn
