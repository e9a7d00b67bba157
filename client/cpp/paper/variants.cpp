#include "client/cpp/paper/variants.h"

#include <utility>

namespace tribodyn::client {

const std::vector<TriedVariant>& tried_variants() {
  static const std::vector<TriedVariant> variants = {
      {"as corrected", {}},
      {"no limiting stress", {"no_limiting_shear_stress"}},
      {"no limiting stress, Newtonian", {"no_limiting_shear_stress", "newtonian"}},
      {"Newtonian", {"newtonian"}},
      {"no boundary friction", {"no_boundary_friction"}},
      {"index Z by Houpert (eq 32)", {"houpert"}},
      {"eqs 20, 22 as printed",
       {"as_published.eq20_semi_major", "as_published.eq22_inverted_ratio"}},
      {"eqs 31, 32 as printed", {"as_published.eq31_32_logarithm"}},
      {"eqs 43, 44 as printed", {"as_published.eq43_44_polynomials"}},
      {"eqs 20, 22, 31, 32, 43, 44 as printed",
       {"as_published.eq20_semi_major", "as_published.eq22_inverted_ratio",
        "as_published.eq31_32_logarithm", "as_published.eq43_44_polynomials"}},
      {"inlet shear heating", {"inlet_shear_heating"}},
      {"exact Hertz", {"exact_hertz"}},
      {"ellipse from the total load", {"hertz_from_total_load"}},
      {"motion of the contact point subtracted", {"subtract_contact_point_motion"}},
      {"load-dependent mesh data", {"load_dependent_mesh_data"}},
      {"energy-consistent equations", {"energy_consistent"}},
      {"tabulated friction arms", {"tabulated_friction_arms"}},
      {"damping in contact only", {"damping_in_contact_only"}}};
  return variants;
}

PaperCurve tried_curve(const TriedVariant& variant, bool is_isothermal) {
  PaperCurve out;
  out.switches = variant.switches;
  out.speeds = kTriedSpeeds;
  return is_isothermal ? with(out, "isothermal") : out;
}

PaperCurve with(PaperCurve curve, const std::string& path) {
  curve.switches.push_back(path);
  return curve;
}

}  // namespace tribodyn::client
