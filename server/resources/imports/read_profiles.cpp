#include "server/resources/imports/read_profiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "core/refusal.h"
#include "core/surface/gaussian_filter.h"
#include "core/surface/roughness_product.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/resources/imports/csv_table.h"
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
    violations.add(
        csv_place(table, table.rows[each.row].line, column.form.header),
        spacing > 0
            ? fmt::format("a step of {:.6g} m; allowed: {:.6g} m within {} of it, positions evenly "
                          "spaced and rising (eq 45)",
                          each.per_sample, spacing, kProfileSpacingTolerance)
            : fmt::format("a step of {:.6g} m; allowed: above 0, positions evenly spaced and "
                          "rising (eq 45)",
                          each.per_sample));
  }
  const Constraint& row = *find_constraint("SurfaceMeasurement", "spacing_metres");
  if (spacing > 0 && !row.allows(spacing)) {
    violations.add(table.name, out_of_range_text(row, spacing));
  }
}

struct LengthUnit {
  double metres;
  std::string_view symbol;
};
constexpr LengthUnit kLengthUnits[] = {{1, "m"}, {1e-3, "mm"}, {1e-6, "um"}, {1e-9, "nm"}};

/// Returns a question for another unit of the heights, or of the positions, with which the profile
/// would be that of a usual flank; empty if there is none.
std::string meant_unit_text(double height, double slope, const CsvColumn& heights,
                            const CsvColumn& positions) {
  const auto is_usual = [](double rms_height, double rms_slope) {
    return rms_height >= 1e-8 && rms_height <= 2e-5 && rms_slope >= 5e-3 && rms_slope <= 1;
  };
  for (const CsvColumn* column : {&heights, &positions}) {
    const double stated = column->form.factor;
    const auto* const written =
        std::find_if(std::begin(kLengthUnits), std::end(kLengthUnits),
                     [stated](const LengthUnit& unit) { return unit.metres == stated; });
    for (const LengthUnit& unit : kLengthUnits) {
      const double factor = unit.metres / stated;
      const double meant_height = column == &heights ? height * factor : height;
      const double meant_slope = column == &heights ? slope * factor : slope / factor;
      if (!is_usual(meant_height, meant_slope)) continue;
      return fmt::format(
          "; did you mean {}s in {}, not in {} (a factor of {:g})? The rms height would be {:.3g} "
          "um and the rms slope {:.3g}",
          column->form.quantity, unit.symbol, written->symbol, std::max(factor, 1 / factor),
          1e6 * meant_height, meant_slope);
    }
  }
  return "";
}

/// Adds a violation if no machined surface has such a profile.
void check_machined(const SpectralMoments& moments, const CsvColumn& heights,
                    const CsvColumn& positions, const std::string& name, Violations& violations) {
  const double height = std::sqrt(moments.m0), slope = std::sqrt(moments.m2);
  const bool slope_is_usual = slope >= kLeastRmsSlope && slope <= kMostRmsSlope;
  if (slope_is_usual && height >= kLeastRmsHeight && height <= kMostRmsHeight) return;
  violations.add(
      join_path(name, slope_is_usual ? "mean_square_height_square_metres" : "mean_square_slope"),
      fmt::format("rms height {:.3g} um and rms slope {:.3g}: no machined surface; allowed: {:g} "
                  "to {:g} um and {:g} to {:g}{}",
                  1e6 * height, slope, 1e6 * kLeastRmsHeight, 1e6 * kMostRmsHeight, kLeastRmsSlope,
                  kMostRmsSlope, meant_unit_text(height, slope, heights, positions)));
}

/// Returns a profile with its moments, or nullopt with all violations if it is not usable.
std::optional<ReadProfile> measure(const v1::SurfaceProfile& profile, v1::Levelling levelling,
                                   const ProfileBand& band, const std::string& name,
                                   Violations& violations) {
  const std::size_t before = violations.size();
  auto table = parse_csv(profile.csv(), name, kMaximumProfileBytes, violations);
  if (!table) return std::nullopt;
  const bool rows_are_missing = violations.size() > before;
  const std::vector<CsvColumn> columns = match_columns(*table, kProfileForms, violations);
  const CsvColumn* position = find_column(columns, kPosition);
  const CsvColumn* height = find_column(columns, kHeight);
  if (position == nullptr || height == nullptr) {
    violations.add(name, "allowed: a column position_... and a column height_...");
  }
  check_units_row(*table, columns, violations);
  const Constraint& samples = *find_constraint("SurfaceMeasurement", "samples");
  const auto count = static_cast<double>(table->rows.size());
  if (!samples.allows(count)) {
    violations.add(name, out_of_range_text(samples, count));
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
    ReadProfile read;
    read.levelling =
        levelling == v1::LEVELLING_MEAN ? Levelling::kMean : Levelling::kLeastSquaresLine;
    read.heights = filtered_profile(levelled_profile(heights, read.levelling), spacing, band);
    const SpectralMoments moments = spectral_moments(read.heights, spacing, read.levelling);
    v1::SurfaceMeasurement& out = read.measurement;
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
    check_machined(moments, *height, *position, name, violations);
    if (violations.size() == before) check_message(out, name, violations);
    return read;
  } catch (const Refusal& refusal) {
    violations.add(name, refusal.what());
    return std::nullopt;
  }
}

