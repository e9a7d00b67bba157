#include "server/resources/imports/import_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <vector>

#include "core/model_options.h"
#include "core/refusal.h"
#include "core/surface/gaussian_filter.h"
#include "core/surface/measured_surface.h"
#include "core/surface/roughness_product.h"
#include "core/surface/spectral_moments.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/resources/accept_resource.h"
#include "server/resources/imports/csv_table.h"
#include "server/resources/provenance.h"
#include "server/support/sha256.h"

namespace tribodyn::server {
namespace {

constexpr double kProfileSpacingTolerance = 1e-3;  // relative to the spacing

constexpr char kPosition[] = "position";
constexpr char kHeight[] = "height";

// Names and units in the headers of instruments: "X (mm)", "Profile [um]".
constexpr char kPositionNames[] = "x|position|distance|length";
constexpr char kHeightNames[] = "z|height|profile";

constexpr CsvColumnForm kProfileForms[] = {
    {"position_metres", kPosition, 1, 0, kPositionNames, "m"},
    {"position_millimetres", kPosition, 1e-3, 0, kPositionNames, "mm"},
    {"position_micrometres", kPosition, 1e-6, 0, kPositionNames, "um"},
    {"height_metres", kHeight, 1, 0, kHeightNames, "m"},
    {"height_millimetres", kHeight, 1e-3, 0, kHeightNames, "mm"},
    {"height_micrometres", kHeight, 1e-6, 0, kHeightNames, "um"},
    {"height_nanometres", kHeight, 1e-9, 0, kHeightNames, "nm"}};

constexpr const char* kFromProfiles[] = {"asperity_density_per_square_metre",
                                         "asperity_radius_metres", "composite_rms_height_metres"};

/// Distance from one readable position of a profile to the next one.
struct Step {
  std::size_t row = 0;    ///< row of the later position
  double per_sample = 0;  ///< distance divided by the number of rows [m]
};

/// Returns the steps between readable positions. If rows are missing, their number is unknown: then
/// a step across them is left out.
std::vector<Step> steps_of(const CsvTable& table, const std::vector<double>& positions,
                           bool rows_are_missing) {
  std::vector<Step> out;
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (std::isnan(positions[i])) continue;
    if (last) {
      const std::size_t samples = i - *last;
      const int lines = table.rows[i].line - table.rows[*last].line;
      if (!rows_are_missing || lines == static_cast<int>(samples)) {
        out.push_back({i, (positions[i] - positions[*last]) / static_cast<double>(samples)});
      }
    }
    last = i;
  }
  return out;
}

double median(const std::vector<Step>& steps) {
  std::vector<double> values;
  values.reserve(steps.size());
  for (const Step& each : steps) values.push_back(each.per_sample);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Adds a violation for each position that does not rise, or whose step differs from the median
/// step.
void check_spacing(const CsvTable& table, const CsvColumn& column, const std::vector<Step>& steps,
                   Violations& violations) {
  if (steps.empty()) return;
  const double spacing = median(steps);
  std::size_t wrong = 0;
  for (const Step& each : steps) {
    const bool rises = each.per_sample > 0;
    const bool even =
        spacing <= 0 || std::abs(each.per_sample - spacing) <= kProfileSpacingTolerance * spacing;
    if (rises && even) continue;
    if (++wrong > kMaximumCsvViolations) return;
    violations.push_back(
        {csv_place(table, table.rows[each.row].line, column.form.header),
         spacing > 0
             ? fmt::format(
                   "a step of {:.6g} m; allowed: {:.6g} m within {} of it, positions evenly "
                   "spaced and rising (eq 45)",
                   each.per_sample, spacing, kProfileSpacingTolerance)
             : fmt::format("a step of {:.6g} m; allowed: above 0, positions evenly spaced and "
                           "rising (eq 45)",
                           each.per_sample)});
  }
  const Constraint& row = *find_constraint("SurfaceMeasurement", "spacing_metres");
  if (spacing > 0 && !(spacing >= row.minimum && spacing <= row.maximum)) {
    violations.push_back({table.name, out_of_range_text(row, spacing)});
  }
}

/// Returns the moments of a profile, or nullopt with all violations if it is not usable.
std::optional<v1::SurfaceMeasurement> measure(const v1::SurfaceProfile& profile,
                                              v1::Levelling levelling, const ProfileBand& band,
                                              const std::string& name, Violations& violations) {
  const std::size_t before = violations.size();
  auto table = parse_csv(profile.csv(), name, kMaximumProfileBytes, violations);
  if (!table) return std::nullopt;
  const bool rows_are_missing = violations.size() > before;
  const std::vector<CsvColumn> columns = match_columns(*table, kProfileForms, violations);
  const CsvColumn* position = find_column(columns, kPosition);
  const CsvColumn* height = find_column(columns, kHeight);
  if (position == nullptr || height == nullptr) {
    violations.push_back({name, "allowed: a column position_... and a column height_..."});
  }
  check_units_row(*table, columns, violations);
  const Constraint& samples = *find_constraint("SurfaceMeasurement", "samples");
  const auto count = static_cast<double>(table->rows.size());
  if (count < samples.minimum || count > samples.maximum) {
    violations.push_back({name, out_of_range_text(samples, count)});
  }
  std::vector<double> positions;
  std::vector<double> heights;
  if (position != nullptr) {
    positions = numbers(*table, *position, EmptyCells::kViolation, violations);
    check_spacing(*table, *position, steps_of(*table, positions, rows_are_missing), violations);
  }
  if (height != nullptr) heights = numbers(*table, *height, EmptyCells::kViolation, violations);
  if (violations.size() > before) return std::nullopt;
  const double spacing =
      (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
  try {
    const Levelling level =
        levelling == v1::LEVELLING_MEAN ? Levelling::kMean : Levelling::kLeastSquaresLine;
    const SpectralMoments moments = spectral_moments(
        filtered_profile(levelled_profile(heights, level), spacing, band), spacing, level);
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
    out.set_short_wave_cut_off_metres(band.shortest);
    out.set_long_wave_cut_off_metres(band.longest);
    check_message(out, name, violations);
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

MeasuredProfile measured_profile(const v1::SurfaceMeasurement& measurement) {
  return {measurement.member() == v1::FLANK_MEMBER_PINION ? FlankMember::kPinion
          : measurement.member() == v1::FLANK_MEMBER_GEAR ? FlankMember::kGear
                                                          : FlankMember::kBoth,
          measurement.direction() == v1::PROFILE_DIRECTION_AXIAL    ? ProfileDirection::kAxial
          : measurement.direction() == v1::PROFILE_DIRECTION_RADIAL ? ProfileDirection::kRadial
                                                                    : ProfileDirection::kAny,
          moments_of(measurement)};
}

std::string join(const std::string& a, const std::string& b) {
  return a.empty() ? b : a + "; " + b;
}

/// Returns e.g. "the pinion's axial profile".
std::string profile_text(const v1::SurfaceMeasurement& measurement) {
  std::string text = measurement.member() == v1::FLANK_MEMBER_PINION ? "the pinion's "
                     : measurement.member() == v1::FLANK_MEMBER_GEAR ? "the gear's "
                                                                     : "the ";
  if (measurement.direction() == v1::PROFILE_DIRECTION_AXIAL) text += "axial ";
  if (measurement.direction() == v1::PROFILE_DIRECTION_RADIAL) text += "radial ";
  return text + "profile";
}

/// Returns a sentence for each profile whose sampling is too coarse for its waves.
std::string unresolved_text(const v1::Surface& surface) {
  std::string out;
  for (const v1::SurfaceMeasurement& each : surface.measurements()) {
    const double waves = wave_length_in_spacings(moments_of(each), each.spacing_metres());
    if (!(waves < kLeastSpacingsPerWave)) continue;
    out =
        join(out, fmt::format("the waves of {} are {:.2g} sample spacings long (white noise: "
                              "3): the profile contains the instrument's noise or was not filtered "
                              "(ISO 3274 requires a cut-off lambda_s of at least 5 spacings)",
                              profile_text(each), waves));
  }
  return out;
}

/// Returns a sentence if no steel surface has this product of Greenwood and Tripp's parameters.
std::string product_text(const Roughness& roughness) {
  const double product = roughness_product(roughness);
  if (product >= kLeastRoughnessProduct && product <= kMostRoughnessProduct) return "";
  return fmt::format(
      "eta_G beta_G sigma_G is {:.3g}; Greenwood and Tripp give {} to {} for steel on steel{}",
      product, kLeastRoughnessProduct, kMostRoughnessProduct,
      product > kMostRoughnessProduct
          ? ": the band of wave lengths of the profiles is too wide; filter them"
          : "");
}

/// Returns the flanks and directions without a profile.
std::string unmeasured_text(const v1::Surface& surface) {
  std::string text;
  std::set<v1::FlankMember> members;
  std::set<std::pair<v1::FlankMember, v1::ProfileDirection>> directions;
  for (const v1::SurfaceMeasurement& each : surface.measurements()) {
    members.insert(each.member());
    directions.emplace(each.member(), each.direction());
  }
  const bool both = members.contains(v1::FLANK_MEMBER_UNSPECIFIED);
  if (!members.contains(v1::FLANK_MEMBER_PINION) || !members.contains(v1::FLANK_MEMBER_GEAR)) {
    text = both ? "both flanks taken to be as the measured profile"
                : "only one flank measured, the other taken to be like it";
  }
  if (members.size() == directions.size()) {
    text = join(text, "taken to be isotropic: one direction measured");
  } else if (directions.size() == 3) {
    text = join(text, "one flank taken to be isotropic: one direction measured");
  }
  return text;
}

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
  std::string warning = unmeasured_text(surface);
  for (const std::string& each : {unresolved_text(surface), product_text(roughness)}) {
    if (!each.empty()) warning = join(warning, each);
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
    violations.push_back(
        {"surface." + name, name + " follows from the profiles; allowed: not set"});
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
  accept(rest, static_cast<const v1::Surface*>(nullptr), lookup, "surface", violations);
}

void check_profiles(const v1::ImportSurfaceProfilesRequest& request, Violations& violations) {
  for (const auto& [field, value] :
       {std::pair("short_wave_cut_off_metres", request.short_wave_cut_off_metres()),
        std::pair("long_wave_cut_off_metres", request.long_wave_cut_off_metres())}) {
    const Constraint& row = *find_constraint("ImportSurfaceProfilesRequest", field);
    if (value == 0 || (value >= row.minimum && value <= row.maximum)) continue;
    violations.push_back({field, out_of_range_text(row, value)});
  }
  if (request.profiles().empty() || request.profiles_size() > kMaximumProfiles) {
    violations.push_back({"profiles", fmt::format("{} profiles; allowed: 1 to {}",
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
    // Profiles with a direction may be repeats.
    if (profile.direction() != v1::PROFILE_DIRECTION_UNSPECIFIED) continue;
    violations.push_back({"profiles",
                          "two of one member without a direction; allowed: one, or each with its "
                          "direction, AXIAL or RADIAL (repeats of a direction are averaged)"});
  }
  if (both && single) {
    violations.push_back({"profiles", "the member is set in some; allowed: in all or none"});
  }
  if (bytes > kMaximumProfileBytes) {
    violations.push_back({"profiles", fmt::format("{} bytes together; allowed: at most {}", bytes,
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
                            "not set; allowed: AXIAL or RADIAL, because another profile of this "
                            "member has a direction"});
    }
    if (!v1::FlankMember_IsValid(each.member())) {
      violations.push_back({fmt::format("profiles[{}].member", i),
                            "allowed: FLANK_MEMBER_PINION, FLANK_MEMBER_GEAR or unset"});
    }
    if (!v1::ProfileDirection_IsValid(each.direction())) {
      violations.push_back({fmt::format("profiles[{}].direction", i),
                            "allowed: PROFILE_DIRECTION_AXIAL, PROFILE_DIRECTION_RADIAL or unset"});
    }
  }
  const bool has_two_directions =
      std::any_of(seen.begin(), seen.end(), [&seen](const std::pair<int, int>& each) {
        return each.second == v1::PROFILE_DIRECTION_AXIAL &&
               seen.count({each.first, v1::PROFILE_DIRECTION_RADIAL}) > 0;
      });
  if (request.eq46_square_root_of_sum() && !has_two_directions) {
    violations.push_back({"eq46_square_root_of_sum",
                          "true; allowed: false, because eq 46 combines an AXIAL and a RADIAL "
                          "profile of one member, and no member has both"});
  }
  if (!v1::Levelling_IsValid(request.levelling())) {
    violations.push_back(
        {"levelling", "allowed: LEVELLING_MEAN, LEVELLING_LEAST_SQUARES_LINE or unset"});
  }
}

}  // namespace

std::vector<v1::RangeWarning> surface_warnings(const v1::Surface& surface) {
  std::vector<v1::RangeWarning> out;
  const auto add = [&out](const char* code, const std::string& sentence) {
    if (sentence.empty()) return;
    v1::RangeWarning& warning = out.emplace_back();
    warning.set_code(code);
    warning.set_message(sentence);
  };
  const v1::ParameterProvenance* known = find_provenance(surface.provenance(), kFromProfiles[0]);
  if (known == nullptr || !known->computed()) return out;
  add("PROFILE_NOT_RESOLVED", unresolved_text(surface));
  add("SURFACE_PARTLY_MEASURED", unmeasured_text(surface));
  return out;
}

std::vector<std::string> profile_headers() {
  std::vector<std::string> out;
  for (const CsvColumnForm& form : kProfileForms) out.emplace_back(form.header);
  return out;
}

std::optional<v1::Surface> import_surface(const v1::ImportSurfaceProfilesRequest& request,
                                          const std::string& name, const ResourceLookup& lookup,
                                          Violations& violations) {
  const std::size_t before = violations.size();
  v1::Surface surface = request.surface();
  surface.set_name(name);
  check_fields_of_profiles_unset(surface, violations);
  check_profiles(request, violations);
  const v1::Levelling levelling = request.levelling() == v1::LEVELLING_UNSPECIFIED
                                      ? v1::LEVELLING_LEAST_SQUARES_LINE
                                      : request.levelling();
  const ProfileBand band{request.short_wave_cut_off_metres(), request.long_wave_cut_off_metres()};
  for (int i = 0; i < std::min(request.profiles_size(), kMaximumProfiles); ++i) {
    auto measured = measure(request.profiles(i), levelling, band,
                            fmt::format("profiles[{}].csv", i), violations);
    if (measured) *surface.add_measurements() = std::move(*measured);
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
    violations.push_back({"profiles", refusal.what()});
    return std::nullopt;
  }
  return accept(surface, static_cast<const v1::Surface*>(nullptr), lookup, "surface", violations);
}

}  // namespace tribodyn::server
