#include "core/study/unused_tolerance.h"

#include <string>

#include "core/number_text.h"

namespace tribodyn {

std::optional<RangeWarning> unused_march_tolerance(const PointOptions& options,
                                                   const PointResult& result) {
  const bool is_quasi_static = result.model == PointModel::kQuasiStatic;
  if (!is_quasi_static && result.method == SteadyStateMethod::kMarch) return std::nullopt;
  const PointOptions defaults;
  std::string unread;
  int count = 0;
  const auto add = [&](const char* name, double value, double default_value) {
    if (value == default_value) return;
    unread += (count++ > 0 ? " and " : "") + std::string(name) + " = " + number_text(value);
  };
  add("march_step_tolerance", options.march_step_tolerance, defaults.march_step_tolerance);
  add("march_settling_tolerance", options.march_settling_tolerance,
      defaults.march_settling_tolerance);
  if (count == 0) return std::nullopt;
  return RangeWarning{"MARCH_TOLERANCE_UNUSED",
                      unread +
                          (count > 1 ? " were not read: only a march reads them, "
                                     : " was not read: only a march reads it, ") +
                          (is_quasi_static ? "and this point was answered by the quasi-static model"
                                           : "and this point was found by shooting") +
                          ", to tolerance = " + number_text(options.tolerance)};
}

}  // namespace tribodyn
