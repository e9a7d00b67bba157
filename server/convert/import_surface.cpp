#include "server/convert/import_surface.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "core/refusal.h"
#include "core/surface/spectral_moments.h"
#include "server/convert/accept_resource.h"
#include "server/convert/csv_table.h"
#include "server/hash/sha256.h"

namespace tribodyn::server {
namespace {

constexpr double kSpacingTolerance = 1e-3;  // of the spacing

constexpr char kPosition[] = "position";
constexpr char kHeight[] = "height";

constexpr CsvColumnForm kForms[] = {{"position_metres", kPosition},
                                    {"position_millimetres", kPosition, 1e-3},
                                    {"position_micrometres", kPosition, 1e-6},
                                    {"height_metres", kHeight},
                                    {"height_millimetres", kHeight, 1e-3},
                                    {"height_micrometres", kHeight, 1e-6},
                                    {"height_nanometres", kHeight, 1e-9}};

/// The even spacing of positions; 0 with violations when it is not even.
double spacing_of(const CsvTable& table, const CsvColumn& column,
                  const std::vector<double>& positions, Violations& violations) {
  const double spacing =
      (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
  std::size_t uneven = 0;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    const double step = positions[i] - positions[i - 1];
    if (spacing > 0 && std::abs(step - spacing) <= kSpacingTolerance * spacing) continue;
    if (++uneven > kMaximumCsvViolations) break;
    violations.push_back({csv_place(table, table.rows[i].line, column.form.header),
                          fmt::format("a step of {} m; legal: {} m within {}, positions evenly "
                                      "spaced and rising (eq 45)",
                                      step, spacing, kSpacingTolerance)});
  }
  return uneven == 0 ? spacing : 0;
}

std::optional<v1::SurfaceMeasurement> measure(const v1::SurfaceProfile& profile,
                                              v1::Levelling levelling, const std::string& name,
                                              Violations& violations) {
  const std::size_t before = violations.size();
  const auto table = parse_csv(profile.csv(), name, kMaximumProfileBytes, violations);
  if (!table) return std::nullopt;
  const std::vector<CsvColumn> columns = match_columns(*table, kForms, violations);
  const CsvColumn* position = find_column(columns, kPosition);
  const CsvColumn* height = find_column(columns, kHeight);
  if (position == nullptr || height == nullptr) {
    violations.push_back({name, "legal: a column position_... and a column height_..."});
  }
  if (violations.size() > before) return std::nullopt;
  const auto positions = numbers(*table, *position, EmptyCells::kViolation, violations);
  const auto heights = numbers(*table, *height, EmptyCells::kViolation, violations);
  if (violations.size() > before) return std::nullopt;
  const double spacing =
      positions.size() < 2 ? 0 : spacing_of(*table, *position, positions, violations);
  if (violations.size() > before) return std::nullopt;
  try {
    const SpectralMoments moments = spectral_moments(
        heights, spacing, levelling == v1::MEAN ? Levelling::kMean : Levelling::kLeastSquaresLine);
    v1::SurfaceMeasurement out;
    out.set_member(profile.member());
    out.set_direction(profile.direction());
    out.set_levelling(levelling);
    out.set_samples(static_cast<int>(heights.size()));
    out.set_spacing_metres(spacing);
    out.set_mean_square_height_square_metres(moments.m0);
    out.set_mean_square_slope(moments.m2);
    out.set_mean_square_curvature_per_square_metre(moments.m4);
    out.set_profile_sha256(sha256(profile.csv()));
    return out;
  } catch (const Refusal& refusal) {
    violations.push_back({name, refusal.what()});
    return std::nullopt;
  }
}

SpectralMoments moments_of(const v1::SurfaceMeasurement& measurement) {
  return {measurement.mean_square_height_square_metres(), measurement.mean_square_slope(),
          measurement.mean_square_curvature_per_square_metre()};
}

/// The isotropic surface of one member; nothing when it was not measured.
std::optional<SpectralMoments> member_moments(const v1::Surface& surface, v1::FlankMember member) {
  std::vector<SpectralMoments> found;
  for (const v1::SurfaceMeasurement& each : surface.measurements()) {
    if (each.member() == member) found.push_back(moments_of(each));
  }
  if (found.empty()) return std::nullopt;
  if (found.size() == 1) return found.front();
  return equivalent_isotropic_moments(found[0], found[1], AsPublished{});
}

std::string join(const std::string& a, const std::string& b) {
  return a.empty() ? b : a + "; " + b;
}

void set_parameters(v1::Surface& surface) {
  const auto both = member_moments(surface, v1::FLANK_MEMBER_UNSPECIFIED);
  const auto pinion = member_moments(surface, v1::PINION);
  const auto gear = member_moments(surface, v1::GEAR);
  std::string warning;
  if (!pinion || !gear) {
    warning = both ? "both flanks taken to be as the measured profile"
                   : "only one flank measured, the other taken to be like it";
  }
  const SpectralMoments one = both ? *both : pinion ? *pinion : *gear;
  const Roughness roughness =
      greenwood_tripp_roughness(composite_moments(pinion.value_or(one), gear.value_or(one)));
  std::set<v1::FlankMember> members;
  for (const v1::SurfaceMeasurement& each : surface.measurements()) members.insert(each.member());
  if (members.size() == static_cast<std::size_t>(surface.measurements_size())) {
    warning = join(warning, "taken to be isotropic: one direction measured");
  } else if (surface.measurements_size() == 3) {
    warning = join(warning, "one flank taken to be isotropic: one direction measured");
  }
  surface.set_asperity_density_per_square_metre(roughness.asperity_density);
  surface.set_asperity_radius_metres(roughness.asperity_radius);
  surface.set_composite_rms_height_metres(roughness.composite_rms_height);
  for (const char* field : {"asperity_density_per_square_metre", "asperity_radius_metres",
                            "composite_rms_height_metres"}) {
    v1::ParameterProvenance* entry = surface.add_provenance();
    entry->set_field(field);
    entry->set_provenance(v1::PROVENANCE_FITTED);
    entry->set_source("measured profiles, eqs 45 to 48");
    entry->set_warning(warning);
    entry->set_computed(true);
  }
}

/// What the profiles tell must not be stated as well.
void check_not_stated(const v1::Surface& surface, Violations& violations) {
  const auto& reflection = *surface.GetReflection();
  for (const char* name : {"asperity_density_per_square_metre", "asperity_radius_metres",
                           "composite_rms_height_metres", "measurements"}) {
    const auto* field = v1::Surface::descriptor()->FindFieldByName(name);
    const bool stated = field->is_repeated() ? reflection.FieldSize(surface, field) > 0
                                             : reflection.HasField(surface, field);
    if (!stated) continue;
    violations.push_back({std::string("surface.") + name,
                          std::string(name) + " follows from the profiles; legal: not set"});
  }
}

void check_profiles(const v1::ImportSurfaceProfilesRequest& request, Violations& violations) {
  if (request.profiles().empty() || request.profiles_size() > kMaximumProfiles) {
    violations.push_back({"profiles", fmt::format("{} profiles; legal: 1 to {}",
                                                  request.profiles_size(), kMaximumProfiles)});
    return;
  }
  std::size_t bytes = 0;
  std::set<std::pair<int, int>> seen;
  bool both = false, single = false;
  for (const v1::SurfaceProfile& profile : request.profiles()) {
    bytes += profile.csv().size();
    (profile.member() == v1::FLANK_MEMBER_UNSPECIFIED ? both : single) = true;
    if (seen.emplace(profile.member(), profile.direction()).second) continue;
    violations.push_back(
        {"profiles",
         "two of one member and direction; legal: one (name the direction, AXIAL or "
         "RADIAL, of each)"});
  }
  if (both && single) {
    violations.push_back({"profiles", "the member is stated for some; legal: for all or none"});
  }
  if (bytes > kMaximumProfileBytes) {
    violations.push_back({"profiles", fmt::format("{} bytes together; legal: at most {}", bytes,
                                                  kMaximumProfileBytes)});
  }
  for (int i = 0; i < request.profiles_size(); ++i) {
    const v1::SurfaceProfile& each = request.profiles(i);
    for (const v1::SurfaceProfile& other : request.profiles()) {
      const bool mixed = other.member() == each.member() &&
                         each.direction() == v1::PROFILE_DIRECTION_UNSPECIFIED &&
                         other.direction() != v1::PROFILE_DIRECTION_UNSPECIFIED;
      if (!mixed) continue;
      violations.push_back({fmt::format("profiles[{}].direction", i),
                            "not set; legal: AXIAL or RADIAL, as another profile of this member "
                            "states one"});
    }
    if (!v1::FlankMember_IsValid(each.member())) {
      violations.push_back({fmt::format("profiles[{}].member", i), "legal: PINION, GEAR or unset"});
    }
    if (!v1::ProfileDirection_IsValid(each.direction())) {
      violations.push_back(
          {fmt::format("profiles[{}].direction", i), "legal: AXIAL, RADIAL or unset"});
    }
  }
  if (!v1::Levelling_IsValid(request.levelling())) {
    violations.push_back({"levelling", "legal: MEAN, LEAST_SQUARES_LINE or unset"});
  }
}

}  // namespace

std::vector<std::string> profile_headers() {
  std::vector<std::string> out;
  for (const CsvColumnForm& form : kForms) out.emplace_back(form.header);
  return out;
}

std::optional<v1::Surface> import_surface(const v1::ImportSurfaceProfilesRequest& request,
                                          const std::string& name, const ResourceLookup& lookup,
                                          Violations& violations) {
  const std::size_t before = violations.size();
  v1::Surface surface = request.surface();
  surface.set_name(name);
  check_not_stated(surface, violations);
  check_profiles(request, violations);
  if (violations.size() > before) return std::nullopt;
  const v1::Levelling levelling = request.levelling() == v1::LEVELLING_UNSPECIFIED
                                      ? v1::LEAST_SQUARES_LINE
                                      : request.levelling();
  for (int i = 0; i < request.profiles_size(); ++i) {
    auto measured =
        measure(request.profiles(i), levelling, fmt::format("profiles[{}].csv", i), violations);
    if (measured) *surface.add_measurements() = std::move(*measured);
  }
  if (violations.size() > before) {
    check_stated(request.surface(), lookup, "surface", violations);
    return std::nullopt;
  }
  try {
    set_parameters(surface);
  } catch (const Refusal& refusal) {
    violations.push_back({"profiles", refusal.what()});
    return std::nullopt;
  }
  return accept(surface, static_cast<const v1::Surface*>(nullptr), lookup, "surface", violations);
}

}  // namespace tribodyn::server
