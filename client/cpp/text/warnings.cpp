#include "client/cpp/text/warnings.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct KnownWarning {
  std::string_view code;
  const char* words;
  bool outside_range;
  bool forbids_ranking;
};

constexpr std::array<KnownWarning, 24> kKnownWarnings = {{
    {"COLD_INLET", "cold inlet, do not rank oils here", true, true},
    {"FILM_RATIO", "film thinner than the asperity model holds for", true, false},
    {"LIMITING_STRESS", "most of the loaded area on the limiting shear stress", true, false},
    {"PRESSURE", "pressure outside the range in which friction was measured", true, false},
    {"RADIUS_RATIO", "contact ellipse slimmer than the fits of eqs 21 and 22 hold for", true,
     false},
    {"ROUGHNESS_PRODUCT", "roughness outside the range of the asperity model", true, false},
    {"VISCOSITY_TEMPERATURE", "temperature outside the range in which viscosity was measured", true,
     false},
    {"BARELY_ATTRACTS", "response that hardly attracts", false, false},
    {"FLANKS_TAP", "flanks that tap each other under hardly any load", false, false},
    {"ISOTHERMAL", "isothermal model", false, false},
    {"NOT_SETTLED", "no steady period, averages over a record", false, false},
    {"PERIOD", "response with a period of several mesh cycles", false, false},
    {"QUASI_STATIC", "quasi-static model", false, false},
    {"RATTLES", "rattle, averages with a statistical error", false, false},
    {"RESPONSES_COEXIST", "another response at the same point", false, false},
    {"BASE_OIL_UNSPECIFIED", "class of base oil not stated", false, false},
    {"DENSITY_ESTIMATED", "density estimated, not measured", false, false},
    {"EXPANSION_ESTIMATED", "thermal expansion estimated, not measured", false, false},
    {"PARAMETER_ESTIMATED", "parameters of the fluid estimated, not measured", false, false},
    {"PROFILE_NOT_RESOLVED", "roughness profile of noise or not filtered", false, false},
    {"SURFACE_PARTLY_MEASURED", "roughness measured in part", false, false},
    {"VISCOSITY_EXTRAPOLATED", "viscosity extrapolated in temperature", false, false},
    {"VISCOSITY_MISFIT", "viscosity law misses a measurement", false, false},
    {"VOGEL_REFERENCE_TEMPERATURE_ASSUMED", "curvature of the viscosity law assumed", false, false},
}};

const KnownWarning* find_warning(const std::string& code) {
  const auto* const found =
      std::find_if(kKnownWarnings.begin(), kKnownWarnings.end(),
                   [&](const KnownWarning& each) { return each.code == code; });
  return found == kKnownWarnings.end() ? nullptr : found;
}

/// Returns e.g. "20 to 45 and 60 km/h": runs of neighbours among all speeds of the curves.
std::string text_of_speeds(const std::set<double>& all, const std::set<double>& affected) {
  if (affected.size() == all.size()) {
    return all.size() == 1 ? significant(*all.begin()) + " km/h" : "all speeds";
  }
  std::vector<std::string> runs;
  for (auto speed = all.begin(); speed != all.end();) {
    if (affected.count(*speed) == 0) {
      ++speed;
      continue;
    }
    const double first = *speed;
    double last = first;
    for (; speed != all.end() && affected.count(*speed) > 0; ++speed) last = *speed;
    runs.push_back(first == last ? significant(first)
                                 : significant(first) + " to " + significant(last));
  }
  std::string text = runs.front();
  for (std::size_t i = 1; i < runs.size(); ++i) {
    text += (i + 1 == runs.size() ? " and " : ", ") + runs[i];
  }
  return text + " km/h";
}

