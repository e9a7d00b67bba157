#pragma once

namespace tribodyn {

/// Quantile of Student's t distribution [-]. Requires degrees_of_freedom > 0, not necessarily
/// whole, and 0 < probability < 1.
double students_t_quantile(double degrees_of_freedom, double probability);

}  // namespace tribodyn