/// Checks what the request says of its profiles, but not their texts.
template <class Request>
void check_profiles(const Request& request, Violations& violations) {
  for (const auto& [field, value] :
       {std::pair("short_wave_cut_off_metres", request.short_wave_cut_off_metres()),
        std::pair("long_wave_cut_off_metres", request.long_wave_cut_off_metres())}) {
    const Constraint& row = *find_constraint(Request::descriptor()->name(), field);
    if (value == 0 || row.allows(value)) continue;
    violations.add(field, out_of_range_text(row, value));
  }
  if (request.profiles().empty() || request.profiles_size() > kMaximumProfiles) {
    violations.add("profiles", "{} profiles; allowed: 1 to {}", request.profiles_size(),
                   kMaximumProfiles);
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
    violations.add("profiles",
                   "two of one member without a direction; allowed: one, or each with its "
                   "direction, AXIAL or RADIAL (repeats of a direction are averaged)");
  }
  if (both && single) {
    violations.add("profiles", "the member is set in some; allowed: in all or none");
  }
  if (bytes > kMaximumProfileBytes) {
    violations.add("profiles", "{} bytes together; allowed: at most {}", bytes,
                   kMaximumProfileBytes);
  }
  for (int i = 0; i < request.profiles_size(); ++i) {
    const v1::SurfaceProfile& each = request.profiles(i);
    for (const v1::SurfaceProfile& other : request.profiles()) {
      const bool mixed = other.member() == each.member() &&
                         each.direction() == v1::PROFILE_DIRECTION_UNSPECIFIED &&
                         other.direction() != v1::PROFILE_DIRECTION_UNSPECIFIED;
      if (!mixed) continue;
      violations.add(fmt::format("profiles[{}].direction", i),
                     "not set; allowed: AXIAL or RADIAL, because another profile of this "
                     "member has a direction");
    }
    if (!v1::FlankMember_IsValid(each.member())) {
      violations.add(fmt::format("profiles[{}].member", i),
                     "allowed: FLANK_MEMBER_PINION, FLANK_MEMBER_GEAR or unset");
    }
    if (!v1::ProfileDirection_IsValid(each.direction())) {
      violations.add(fmt::format("profiles[{}].direction", i),
                     "allowed: PROFILE_DIRECTION_AXIAL, PROFILE_DIRECTION_RADIAL or unset");
    }
  }
  const bool has_two_directions =
      std::any_of(seen.begin(), seen.end(), [&seen](const std::pair<int, int>& each) {
        return each.second == v1::PROFILE_DIRECTION_AXIAL &&
               seen.count({each.first, v1::PROFILE_DIRECTION_RADIAL}) > 0;
      });
  if (request.eq46_square_root_of_sum() && !has_two_directions) {
    violations.add("eq46_square_root_of_sum",
                   "true; allowed: false, because eq 46 combines an AXIAL and a RADIAL "
                   "profile of one member, and no member has both");
  }
  if (!v1::Levelling_IsValid(request.levelling())) {
    violations.add("levelling", "allowed: LEVELLING_MEAN, LEVELLING_LEAST_SQUARES_LINE or unset");
  }
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

/// Checks the profiles of the request and reads those that are usable.
template <class Request>
std::vector<ReadProfile> checked_profiles(const Request& request, Violations& violations) {
  check_profiles(request, violations);
  const v1::Levelling levelling = request.levelling() == v1::LEVELLING_UNSPECIFIED
                                      ? v1::LEVELLING_LEAST_SQUARES_LINE
                                      : request.levelling();
  const ProfileBand band{request.short_wave_cut_off_metres(), request.long_wave_cut_off_metres()};
  std::vector<ReadProfile> out;
  for (int i = 0; i < std::min(request.profiles_size(), kMaximumProfiles); ++i) {
    auto profile = measure(request.profiles(i), levelling, band, fmt::format("profiles[{}].csv", i),
                           violations);
    if (profile) out.push_back(std::move(*profile));
  }
  return out;
}

}  // namespace

std::vector<ReadProfile> read_profiles(const v1::ImportSurfaceProfilesRequest& request,
                                       Violations& violations) {
  return checked_profiles(request, violations);
}

std::vector<ReadProfile> read_profiles(const v1::EvaluateProfilesRequest& request,
                                       Violations& violations) {
  return checked_profiles(request, violations);
}

MeasuredProfile measured_profile(const v1::SurfaceMeasurement& measurement) {
  return {measurement.member() == v1::FLANK_MEMBER_PINION ? FlankMember::kPinion
          : measurement.member() == v1::FLANK_MEMBER_GEAR ? FlankMember::kGear
                                                          : FlankMember::kBoth,
          measurement.direction() == v1::PROFILE_DIRECTION_AXIAL    ? ProfileDirection::kAxial
          : measurement.direction() == v1::PROFILE_DIRECTION_RADIAL ? ProfileDirection::kRadial
                                                                    : ProfileDirection::kAny,
          {measurement.mean_square_height_square_metres(), measurement.mean_square_slope(),
           measurement.mean_square_curvature_per_square_metre()}};
}

std::string unresolved_text(const Measurements& measurements) {
  std::string out;
  for (const v1::SurfaceMeasurement& each : measurements) {
    const double waves =
        wave_length_in_spacings(measured_profile(each).moments, each.spacing_metres());
    if (!(waves < kLeastSpacingsPerWave)) continue;
    const std::string sentence = fmt::format(
        "the waves of {} are {:.2g} sample spacings long (white noise: "
        "3): the profile contains the instrument's noise or was not filtered "
        "(ISO 3274 requires a cut-off lambda_s of at least 5 spacings)",
        profile_text(each), waves);
    if (out.find(sentence) == std::string::npos) out = join(out, sentence);  // repeats are alike
  }
  return out;
}

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

std::string unmeasured_text(const Measurements& measurements) {
  std::string text;
  std::set<v1::FlankMember> members;
  std::set<std::pair<v1::FlankMember, v1::ProfileDirection>> directions;
  for (const v1::SurfaceMeasurement& each : measurements) {
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

std::vector<std::string> profile_headers() { return headers_of(kProfileForms); }

}  // namespace tribodyn::server
