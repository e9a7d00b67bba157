#pragma once

namespace tribodyn {

/// Changes whenever any result can change by a bit: laws, defaults, solver, friction kernel
/// variant.
inline constexpr char kModelVersion[] = "tribodyn-model-20";

}  // namespace tribodyn
