#pragma once

#include <array>
#include <string>
#include <vector>

#include "client/cpp/paper/study.h"
#include "client/cpp/plot/panel.h"

namespace tribodyn::client {

/// What the corrected model says of a statement of the paper.
enum class Verdict {
  // Of a prediction.
  kHolds,
  kPartly,
  kNot,
  // Of a measurement: the model may disagree with it, but cannot refute it.
  kAgrees,
  kAgreesInPart,
  kDisagrees,
  /// The model cannot decide: it was calibrated to the statement, or the statement compares
  /// measurements that are not at hand.
  kOpen,
};

/// How a verdict is named and drawn.
struct VerdictLook {
  const char* text;
  const char* style;   ///< class of the style sheet of pages
  const char* colour;  ///< in pictures
};
/// In the order of Verdict.
inline constexpr std::array<VerdictLook, 7> kVerdictLooks = {
    {{"holds", "holds", "#0b6b48"},
     {"partly", "partly", "#8a5a00"},
     {"does not hold", "does-not-hold", "#a83200"},
     {"model agrees", "holds", "#0b6b48"},
     {"model agrees in part", "partly", "#8a5a00"},
     {"model disagrees", "does-not-hold", "#a83200"},
     {"open", "open", "#555555"}}};
constexpr const VerdictLook& verdict_look(Verdict verdict) {
  return kVerdictLooks[static_cast<std::size_t>(verdict)];
}
/// Whether the model contradicts the statement.
constexpr bool contradicts(Verdict verdict) {
  return verdict == Verdict::kNot || verdict == Verdict::kDisagrees;
}

/// A number that a verdict rests on.
struct Evidence {
  std::string quantity;  ///< e.g. "isothermal"
  std::string unit;      ///< empty: none
  std::string at;        ///< e.g. "20 km/h"; empty: of the whole figure
  double value;
};

struct Finding {
  std::string statement;  ///< what the paper states
  Verdict verdict;
  std::string rule;  ///< what the verdict depends on, and what explains the rest
  std::vector<Evidence> evidence;
};

/// A figure of the paper as a study of the service.
struct PaperFigure {
  std::string name;     ///< "10"; "conclusions" for the statements of section 4
  std::string title;    ///< what the figure shows
  std::string studied;  ///< the computed quantities and their conditions
  std::vector<PaperCurve> curves;
  std::vector<PaperRig> rigs;
  std::vector<Finding> (*findings)(const PaperResults& results);
  /// Panels without places, drawn one below the other.
  std::vector<Panel> (*panels)(const PaperResults& results);
  /// What other laws and misprints give where the corrected model contradicts the paper.
  std::string variants_title = {};
  std::vector<Evidence> (*variants)(const PaperResults& results) = nullptr;
};

/// Returns all figures in their order, the conclusions last. This table alone defines them.
const std::vector<PaperFigure>& paper_figures();

// The parts of the table, by subject.
std::vector<PaperFigure> rig_figures();           ///< 5, 9 and 14
std::vector<PaperFigure> dynamics_figures();      ///< 6, 7, 8 and 11
std::vector<PaperFigure> inefficiency_figures();  ///< 10, 12, 13, 15, 16 and the conclusions

/// Sump temperatures of figures 11 and 12 [C].
inline constexpr double kSumps[] = {10, 40, 90};
inline constexpr char kSumpsAreChosen[] =
    " The paper does not name its three temperatures: 10, 40 and 90 C are this page's choice.";

/// Returns a sweep of lubricant 1 at 40 C that goes to 170 km/h, beyond all speeds at which contact
/// is lost: a down-sweep from 140 km/h would miss the response with impacts above 118 km/h.
PaperCurve wide_sweep(bool is_down_sweep, const std::string& gear_set = PaperCurve().gear_set);

/// Figures of a point.
double rms_inefficiency(const v1::PointResult& result);      ///< [%]
double energy_inefficiency(const v1::PointResult& result);   ///< [%]
double mean_friction_torque(const v1::PointResult& result);  ///< on the pinion, braking [N m]

/// Returns the evidence of a line at some places of its x, e.g. at 20 "km/h".
void add_evidence(const std::string& quantity, const std::string& unit, const PaperLine& line,
                  const std::vector<double>& places, const std::string& place_unit,
                  std::vector<Evidence>& out);

/// Returns a series with the look of `index`; `is_second` gives its dashed look.
Series paper_series(const PaperLine& line, std::size_t index, const std::string& label,
                    bool is_second = false);
Panel paper_panel(const std::string& title, const std::string& x_title);

}  // namespace tribodyn::client
