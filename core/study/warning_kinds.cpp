#include "core/study/warning_kinds.h"

#include <algorithm>
#include <iterator>

namespace tribodyn {
namespace {

using enum WarningKind::Level;

constexpr WarningKind kKinds[] = {
    {"VISCOSITY_TEMPERATURE", "temperature outside the range in which viscosity was measured",
     kCaution},
    {"PRESSURE", "pressure outside the range in which friction was measured", kCaution},
    {"RADIUS_RATIO", "contact ellipse slimmer than the fits of eqs 21 and 22 hold for", kCaution},
    {"FILM_RATIO", "film thinner than the asperity model holds for", kCaution},
    {"ROUGHNESS_PRODUCT", "roughness outside the range of the asperity model", kCaution},
    {"LIMITING_STRESS", "most of the loaded area on the limiting shear stress", kCaution},
    {"ISOTHERMAL", "isothermal model", kNote},
    {"INLET_HEATING_LEFT_OUT", "film without shear heating of the inlet: do not rank oils here",
     kWithholdsVerdict},
    {"STARVATION", "oil so thick that its film may starve", kCaution},
    {"VISCOSITY_RANGE", "viscosity of no lubricating oil: do not rank oils here",
     kWithholdsVerdict},
    {"THICK_FILM", "film thicker than any contact is fed: do not rank oils here",
     kWithholdsVerdict},
    {"NOT_SETTLED", "no steady period, averages over a record", kWithholdsVerdict},
    {"PERIOD", "response with a period of several mesh cycles", kNote},
    {"QUASI_STATIC", "quasi-static model", kNote},
    {"BARELY_ATTRACTS", "response that hardly attracts", kNote},
    {"FLANKS_TAP", "flanks that tap each other under hardly any load", kCaution},
    {"RESPONSES_COEXIST", "another response at the same point", kCaution},
    {"FLANKS_FLOAT", "flanks that no torque holds together", kCaution},
    {"RATTLES", "rattle, averages with a statistical error", kCaution},
    {"MARCH_TOLERANCE_UNUSED", "tolerance of a march that was not needed", kNote},
    {"NO_SENSITIVITIES", "no sensitivities", kNote},
    {"BASE_OIL_UNSPECIFIED", "class of base oil not stated", kNote},
    {"DENSITY_ESTIMATED", "density estimated, not measured", kNote},
    {"EXPANSION_ESTIMATED", "thermal expansion estimated, not measured", kNote},
    {"PARAMETER_ESTIMATED", "parameters of the fluid estimated, not measured", kNote},
    {"PROFILE_NOT_RESOLVED", "roughness profile of noise or not filtered", kNote},
    {"SURFACE_PARTLY_MEASURED", "roughness measured in part", kNote},
    {"VISCOSITY_EXTRAPOLATED", "viscosity extrapolated in temperature", kNote},
    {"VISCOSITY_MISFIT", "viscosity law misses a measurement", kNote},
    {"VOGEL_REFERENCE_TEMPERATURE_ASSUMED", "curvature of the viscosity law assumed", kNote},
    {"VISCOSITY_INDEX_UNUSUAL", "viscosity index of no gear oil", kCaution},
    {"NO_LUBRICATED_CONTACT", "friction or heat that no oil survives: do not rank oils here",
     kWithholdsVerdict},
};

}  // namespace

std::span<const WarningKind> warning_kinds() { return kKinds; }

int warning_number(std::string_view code) {
  const auto* const found =
      std::find_if(std::begin(kKinds), std::end(kKinds),
                   [code](const WarningKind& each) { return each.code == code; });
  return found == std::end(kKinds) ? -1 : static_cast<int>(found - kKinds);
}

bool withholds_verdict(std::string_view code) {
  const int number = warning_number(code);
  return number >= 0 && kKinds[number].level == kWithholdsVerdict;
}

}  // namespace tribodyn
