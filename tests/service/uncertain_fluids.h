#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/uncertainty/drawn_value.h"
#include "proto/resource_kinds.h"
#include "server/contract/resource_names.h"
#include "server/resources/lubricant_parameters.h"
#include "server/simulation/point_comparison.h"
#include "tests/service/support.h"

namespace tribodyn::server {

/// A seed whose numbers are exact: tests state the uncertainties that they need.
template <class Resource>
Resource exact_seed(const std::string& name) {
  auto out = seed<Resource>(name);
  for (auto& entry : *out.mutable_provenance()) entry.clear_standard_uncertainty();
  return out;
}

/// Resources of a test besides the seeds, which are exact.
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
      if (found != bodies.end()) return FoundResource{1, false, found->second};
      auto seeded = seeds(name);
      if (!seeded) return seeded;
#define TRIBODYN_EXACT(Resource, field, collection, seed_id)                \
  if (name.name.starts_with(#collection "/")) {                             \
    seeded->body = exact_seed<v1::Resource>(name.name).SerializeAsString(); \
  }
      TRIBODYN_RESOURCE_KINDS(TRIBODYN_EXACT)
#undef TRIBODYN_EXACT
      return seeded;
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
  auto out = exact_seed<v1::Lubricant>("lubricants/paper-fluid-1");
  const double value = factor * out.pressure_viscosity_coefficient_per_pascal();
  out.set_pressure_viscosity_coefficient_per_pascal(value);
  set_uncertainty(out, kAlpha, relative_uncertainty * value, is_estimate);
  out.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  return out;
}

/// A request with the default draws.
inline v1::ComparePointsRequest request_at(const std::vector<double>& speeds,
                                           const std::vector<std::string>& lubricants) {
  v1::ComparePointsRequest out;
  for (const std::string& each : lubricants) out.add_lubricants(each);
  for (const double speed : speeds) {
    out.add_conditions()->set_speed_kilometres_per_hour(speed);
  }
  return out;
}

/// The answer to a valid request.
inline v1::ComparePointsResponse compare(const v1::ComparePointsRequest& request,
                                         const Fluids& fluids) {
  Violations violations;
  const auto comparison = read_comparison(request, fluids.lookup(), violations);
  if (!comparison) throw std::runtime_error(violations.begin()->description);
  PreparedGearSets gear_sets;
  return compare_points(*comparison, gear_sets, [] { return false; });
}

/// A fluid by its data sheet: kinematic viscosities and density, all else estimated.
inline v1::Lubricant data_sheet(double kinematic_viscosity_40, double kinematic_viscosity_100) {
  v1::Lubricant out;
  out.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  auto& measured = *out.mutable_measurements();
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(kinematic_viscosity_40);
  measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(
      kinematic_viscosity_100);
  measured.set_density_15_celsius_kilograms_per_cubic_metre(868);
  Violations violations;
  complete_parameters(out, "", violations);
  EXPECT_EQ(violations.size(), 0);
  return out;
}

/// Inputs that err in tests of coverage, with the largest of their relative uncertainties.
struct ErringInput {
  const char* field;
  double largest_uncertainty;
};
inline constexpr ErringInput kErring[] = {{kAlpha, 0.25},
                                          {"relaxation_time_seconds", 0.6},
                                          {"havriliak_negami_beta", 0.3},
                                          {"limiting_shear_stress_coefficient", 0.2},
                                          {"thermal_conductivity_watts_per_metre_kelvin", 0.1},
                                          {"vogel_viscosity_prefactor_pascal_seconds", 0.05}};

/// A lubricant as it is, and as a laboratory measures it.
struct MeasuredFluid {
  v1::Lubricant truth, measured;
};

inline MeasuredFluid measured_fluid(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  MeasuredFluid out;
  out.truth = exact_seed<v1::Lubricant>("lubricants/paper-fluid-1");
  out.measured = out.truth;
  for (const ErringInput& input : kErring) {
    const auto* field = v1::Lubricant::descriptor()->FindFieldByName(input.field);
    const auto* reflection = out.truth.GetReflection();
    const double value =
        reflection->GetDouble(out.truth, field) * std::exp(0.2 * (2 * uniform(random) - 1));
    const double relative = input.largest_uncertainty * uniform(random);
    reflection->SetDouble(&out.truth, field, value);
    const double measured = drawn_value(value, relative * value, normal(random));
    reflection->SetDouble(&out.measured, field, measured);
    set_uncertainty(out.measured, input.field, relative * measured);
  }
  return out;
}

}  // namespace tribodyn::server
