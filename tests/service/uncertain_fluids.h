#pragma once

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>

#include "server/contract/resource_names.h"
#include "tests/service/support.h"

namespace tribodyn::server {

/// Resources of a test besides the seeds.
class Fluids {
 public:
  void add(const std::string& name, const google::protobuf::Message& resource) {
    bodies_[name] = resource.SerializeAsString();
  }
  ResourceLookup lookup() const {
    ResourceLookup out = seed_lookup();
    out.find = [seeds = out.find,
                bodies = bodies_](const RevisionName& name) -> std::optional<FoundResource> {
      const auto found = bodies.find(name.name);
      if (found == bodies.end()) return seeds(name);
      return FoundResource{1, false, found->second};
    };
    return out;
  }

 private:
  std::map<std::string, std::string> bodies_;
};

/// Sets the standard uncertainty of a parameter that is measured, or estimated.
inline void set_uncertainty(v1::Lubricant& lubricant, const std::string& field, double uncertainty,
                            bool is_estimate = false) {
  for (v1::ParameterProvenance& entry : *lubricant.mutable_provenance()) {
    if (entry.field() != field) continue;
    entry.set_standard_uncertainty(uncertainty);
    entry.set_provenance(is_estimate ? v1::PROVENANCE_ASSUMED : v1::PROVENANCE_MEASURED);
    entry.set_computed(is_estimate);
    return;
  }
  ADD_FAILURE() << field;
}

inline constexpr char kAlpha[] = "pressure_viscosity_coefficient_per_pascal";

/// Fluid 1 with a pressure-viscosity coefficient known to 5 % or so.
inline v1::Lubricant fluid_with_alpha(double factor = 1, double relative_uncertainty = 0.05,
                                      bool is_estimate = false) {
  auto out = seed<v1::Lubricant>("lubricants/paper-fluid-1");
  const double value = factor * out.pressure_viscosity_coefficient_per_pascal();
  out.set_pressure_viscosity_coefficient_per_pascal(value);
  set_uncertainty(out, kAlpha, relative_uncertainty * value, is_estimate);
  out.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  return out;
}

}  // namespace tribodyn::server
