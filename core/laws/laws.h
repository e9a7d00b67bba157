#pragma once

#include "core/laws/asperities-inl.h"
#include "core/laws/film-inl.h"
#include "core/laws/heat-inl.h"
#include "core/laws/hertz-inl.h"
#include "core/laws/pressure_growth-inl.h"
#include "core/laws/shear-inl.h"
#include "core/laws/viscosity-inl.h"
#include "core/numerics/dual-inl.h"

namespace tribodyn {

/// One equation per function, without state, on double, packs and dual numbers. The headers ending
/// in -inl.h declare everything once per instruction set in a namespace of its own, as Highway's
/// files do: files that are compiled once per instruction set include those, all others this one,
/// which names the set of the compiler's options.
namespace laws = HWY_NAMESPACE;

}  // namespace tribodyn
