#pragma once

namespace tribodyn {

/// A drawn value of an input with a standard uncertainty, `deviation` standard normal: log-normal
/// with the stated value as median if that is positive, so that no draw is negative, else normal.
/// The value without an uncertainty, or at deviation 0. A relative uncertainty above 10 counts as
/// 10.
double drawn_value(double value, double standard_uncertainty, double deviation);

}  // namespace tribodyn
