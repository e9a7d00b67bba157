#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/text/table.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// A warning of figures: what it says, and where it holds.
struct ShownWarning {
  std::string code;
  std::string summary;  ///< in a few words
  v1::WarningLevel level = v1::WARNING_LEVEL_NOTE;
  std::string message;     ///< a sentence; may be empty
  std::string where = {};  ///< e.g. "oil-a at 20 to 45 km/h"; empty: everywhere
};

ShownWarning shown_warning(const v1::RangeWarning& warning);
ShownWarning shown_warning(const v1::PointWarning& warning);
ShownWarning shown_warning(const v1::CandidateWarning& warning);
inline ShownWarning shown_warning(const ShownWarning& warning) { return warning; }

/// Whether a law is used outside the range in which it was measured or checked. Other warnings say
/// how a figure was computed.
inline bool is_outside_range(v1::WarningLevel level) { return level >= v1::WARNING_LEVEL_CAUTION; }
/// Whether the figures decide nothing between lubricants.
inline bool withholds_verdict(v1::WarningLevel level) {
  return level == v1::WARNING_LEVEL_WITHHOLDS_VERDICT;
}

/// Collects the warnings of an answer: each code once, with the places that it concerns.
class WarningCollector {
 public:
  /// `places`: what figures are of, in order, e.g. speeds; `unit` stands behind them, and `all` in
  /// place of all of them. `subjects`: what has figures at each place, e.g. lubricants.
  WarningCollector(std::vector<std::string> places, std::string unit, std::string all,
                   std::vector<std::string> subjects);

  template <class Warnings>
  void add(const Warnings& warnings, std::size_t subject, std::size_t place) {
    for (const auto& each : warnings) add(shown_warning(each), subject, place);
  }
  void add(const ShownWarning& warning, std::size_t subject, std::size_t place);

  /// Returns the warnings, those that withhold a verdict first, then by code. A message that
  /// differs from place to place is that of the first one, which it names.
  std::vector<ShownWarning> warnings() const;

 private:
  struct Found {
    ShownWarning first;
    std::string first_place;
    bool is_same_everywhere = true;
    std::map<std::size_t, std::set<std::size_t>> places;  // by subject
  };

  std::string text_of_places(const std::set<std::size_t>& affected) const;
  std::string where(const Found& found) const;

  std::vector<std::string> places_;
  std::string unit_, all_;
  std::vector<std::string> subjects_;
  std::map<std::string, Found> found_;
};

/// Returns a warning as sentences: plain words first, the code last.
std::string warning_sentence(const ShownWarning& warning);
/// Returns a note about an input: its message alone, which says all, and the code.
std::string note_sentence(const ShownWarning& note);
/// Adds warnings below headings: plain words first, the code last.
void add_warnings(const std::vector<ShownWarning>& warnings, Sheet& sheet);
/// Returns the same as text; empty if there are none.
std::string warnings_text(const std::vector<ShownWarning>& warnings);
/// Returns a warning without its message, for a line below a plot; `start` stands before it.
std::string footer_text(const ShownWarning& warning, const std::string& start = "");
/// Returns the warnings as a JSON list of objects.
std::string warnings_json(const std::vector<ShownWarning>& warnings);

/// Returns the codes of warnings, each once, separated by blanks: a cell of CSV.
template <class Warnings>
std::string codes_of(const Warnings& warnings) {
  std::set<std::string> known;
  std::string out;
  for (const auto& each : warnings) {
    std::string code;
    if constexpr (requires { each.code(); }) {
      code = each.code();
    } else {
      code = each.code;
    }
    if (known.insert(code).second) out += (out.empty() ? "" : " ") + code;
  }
  return out;
}

/// Returns the summary of the first warning that withholds the verdict; empty if none does.
template <class Warnings>
std::string withheld_by(const Warnings& warnings) {
  for (const auto& each : warnings) {
    const ShownWarning shown = shown_warning(each);
    if (withholds_verdict(shown.level)) return shown.summary;
  }
  return "";
}

/// Returns "withheld" or "withheld: SUMMARY".
std::string withheld_text(const std::string& summary);

/// One warning of curves and the speeds at which at least one curve has it.
struct CurveWarning : ShownWarning {
  std::string mark;  ///< "a", "b", ...: letter of the strip in the plot
  /// The speeds as ranges [km/h], each half way to its neighbours.
  std::vector<std::pair<double, double>> bands;
};

/// Returns every warning of the curves: those outside a range first, then by code.
std::vector<CurveWarning> curve_warnings(const std::vector<v1::Simulation>& simulations);

/// Returns the ranges of rising `x` in which `holds` is true; each reaches half way to the
/// neighbours.
std::vector<std::pair<double, double>> bands_where(const std::vector<double>& x,
                                                   const std::vector<bool>& holds);
std::vector<std::pair<double, double>> bands_where(const std::map<double, bool>& holds_at_x);

/// Returns the ranges of speed [km/h] in which `holds` is true for a result of some simulation,
/// ascending and without overlap. Each range reaches half way to the neighbouring speeds.
template <class Holds>
std::vector<std::pair<double, double>> speed_bands(const std::vector<v1::Simulation>& simulations,
                                                   const Holds& holds);

/// Joins ranges that touch or overlap.
std::vector<std::pair<double, double>> merged_bands(std::vector<std::pair<double, double>> spans);

/// Adds the warnings of one point or one curve.
void add_warnings(const v1::Simulation& simulation, Sheet& sheet);

template <class Holds>
std::vector<std::pair<double, double>> speed_bands(const std::vector<v1::Simulation>& simulations,
                                                   const Holds& holds) {
  std::vector<std::pair<double, double>> spans;
  for (const v1::Simulation& simulation : simulations) {
    std::vector<double> speeds;
    std::vector<bool> held;
    for (const v1::CurvePoint& point : simulation.result().points()) {
      speeds.push_back(point.speed_kilometres_per_hour());
      held.push_back(point.has_result() && holds(point.result()));
    }
    for (const auto& each : bands_where(speeds, held)) spans.push_back(each);
  }
  return merged_bands(std::move(spans));
}

}  // namespace tribodyn::client