bool has_warning(const v1::PointResult& result, const std::string& code) {
  return std::any_of(result.warnings().begin(), result.warnings().end(),
                     [&](const v1::RangeWarning& each) { return each.code() == code; });
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// Returns a remark. For a curve it contains the message of the first speed only.
std::string remark_of(const CurveWarning& warning, bool is_curve) {
  const std::string words = capitalised(warning_words(warning.code));
  const std::string where = is_curve ? ", at " + warning.speeds_text + ". At " +
                                           significant(warning.first_speed) + " km/h: "
                                     : ": ";
  return words + where + warning.first_message + ". [" + warning.code + "]";
}

}  // namespace

std::string warning_words(const std::string& code) {
  if (const KnownWarning* known = find_warning(code)) return known->words;
  std::string words = code.empty() ? "warning" : printable(code);
  std::transform(words.begin(), words.end(), words.begin(), [](unsigned char c) {
    return c == '_' ? ' ' : static_cast<char>(std::tolower(c));
  });
  return words;
}

bool is_outside_range(const std::string& code) {
  const KnownWarning* known = find_warning(code);
  return known == nullptr || known->outside_range;
}

bool forbids_ranking(const std::string& code) {
  const KnownWarning* known = find_warning(code);
  return known != nullptr && known->forbids_ranking;
}

std::vector<std::pair<double, double>> merged_bands(std::vector<std::pair<double, double>> spans) {
  std::sort(spans.begin(), spans.end());
  std::vector<std::pair<double, double>> bands;
  for (const auto& span : spans) {
    if (!bands.empty() && span.first <= bands.back().second) {
      bands.back().second = std::max(bands.back().second, span.second);
    } else {
      bands.push_back(span);
    }
  }
  return bands;
}

std::vector<CurveWarning> curve_warnings(const std::vector<v1::Simulation>& simulations) {
  std::set<double> all_speeds;
  std::map<std::string, CurveWarning> by_code;
  std::map<std::string, std::set<double>> speeds;
  std::map<std::string, std::vector<std::string>> names;
  for (const v1::Simulation& simulation : simulations) {
    for (const v1::CurvePoint& point : simulation.result().points()) {
      const double speed = point.speed_kilometres_per_hour();
      all_speeds.insert(speed);
      for (const v1::RangeWarning& each : point.result().warnings()) {
        CurveWarning& warning = by_code[each.code()];
        if (warning.speeds++ == 0) {
          warning.code = each.code();
          warning.first_speed = speed;
          warning.first_message = each.message();
        }
        speeds[each.code()].insert(speed);
        std::vector<std::string>& concerned = names[each.code()];
        if (concerned.empty() || concerned.back() != simulation.lubricant()) {
          concerned.push_back(simulation.lubricant());
        }
      }
    }
  }
  std::vector<CurveWarning> warnings;
  for (auto& [code, warning] : by_code) {
    warning.speeds_text = text_of_speeds(all_speeds, speeds[code]);
    if (names[code].size() < simulations.size()) warning.names = names[code];
    warning.bands = speed_bands(simulations, [&, wanted = code](const v1::PointResult& result) {
      return has_warning(result, wanted);
    });
    warnings.push_back(std::move(warning));
  }
  std::stable_sort(warnings.begin(), warnings.end(),
                   [](const CurveWarning& a, const CurveWarning& b) {
                     return is_outside_range(a.code) && !is_outside_range(b.code);
                   });
  char mark = 'a';
  for (CurveWarning& warning : warnings) {
    if (is_outside_range(warning.code) && !forbids_ranking(warning.code) && mark <= 'z') {
      warning.mark = std::string(1, mark++);
    }
  }
  return warnings;
}

void add_warnings(const v1::Simulation& simulation, Sheet& sheet) {
  std::string last_heading;
  for (const CurveWarning& warning : curve_warnings({simulation})) {
    const std::string heading =
        is_outside_range(warning.code) ? "Outside the validated range" : "Method of computation";
    if (heading != last_heading) sheet.heading(heading);
    last_heading = heading;
    sheet.remark(remark_of(warning, simulation.has_inefficiency_curve()));
  }
}

}  // namespace tribodyn::client
