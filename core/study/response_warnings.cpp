#include "core/study/response_warnings.h"

#include <cmath>
#include <limits>
#include <string>

#include "core/number_text.h"

namespace tribodyn {

std::optional<RangeWarning> barely_attracts_warning(double multiplier, double doubt) {
  if (!(std::abs(1 - multiplier) <= doubt)) return std::nullopt;
  return RangeWarning{
      "BARELY_ATTRACTS",
      "the largest Floquet multiplier, " + number_text(multiplier, 6) +
          ", is within its error of 1: disturbances hardly die out, or hardly grow"};
}

std::vector<RangeWarning> orbit_warnings(const PeriodicOrbit& orbit) {
  std::vector<RangeWarning> out;
  if (orbit.barely_attracts) {
    constexpr double kAnyDoubt = std::numeric_limits<double>::infinity();
    out.push_back(
        barely_attracts_warning(orbit.multiplier_with_friction.value_or(1), kAnyDoubt).value());
  }
  if (orbit.is_tapping) {
    out.push_back({"FLANKS_TAP",
                   "under so light a load the flanks tap each other once in a mesh cycle; released "
                   "elsewhere in the backlash they may rattle for long, with far more loss"});
  }
  return out;
}

std::optional<RangeWarning> coexistence_warning(const PointProblem& problem, bool contact_loss) {
  if (!problem.options.warn_of_coexisting_response) return std::nullopt;
  OtherResponses& others = problem.gear_set.other_responses();
  const PeriodicProblem periodic = problem.periodic(problem.options.tolerance);
  std::string sentence;
  if (contact_loss) {
    if (!others.may_be_quiet(periodic)) return std::nullopt;
    sentence = "a response without contact loss exists here too, or nearly: start = QUASI_STATIC";
  } else {
    if (!others.may_be_loud(periodic)) return std::nullopt;
    sentence = "a response with contact loss exists here too, or nearly: start = LARGE_VIBRATION";
  }
  return RangeWarning{"RESPONSES_COEXIST",
                      sentence + " leads there (found under a friction coefficient of 0.05)"};
}

}  // namespace tribodyn
