#pragma once

namespace tribodyn {

inline double square(double v) { return v * v; }

}  // namespace tribodyn
