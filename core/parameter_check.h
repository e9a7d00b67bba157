#pragma once

#include <cmath>
#include <string>

#include "core/number_text.h"
#include "core/refusal.h"

namespace tribodyn {

/// What a parameter must be for the laws to hold, however unusual it is. Always finite.
enum class Bound { kFinite, kPositive, kNotNegative, kNotPositive };

/// Collects the parameters that are out of their bounds, for one Refusal. `name`: as the structure
/// has it; value and unit: SI, "1" for none.
class ParameterCheck {
 public:
  void expect(const char* name, double value, const char* unit, Bound bound) {
    switch (bound) {
      case Bound::kFinite:
        return expect(true, name, value, unit, "finite");
      case Bound::kPositive:
        return expect(value > 0, name, value, unit, "positive");
      case Bound::kNotNegative:
        return expect(value >= 0, name, value, unit, "zero or positive");
      case Bound::kNotPositive:
        return expect(value <= 0, name, value, unit, "zero or negative");
    }
  }
  /// `allowed`: what is allowed, such as "above -1 and at most 0.5".
  void expect(bool is_allowed, const char* name, double value, const char* unit,
              const char* allowed) {
    if (is_allowed && std::isfinite(value)) return;
    wrong_ += std::string(wrong_.empty() ? "" : "; ") + name + " = " + number_text(value) +
              (std::string(unit) == "1" ? "" : std::string(" ") + unit) + ", allowed: " + allowed;
  }
  /// Throws Refusal PARAMETER_OUT_OF_RANGE, all violations in one sentence, if there are any.
  void conclude() const {
    if (!wrong_.empty()) throw Refusal("PARAMETER_OUT_OF_RANGE", wrong_);
  }

 private:
  std::string wrong_;
};

}  // namespace tribodyn
