#include "server/resources/imports/import_surface.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>
#include <vector>

#include "core/model_options.h"
#include "core/refusal.h"
#include "core/surface/measured_surface.h"
#include "server/contract/constraints.h"
#include "server/mapping/from_core.h"
#include "server/resources/accept_resource.h"
#include "server/resources/imports/read_profiles.h"
#include "server/resources/provenance.h"

namespace tribodyn::server {
namespace {

constexpr const char* kFromProfiles[] = {"asperity_density_per_square_metre",
                                         "asperity_radius_metres", "composite_rms_height_metres"};

/// Adds the provenance of a parameter; `uncertainty` 0: not known.
void add_profile_provenance(const char* field, double uncertainty, const AsPublished& as_published,
                            const std::string& warning, v1::Surface& surface) {
  v1::ParameterProvenance* entry = surface.add_provenance();
  std::string source = "measured profiles, eqs 45 to 48";
  if (as_published.eq46_square_root_of_sum) source += ", eq 46 as published";
  if (uncertainty > 0) {
    source +=
        fmt::format("; uncertainty from the spread of {} profiles", surface.measurements_size());
  }
  entry->set_field(field);
  entry->set_provenance(v1::PROVENANCE_FITTED);
  entry->set_source(source);
  entry->set_standard_uncertainty(uncertainty);
  entry->set_warning(warning);
  entry->set_computed(true);
}

void set_parameters(v1::Surface& surface, const AsPublished& as_published) {
  std::vector<MeasuredProfile> profiles;
  for (const v1::SurfaceMeasurement& each : surface.measurements()) {
    profiles.push_back(measured_profile(each));
  }
  const Roughness roughness = roughness_of_profiles(profiles, as_published);
  const Roughness uncertainty = roughness_uncertainty(profiles, as_published).value_or(Roughness{});
  std::string warning = unmeasured_text(surface.measurements());
  for (const std::string& each :
       {unresolved_text(surface.measurements()), product_text(roughness)}) {
    if (!each.empty()) warning += (warning.empty() ? "" : "; ") + each;
  }
  surface.set_asperity_density_per_square_metre(roughness.asperity_density);
  surface.set_asperity_radius_metres(roughness.asperity_radius);
  surface.set_composite_rms_height_metres(roughness.composite_rms_height);
  const double uncertainties[] = {uncertainty.asperity_density, uncertainty.asperity_radius,
                                  uncertainty.composite_rms_height};
  for (std::size_t k = 0; k < std::size(kFromProfiles); ++k) {
    add_profile_provenance(kFromProfiles[k], uncertainties[k], as_published, warning, surface);
  }
}

/// Adds a violation for each set field that follows from the profiles.
void check_fields_of_profiles_unset(const v1::Surface& surface, Violations& violations) {
  const auto refuse = [&](const std::string& name) {
    violations.add("surface." + name, name + " follows from the profiles; allowed: not set");
  };
  for (const char* name : kFromProfiles) {
    const auto* field = v1::Surface::descriptor()->FindFieldByName(name);
    if (surface.GetReflection()->HasField(surface, field)) refuse(name);
  }
  if (surface.measurements_size() > 0) refuse("measurements");
}

/// Checks the fields that do not follow from the profiles.
void check_other_fields(const v1::Surface& stated, const std::string& name,
                        const ResourceLookup& lookup, Violations& violations) {
  v1::Surface rest = stated;
  rest.set_name(name);
  rest.clear_measurements();
  for (const char* field : kFromProfiles) {
    rest.GetReflection()->SetDouble(&rest, v1::Surface::descriptor()->FindFieldByName(field),
                                    find_constraint("Surface", field)->minimum);
  }
  accept(rest, nullptr, lookup, "surface", violations);
}

}  // namespace

std::vector<v1::RangeWarning> surface_warnings(const v1::Surface& surface) {
  std::vector<v1::RangeWarning> out;
  const auto add = [&out](const char* code, const std::string& sentence) {
    if (sentence.empty()) return;
    out.push_back(to_message(RangeWarning{code, sentence}));
  };
  const v1::ParameterProvenance* known = find_provenance(surface.provenance(), kFromProfiles[0]);
  if (known == nullptr || !known->computed()) return out;
  add("PROFILE_NOT_RESOLVED", unresolved_text(surface.measurements()));
  add("SURFACE_PARTLY_MEASURED", unmeasured_text(surface.measurements()));
  return out;
}

std::optional<v1::Surface> import_surface(const v1::ImportSurfaceProfilesRequest& request,
                                          const std::string& name, const ResourceLookup& lookup,
                                          Violations& violations) {
  const std::size_t before = violations.size();
  v1::Surface surface = request.surface();
  surface.set_name(name);
  check_fields_of_profiles_unset(surface, violations);
  for (ReadProfile& profile : read_profiles(request, violations)) {
    *surface.add_measurements() = std::move(profile.measurement);
  }
  if (violations.size() > before) {
    check_other_fields(request.surface(), name, lookup, violations);
    return std::nullopt;
  }
  try {
    AsPublished as_published;
    as_published.eq46_square_root_of_sum = request.eq46_square_root_of_sum();
    set_parameters(surface, as_published);
  } catch (const Refusal& refusal) {
    violations.add("profiles", refusal.what());
    return std::nullopt;
  }
  return accept(surface, nullptr, lookup, "surface", violations);
}

}  // namespace tribodyn::server
