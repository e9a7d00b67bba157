#pragma once

namespace tribodyn {

/// Nodes and weights of the classical Runge-Kutta step: stage i starts from the rates of stage
/// i - 1 over kRungeKuttaNode[i] of the step.
inline constexpr double kRungeKuttaNode[4] = {0, 0.5, 0.5, 1};
inline constexpr double kRungeKuttaWeight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};

}  // namespace tribodyn
